//! Pages that were read for pictures, within a budget of memory.

use std::collections::BTreeSet;
use std::sync::Arc;

use super::{Page, PageAddress, PageSource, ResidentPages};
use crate::{Dataset, LoadError};

/// Pages of a volume, of which those that no picture wants any longer make room for others.
#[derive(Debug, Clone)]
pub struct PageCache {
    source: Arc<dyn PageSource>,
    resident: ResidentPages,
    /// Maximum number of pages.
    capacity: usize,
}

impl PageCache {
    /// Creates a cache of pages for a dataset, of at most `bytes`, but at least of one page.
    pub fn new(source: Arc<dyn PageSource>, dataset: &Dataset, bytes: u64) -> Self {
        let resident = ResidentPages::new(
            source.levels().clone(),
            dataset.volume().density_mapping(),
            Arc::clone(dataset.bricks()),
        );
        let capacity = usize::try_from(bytes / Page::bytes()).unwrap_or(usize::MAX).max(1);
        Self { source, resident, capacity }
    }

    /// Returns the source of the pages.
    pub fn source(&self) -> &Arc<dyn PageSource> {
        &self.source
    }

    /// Returns the pages that are there, with the bounds that hold for all that were read.
    pub fn resident(&self) -> &ResidentPages {
        &self.resident
    }

    /// Returns the maximum number of pages.
    pub fn capacity(&self) -> usize {
        self.capacity
    }

    /// Returns the pages among `wanted` that have to be read, in their order.
    pub fn missing(&self, wanted: &[PageAddress]) -> Vec<PageAddress> {
        wanted.iter().copied().filter(|address| !self.resident.pages().contains_key(address)).collect()
    }

    /// Reads pages, several at a time.
    ///
    /// # Errors
    /// Fails like [`PageSource::read`].
    pub fn read(&self, addresses: &[PageAddress]) -> Result<Vec<(PageAddress, Arc<Page>)>, LoadError> {
        use rayon::prelude::*;
        let read =
            |address: &PageAddress| Ok((*address, Arc::new(Page::from_source(&*self.source, *address)?)));
        addresses.par_iter().map(read).collect()
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
        self.resident.record(empty);
        let room = self.capacity.saturating_sub(shown.len());
        if self.resident.pages().len() > room {
            let wanted: BTreeSet<_> = wanted.iter().copied().collect();
            self.resident.retain(|address| wanted.contains(&address));
        }
        self.resident.insert(shown);
    }
}
