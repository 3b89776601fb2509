//! Ray casting of a light volume: ray marching from every voxel to the light.

use super::fill_inputs::{LightTables, LightWithSettings};
use super::light_uniform::light_uniform;
use super::light_volume::LightVolume;
use crate::pipelines::binding::{bind_buffer, bind_view};
use crate::pipelines::pipeline_variant::{
    GridBoundaries, PipelineVariant, ReconstructionVariant, ShaderConstants, deposit_constant, flag, is_cut,
};
use crate::pipelines::uniforms;
use crate::plan::ray_reach;
use crate::resources::pass;
use crate::volume::brick_list::{self, BrickEntry};
use crate::volume::transfer_tables::UNLIMITED_REACH;
use crate::volume::{PyramidLevels, VolumeContext};
use crate::{GpuError, RenderOptions};
use chiaroscuro_scene::{DepositMode, Settings};

/// Number of bricks per submission: 16 × 512 rays, each through the whole of a dense 256³ volume, take a software
/// adapter some 0.2 s.
pub(crate) const BRICKS_PER_STEP: usize = 16;

/// Pipeline variant of rays to lights.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct RaycastVariant {
    reconstruction: ReconstructionVariant,
    deposit: DepositMode,
    is_cut: bool,
    /// Channel of the gathered values that holds extinction.
    component: u32,
}

impl RaycastVariant {
    /// Creates the variant without grid boundaries.
    pub(crate) fn from_settings(settings: &Settings) -> Self {
        let shadows = &settings.shadows;
        Self {
            reconstruction: ReconstructionVariant::new(settings.light_kernel(), shadows.quadrature),
            deposit: shadows.deposit,
            is_cut: is_cut(settings.cuts.shadowing_part()),
            component: 0,
        }
    }

    /// Sets the grid boundaries that rays may meet.
    pub(crate) fn with_boundaries(mut self, ends: GridBoundaries) -> Self {
        self.reconstruction = self.reconstruction.with_boundaries(ends);
        self
    }
}

impl PipelineVariant for RaycastVariant {
    fn shader(&self) -> &'static str {
        "light/raycast.wgsl"
    }

    fn constants(&self) -> ShaderConstants {
        let mut constants = self.reconstruction.constants();
        constants.extend([
            deposit_constant(self.deposit),
            flag("CUT", self.is_cut),
            ("EXTINCTION_CHANNEL", f64::from(self.component)),
        ]);
        constants
    }
}

/// Fills the listed bricks of a light volume, for white light or one of its colours.
pub(crate) fn raycast(
    gpu: VolumeContext<'_>,
    LightTables { tables, color }: LightTables<'_>,
    LightWithSettings { light, settings }: LightWithSettings<'_>,
    options: &RenderOptions,
    target: &LightVolume,
    bricks: &[BrickEntry],
    encoder: &mut wgpu::CommandEncoder,
) -> Result<(), GpuError> {
    if bricks.is_empty() {
        return Ok(());
    }
    let VolumeContext { shaders, volume, .. } = gpu;
    let seen = i32::from(ray_reach(&settings.shadows, &volume.scene));
    let dilation = if options.switches.empty_space_skipping { seen } else { UNLIMITED_REACH };
    let met = tables.lighting_of_color(color);
    let component = met.extinction_channel;
    let rays = RaycastVariant::from_settings(settings).with_boundaries(met.boundaries(volume, dilation, 0.0));
    let variant = RaycastVariant { component, ..rays };
    let pipeline = shaders.pipeline_into(&variant, target.texture.format())?;
    let uniform = uniforms::RaycastUniform {
        light: light_uniform(light, Some(target), &volume.scene, settings),
        space: uniforms::SpaceUniform::new(&volume.scene),
        dims: target.dims.map(|n| n as u32),
        bricks: bricks.len() as u32,
        voxel_step: target.divisor as f32,
        ray_step: settings.shadows.ray_step(&volume.scene) as f32,
        max_optical_depth: options.switches.max_optical_depth(),
        pad0: 0,
        shading_cut: uniforms::CutUniform::new(&settings.cuts.shadowing_part().region(&volume.scene)),
    };
    let uniform = gpu.uniform("Raycast::uniform", uniform);
    let list = brick_list::upload_bricks(gpu, bricks);
    let own = gpu.bind(
        "Raycast::bind_group",
        &pipeline,
        0,
        &[
            bind_buffer("bound_raycast", &uniform),
            bind_buffer("table", met.lookup_buffer()),
            bind_view("distances", &tables.light_distances),
            bind_buffer("bricks", &list),
            bind_view("attenuation", &target.view),
        ],
    );
    let of_volume =
        gpu.bind_volume(&pipeline, dilation, PyramidLevels::Finest, tables.lighting_pyramids(volume));
    pass::dispatch(
        encoder,
        "Raycast::pass",
        &pipeline,
        &[&own, &of_volume],
        brick_list::two_workgroups_per_brick(bricks.len() as u32),
    );
    Ok(())
}
