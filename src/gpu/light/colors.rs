//! Coloured shadows: attenuation volumes of red, green and blue light, computed in turn and merged into one.

use super::volume::LightVolume;
use crate::gpu::pipelines::binding::{Named, view_of};
use crate::gpu::pipelines::variant::Only;
use crate::gpu::resources::pass;
use crate::gpu::volume::Gpu;
use crate::gpu::volume::listed_bricks::{self, Listed};
use crate::gpu::{Context, GpuError};
use crate::model::COLORS;

/// Temporary volumes for filling an attenuation volume of three colours.
#[derive(Debug)]
pub(crate) struct ColorPlanes([LightVolume; COLORS]);

impl ColorPlanes {
    /// Allocates the temporary volumes for a light whose volume is `whole`.
    ///
    /// # Errors
    /// Returns an error if memory is exhausted.
    pub(crate) fn new(context: &Context, whole: &LightVolume) -> Result<Self, GpuError> {
        let plane = || whole.alike(context, context.storage_format);
        Ok(Self([plane()?, plane()?, plane()?]))
    }

    /// Returns the size of all temporary volumes, in bytes.
    pub(crate) fn bytes(&self) -> u64 {
        self.0.iter().map(LightVolume::bytes).sum()
    }

    /// Returns the volume of a colour: 0 red, 1 green, 2 blue.
    pub(crate) fn plane(&self, color: usize) -> &LightVolume {
        &self.0[color % COLORS]
    }

    /// Merges the three volumes into the light's own volume, in the listed bricks.
    pub(crate) fn join(
        &self,
        gpu: Gpu<'_>,
        whole: &LightVolume,
        bricks: &[Listed],
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<(), GpuError> {
        if bricks.is_empty() {
            return Ok(());
        }
        let pipeline = gpu.shaders.pipeline_into(&Only("light/colors.wgsl"), whole.texture.format())?;
        let list = listed_bricks::upload(gpu, bricks);
        let [red, green, blue] = &self.0;
        let entries = [
            Named { name: "bricks", resource: listed_bricks::exactly(&list, bricks) },
            view_of("red", &red.view),
            view_of("green", &green.view),
            view_of("blue", &blue.view),
            view_of("attenuation", &whole.view),
        ];
        let own = gpu.bind("ColorPlanes::bind_group", &pipeline, 0, &entries);
        let groups = listed_bricks::workgroups(bricks.len() as u32);
        pass::dispatch(encoder, "ColorPlanes::join", &pipeline, &[&own], groups);
        Ok(())
    }
}
