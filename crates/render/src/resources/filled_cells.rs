//! Filled cells of a cached volume, and the ring of cells around them.

use std::cell::RefCell;
use std::sync::Arc;

use crate::plan::CellSet;

/// Cells that a cached volume holds values of.
///
/// Pictures ask for the same set again and again, so the last one that was found to be covered is remembered.
#[derive(Debug, Clone, Default)]
pub(crate) struct FilledCells {
    /// Cells that hold values.
    pub(crate) cells: Arc<CellSet>,
    /// Set that was found to be covered last.
    covered: RefCell<Option<Arc<CellSet>>>,
}

impl FilledCells {
    /// Creates the record of some filled cells.
    pub(crate) fn new(cells: Arc<CellSet>) -> Self {
        Self { cells, covered: RefCell::default() }
    }

    /// Returns true if all needed cells are filled.
    pub(crate) fn covers(&self, needed: &Arc<CellSet>) -> bool {
        let is_same = |known: &Arc<CellSet>| Arc::ptr_eq(needed, known);
        if is_same(&self.cells) || self.covered.borrow().as_ref().is_some_and(is_same) {
            return true;
        }
        let is_covered = needed.is_subset(&self.cells);
        if is_covered {
            *self.covered.borrow_mut() = Some(Arc::clone(needed));
        }
        is_covered
    }
}

/// Ring of cells around filled ones, up to a larger distance.
#[derive(Debug, Clone, Default)]
pub(crate) struct CellMargin {
    /// Cells up to the larger distance, those that are filled included.
    around: Arc<CellSet>,
    filled: Arc<CellSet>,
}

impl CellMargin {
    /// Creates the ring of the cells `around` that are not filled.
    pub(crate) fn new(around: Arc<CellSet>, filled: Arc<CellSet>) -> Self {
        Self { around, filled }
    }

    /// Returns the cells of this ring that are not in another one on the same grid: none if both are the same, as
    /// while a light is dragged.
    pub(crate) fn difference(&self, other: &Self) -> CellSet {
        if Arc::ptr_eq(&self.around, &other.around) && Arc::ptr_eq(&self.filled, &other.filled) {
            return CellSet::default();
        }
        self.cells().difference(&other.cells())
    }

    /// Returns the cells of the ring.
    pub(crate) fn cells(&self) -> CellSet {
        self.around.difference(&self.filled)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn set(mask: u64) -> Arc<CellSet> {
        Arc::new(CellSet { dims: [2, 1, 1], masks: vec![mask, 1] })
    }

    #[test]
    fn a_set_is_covered_as_long_as_its_cells_are_filled() {
        let filled = FilledCells::new(set(0b0111));
        let (inside, beyond) = (set(0b0101), set(0b1001));
        for _ in 0..2 {
            assert!(filled.covers(&inside) && filled.covers(&Arc::clone(&filled.cells)));
            assert!(!filled.covers(&beyond));
        }
    }

    #[test]
    fn a_ring_has_the_cells_between_its_sets() {
        let (wide, narrow) = (set(0b1111), set(0b0110));
        let ring = CellMargin::new(Arc::clone(&wide), Arc::clone(&narrow));
        assert_eq!(ring.cells().masks, [0b1001, 0]);
        assert_eq!(ring.difference(&ring.clone()), CellSet::default());
        let other = CellMargin::new(set(0b1000), set(0));
        assert_eq!(ring.difference(&other).masks, [0b0001, 0]);
        // Equal sets in other places.
        assert_eq!(ring.difference(&CellMargin::new(set(0b1111), set(0b0110))).count(), 0);
    }
}
