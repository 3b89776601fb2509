//! Gradients of the pyramid in a texture of their own, while memory allows.

use std::ops::Range;

use super::pass;
use super::uniforms;
use super::volume::{GpuVolume, entry};
use super::{Context, GpuError, ShaderLibrary};

/// Most bytes that gradients may take: 512³ voxels need 1.29 GB, with coarser levels. Beyond that, a
/// volume's gradients are six fetches of the pyramid each.
const MAX_BYTES: u64 = 3 << 29;

/// Makes the texture beside a pyramid; `None` where it would take too much memory.
pub(super) fn texture(context: &Context, pyramid: &wgpu::Texture) -> Option<wgpu::Texture> {
    let size = pyramid.size();
    let texels = u64::from(size.width) * u64::from(size.height) * u64::from(size.depth_or_array_layers);
    if bytes(texels) > MAX_BYTES {
        return None;
    }
    let texture = context.texture(&wgpu::TextureDescriptor {
        label: Some("Gradients::texture"),
        size,
        mip_level_count: pyramid.mip_level_count(),
        sample_count: 1,
        dimension: wgpu::TextureDimension::D3,
        format: wgpu::TextureFormat::Rgba16Float,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::STORAGE_BINDING,
        view_formats: &[],
    });
    // Pictures do without.
    texture.inspect_err(|err| log::info!("no texture of gradients: {err}")).ok()
}

/// Bytes for so many texels of the finest level: 8 each, and a seventh for the coarser levels.
pub(super) fn bytes(texels: u64) -> u64 {
    texels * 64 / 7
}

/// Fills some slices of one level from the pyramid, which must be complete.
pub(super) fn fill(
    context: &Context,
    shaders: &ShaderLibrary,
    volume: &GpuVolume,
    level: u32,
    slices: &Range<u32>,
    encoder: &mut wgpu::CommandEncoder,
) -> Result<(), GpuError> {
    let Some(gradients) = &volume.gradients else { return Ok(()) };
    let view_of = |texture: &wgpu::Texture| {
        texture.create_view(&wgpu::TextureViewDescriptor {
            label: Some("Gradients::level"),
            base_mip_level: level,
            mip_level_count: Some(1),
            ..Default::default()
        })
    };
    let pipeline = shaders.pipeline("gradients.wgsl", &[])?;
    let spacing = (1u32 << level) as f32;
    let uniform = uniforms::Slices { first: slices.start, end: slices.end, spacing, pad0: 0 };
    let uniform = context.buffer("Gradients::slices", &[uniform], wgpu::BufferUsages::UNIFORM);
    let bind_group = pass::bind(
        context,
        "Gradients::bind_group",
        &pipeline,
        0,
        &[
            entry(0, wgpu::BindingResource::TextureView(&view_of(&volume.pyramid))),
            entry(3, uniform.as_entire_binding()),
            entry(4, wgpu::BindingResource::TextureView(&view_of(gradients))),
        ],
    );
    let size = gradients.size();
    let [width, height] = [size.width, size.height].map(|n| (n >> level).max(1));
    pass::dispatch(
        encoder,
        "Gradients::fill",
        &pipeline,
        &[&bind_group],
        [width.div_ceil(8), height.div_ceil(4), (slices.end - slices.start).div_ceil(4)],
    );
    Ok(())
}
