//! Fills the pyramid: `prefilter.wgsl` makes level 0 from the density, `downsample.wgsl` the others.

use super::volume::{GpuVolume, entry};
use super::{Context, GpuError, ShaderLibrary};

/// Levels of the pyramid to fill, finest first.
pub(super) fn levels(volume: &GpuVolume) -> u32 {
    volume.pyramid.mip_level_count()
}

/// Fills one level. The one above must be complete.
pub(super) fn fill(
    context: &Context,
    shaders: &ShaderLibrary,
    volume: &GpuVolume,
    level: u32,
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
    let bind_group = context.device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("Pyramid::bind_group"),
        layout: &pipeline.get_bind_group_layout(0),
        entries: &[
            entry(0, wgpu::BindingResource::TextureView(&source)),
            entry(1, wgpu::BindingResource::Sampler(&volume.clamped)),
            entry(2, wgpu::BindingResource::TextureView(&view_of(level))),
        ],
    });
    let size = volume.pyramid.size();
    let texels = [size.width, size.height, size.depth_or_array_layers].map(|n| (n >> level).max(1));
    let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
        label: Some("Pyramid::fill"),
        timestamp_writes: None,
    });
    pass.set_pipeline(&pipeline);
    pass.set_bind_group(0, &bind_group, &[]);
    pass.dispatch_workgroups(texels[0].div_ceil(8), texels[1].div_ceil(4), texels[2].div_ceil(4));
    Ok(())
}
