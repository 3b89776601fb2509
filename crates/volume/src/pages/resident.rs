//! Pages that a picture may use.

use std::collections::BTreeMap;
use std::hash::{DefaultHasher, Hash as _, Hasher as _};
use std::sync::Arc;

use super::{FinerLevels, Page, PageAddress};
use crate::{BrickBounds, DensityMapping, PagesId};

/// Pages of the levels that are finer than a volume in memory, as many as a picture may use. Clones share them.
#[derive(Debug, Clone)]
pub struct ResidentPages {
    levels: Arc<FinerLevels>,
    mapping: DensityMapping,
    pages: BTreeMap<PageAddress, Arc<Page>>,
    /// Bounds of the volume in memory and of all pages that were read.
    bounds: Arc<BrickBounds>,
    /// Pages that were read, with the range of their densities.
    ranges: Arc<BTreeMap<PageAddress, [f32; 2]>>,
    /// Maximum number of pages.
    capacity: usize,
    id: PagesId,
}

impl ResidentPages {
    /// Creates a set without pages, for at most `capacity` of them, of a volume in memory with these bounds and this mapping of
    /// values.
    pub fn new(
        levels: FinerLevels,
        mapping: DensityMapping,
        bounds: Arc<BrickBounds>,
        capacity: usize,
    ) -> Self {
        let (levels, pages, ranges) = (Arc::new(levels), BTreeMap::new(), Arc::default());
        let empty = Self { levels, mapping, pages, bounds, ranges, capacity, id: PagesId::default() };
        Self { id: empty.computed_id(), ..empty }
    }

    /// Adds pages, and widens the bounds by their densities. Those without texels are only remembered with their range.
    pub fn insert(&mut self, pages: impl IntoIterator<Item = (PageAddress, Arc<Page>)>) {
        for (address, page) in pages {
            if Arc::make_mut(&mut self.ranges).insert(address, page.range).is_none() {
                Arc::make_mut(&mut self.bounds).widen(&page.cells);
            }
            if !page.texels.is_empty() {
                self.pages.insert(address, page);
            }
        }
        self.id = self.computed_id();
    }

    /// Removes all pages but those for which `keeps` is true. The bounds still hold for them.
    pub fn retain(&mut self, keeps: impl Fn(PageAddress) -> bool) {
        self.pages.retain(|address, _| keeps(*address));
        self.id = self.computed_id();
    }

    /// Returns the maximum number of pages.
    pub fn capacity(&self) -> usize {
        self.capacity
    }

    /// Returns the levels, finest first.
    pub fn levels(&self) -> &Arc<FinerLevels> {
        &self.levels
    }

    /// Returns the quantity that the densities of the pages represent.
    pub fn mapping(&self) -> DensityMapping {
        self.mapping
    }

    /// Returns the pages by their addresses, finest level first.
    pub fn pages(&self) -> &BTreeMap<PageAddress, Arc<Page>> {
        &self.pages
    }

    /// Returns the bounds of bricks and cells, which hold for the volume in memory and for the pages.
    pub fn bounds(&self) -> &Arc<BrickBounds> {
        &self.bounds
    }

    /// Returns the ranges of densities of the pages that were read, resident or not.
    pub fn ranges(&self) -> &Arc<BTreeMap<PageAddress, [f32; 2]>> {
        &self.ranges
    }

    /// Returns the identity of the pages and of the bounds.
    pub fn id(&self) -> PagesId {
        self.id
    }

    fn computed_id(&self) -> PagesId {
        let hash = |addresses: Vec<&PageAddress>| {
            let mut hasher = DefaultHasher::new();
            let shapes: Vec<_> = self.levels.0.iter().map(|level| (level.dims, level.per_voxel)).collect();
            (shapes, format!("{:?}", self.mapping), addresses).hash(&mut hasher);
            // 0 stands for no pages at all.
            hasher.finish().max(1)
        };
        PagesId { pages: hash(self.pages.keys().collect()), bounds: hash(self.ranges.keys().collect()) }
    }
}
