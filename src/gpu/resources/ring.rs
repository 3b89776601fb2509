//! The textures of sheets, as one light volume leaves them to the next.

use crate::gpu::pipelines::binding::ring_format;
use crate::gpu::{Context, GpuError};

/// A ring has at most so many times the texels that are needed, or [`SMALL_RING`].
const MOST_ROOM: u64 = 2;
/// Texels of a ring that is not worth making smaller, 8 MiB: for coarse previews and small volumes.
const SMALL_RING: u64 = 1 << 20;

/// A ring of layers through which the slabs of a light stream, and the running transmittance behind them.
#[derive(Debug)]
pub(crate) struct Ring {
    /// Deposited transmittance, four sheets in a texel.
    pub texture: wgpu::Texture,
    /// A view of all layers.
    pub view: wgpu::TextureView,
    /// A float for each pixel of a sheet.
    pub transmittance: wgpu::Buffer,
}

impl Ring {
    /// A ring of so many columns, rows and layers.
    ///
    /// # Errors
    /// When memory is out.
    pub(crate) fn new(context: &Context, [width, height, layers]: [u32; 3]) -> Result<Self, GpuError> {
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
        let transmittance = context.empty_buffer(&wgpu::BufferDescriptor {
            label: Some("Ring::transmittance"),
            size: u64::from(width) * u64::from(height) * 4,
            usage: wgpu::BufferUsages::STORAGE,
            mapped_at_creation: false,
        });
        // An array even where it has one layer.
        let view = texture.create_view(&wgpu::TextureViewDescriptor {
            dimension: Some(wgpu::TextureViewDimension::D2Array),
            ..Default::default()
        });
        Ok(Self { texture, view, transmittance })
    }

    /// This ring, if so many columns, rows and layers fit and are not much less; otherwise the size of a ring to take
    /// its place, which holds both if it can.
    pub(crate) fn or_larger(self, needed: [u32; 3]) -> Result<Self, [u32; 3]> {
        let size = self.texture.size();
        let held = [size.width, size.height, size.depth_or_array_layers];
        let texels = |[a, b, c]: [u32; 3]| u64::from(a) * u64::from(b) * u64::from(c);
        let both = [0, 1, 2].map(|axis| held[axis].max(needed[axis]));
        if texels(both) > (MOST_ROOM * texels(needed)).max(SMALL_RING) {
            Err(needed)
        } else if both == held {
            Ok(self)
        } else {
            Err(both)
        }
    }

    /// Bytes of the ring and of the running transmittance.
    pub(crate) fn bytes(&self) -> u64 {
        let size = self.texture.size();
        let texel = u64::from(self.texture.format().block_copy_size(None).unwrap_or(8));
        let pixels = u64::from(size.width) * u64::from(size.height);
        pixels * (4 + u64::from(size.depth_or_array_layers) * texel)
    }
}
