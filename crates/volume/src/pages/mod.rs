//! Pages: cubes of 64³ voxels of an image's finer levels, which are read where a picture shows them while the volume
//! itself is a coarser level that fits into memory.
//!
//! A [`PageSource`] reads voxels of the finer levels, [`Page::from_source`] makes a page of them, and [`ResidentPages`]
//! are those that a picture may use, with the bounds of brick and cell that hold for their voxels. Where a page is
//! absent, the next coarser level takes its place.

mod cache;
mod levels;
mod page;
mod pool_layout;
mod resident;

pub use cache::{PAGES_PER_BATCH, PageCache, read_pages};
pub use levels::{FinerLevel, FinerLevels, PAGE_EDGE, PageAddress};
pub use page::{PAGE_BORDER, PAGE_READ_MARGIN, PAGE_STORED_EDGE, Page};
pub use pool_layout::PoolLayout;
pub use resident::ResidentPages;

use std::ops::Range;

use crate::LoadError;

/// Source of the voxels of levels that are finer than a volume in memory.
pub trait PageSource: Send + Sync + std::fmt::Debug {
    /// Returns the levels, finest first.
    fn levels(&self) -> &FinerLevels;

    /// Reads the densities of a box of voxels of a level, x fastest, in the mapping of the volume in memory. `level` is an
    /// index into the levels.
    ///
    /// # Errors
    /// Fails like opening the file.
    fn read(&self, level: usize, region: &[Range<usize>; 3]) -> Result<Vec<f32>, LoadError>;
}
