//! Density and pyramid textures of a volume, and their number formats.

#[cfg(feature = "testing")]
use half::f16;

use super::texture_shapes::{pyramid_dims, texture_3d};
use crate::plan::MAX_STRETCH_LEVEL;
use crate::{GpuContext, GpuError};
use chiaroscuro_volume::{BRICK_EDGE, Volume, VoxelType};

/// Maximum number of voxels along an axis: brick coordinates are packed into ten bits each, and the pyramid has one
/// brick more.
const MAX_VOXELS: usize = 1023 * BRICK_EDGE;

/// Creates the density texture of a volume as if it had these dimensions.
///
/// # Errors
/// Returns an error if the adapter cannot hold it.
pub(crate) fn density_texture(
    context: &GpuContext,
    volume: &Volume,
    dims: [usize; 3],
) -> Result<wgpu::Texture, GpuError> {
    if let Some(&size) = dims.iter().find(|&&n| n > MAX_VOXELS) {
        return Err(GpuError::OverLimit {
            what: "the volume".to_owned(),
            size: size as u64,
            limit: MAX_VOXELS as u64,
            help: "open a part of it, or choose fewer voxels",
        });
    }
    let unorm = density_is_unorm(context, volume);
    context.texture(&texture_3d(
        "Volume::density",
        dims.map(|n| n + 2),
        if unorm { wgpu::TextureFormat::R16Unorm } else { wgpu::TextureFormat::R16Float },
        wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
    ))
}

/// Creates the texture for the pyramid of a volume of these dimensions.
///
/// # Errors
/// Returns an error if the adapter cannot hold it.
pub(crate) fn pyramid_texture(context: &GpuContext, dims: [usize; 3]) -> Result<wgpu::Texture, GpuError> {
    context.texture(&wgpu::TextureDescriptor {
        mip_level_count: MAX_STRETCH_LEVEL as u32 + 1,
        ..texture_3d(
            "Volume::pyramid",
            pyramid_dims(dims),
            context.storage_format,
            wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::STORAGE_BINDING,
        )
    })
}

/// Converts a density to a 16-bit normalised integer.
pub(super) fn unorm16(density: f32) -> u16 {
    (density.clamp(0.0, 1.0) * 65535.0).round() as u16
}

/// Returns true if density is stored in 16-bit normalised integers.
///
/// 16-bit floats have 11 significant bits and are fastest on software drivers: enough for 8-bit data. Finer data use
/// normalised integers, where the adapter has them.
pub(super) fn density_is_unorm(context: &GpuContext, volume: &Volume) -> bool {
    let eight_bits = matches!(volume.samples().voxel_type(), VoxelType::U8 | VoxelType::I8);
    context.has_unorm16 && !eight_bits
}

/// Returns a density as rounded by the texture format; the reference renderer rounds the same way.
#[cfg(feature = "testing")]
pub fn stored_density(context: &GpuContext, volume: &Volume, density: f32) -> f32 {
    if density_is_unorm(context, volume) {
        f32::from(unorm16(density)) / 65535.0
    } else {
        f16::from_f32(density).to_f32()
    }
}
