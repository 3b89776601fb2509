//! Pages of finer levels for one part of a picture after another, so that memory does not limit what it shows.

use std::fmt;
use std::sync::Arc;

use crate::GpuError;
use crate::plan::{PixelWindow, fill_part};
use chiaroscuro_scene::Settings;
use chiaroscuro_volume::{Dataset, LoadError, PageCache};

/// Shortest edge that is left when a part is halved because its pages do not fit, in pixels: smaller parts see the same pages.
const MIN_HALF_EDGE: u32 = 16;

/// Reason why a picture could not be drawn in bands.
#[derive(Debug, thiserror::Error)]
pub enum BandError {
    /// The device has failed, or its memory is exhausted.
    #[error(transparent)]
    Gpu(#[from] GpuError),
    /// The pages of a part could not be read.
    #[error(transparent)]
    Pages(#[from] LoadError),
    /// The pages of the smallest part do not fit into memory.
    #[error(
        "the finer levels behind {width} x {height} pixels do not fit into memory, which has room for {pages} of their \
         parts; allow more, or show a coarser level"
    )]
    PoolTooSmall {
        /// Width of the part, in pixels.
        width: u32,
        /// Height of the part, in pixels.
        height: u32,
        /// Number of pages that fit.
        pages: usize,
    },
}

/// Pages of finer levels that are read for one part of a picture after another.
pub struct PartPages<'a> {
    cache: &'a mut PageCache,
    /// Function that is told the number of pages that are missing; drawing ends if it returns false.
    progress: Box<dyn FnMut(usize) -> bool + 'a>,
}

impl fmt::Debug for PartPages<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("PartPages").field("cache", &self.cache).finish_non_exhaustive()
    }
}

impl<'a> PartPages<'a> {
    /// Creates pages that are held in a cache, with a function that is told the number of those that are missing; drawing ends if it
    /// returns false.
    pub fn new(cache: &'a mut PageCache, progress: impl FnMut(usize) -> bool + 'a) -> Self {
        Self { cache, progress: Box::new(progress) }
    }

    /// Reads the pages of a part. Returns the dataset with them; `None` if they do not fit and the part has to be halved.
    ///
    /// # Arguments
    /// * `part`: part in pixels of the picture.
    /// * `drawn`: samples that are drawn for it, with its margin.
    ///
    /// # Errors
    /// Fails if the pages cannot be read, or do not fit although the part is small.
    pub(super) fn dataset(
        &mut self,
        dataset: &Dataset,
        settings: &Settings,
        part: PixelWindow,
        drawn: PixelWindow,
    ) -> Result<Option<Dataset>, BandError> {
        if fill_part(self.cache, dataset, settings, drawn, &mut self.progress)? {
            return Ok(Some(dataset.clone().with_pages(Some(Arc::new(self.cache.resident().clone())))));
        }
        if part.size.iter().any(|&edge| edge >= 2 * MIN_HALF_EDGE) {
            return Ok(None);
        }
        let [width, height] = part.size;
        Err(BandError::PoolTooSmall { width, height, pages: self.cache.resident().capacity() })
    }
}
