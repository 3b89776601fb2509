//! Volume of scattered light: mean radiance in blocks of voxels.

use std::sync::Arc;

use crate::plan::CellSet;
use crate::resources::fill_time::FillStopwatch;
use crate::volume::texture_3d;
use crate::{GpuContext, GpuError};

/// Maximum number of texels for the rays of one direction: 256 MiB of sheets with three colours.
pub(crate) const MAX_DIRECTION_TEXELS: u64 = 1 << 25;

/// Mean radiance over all directions of the light that was scattered before it reaches a block of voxels.
#[derive(Debug)]
pub(crate) struct ScatteredLightVolume {
    /// Number of blocks along x, y and z.
    pub dims: [usize; 3],
    /// Number of voxels along the edge of a block.
    pub divisor: usize,
    /// View of the texture of linear RGB.
    pub view: wgpu::TextureView,
    /// Cells (of blocks) that hold values, or will when the volume is complete.
    pub filled_cells: Arc<CellSet>,
    /// Stopwatch for the filling of the volume.
    pub fill_time: FillStopwatch,
}

impl ScatteredLightVolume {
    /// Creates the texture, for blocks of `divisor`³ voxels; nothing is filled yet.
    ///
    /// # Errors
    /// Returns an error if memory is exhausted.
    pub(crate) fn new(
        context: &GpuContext,
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
        Ok(Self { dims, divisor, view, filled_cells: filled, fill_time: FillStopwatch::default() })
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
