//! Volume of scattered light: mean radiance in blocks of voxels.

use std::sync::Arc;

use crate::plan::CellSet;
use crate::resources::fill_time::FillStopwatch;
use crate::sky::block_texture::BlockTexture;
use crate::{GpuContext, GpuError};

/// Maximum number of texels for the rays of one direction: 256 MiB of sheets with three colours.
pub(crate) const MAX_DIRECTION_TEXELS: u64 = 1 << 25;

/// Mean radiance over all directions of the light that was scattered before it reaches a block of voxels.
#[derive(Debug)]
pub(crate) struct ScatteredLightVolume {
    /// Linear RGB of each block.
    pub blocks: BlockTexture,
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
        let blocks = BlockTexture::new(context, "BouncesVolume::texture", grid, divisor)?;
        Ok(Self { blocks, filled_cells: filled, fill_time: FillStopwatch::default() })
    }
}
