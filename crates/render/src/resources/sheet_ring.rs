//! Ring of sheet textures, reused from one light volume to the next.

use crate::pipelines::binding::ring_format;
use crate::{GpuContext, GpuError};

/// Maximum ratio of a ring's texels to the texels needed, above [`ALWAYS_KEPT_TEXELS`].
const MAX_EXCESS: u64 = 2;
/// Number of texels (8 MiB) below which a ring is never shrunk: for coarse previews and small volumes.
const ALWAYS_KEPT_TEXELS: u64 = 1 << 20;

/// Ring of layers through which the slabs of a light stream, and the running transmittance behind them.
#[derive(Debug)]
pub(crate) struct SheetRing {
    /// Deposited transmittance, four sheets per texel.
    pub texture: wgpu::Texture,
    /// View of all layers, as an array.
    pub view: wgpu::TextureView,
    /// Running transmittance: a float for each pixel of a sheet.
    pub transmittance: wgpu::Buffer,
}

impl SheetRing {
    /// Creates a ring of this many columns, rows and layers.
    ///
    /// # Errors
    /// Returns an error if memory is exhausted.
    pub(crate) fn new(context: &GpuContext, [width, height, layers]: [u32; 3]) -> Result<Self, GpuError> {
        let texture = context.texture(&wgpu::TextureDescriptor {
            label: Some("Ring::texture"),
            size: wgpu::Extent3d { width, height, depth_or_array_layers: layers },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: ring_format(context.storage_format),
            usage: wgpu::TextureUsages::TEXTURE_BINDING
                | wgpu::TextureUsages::STORAGE_BINDING
                | wgpu::TextureUsages::COPY_SRC,
            view_formats: &[],
        })?;
        let transmittance = context.uninitialised_buffer(&wgpu::BufferDescriptor {
            label: Some("Ring::transmittance"),
            size: u64::from(width) * u64::from(height) * 4,
            usage: wgpu::BufferUsages::STORAGE,
            mapped_at_creation: false,
        });
        // An array view is required even if there is a single layer.
        let view = texture.create_view(&wgpu::TextureViewDescriptor {
            dimension: Some(wgpu::TextureViewDimension::D2Array),
            ..Default::default()
        });
        Ok(Self { texture, view, transmittance })
    }

    /// Returns this ring if the needed columns, rows and layers fit and fill a fair part of it; otherwise, as the
    /// error, the size of a replacement, which covers both needs unless that would be too large.
    pub(crate) fn reuse_or_new_size(self, needed: [u32; 3]) -> Result<Self, [u32; 3]> {
        let size = self.texture.size();
        let held = [size.width, size.height, size.depth_or_array_layers];
        let texels = |[a, b, c]: [u32; 3]| u64::from(a) * u64::from(b) * u64::from(c);
        let both = [0, 1, 2].map(|axis| held[axis].max(needed[axis]));
        if texels(both) > (MAX_EXCESS * texels(needed)).max(ALWAYS_KEPT_TEXELS) {
            Err(needed)
        } else if both == held {
            Ok(self)
        } else {
            Err(both)
        }
    }

    /// Returns the size of the ring and the running transmittance, in bytes.
    pub(crate) fn bytes(&self) -> u64 {
        let size = self.texture.size();
        let texel = u64::from(self.texture.format().block_copy_size(None).unwrap_or(8));
        let pixels = u64::from(size.width) * u64::from(size.height);
        pixels * (4 + u64::from(size.depth_or_array_layers) * texel)
    }
}
