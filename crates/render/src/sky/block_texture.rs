//! Texture with a texel for each block of voxels, for light that varies slowly: sky visibility or scattered light.

use crate::volume::texture_3d;
use crate::{GpuContext, GpuError};

/// Texture of four 16-bit channels with a texel for each block of voxels.
#[derive(Debug)]
pub(crate) struct BlockTexture {
    /// Number of blocks along x, y and z.
    pub dims: [usize; 3],
    /// Number of voxels along the edge of a block.
    pub divisor: usize,
    /// View of all texels.
    pub view: wgpu::TextureView,
}

impl BlockTexture {
    /// Creates the texture for blocks of `divisor`³ voxels of a grid; nothing is filled yet.
    ///
    /// # Errors
    /// Returns an error if memory is exhausted.
    pub(crate) fn new(
        context: &GpuContext,
        label: &'static str,
        grid: [usize; 3],
        divisor: usize,
    ) -> Result<Self, GpuError> {
        let dims = grid.map(|n| n.div_ceil(divisor));
        let texture = context.texture(&texture_3d(
            label,
            dims,
            wgpu::TextureFormat::Rgba16Float,
            wgpu::TextureUsages::TEXTURE_BINDING
                | wgpu::TextureUsages::STORAGE_BINDING
                | wgpu::TextureUsages::COPY_SRC,
        ))?;
        let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
        Ok(Self { dims, divisor, view })
    }

    /// Returns the scale from index space to texture coordinates: (p + ½) × lookup.
    pub(crate) fn lookup(&self) -> [f32; 3] {
        self.dims.map(|n| 1.0 / (n * self.divisor) as f32)
    }

    /// Returns the size of the texture, in bytes.
    pub(crate) fn bytes(&self) -> u64 {
        8 * self.dims.iter().map(|&n| n as u64).product::<u64>()
    }
}
