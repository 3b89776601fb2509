//! Sets of cells, as bit masks of 64 bits for each brick.

use rayon::prelude::*;

use crate::plan::BrickSet;

/// Cells along the edge of a brick.
const CELLS_PER_BRICK_EDGE: usize = 4;

/// Minimum number of bricks that a thread shifts: what takes longer than to hand them to it.
const MIN_BRICKS_PER_TASK: usize = 16 << 10;

/// Masks of the first layer of a brick's cells along each axis.
const FIRST_LAYER_MASKS: [u64; 3] = [0x1111_1111_1111_1111, 0x000f_000f_000f_000f, 0xffff];

/// Mask of a brick's cells whose coordinates are all even.
const FIRST_CELLS_OF_PAIRS: u64 = 0x0000_0505_0000_0505;

/// Set of cells of a grid of bricks.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct CellSet {
    /// Number of bricks along x, y, z.
    pub dims: [usize; 3],
    /// Mask of each brick, x fastest, with a bit for each of its 4³ cells, x fastest.
    pub masks: Vec<u64>,
}

impl CellSet {
    /// Creates the set of all cells.
    pub fn full(dims: [usize; 3]) -> Self {
        Self { dims, masks: vec![u64::MAX; dims.iter().product()] }
    }

    /// Returns the difference of two sets on the same grid: members of this one that are not in the other.
    #[must_use]
    pub fn difference(&self, other: &Self) -> Self {
        let masks = self.masks.iter().zip(&other.masks).map(|(a, b)| a & !b).collect();
        Self { dims: self.dims, masks }
    }

    /// Returns the union of two sets on the same grid.
    #[must_use]
    pub fn union(&self, other: &Self) -> Self {
        let masks = self.masks.iter().zip(&other.masks).map(|(a, b)| a | b).collect();
        Self { dims: self.dims, masks }
    }

    /// Returns the set shifted by one cell along an axis, in a grid whose last cell is `last`, with clamped borders:
    /// border cells are repeated outside, so that they shift in from there and stay when they shift out.
    #[must_use]
    pub fn shifted(&self, axis: usize, forwards: bool, last: usize) -> Self {
        let layer = FIRST_LAYER_MASKS[axis];
        let step = 1 << (2 * axis);
        let count = self.dims[axis];
        let end = step * (CELLS_PER_BRICK_EDGE - 1);
        let within_last: u64 = (0..=last % CELLS_PER_BRICK_EDGE).map(|at| layer << (step * at)).sum();
        // Cells of a brick that stay at the border, and those that lie in the grid.
        let limits = |brick: usize| {
            let is_last = brick == last / CELLS_PER_BRICK_EDGE;
            let first_border = if brick == 0 { layer } else { 0 };
            let last_border = if is_last { layer << (step * (last % CELLS_PER_BRICK_EDGE)) } else { 0 };
            (first_border | last_border, if is_last { within_last } else { u64::MAX })
        };
        let moved = |mask: u64, neighbour: u64, (border, grid): (u64, u64)| {
            let shifted = if forwards {
                (mask & !(layer << end)) << step | (neighbour >> end & layer)
            } else {
                (mask & !layer) >> step | (neighbour & layer) << end
            };
            (shifted | mask & border) & grid
        };
        // The brick from which cells shift in is outside the grid, and empty, for the first or the last one.
        let neighbour_of = |brick: usize| {
            if forwards { brick.checked_sub(1) } else { Some(brick + 1).filter(|next| *next < count) }
        };
        let mut masks = vec![0; self.masks.len()];
        // Bricks that lie side by side across the axis have the same limits.
        let stride: usize = self.dims[..axis].iter().product();
        let run = if axis == 0 { count } else { stride }.max(1);
        let runs = masks.par_chunks_mut(run).with_min_len(MIN_BRICKS_PER_TASK.div_ceil(run)).enumerate();
        runs.for_each(|(at, targets)| {
            let source = |at: usize| &self.masks[at * run..(at + 1) * run];
            let line = source(at);
            if axis == 0 {
                for (brick, (target, &mask)) in targets.iter_mut().zip(line).enumerate() {
                    *target = moved(mask, neighbour_of(brick).map_or(0, |next| line[next]), limits(brick));
                }
                return;
            }
            let brick = at % count;
            let limits = limits(brick);
            match neighbour_of(brick).map(|next| source(at + next - brick)) {
                Some(neighbours) => {
                    for (target, (&mask, &neighbour)) in targets.iter_mut().zip(line.iter().zip(neighbours)) {
                        *target = moved(mask, neighbour, limits);
                    }
                }
                None => {
                    for (target, &mask) in targets.iter_mut().zip(line) {
                        *target = moved(mask, 0, limits);
                    }
                }
            }
        });
        Self { dims: self.dims, masks }
    }

    /// Returns the cells of a grid of `bricks`, with cells `factor` times as large, that contain any member.
    #[must_use]
    pub fn coarsened(&self, factor: usize, bricks: [usize; 3]) -> Self {
        let mut coarse = Self { dims: bricks, masks: vec![0; bricks.iter().product()] };
        self.cubes_within(factor).for_each(|cell| coarse.insert(cell.map(|at| at / factor)));
        coarse
    }

    /// Adds a cell; cells outside the grid are ignored.
    pub fn insert(&mut self, cell: [usize; 3]) {
        if let Some((at, bit)) = self.brick_and_bit(cell) {
            self.masks[at] |= bit;
        }
    }

    /// Returns true if a cell is a member.
    pub fn contains(&self, cell: [usize; 3]) -> bool {
        self.brick_and_bit(cell).is_some_and(|(at, bit)| self.masks[at] & bit != 0)
    }

    /// Returns the index of a cell's brick and the bit of the cell.
    fn brick_and_bit(&self, cell: [usize; 3]) -> Option<(usize, u64)> {
        let [x, y, z] = cell.map(|c| c / CELLS_PER_BRICK_EDGE);
        let [nx, ny, nz] = self.dims;
        let [i, j, k] = cell.map(|c| c % CELLS_PER_BRICK_EDGE);
        let is_inside = x < nx && y < ny && z < nz;
        is_inside.then(|| {
            (x + nx * (y + ny * z), 1 << (i + CELLS_PER_BRICK_EDGE * (j + CELLS_PER_BRICK_EDGE * k)))
        })
    }

    /// Returns true if this set is a subset of the other.
    pub fn is_subset(&self, other: &Self) -> bool {
        self.dims == other.dims && self.masks.iter().zip(&other.masks).all(|(a, b)| a & !b == 0)
    }

    /// Iterates over the bricks that contain members, with their masks.
    pub fn bricks(&self) -> impl Iterator<Item = ([usize; 3], u64)> + '_ {
        let [nx, ny, _] = self.dims;
        // Row by row, since a division for each brick takes longer than all else.
        self.masks.chunks(nx.max(1)).enumerate().flat_map(move |(row, masks)| {
            let members = masks.iter().enumerate().filter(|(_, mask)| **mask != 0);
            members.map(move |(x, &mask)| ([x, row % ny, row / ny], mask))
        })
    }

    /// Iterates over the members, brick by brick.
    pub fn cells(&self) -> impl Iterator<Item = [usize; 3]> + '_ {
        self.cubes_within(1)
    }

    /// Iterates over cubes of cells that contain members, brick by brick: the largest cubes, of 1, 2 or 4 cells along
    /// an edge, of which none is cut where the grid is divided into cubes of `factor` cells. Returns their first cells.
    pub fn cubes_within(&self, factor: usize) -> impl Iterator<Item = [usize; 3]> + '_ {
        self.bricks().flat_map(move |(brick, mask)| {
            let rest = |left: &u64| Some(left & (left - 1)).filter(|&left| left != 0);
            std::iter::successors(Some(first_cells_of_cubes(mask, factor)), rest).map(move |left| {
                let bit = left.trailing_zeros() as usize;
                let within = [
                    bit % CELLS_PER_BRICK_EDGE,
                    bit / CELLS_PER_BRICK_EDGE % CELLS_PER_BRICK_EDGE,
                    bit / (CELLS_PER_BRICK_EDGE * CELLS_PER_BRICK_EDGE),
                ];
                std::array::from_fn(|axis| brick[axis] * CELLS_PER_BRICK_EDGE + within[axis])
            })
        })
    }

    /// Returns the bricks that contain any member.
    pub fn to_bricks(&self) -> BrickSet {
        BrickSet::new(self.dims, self.masks.iter().map(|&mask| mask != 0).collect())
    }

    /// Returns the number of members.
    pub fn count(&self) -> usize {
        self.masks.iter().map(|mask| mask.count_ones() as usize).sum()
    }
}

/// Returns the mask of the first cell of each cube that contains members of a brick's mask; cubes are the largest that
/// [`CellSet::cubes_within`] allows.
fn first_cells_of_cubes(mask: u64, factor: usize) -> u64 {
    if factor.is_multiple_of(4) {
        return u64::from(mask != 0);
    }
    if factor.is_multiple_of(2) {
        // Bits move from odd to even coordinates; what moves beyond a row or layer ends at odd ones.
        let along_x = mask | mask >> 1;
        let along_y = along_x | along_x >> 4;
        return (along_y | along_y >> 16) & FIRST_CELLS_OF_PAIRS;
    }
    mask
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sets_are_compared_cell_by_cell() {
        let a = CellSet { dims: [2, 1, 1], masks: vec![0b0110, 0] };
        let b = CellSet { dims: [2, 1, 1], masks: vec![0b0111, 8] };
        assert!(a.is_subset(&b) && !b.is_subset(&a));
        assert_eq!(b.difference(&a).masks, [1, 8]);
        assert_eq!(a.bricks().collect::<Vec<_>>(), [([0, 0, 0], 0b0110)]);
        assert_eq!((a.count(), b.to_bricks().positions().count()), (2, 2));
        assert_eq!(b.cells().collect::<Vec<_>>(), [[0, 0, 0], [1, 0, 0], [2, 0, 0], [7, 0, 0]]);
        assert!(b.is_subset(&CellSet::full([2, 1, 1])));
    }

    /// Makes a set with the given members, on a grid of 3 × 2 × 2 bricks.
    fn set(members: &[[usize; 3]]) -> CellSet {
        let mut set = CellSet { dims: [3, 2, 2], masks: vec![0; 12] };
        for &cell in members {
            set.insert(cell);
        }
        set
    }

    #[test]
    fn a_step_moves_every_cell_and_stops_at_the_border() {
        let last = [10, 6, 7];
        let members = [[0, 0, 0], [3, 3, 3], [4, 2, 7], [10, 6, 5], [7, 5, 4]];
        for axis in 0..3 {
            for forwards in [true, false] {
                let mut expected = set(&members.map(|mut cell| {
                    let at: &mut usize = &mut cell[axis];
                    *at = if forwards { (*at + 1).min(last[axis]) } else { at.saturating_sub(1) };
                    cell
                }));
                // Clamped borders: cells that shift in from outside.
                let is_at_border = |cell: &&[usize; 3]| [0, last[axis]].contains(&cell[axis]);
                members.iter().filter(is_at_border).for_each(|&cell| expected.insert(cell));
                assert_eq!(set(&members).shifted(axis, forwards, last[axis]), expected, "{axis} {forwards}");
            }
        }
    }

    #[test]
    fn cubes_contain_the_members_and_nothing_else() {
        // Every cell of a brick, alone and with its opposite one.
        for (at, factor) in (0..64).flat_map(|at| [1, 2, 3, 4, 6, 8].map(|factor| (at, factor))) {
            let edge = [1, 2, 4].into_iter().rfind(|edge| factor % edge == 0).unwrap();
            for mask in [1_u64 << at, 1 << at | 1 << (63 - at)] {
                let set = CellSet { dims: [2, 1, 1], masks: vec![0, mask] };
                let mut expected: Vec<_> = set.cells().map(|cell| cell.map(|c| c / edge * edge)).collect();
                expected.sort_unstable();
                expected.dedup();
                let mut found: Vec<_> = set.cubes_within(factor).collect();
                found.sort_unstable();
                assert_eq!(found, expected, "{mask:x} {factor}");
            }
        }
    }

    #[test]
    fn a_coarse_cell_holds_what_its_cells_do() {
        let coarse = set(&[[3, 5, 7], [8, 0, 0]]).coarsened(2, [2, 1, 1]);
        let expected = {
            let mut expected = CellSet { dims: [2, 1, 1], masks: vec![0; 2] };
            expected.insert([1, 2, 3]);
            expected.insert([4, 0, 0]);
            expected
        };
        assert_eq!(coarse, expected);
        assert!(coarse.contains([1, 2, 3]) && !coarse.contains([0, 0, 0]) && !coarse.contains([99, 0, 0]));
    }
}
