//! Precomputed gradients of the pyramid in a texture, where memory allows.

use std::ops::Range;

use super::{LevelBuffers, level_buffers, level_view};
use crate::pipelines::binding::{bind_buffer, bind_view};
use crate::pipelines::pipeline_variant::SingleVariant;
use crate::resources::pass;
use crate::volume::GpuVolume;
use crate::volume::brick_list;
use crate::{GpuContext, GpuError, ShaderLibrary};

/// Maximum size of the gradient texture, in bytes: 512³ voxels need 1.29 GB with the coarser levels. Larger volumes
/// take each gradient from twelve fetches of the pyramid.
const MAX_GRADIENT_BYTES: u64 = 3 << 29;

/// Creates the gradient texture for a pyramid; `None` if it would be too large or memory is exhausted.
pub(crate) fn gradient_texture(context: &GpuContext, pyramid: &wgpu::Texture) -> Option<wgpu::Texture> {
    let size = pyramid.size();
    let texels = u64::from(size.width) * u64::from(size.height) * u64::from(size.depth_or_array_layers);
    if gradient_bytes(texels) > MAX_GRADIENT_BYTES {
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
    // Not an error: without the texture, shaders compute gradients from the pyramid.
    texture.inspect_err(|err| log::info!("no texture of gradients: {err}")).ok()
}

/// Returns the size in bytes for `texels` texels of the finest level: 8 each, and a seventh for the coarser levels.
pub(crate) fn gradient_bytes(texels: u64) -> u64 {
    texels * 64 / 7
}

/// Fills the gradients of some bricks of one level. The pyramid must be complete.
pub(crate) fn fill_gradients(
    context: &GpuContext,
    shaders: &ShaderLibrary,
    volume: &GpuVolume,
    level: u32,
    range: &Range<usize>,
    encoder: &mut wgpu::CommandEncoder,
) -> Result<(), GpuError> {
    let Some(pyramid) = &volume.pyramid else { return Ok(()) };
    let Some(gradients) = &pyramid.gradients else { return Ok(()) };
    let bricks = &volume.filled_levels[level as usize][range.clone()];
    let pipeline = shaders.pipeline(&SingleVariant("volume/gradients.wgsl"))?;
    let LevelBuffers { uniform, bricks: list } = level_buffers(context, level, bricks);
    let bind_group = pass::bind(
        context,
        "Gradients::bind_group",
        &pipeline,
        0,
        &[
            bind_view("source_texture", &level_view(&pyramid.texture, level)),
            bind_buffer("bound_resample", &uniform),
            bind_view("gradient_level", &level_view(gradients, level)),
            bind_buffer("bricks", &list),
        ],
    );
    let groups = brick_list::two_workgroups_per_brick(bricks.len().max(1) as u32);
    pass::dispatch(encoder, "Gradients::fill", &pipeline, &[&bind_group], groups);
    Ok(())
}
