//! Dimensions and descriptors of volume textures.

use chiaroscuro_volume::BRICK_EDGE;

/// Padding of the pyramid, in voxels on each side, which replicates the border: one texel of the coarsest level.
pub(super) const PYRAMID_PADDING: usize = 4;

/// Returns the dimensions of the pyramid, padded to multiples of 8 so that each texel covers exactly 2³ of the finer
/// level.
pub(super) fn pyramid_dims(dims: [usize; 3]) -> [usize; 3] {
    dims.map(|n| (n + 2 * PYRAMID_PADDING).next_multiple_of(8))
}

/// Returns the number of bricks along each axis of a grid.
pub(crate) fn brick_dims(dims: [usize; 3]) -> [usize; 3] {
    dims.map(|n| n.div_ceil(BRICK_EDGE))
}

/// Returns the descriptor of a 3D texture with a single mip level.
pub(crate) fn texture_3d(
    label: &'static str,
    dims: [usize; 3],
    format: wgpu::TextureFormat,
    usage: wgpu::TextureUsages,
) -> wgpu::TextureDescriptor<'static> {
    wgpu::TextureDescriptor {
        label: Some(label),
        size: wgpu::Extent3d {
            width: dims[0] as u32,
            height: dims[1] as u32,
            depth_or_array_layers: dims[2] as u32,
        },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D3,
        format,
        usage,
        view_formats: &[],
    }
}

/// Returns the number of texels of the finest level of a texture.
pub(super) fn texel_count(texture: &wgpu::Texture) -> u64 {
    let size = texture.size();
    u64::from(size.width) * u64::from(size.height) * u64::from(size.depth_or_array_layers)
}
