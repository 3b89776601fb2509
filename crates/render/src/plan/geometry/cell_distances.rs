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
        let [nx, ny, _] = dims;
        let mut values = vec![MAX_CELL_DISTANCE; dims.iter().product()];
        values.par_chunks_mut(nx * ny).enumerate().for_each(|(z, plane)| {
            for (y, row) in plane.chunks_mut(nx).enumerate() {
                let first =
                    set.dims[0] * (y / CELLS_PER_BRICK_EDGE + set.dims[1] * (z / CELLS_PER_BRICK_EDGE));
                let shift = CELLS_PER_BRICK_EDGE * (y % CELLS_PER_BRICK_EDGE)
                    + CELLS_PER_BRICK_EDGE * CELLS_PER_BRICK_EDGE * (z % CELLS_PER_BRICK_EDGE);
                for (cells, mask) in row.chunks_mut(CELLS_PER_BRICK_EDGE).zip(&set.masks[first..]) {
                    for (x, cell) in cells.iter_mut().enumerate() {
                        *cell = if mask >> (shift + x) & 1 == 1 { 0 } else { MAX_CELL_DISTANCE };
                    }
                }
                spread_along(row);
            }
            spread_across(plane, nx);
        });
        Self { dims, values: spread_through(&values, nx * ny) }
    }

    /// Returns the minimum distance at the faces of a grid whose last cells along x, y and z are `last`. The last
    /// face may lie within a cell, so the cell before it counts as well, and so do those beyond.
    pub fn min_at_faces(&self, last: [usize; 3]) -> u8 {
        let [nx, ny, _] = self.dims;
        let is_at_face = |c: usize, axis: usize| c == 0 || c + 1 >= last[axis];
        let least_in = |(z, plane): (usize, &[u8])| {
            let whole = is_at_face(z, 2);
            let rows = plane.chunks(nx).enumerate();
            let least = rows.map(|(y, row)| {
                let cells = row.iter().enumerate();
                let at_faces = cells.filter(|(x, _)| whole || is_at_face(y, 1) || is_at_face(*x, 0));
                at_faces.map(|(_, distance)| *distance).min().unwrap_or(MAX_CELL_DISTANCE)
            });
            least.min().unwrap_or(MAX_CELL_DISTANCE)
        };
        self.values.par_chunks(nx * ny).enumerate().map(least_in).min().unwrap_or(MAX_CELL_DISTANCE)
    }

    /// Returns the minimum of two distance fields on the same grid.
    #[must_use]
    pub fn min(&self, other: &Self) -> Self {
        let values = self.values.iter().zip(&other.values).map(|(a, b)| *a.min(b)).collect();
        Self { dims: self.dims, values }
    }

    /// Returns the cells up to `reach` from the set, on a grid of `bricks` with cells `factor` times as large: a
    /// coarse cell is a member if any of its cells is near enough.
    pub fn cells_within(&self, reach: u8, factor: usize, bricks: [usize; 3]) -> CellSet {
        let [nx, ny, nz] = self.dims;
        let holds = |cell: [usize; 3]| {
            let [xs, ys, zs] = [(cell[0], nx), (cell[1], ny), (cell[2], nz)]
                .map(|(c, n)| (c * factor).min(n)..((c + 1) * factor).min(n));
            zs.clone().any(|z| {
                ys.clone().any(|y| {
                    let row = nx * (y + ny * z);
                    self.values[row + xs.start..row + xs.end].iter().any(|&distance| distance <= reach)
                })
            })
        };
        let mask = |at: usize| {
            let brick = [at % bricks[0], at / bricks[0] % bricks[1], at / (bricks[0] * bricks[1])];
            let bit = |cell: usize| {
                let [x, y, z] = brick.map(|c| c * CELLS_PER_BRICK_EDGE);
                let at = [
                    x + cell % CELLS_PER_BRICK_EDGE,
                    y + cell / CELLS_PER_BRICK_EDGE % CELLS_PER_BRICK_EDGE,
                    z + cell / 16,
                ];
                u64::from(holds(at)) << cell
            };
            (0..CELLS_PER_BRICK_EDGE * CELLS_PER_BRICK_EDGE * CELLS_PER_BRICK_EDGE).map(bit).sum()
        };
        CellSet { dims: bricks, masks: (0..bricks.iter().product()).into_par_iter().map(mask).collect() }
    }
}

// Chebyshev's distance separates by axis: the distance over three axes is the minimum over the third axis of
// max(distance over the first two, step).

/// Propagates distances along a row of cells.
fn spread_along(row: &mut [u8]) {
    let before = row.to_vec();
    if before.iter().all(|&distance| distance == MAX_CELL_DISTANCE) {
        return;
    }
    for step in 1..usize::from(MAX_CELL_DISTANCE).min(row.len()) {
        include(&mut row[step..], &before, step);
        let end = row.len() - step;
        include(&mut row[..end], &before[step..], step);
    }
}

/// Propagates distances along the columns of a plane of rows.
fn spread_across(plane: &mut [u8], row: usize) {
    let before = plane.to_vec();
    if before.iter().all(|&distance| distance == MAX_CELL_DISTANCE) {
        return;
    }
    for (at, target) in plane.chunks_mut(row).enumerate() {
        min_over_lines(target, &before, at, row);
    }
}

/// Propagates distances from plane to plane.
fn spread_through(planes: &[u8], plane: usize) -> Vec<u8> {
    let mut spread = planes.to_vec();
    spread
        .par_chunks_mut(plane)
        .enumerate()
        .for_each(|(at, target)| min_over_lines(target, planes, at, plane));
    spread
}

/// Updates `target` with the minimum, over lines of `length` values, of max(value, distance from line `at`).
fn min_over_lines(target: &mut [u8], lines: &[u8], at: usize, length: usize) {
    let count = lines.len() / length;
    for step in 1..usize::from(MAX_CELL_DISTANCE).min(count.max(1)) {
        // Lines further away cannot improve any distance.
        if target.iter().all(|&known| usize::from(known) <= step) {
            break;
        }
        if step <= at {
            include(target, &lines[(at - step) * length..], step);
        }
        if at + step < count {
            include(target, &lines[(at + step) * length..], step);
        }
    }
}

fn include(target: &mut [u8], line: &[u8], step: usize) {
    for (known, &other) in target.iter_mut().zip(line) {
        *known = (*known).min(other.max(step as u8));
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
