//! Sets of cells, a word of 64 bits for each brick.

use crate::plan::BrickSet;

/// A set of the cells of a grid of bricks.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CellSet {
    /// Bricks along x, y, z.
    pub dims: [usize; 3],
    /// For each brick, x fastest, a bit for each of its 4³ cells, x fastest.
    pub masks: Vec<u64>,
}

impl CellSet {
    /// Every cell.
    pub fn full(dims: [usize; 3]) -> Self {
        Self { dims, masks: vec![u64::MAX; dims.iter().product()] }
    }

    /// What is in this set and not in the other, of the same grid.
    #[must_use]
    pub fn without(&self, other: &Self) -> Self {
        let masks = self.masks.iter().zip(&other.masks).map(|(a, b)| a & !b).collect();
        Self { dims: self.dims, masks }
    }

    /// Whether all of this set is in the other.
    pub fn is_within(&self, other: &Self) -> bool {
        self.dims == other.dims && self.masks.iter().zip(&other.masks).all(|(a, b)| a & !b == 0)
    }

    /// The bricks with any cells, and those.
    pub fn bricks(&self) -> impl Iterator<Item = ([usize; 3], u64)> + '_ {
        let [nx, ny, _] = self.dims;
        let brick = move |(at, &mask): (usize, &u64)| ([at % nx, at / nx % ny, at / (nx * ny)], mask);
        self.masks.iter().enumerate().filter(|(_, mask)| **mask != 0).map(brick)
    }

    /// The bricks that have any of the cells.
    pub fn to_bricks(&self) -> BrickSet {
        BrickSet::new(self.dims, self.masks.iter().map(|&mask| mask != 0).collect())
    }

    /// How many cells there are.
    pub fn count(&self) -> usize {
        self.masks.iter().map(|mask| mask.count_ones() as usize).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sets_are_compared_cell_by_cell() {
        let a = CellSet { dims: [2, 1, 1], masks: vec![0b0110, 0] };
        let b = CellSet { dims: [2, 1, 1], masks: vec![0b0111, 8] };
        assert!(a.is_within(&b) && !b.is_within(&a));
        assert_eq!(b.without(&a).masks, [1, 8]);
        assert_eq!(a.bricks().collect::<Vec<_>>(), [([0, 0, 0], 0b0110)]);
        assert_eq!((a.count(), b.to_bricks().positions().count()), (2, 2));
        assert!(b.is_within(&CellSet::full([2, 1, 1])));
    }
}
