//! Fills a light volume by a ray from every voxel to the light.

use super::volume::LightVolume;
use crate::gpu::eye::gather::pack_light;
use crate::gpu::resources::kernel::{cut_constant, kernel_constants, quadrature_constant};
use crate::gpu::resources::listed_bricks::{self, Listed};
use crate::gpu::resources::pass;
use crate::gpu::resources::uniforms;
use crate::gpu::volume::transfer_tables::{EVERYWHERE, Tables, view_entry};
use crate::gpu::volume::{Gpu, Levels, entry};
use crate::gpu::{GpuError, RenderOptions};
use crate::model::{Deposit, SceneLight, Settings};
use crate::plan::ray_reach;

/// Bricks per submission: 16 × 512 rays, each through the whole of a dense 256³ volume, take a
/// software adapter some 0.2 s.
pub(crate) const BRICKS_PER_STEP: usize = 16;

/// The variant of the shader for a kernel.
pub(crate) fn constants(settings: &Settings) -> [(&'static str, f64); 5] {
    let shadows = &settings.shadows;
    let [kernel, sigma] = kernel_constants(shadows.kernel);
    let front = f64::from(u8::from(shadows.deposit == Deposit::Front));
    [
        kernel,
        sigma,
        quadrature_constant(shadows.quadrature),
        ("DEPOSIT_FRONT", front),
        cut_constant(settings.cuts.shading()),
    ]
}

/// Fills the listed bricks of a light volume.
pub(crate) fn raycast(
    gpu: Gpu<'_>,
    tables: &Tables,
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
    let pipeline =
        shaders.pipeline_into("light/raycast.wgsl", &constants(settings), target.texture.format())?;
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
            entry(0, uniform.as_entire_binding()),
            entry(1, tables.lighting.buffer.as_entire_binding()),
            view_entry(2, &tables.light_distances),
            entry(3, list.as_entire_binding()),
            view_entry(4, &target.view),
        ],
    );
    let seen = i32::from(ray_reach(&settings.shadows, &volume.scene));
    let dilation = if options.empty_space_skipping { seen } else { EVERYWHERE };
    let of_volume = gpu.bind_volume(&pipeline, dilation, Levels::Finest);
    pass::dispatch(
        encoder,
        "Raycast::pass",
        &pipeline,
        &[&own, &of_volume],
        listed_bricks::workgroups(bricks.len() as u32),
    );
    Ok(())
}
