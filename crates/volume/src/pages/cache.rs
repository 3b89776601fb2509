//! Pages that were read for pictures, within a budget of memory.

use std::collections::BTreeSet;
use std::sync::Arc;

use rayon::prelude::*;

use super::{Page, PageAddress, PageSource, ResidentPages};
use crate::{BrickBounds, DensityMapping, LoadError, memory_budget_bytes};

/// Number of pages that are read before it is asked which are needed still: half a second's on a slow machine.
pub const PAGES_PER_BATCH: usize = 32;

/// Largest memory for pages where the user names none, in bytes.
const MAX_DEFAULT_BYTES: u64 = 1 << 30;

/// Pages of a volume, of which those that no picture wants any longer make room for others.
#[derive(Debug, Clone)]
pub struct PageCache {
    source: Arc<dyn PageSource>,
    resident: ResidentPages,
}

impl PageCache {
    /// Creates a cache of pages for a volume in memory with these bounds and this mapping of values, of at most `bytes`, but
    /// at least of one page.
    pub fn new(
        source: Arc<dyn PageSource>,
        mapping: DensityMapping,
        bounds: Arc<BrickBounds>,
        bytes: u64,
    ) -> Self {
        let capacity = usize::try_from(bytes / Page::bytes()).unwrap_or(usize::MAX).max(1);
        let resident = ResidentPages::new(source.levels().clone(), mapping, bounds, capacity);
        Self { source, resident }
    }

    /// Returns the memory for pages where the user names none, in bytes: what most graphics cards can spare, within a quarter
    /// of what is free.
    pub fn default_bytes() -> u64 {
        MAX_DEFAULT_BYTES.min(memory_budget_bytes() / 4)
    }

    /// Returns the source of the pages.
    pub fn source(&self) -> &Arc<dyn PageSource> {
        &self.source
    }

    /// Returns the pages that are there, with the bounds that hold for all that were read.
    pub fn resident(&self) -> &ResidentPages {
        &self.resident
    }

    /// Returns the pages among `wanted` that have to be read, in their order.
    pub fn missing(&self, wanted: &[PageAddress]) -> Vec<PageAddress> {
        wanted.iter().copied().filter(|address| !self.resident.pages().contains_key(address)).collect()
    }

    /// Reads pages until none is missing.
    ///
    /// # Arguments
    /// * `wanted`: function that returns the pages that a picture wants, given those that are known so far.
    /// * `is_visible`: function that says whether densities in a range show anything.
    /// * `progress`: function that is told the number of pages that are missing; reading ends if it returns false.
    ///
    /// # Errors
    /// Fails like [`PageSource::read`], and with [`LoadError::Cancelled`].
    pub fn fill(
        &mut self,
        wanted: impl Fn(&Self) -> Vec<PageAddress>,
        is_visible: impl Fn([f32; 2]) -> bool + Sync,
        mut progress: impl FnMut(usize) -> bool,
    ) -> Result<(), LoadError> {
        loop {
            let all = wanted(self);
            let mut missing = self.missing(&all);
            if missing.is_empty() {
                return Ok(());
            }
            if !progress(missing.len()) {
                return Err(LoadError::Cancelled);
            }
            missing.truncate(PAGES_PER_BATCH);
            let read = read_pages(&*self.source, &missing, &is_visible)?;
            self.insert(read, &all, &is_visible);
        }
    }

    /// Adds pages that were read. Those for which `is_visible` is false are only remembered with their range; others that are
    /// not `wanted` make room.
    pub fn insert(
        &mut self,
        pages: Vec<(PageAddress, Arc<Page>)>,
        wanted: &[PageAddress],
        is_visible: impl Fn([f32; 2]) -> bool,
    ) {
        let (shown, empty): (Vec<_>, Vec<_>) =
            pages.into_iter().partition(|(_, page)| is_visible(page.range));
        let (shown, stale): (Vec<_>, Vec<_>) =
            shown.into_iter().partition(|(_, page)| !page.texels.is_empty());
        // Read for another look, of which nothing of them was visible: they are read again.
        drop(stale);
        self.resident.record(empty);
        let room = self.resident.capacity().saturating_sub(shown.len());
        if self.resident.pages().len() > room {
            let wanted: BTreeSet<_> = wanted.iter().copied().collect();
            self.resident.retain(|address| wanted.contains(&address));
        }
        self.resident.insert(shown);
    }
}

/// Reads pages from a source, several at a time, as [`Page::from_source`] does.
///
/// # Errors
/// Fails like [`PageSource::read`].
pub fn read_pages(
    source: &dyn PageSource,
    addresses: &[PageAddress],
    is_visible: impl Fn([f32; 2]) -> bool + Sync,
) -> Result<Vec<(PageAddress, Arc<Page>)>, LoadError> {
    let read =
        |address: &PageAddress| Ok((*address, Arc::new(Page::from_source(source, *address, &is_visible)?)));
    addresses.par_iter().map(read).collect()
}
