//! Sheets of a sweep: light along the rays of a batch of directions, slice by slice.

use crate::volume::texture_3d;
use crate::{GpuContext, GpuError};

/// 3D texture with columns and rows of rays, and a layer for each slice of each direction in a batch.
///
/// A 2D array would be filtered in half the time, but drivers take far longer to clear it.
#[derive(Debug)]
pub(crate) struct RaySheets {
    pub view: wgpu::TextureView,
    pub size: [usize; 3],
    pub format: wgpu::TextureFormat,
}

impl RaySheets {
    /// Creates a texture of this many columns, rows and layers.
    ///
    /// # Errors
    /// Returns an error if memory is exhausted.
    pub(crate) fn new(
        context: &GpuContext,
        size: [usize; 3],
        format: wgpu::TextureFormat,
    ) -> Result<Self, GpuError> {
        let usages = wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::STORAGE_BINDING;
        let texture = context.texture(&texture_3d("RaySheets::texture", size, format, usages))?;
        let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
        Ok(Self { view, size, format })
    }

    /// Returns the size of the texture, in bytes.
    pub(crate) fn bytes(&self) -> u64 {
        let texel = u64::from(self.format.block_copy_size(None).unwrap_or(8));
        texel * self.size.iter().map(|&n| n as u64).product::<u64>()
    }
}
