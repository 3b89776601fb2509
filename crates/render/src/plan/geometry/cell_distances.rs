//! Distance field of cells, for empty-space skipping: distance of every cell to the nearest visible one.
//!
//! Distances are Chebyshev's, in cells: everything nearer than a cell's distance is a cube of empty cells that a ray
//! can leave in one step. The reach of a kernel, lookup or reverse kernel beyond a cell is subtracted from its
//! distance, so that one field serves all passes.

use rayon::prelude::*;

use crate::plan::CellSet;

/// Cells along the edge of a brick.
const CELLS_PER_BRICK_EDGE: usize = 4;

/// Maximum stored distance, in cells: a ray leaves at most 62 voxels in one step.
pub const MAX_CELL_DISTANCE: u8 = 31;

/// Distance of every cell to the nearest member of a set.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CellDistances {
    /// Number of cells along x, y, z, in whole bricks.
    pub dims: [usize; 3],
    /// Distances in cells, 0 for members, at most [`MAX_CELL_DISTANCE`]; x fastest.
    pub values: Vec<u8>,
}

impl CellDistances {
    /// Computes the distances to the cells of a set.
    pub fn from_set(set: &CellSet) -> Self {
        let dims = set.dims.map(|n| n * CELLS_PER_BRICK_EDGE);
        let [nx, ny, nz] = dims;
        let plane = nx * ny;
        let mut values = vec![0; plane * nz];
        if values.is_empty() {
            return Self { dims, values };
        }
        // Each thread computes some planes, and those around them that members beyond may be nearest to.
        let most = usize::from(MAX_CELL_DISTANCE);
        let planes = nz.div_ceil(rayon::current_num_threads()).max(most);
        values.par_chunks_mut(plane * planes).enumerate().for_each(|(at, target)| {
            let (first, end) = (at * planes, at * planes + target.len() / plane);
            let (low, high) = (first.saturating_sub(most), (end + most).min(nz));
            let mut spread = vec![MAX_CELL_DISTANCE; plane * (high - low)];
            for (row, line) in spread.chunks_mut(nx).enumerate() {
                write_members(set, [row % ny, low + row / ny], line);
            }
            spread_through(&mut spread, nx, ny);
            target.copy_from_slice(&spread[plane * (first - low)..plane * (end - low)]);
        });
        Self { dims, values }
    }

    /// Returns the minimum distance at the faces of a grid whose last cells along x, y and z are `last`. The last
    /// face may lie within a cell, so the cell before it counts as well, and so do those beyond.
    pub fn min_at_faces(&self, last: [usize; 3]) -> u8 {
        let [nx, ny, _] = self.dims;
        let is_at_face = |c: usize, axis: usize| c == 0 || c + 1 >= last[axis];
        let behind = last[0].saturating_sub(1).min(nx);
        let least = |cells: &[u8]| cells.iter().copied().min().unwrap_or(MAX_CELL_DISTANCE);
        let planes = self.values.chunks(nx * ny).enumerate().map(|(z, plane)| {
            if is_at_face(z, 2) {
                return least(plane);
            }
            let row = |(y, row): (usize, &[u8])| {
                if is_at_face(y, 1) { least(row) } else { least(&row[..1]).min(least(&row[behind..])) }
            };
            plane.chunks(nx).enumerate().map(row).min().unwrap_or(MAX_CELL_DISTANCE)
        });
        planes.min().unwrap_or(MAX_CELL_DISTANCE)
    }

    /// Returns the minimum of two distance fields on the same grid.
    #[must_use]
    pub fn min(&self, other: &Self) -> Self {
        let pairs = self.values.par_iter().zip(&other.values);
        Self { dims: self.dims, values: pairs.map(|(a, b)| *a.min(b)).collect() }
    }

    /// Returns the cells up to `reach` from the set, on a grid of `bricks` with cells `factor` times as large: a
    /// coarse cell is a member if any of its cells is near enough.
    pub fn cells_within(&self, reach: u8, factor: usize, bricks: [usize; 3]) -> CellSet {
        let fine = self.dims.map(|n| n / CELLS_PER_BRICK_EDGE);
        let [nx, ny, _] = self.dims;
        let mut masks = vec![0; fine.iter().product()];
        // The cells of a row of bricks lie in 16 rows.
        masks.par_chunks_mut(fine[0].max(1)).enumerate().for_each(|(at, masks)| {
            let [y, z] = [at % fine[1], at / fine[1]].map(|c| c * CELLS_PER_BRICK_EDGE);
            for row in 0..CELLS_PER_BRICK_EDGE * CELLS_PER_BRICK_EDGE {
                let [j, k] = [row % CELLS_PER_BRICK_EDGE, row / CELLS_PER_BRICK_EDGE];
                let first = nx * (y + j + ny * (z + k));
                let (bricks, _) = self.values[first..first + nx].as_chunks();
                for (mask, &cells) in masks.iter_mut().zip(bricks) {
                    *mask |= u64::from(near_cells(cells, reach)) << (CELLS_PER_BRICK_EDGE * row);
                }
            }
        });
        let all = CellSet { dims: fine, masks };
        if factor == 1 && bricks == fine { all } else { all.coarsened(factor, bricks) }
    }
}

/// Returns a mask of the cells of a row of a brick whose distances are at most `reach`.
fn near_cells(distances: [u8; CELLS_PER_BRICK_EDGE], reach: u8) -> u32 {
    // A byte's highest bit is set by this sum if its distance, of at most MAX_CELL_DISTANCE, is larger.
    let beyond = 0x7f - u32::from(reach.min(MAX_CELL_DISTANCE));
    let sums = u32::from_le_bytes(distances) + beyond * 0x0101_0101;
    // The product has the bits 0, 8, 16 and 24 side by side, from bit 24 on.
    ((!sums >> 7 & 0x0101_0101).wrapping_mul(1 << 24 | 1 << 17 | 1 << 10 | 1 << 3)) >> 24
}

/// Writes the distances along x to members of a set into a row of cells that is full of the maximum.
fn write_members(set: &CellSet, [y, z]: [usize; 2], row: &mut [u8]) {
    let first = set.dims[0] * (y / CELLS_PER_BRICK_EDGE + set.dims[1] * (z / CELLS_PER_BRICK_EDGE));
    let shift = CELLS_PER_BRICK_EDGE * (y % CELLS_PER_BRICK_EDGE)
        + CELLS_PER_BRICK_EDGE * CELLS_PER_BRICK_EDGE * (z % CELLS_PER_BRICK_EDGE);
    let masks = &set.masks[first..first + set.dims[0]];
    if masks.iter().all(|mask| (mask >> shift).trailing_zeros() as usize >= CELLS_PER_BRICK_EDGE) {
        return;
    }
    for (cells, mask) in row.chunks_mut(CELLS_PER_BRICK_EDGE).zip(masks) {
        for (x, cell) in cells.iter_mut().enumerate() {
            *cell = if mask >> (shift + x) & 1 == 1 { 0 } else { MAX_CELL_DISTANCE };
        }
    }
    spread_along(row);
}

/// Propagates distances along a row of cells, of which members have 0 and all others the maximum: by steps of 1, 2,
/// 4, 8 and 16 cells, whose sums are all distances up to the maximum.
fn spread_along(row: &mut [u8]) {
    let mut before = row.to_vec();
    let length = row.len();
    for step in [1, 2, 4, 8, 16].into_iter().filter(|&step| step < length) {
        before.copy_from_slice(row);
        let nearer = |known: &mut u8, other: u8| *known = (*known).min(other + step as u8);
        row[step..].iter_mut().zip(&before).for_each(|(known, &other)| nearer(known, other));
        row.iter_mut().zip(&before[step..]).for_each(|(known, &other)| nearer(known, other));
    }
}

/// Propagates distances along x through planes of `ny` rows of `nx` cells, in two passes in opposite directions
/// (A. Rosenfeld and J. Pfaltz, Pattern Recognition 1, 1968): a cell is one further than the nearest of its neighbours
/// in the rows before. A path to the nearest member goes along its row, then forwards, then backwards.
fn spread_through(distances: &mut [u8], nx: usize, ny: usize) {
    let far = vec![MAX_CELL_DISTANCE; nx];
    let mut nearest = vec![MAX_CELL_DISTANCE; nx + 2];
    let rows = distances.len() / nx;
    for row in 0..rows {
        let (before, rest) = distances.split_at_mut(row * nx);
        let line = |back: usize, is_there: bool| {
            if is_there && back <= row { &before[(row - back) * nx..(row - back + 1) * nx] } else { &far[..] }
        };
        let (has_previous, has_next) = (row % ny > 0, row % ny + 1 < ny);
        let neighbours =
            [line(1, has_previous), line(ny + 1, has_previous), line(ny, true), line(ny - 1, has_next)];
        include_neighbours(&mut rest[..nx], neighbours, &mut nearest);
    }
    for row in (0..rows).rev() {
        let (before, behind) = distances.split_at_mut((row + 1) * nx);
        let line = |forth: usize, is_there: bool| {
            let is_there = is_there && row + forth < rows;
            if is_there { &behind[(forth - 1) * nx..forth * nx] } else { &far[..] }
        };
        let (has_previous, has_next) = (row % ny > 0, row % ny + 1 < ny);
        let neighbours =
            [line(1, has_next), line(ny + 1, has_next), line(ny, true), line(ny - 1, has_previous)];
        include_neighbours(&mut before[row * nx..], neighbours, &mut nearest);
    }
}

/// Updates a row with distances that are one larger than the nearest in neighbouring rows, up to a cell aside.
/// `nearest` is scratch space for a row and a cell on either side, which stay at the maximum.
fn include_neighbours(row: &mut [u8], [a, b, c, d]: [&[u8]; 4], nearest: &mut [u8]) {
    let count = row.len();
    let columns = a.iter().zip(b).zip(c.iter().zip(d));
    for (least, ((a, b), (c, d))) in nearest[1..=count].iter_mut().zip(columns) {
        *least = (*a).min(*b).min((*c).min(*d));
    }
    let columns = nearest.iter().zip(&nearest[1..]).zip(&nearest[2..]);
    for (known, ((left, middle), right)) in row.iter_mut().zip(columns) {
        *known = (*known).min((*left).min(*middle).min(*right) + 1);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Makes a set with the given members, on a grid of 3 × 2 × 4 bricks.
    fn set(members: &[[usize; 3]]) -> CellSet {
        let mut set = CellSet { dims: [3, 2, 4], masks: vec![0; 24] };
        for &[x, y, z] in members {
            set.masks[x / 4 + 3 * (y / 4 + 2 * (z / 4))] |= 1 << (x % 4 + 4 * (y % 4) + 16 * (z % 4));
        }
        set
    }

    #[test]
    fn faces_are_as_far_as_their_nearest_cell() {
        // 21 voxels: cells 0 … 10 of 12.
        let least = |cell: [usize; 3]| {
            let mut set = CellSet { dims: [3; 3], masks: vec![0; 27] };
            set.insert(cell);
            CellDistances::from_set(&set).min_at_faces([10; 3])
        };
        assert_eq!(least([5, 5, 5]), 4);
        assert_eq!(least([5, 2, 5]), 2);
        assert_eq!((least([9, 5, 5]), least([5, 10, 5]), least([5, 5, 8])), (0, 0, 1));
        assert_eq!(
            CellDistances::from_set(&CellSet { dims: [3; 3], masks: vec![0; 27] }).min_at_faces([10; 3]),
            MAX_CELL_DISTANCE
        );
    }

    #[test]
    fn distances_are_chebyshevs() {
        let members = [[1, 1, 0], [6, 3, 4], [0, 7, 15]];
        let found = CellDistances::from_set(&set(&members));
        assert_eq!(found.dims, [12, 8, 16]);
        for (at, &distance) in found.values.iter().enumerate() {
            let p = [at % 12, at / 12 % 8, at / 96];
            let expected =
                members.iter().map(|m| (0..3).map(|a| m[a].abs_diff(p[a])).max().unwrap()).min().unwrap();
            assert_eq!(usize::from(distance), expected, "at {p:?}");
        }
    }

    #[test]
    fn an_empty_set_is_far_from_everything() {
        assert!(
            CellDistances::from_set(&set(&[])).values.iter().all(|&distance| distance == MAX_CELL_DISTANCE)
        );
    }

    #[test]
    fn what_is_near_is_within_reach() {
        let distances = CellDistances::from_set(&set(&[[4, 4, 4]]));
        let same = distances.cells_within(0, 1, [3, 2, 4]);
        assert_eq!(same, set(&[[4, 4, 4]]));
        assert_eq!(distances.cells_within(1, 1, [3, 2, 4]).count(), 27);
        // Cells 3 … 5 are in cells 1 and 2 of twice the size.
        let coarse = distances.cells_within(1, 2, [2, 1, 2]);
        assert_eq!(coarse.count(), 8);
        assert_eq!(coarse.masks[0], 0b0110_0110 << 20 | 0b0110_0110 << 36);
    }

    #[test]
    fn the_nearest_of_two_sets_counts() {
        let (a, b) = (set(&[[4, 4, 4]]), set(&[[9, 1, 2]]));
        let both = CellDistances::from_set(&a).min(&CellDistances::from_set(&b));
        assert_eq!(both, CellDistances::from_set(&set(&[[4, 4, 4], [9, 1, 2]])));
    }
}
