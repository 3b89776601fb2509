//! The volume of light that has bounced.

use std::sync::Arc;

use crate::gpu::resources::fill_time::FillTime;
use crate::gpu::volume::texture_3d;
use crate::gpu::{Context, GpuError};
use crate::plan::CellSet;

/// Most texels that the rays of one direction may take: 256 MiB of sheets of colours.
pub(crate) const MOST_TEXELS: u64 = 1 << 25;

/// Light that has been scattered before it reaches a block of voxels: its mean over all directions.
#[derive(Debug)]
pub(crate) struct BouncesVolume {
    /// Blocks along x, y and z.
    pub dims: [usize; 3],
    /// Voxels along the edge of a block.
    pub divisor: usize,
    /// Linear RGB.
    pub view: wgpu::TextureView,
    /// Cells (of blocks) that hold, or will hold, values.
    pub filled: Arc<CellSet>,
    /// How long it took.
    pub fill: FillTime,
    /// Counts up with every use; the least recently used goes first.
    pub last_used: u64,
}

impl BouncesVolume {
    /// Makes the texture, of blocks of `divisor`³ voxels; nothing is filled yet.
    ///
    /// # Errors
    /// When memory is out.
    pub(crate) fn new(
        context: &Context,
        grid: [usize; 3],
        divisor: usize,
        filled: Arc<CellSet>,
    ) -> Result<Self, GpuError> {
        let dims = grid.map(|n| n.div_ceil(divisor));
        let texture = context.texture(&texture_3d(
            "BouncesVolume::texture",
            dims,
            wgpu::TextureFormat::Rgba16Float,
            wgpu::TextureUsages::TEXTURE_BINDING
                | wgpu::TextureUsages::STORAGE_BINDING
                | wgpu::TextureUsages::COPY_SRC,
        ))?;
        let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
        Ok(Self { dims, divisor, view, filled, fill: FillTime::default(), last_used: 0 })
    }

    /// Index space to texture coordinates: (p + ½) × lookup.
    pub(crate) fn lookup(&self) -> [f32; 3] {
        self.dims.map(|n| 1.0 / (n * self.divisor) as f32)
    }

    /// Bytes of its texture.
    pub(crate) fn bytes(&self) -> u64 {
        8 * self.dims.iter().map(|&n| n as u64).product::<u64>()
    }
}
