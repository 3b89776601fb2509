//! Coloured shadows: attenuation volumes of red, green and blue light, computed in turn and merged into one.

use super::light_volume::LightVolume;
use crate::pipelines::binding::{NamedResource, bind_view};
use crate::pipelines::pipeline_variant::SingleVariant;
use crate::resources::pass;
use crate::volume::VolumeContext;
use crate::volume::brick_list::{self, BrickEntry};
use crate::{GpuContext, GpuError};
use chiaroscuro_scene::LIGHT_COLORS;

/// Temporary volumes for filling an attenuation volume of three colours.
#[derive(Debug)]
pub(crate) struct ColorVolumes([LightVolume; LIGHT_COLORS]);

impl ColorVolumes {
    /// Allocates the temporary volumes for a light whose volume is `whole`.
    ///
    /// # Errors
    /// Returns an error if memory is exhausted.
    pub(crate) fn new(context: &GpuContext, whole: &LightVolume) -> Result<Self, GpuError> {
        let plane = || whole.with_same_voxels(context, context.storage_format);
        Ok(Self([plane()?, plane()?, plane()?]))
    }

    /// Returns the size of all temporary volumes, in bytes.
    pub(crate) fn bytes(&self) -> u64 {
        self.0.iter().map(LightVolume::bytes).sum()
    }

    /// Returns the volume of a colour: 0 red, 1 green, 2 blue.
    pub(crate) fn volume(&self, color: usize) -> &LightVolume {
        &self.0[color % LIGHT_COLORS]
    }

    /// Merges the three volumes into the light's own volume, in the listed bricks.
    pub(crate) fn merge(
        &self,
        gpu: VolumeContext<'_>,
        whole: &LightVolume,
        bricks: &[BrickEntry],
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<(), GpuError> {
        if bricks.is_empty() {
            return Ok(());
        }
        let pipeline = gpu
            .shaders
            .pipeline_into(&SingleVariant("light/colored_shadows.wgsl"), whole.texture.format())?;
        let list = brick_list::upload_bricks(gpu, bricks);
        let [red, green, blue] = &self.0;
        let entries = [
            NamedResource { name: "bricks", resource: brick_list::bind_exact_length(&list, bricks) },
            bind_view("red", &red.view),
            bind_view("green", &green.view),
            bind_view("blue", &blue.view),
            bind_view("attenuation", &whole.view),
        ];
        let own = gpu.bind("ColorPlanes::bind_group", &pipeline, 0, &entries);
        let groups = brick_list::two_workgroups_per_brick(bricks.len() as u32);
        pass::dispatch(encoder, "ColorPlanes::join", &pipeline, &[&own], groups);
        Ok(())
    }
}
