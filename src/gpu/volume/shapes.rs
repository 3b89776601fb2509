//! Shapes of the textures of a volume.

/// Voxels before the data in the pyramid, which repeat its border: one texel of its coarsest level.
pub(super) const PYRAMID_PADDING: usize = 4;

/// Texels of the pyramid: whole ones on every level, so that a level's texel is exactly 2³ of the finer one's.
pub(super) fn padded(dims: [usize; 3]) -> [usize; 3] {
    dims.map(|n| (n + 2 * PYRAMID_PADDING).next_multiple_of(8))
}

/// A 3D texture without mip levels.
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
