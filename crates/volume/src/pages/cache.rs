//! Pages that were read for pictures, within a budget of memory.

use std::collections::BTreeSet;
use std::sync::Arc;

use rayon::prelude::*;

use super::{Page, PageAddress, PageSource, PoolLayout, ResidentPages};
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
    /// Creates a cache of pages for a volume in memory with these bounds and this mapping of values, whose texture has
    /// at most `bytes`, but room for a page.
    pub fn new(
        source: Arc<dyn PageSource>,
        mapping: DensityMapping,
        bounds: Arc<BrickBounds>,
        bytes: u64,
    ) -> Self {
        let capacity = PoolLayout::max_pages(bytes).max(1);
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

    /// Reads pages until none is missing. Returns false if reading ended because `wanted` returned `None`.
    ///
    /// # Arguments
    /// * `wanted`: function that returns the pages that a picture wants, given those that are known so far; `None` ends
    ///   reading.
    /// * `is_visible`: function that says whether densities in a range show anything.
    /// * `progress`: function that is told the number of pages that are missing; reading ends if it returns false.
    ///
    /// # Errors
    /// Fails like [`PageSource::read`], and with [`LoadError::Cancelled`].
    pub fn fill(
        &mut self,
        wanted: impl Fn(&Self) -> Option<Vec<PageAddress>>,
        is_visible: impl Fn([f32; 2]) -> bool + Sync,
        mut progress: impl FnMut(usize) -> bool,
    ) -> Result<bool, LoadError> {
        loop {
            let Some(all) = wanted(self) else { return Ok(false) };
            let mut missing = self.missing(&all);
            if missing.is_empty() {
                return Ok(true);
            }
            if !progress(missing.len()) {
                return Err(LoadError::Cancelled);
            }
            missing.truncate(PAGES_PER_BATCH);
            let read = read_pages(&*self.source, &missing, &is_visible)?;
            self.insert(read, &all, &is_visible);
        }
    }

    /// Adds pages that were read. Others that are not `wanted` make room; of new ones for which there is none, only the range of
    /// densities is remembered.
    pub fn insert(
        &mut self,
        mut pages: Vec<(PageAddress, Arc<Page>)>,
        wanted: &[PageAddress],
        is_visible: impl Fn([f32; 2]) -> bool,
    ) {
        // Those that were read for another look, of which nothing of them was visible, are read again.
        pages.retain(|(_, page)| !page.texels.is_empty() || !Page::has_texels(page.range, &is_visible));
        let shown = pages.iter().filter(|(_, page)| !page.texels.is_empty()).count();
        let room = self.resident.capacity().saturating_sub(shown);
        if self.resident.pages().len() > room {
            let wanted: BTreeSet<_> = wanted.iter().copied().collect();
            self.resident.retain(|address| wanted.contains(&address));
        }
        let mut free = self.resident.capacity().saturating_sub(self.resident.pages().len());
        for (_, page) in &mut pages {
            if page.texels.is_empty() {
                continue;
            }
            match free.checked_sub(1) {
                Some(left) => free = left,
                None => Arc::make_mut(page).texels = Vec::new(),
            }
        }
        self.resident.insert(pages);
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

#[cfg(test)]
mod tests {
    use std::ops::Range;

    use super::*;
    use crate::{Dataset, FinerLevels, Samples, Volume};
    use glam::DVec3;

    /// Level of 256³ voxels that are not the same all over.
    #[derive(Debug)]
    struct Ramp(FinerLevels);

    impl PageSource for Ramp {
        fn levels(&self) -> &FinerLevels {
            &self.0
        }

        fn read(&self, _: usize, region: &[Range<usize>; 3]) -> Result<Vec<f32>, LoadError> {
            let count: usize = region.iter().map(ExactSizeIterator::len).product();
            Ok((0..count).map(|at| at as f32 / count as f32).collect())
        }
    }

    #[test]
    fn pages_beyond_the_capacity_are_only_remembered() {
        let samples = Samples::U8((0..128 * 128 * 128).map(|at: usize| at as u8).collect());
        let dataset = Dataset::new(Volume::with_spacing("ramp", [128; 3], DVec3::ONE, samples).unwrap());
        let levels = FinerLevels::of_volume([128; 3], [([256; 3], "0".to_owned())]);
        let mapping = dataset.volume().density_mapping();
        // Room for three pages.
        let bounds = Arc::clone(dataset.bricks());
        let mut cache = PageCache::new(Arc::new(Ramp(levels)), mapping, bounds, 8 << 20);
        let wanted: Vec<_> = (0..4).map(|x| PageAddress { level: 0, at: [x, 0, 0] }).collect();
        let read = read_pages(&**cache.source(), &wanted, |_| true).unwrap();
        cache.insert(read, &wanted, |_| true);
        assert_eq!(cache.missing(&wanted), wanted[3..]);
        assert_eq!(cache.resident().ranges().len(), 4);
        let read = read_pages(&**cache.source(), &wanted[3..], |_| true).unwrap();
        cache.insert(read, &wanted[2..], |_| true);
        assert_eq!(cache.missing(&wanted), wanted[..2], "those that are not wanted make room");
    }
}
