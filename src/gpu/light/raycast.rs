//! Ray casting of a light volume: a ray from every voxel to the light.

use super::packed::pack_light;
use super::volume::LightVolume;
use crate::gpu::pipelines::binding::{buffer, view_of};
use crate::gpu::pipelines::uniforms;
use crate::gpu::pipelines::variant::{
    Constants, Ends, Reconstruction, Variant, deposit_constant, flag, is_cut,
};
use crate::gpu::resources::pass;
use crate::gpu::volume::listed_bricks::{self, Listed};
use crate::gpu::volume::transfer_tables::{EVERYWHERE, Tables};
use crate::gpu::volume::{Gpu, Levels};
use crate::gpu::{GpuError, RenderOptions};
use crate::model::{Deposit, SceneLight, Settings};
use crate::plan::ray_reach;

/// Number of bricks per submission: 16 × 512 rays, each through the whole of a dense 256³ volume, take a software
/// adapter some 0.2 s.
pub(crate) const BRICKS_PER_STEP: usize = 16;

/// Pipeline variant of rays to lights.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct RaycastVariant {
    reconstruction: Reconstruction,
    deposit: Deposit,
    is_cut: bool,
    /// Channel of the gathered values that holds extinction.
    component: u32,
}

impl RaycastVariant {
    /// Creates the variant without grid boundaries.
    pub(crate) fn of(settings: &Settings) -> Self {
        let shadows = &settings.shadows;
        Self {
            reconstruction: Reconstruction::new(settings.light_kernel(), shadows.quadrature),
            deposit: shadows.deposit,
            is_cut: is_cut(settings.cuts.shading()),
            component: 0,
        }
    }

    /// Sets the grid boundaries that rays may meet.
    pub(crate) fn ending(mut self, ends: Ends) -> Self {
        self.reconstruction = self.reconstruction.ending(ends);
        self
    }
}

impl Variant for RaycastVariant {
    fn shader(&self) -> &'static str {
        "light/raycast.wgsl"
    }

    fn constants(&self) -> Constants {
        let mut constants = self.reconstruction.constants();
        constants.extend([
            deposit_constant(self.deposit),
            flag("CUT", self.is_cut),
            ("GATHERED", f64::from(self.component)),
        ]);
        constants
    }
}

/// Fills the listed bricks of a light volume, for white light or one of its colours.
pub(crate) fn raycast(
    gpu: Gpu<'_>,
    (tables, color): (&Tables, Option<usize>),
    (light, settings): (&SceneLight, &Settings),
    options: &RenderOptions,
    target: &LightVolume,
    bricks: &[Listed],
    encoder: &mut wgpu::CommandEncoder,
) -> Result<(), GpuError> {
    if bricks.is_empty() {
        return Ok(());
    }
    let Gpu { shaders, volume, .. } = gpu;
    let seen = i32::from(ray_reach(&settings.shadows, &volume.scene));
    let dilation = if options.empty_space_skipping { seen } else { EVERYWHERE };
    let met = tables.met(color);
    let component = met.component;
    let rays = RaycastVariant::of(settings).ending(met.ends(volume, dilation, 0.0));
    let variant = RaycastVariant { component, ..rays };
    let pipeline = shaders.pipeline_into(&variant, target.texture.format())?;
    let uniform = uniforms::Raycast {
        light: pack_light(light, Some(target), &volume.scene, settings),
        space: uniforms::Space::new(&volume.scene),
        dims: target.dims.map(|n| n as u32),
        bricks: bricks.len() as u32,
        voxel_step: target.divisor as f32,
        ray_step: settings.shadows.ray_step(&volume.scene) as f32,
        dark: options.max_optical_depth(),
        pad0: 0,
        shading_cut: uniforms::Cut::new(&settings.cuts.shading().region(&volume.scene)),
    };
    let uniform = gpu.uniform("Raycast::uniform", uniform);
    let list = listed_bricks::upload(gpu, bricks);
    let own = gpu.bind(
        "Raycast::bind_group",
        &pipeline,
        0,
        &[
            buffer("bound_raycast", &uniform),
            buffer("table", met.gathered()),
            view_of("distances", &tables.light_distances),
            buffer("bricks", &list),
            view_of("attenuation", &target.view),
        ],
    );
    let of_volume = gpu.bind_volume(&pipeline, dilation, Levels::Finest, tables.lighting_pyramids(volume));
    pass::dispatch(
        encoder,
        "Raycast::pass",
        &pipeline,
        &[&own, &of_volume],
        listed_bricks::workgroups(bricks.len() as u32),
    );
    Ok(())
}
