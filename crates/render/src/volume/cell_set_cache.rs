//! Cache of sets of cells near occupied ones.

use std::cell::RefCell;
use std::collections::VecDeque;
use std::sync::Arc;

use crate::plan::{CellSet, NearFieldOffset};

/// Maximum number of cached sets: for eight lights, two settings and two resolutions.
const MAX_CACHED_SETS: usize = 32;

/// Parameters of the cell set that a picture needs of a light volume.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct CellRequirement {
    /// Maximum distance, in data cells, from occupied cells.
    pub reach: u8,
    /// Number of data voxels per light voxel, along an axis.
    pub divisor: usize,
    /// Offset of near-field lookups towards the light.
    pub offset: NearFieldOffset,
}

/// Cells from which distances of required cells are counted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum OccupiedCells {
    /// Cells occupied in either transfer function.
    Any,
    /// Cells that attenuate light.
    Attenuating,
}

/// Sets of cells that recent pictures have needed of the same transfer tables, most recent first.
#[derive(Debug, Clone, Default)]
pub(super) struct CellSetCache(RefCell<VecDeque<(OccupiedCells, CellRequirement, Arc<CellSet>)>>);

impl CellSetCache {
    /// Returns the set with these parameters, made if it is not known.
    pub(super) fn get_or_make(
        &self,
        occupied: OccupiedCells,
        needs: CellRequirement,
        make: impl FnOnce() -> CellSet,
    ) -> Arc<CellSet> {
        let find = |(cells, known, set): &(OccupiedCells, CellRequirement, Arc<CellSet>)| {
            (*cells == occupied && *known == needs).then(|| Arc::clone(set))
        };
        if let Some(known) = self.0.borrow().iter().find_map(find) {
            return known;
        }
        // Not borrowed meanwhile, since a set may be made from another one.
        let fresh = Arc::new(make());
        let mut sets = self.0.borrow_mut();
        sets.truncate(MAX_CACHED_SETS - 1);
        sets.push_front((occupied, needs, Arc::clone(&fresh)));
        fresh
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_set_is_made_once_while_it_is_recent() {
        let cache = CellSetCache::default();
        let needs = |reach| CellRequirement { reach, divisor: 1, offset: NearFieldOffset::default() };
        let made = RefCell::new(0);
        let get = |occupied, reach| {
            cache.get_or_make(occupied, needs(reach), || {
                *made.borrow_mut() += 1;
                CellSet::default()
            })
        };
        let first = get(OccupiedCells::Any, 0);
        assert!(Arc::ptr_eq(&first, &get(OccupiedCells::Any, 0)) && *made.borrow() == 1);
        get(OccupiedCells::Attenuating, 0);
        assert_eq!(*made.borrow(), 2);
        (1..=MAX_CACHED_SETS as u8).for_each(|reach| drop(get(OccupiedCells::Any, reach)));
        assert!(!Arc::ptr_eq(&first, &get(OccupiedCells::Any, 0)));
    }
}
