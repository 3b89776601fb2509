//! Fills the pyramid: `prefilter.wgsl` makes level 0 from the density, `downsample.wgsl` the others.

use std::ops::Range;

use super::pass;
use super::uniforms;
use super::volume::{GpuVolume, entry};
use super::{Context, GpuError, ShaderLibrary};

/// Levels of the pyramid to fill, finest first.
pub(super) fn levels(volume: &GpuVolume) -> u32 {
    volume.pyramid.mip_level_count()
}

/// Texels per step: 8 fetches each, some 40 ms on a software adapter.
const STEP_TEXELS: u32 = 1 << 18;

/// A level and its slices, cut into short steps.
pub(super) fn steps(volume: &GpuVolume, level: u32) -> Vec<(u32, Range<u32>)> {
    let [width, height, depth] = texels(volume, level);
    let slices = (STEP_TEXELS / (width * height)).max(1);
    (0..depth).step_by(slices as usize).map(|first| (level, first..depth.min(first + slices))).collect()
}

/// Texels of a level along x, y, z.
fn texels(volume: &GpuVolume, level: u32) -> [u32; 3] {
    let size = volume.pyramid.size();
    [size.width, size.height, size.depth_or_array_layers].map(|n| (n >> level).max(1))
}

/// Fills some slices of one level. The finer level must be complete.
pub(super) fn fill(
    context: &Context,
    shaders: &ShaderLibrary,
    volume: &GpuVolume,
    level: u32,
    slices: &Range<u32>,
    encoder: &mut wgpu::CommandEncoder,
) -> Result<(), GpuError> {
    let view_of = |level: u32| {
        volume.pyramid.create_view(&wgpu::TextureViewDescriptor {
            label: Some("Pyramid::level"),
            base_mip_level: level,
            mip_level_count: Some(1),
            ..Default::default()
        })
    };
    let (shader, source) = match level {
        0 => ("prefilter.wgsl", volume.density_view.clone()),
        _ => ("downsample.wgsl", view_of(level - 1)),
    };
    let pipeline = shaders.pipeline(shader, &[])?;
    let spacing = (1u32 << level) as f32;
    let uniform = uniforms::Slices { first: slices.start, end: slices.end, spacing, pad0: 0 };
    let uniform = context.buffer("Pyramid::slices", &[uniform], wgpu::BufferUsages::UNIFORM);
    let bind_group = pass::bind(
        context,
        "Pyramid::bind_group",
        &pipeline,
        0,
        &[
            entry(0, wgpu::BindingResource::TextureView(&source)),
            entry(1, wgpu::BindingResource::Sampler(&volume.clamped)),
            entry(2, wgpu::BindingResource::TextureView(&view_of(level))),
            entry(3, uniform.as_entire_binding()),
        ],
    );
    let [width, height, _] = texels(volume, level);
    pass::dispatch(
        encoder,
        "Pyramid::fill",
        &pipeline,
        &[&bind_group],
        [width.div_ceil(8), height.div_ceil(4), (slices.end - slices.start).div_ceil(4)],
    );
    Ok(())
}
