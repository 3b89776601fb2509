//! The light along the rays of a batch of directions, slice by slice.

use crate::gpu::volume::texture_3d;
use crate::gpu::{Context, GpuError};

/// Columns and rows of rays, and a layer for each slice of each direction of a batch.
///
/// Layers of a 3D texture: those of an array would be filtered in half the time, but drivers take far longer to clear them.
#[derive(Debug)]
pub(crate) struct RaySheets {
    pub view: wgpu::TextureView,
    pub size: [usize; 3],
    pub format: wgpu::TextureFormat,
}

impl RaySheets {
    /// Room for so many columns, rows and layers.
    ///
    /// # Errors
    /// When memory is out.
    pub(crate) fn new(
        context: &Context,
        size: [usize; 3],
        format: wgpu::TextureFormat,
    ) -> Result<Self, GpuError> {
        let usages = wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::STORAGE_BINDING;
        let texture = context.texture(&texture_3d("RaySheets::texture", size, format, usages))?;
        let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
        Ok(Self { view, size, format })
    }

    /// Bytes of the texture.
    pub(crate) fn bytes(&self) -> u64 {
        let texel = u64::from(self.format.block_copy_size(None).unwrap_or(8));
        texel * self.size.iter().map(|&n| n as u64).product::<u64>()
    }
}
