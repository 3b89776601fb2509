//! Bricks of 8³ voxels with the minimum and maximum density that a sample inside can see.
//!
//! A sample at `p` (index space) belongs to brick `floor(p / 8)`, clamped to the grid. Its kernel of radius 2 covers
//! voxels `floor(p) − 1 … floor(p) + 2`; with two quadrature points it is evaluated up to 0.58 voxel further away.
//! The range of a brick therefore covers its voxels and three more on every side. Beyond the grid, densities are
//! clamped to the border, so skipping a brick whose range is transparent cannot change any pixel.

use std::collections::BTreeMap;
use std::ops::RangeInclusive;

use rayon::prelude::*;

use super::cells::{self, BRICK_EDGE, CellBounds};
use crate::Volume;
use crate::cancellation::CancelToken;

/// Margin of a brick's range beyond its voxels: the kernel's radius of 2, and one voxel for the quadrature offset of
/// at most 2 · 0.289 voxel with the thickest slab.
const RANGE_MARGIN: usize = 3;

/// Density ranges of all bricks of a volume.
#[derive(Debug, Clone, PartialEq)]
pub struct BrickBounds {
    /// Number of bricks along x, y, z: ⌈dims / 8⌉.
    pub dims: [usize; 3],
    /// (Minimum, maximum) density that a sample in the brick can see, x fastest.
    pub ranges: Vec<[f32; 2]>,
    /// Bounds of the density reconstructed in each cell of the bricks, by an unstretched kernel.
    pub cells: Vec<CellBounds>,
    /// Bit mask for each brick of the cells in which an unstretched kernel reaches any voxel that is neither missing nor
    /// hidden; `None` if all are present.
    present: Option<Vec<u64>>,
}

/// Ranges of densities in a box of cells, such as that of a page of a finer level.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct CellRanges {
    /// First cell along x, y and z.
    pub first: [usize; 3],
    /// Number of cells along x, y and z.
    pub dims: [usize; 3],
    /// (Minimum, maximum) density that a sample in the cell can see, x fastest.
    pub ranges: Vec<[f32; 2]>,
}

impl CellRanges {
    /// Returns the range of a cell; `None` outside the box.
    pub fn get(&self, cell: [usize; 3]) -> Option<[f32; 2]> {
        let place: [usize; 3] = std::array::from_fn(|axis| cell[axis].wrapping_sub(self.first[axis]));
        let is_inside = (0..3).all(|axis| place[axis] < self.dims[axis]);
        is_inside.then(|| self.ranges[place[0] + self.dims[0] * (place[1] + self.dims[1] * place[2])])
    }
}

impl BrickBounds {
    /// Widens the bounds of cells, and of their bricks, by the densities that samples of a finer level can see in them. Cells
    /// beyond the grid count as its last.
    pub fn widen(&mut self, by: &CellRanges) {
        let edge = BRICK_EDGE / cells::CELL_EDGE;
        let [last_x, last_y, last_z] = self.dims.map(|n| n * edge - 1);
        // Cells are quantised in the range of their brick, so that this has to be final first.
        let mut widened: BTreeMap<usize, Vec<(usize, [f32; 2])>> = BTreeMap::new();
        for (at, &range) in by.ranges.iter().enumerate() {
            let [nx, ny, _] = by.dims;
            let x = (by.first[0] + at % nx).min(last_x);
            let y = (by.first[1] + at / nx % ny).min(last_y);
            let z = (by.first[2] + at / (nx * ny)).min(last_z);
            let brick = x / edge + self.dims[0] * (y / edge + self.dims[1] * (z / edge));
            let cell = x % edge + edge * (y % edge + edge * (z % edge));
            widened.entry(brick).or_default().push((cell, range));
        }
        for (brick, cells) in widened {
            let before = self.ranges[brick];
            let after = cells.iter().fold(before, |all, (_, range)| union(all, *range));
            self.ranges[brick] = after;
            if after != before {
                for bounds in &mut self.cells[brick] {
                    *bounds = cells::quantised(cells::dequantised(*bounds, before), after);
                }
            }
            for (cell, range) in cells {
                let [low, high] = cells::quantised(range, after);
                let bounds = &mut self.cells[brick][cell];
                *bounds = [bounds[0].min(low), bounds[1].max(high)];
            }
        }
    }

    /// Computes the density ranges of a volume's bricks and cells.
    pub fn from_volume(volume: &Volume) -> Self {
        let dims = volume.dims().map(|n| n.div_ceil(BRICK_EDGE));
        let ranges = ranges(volume, dims);
        let cells = cells::bounds(volume, dims, &ranges);
        Self { dims, ranges, cells, present: volume.present_cells(dims) }
    }

    /// Returns the bounds of the same voxels where others of them are missing or hidden.
    pub(crate) fn with_presence_of(&self, volume: &Volume) -> Self {
        Self { present: volume.present_cells(self.dims), ..self.clone() }
    }

    /// Returns the mask of cells of a brick that are not entirely missing or hidden.
    pub(super) fn present_cells(&self, brick: usize) -> u64 {
        self.present.as_ref().map_or(u64::MAX, |present| present[brick])
    }

    /// Returns for each brick whether `visible(min, max)`, a transfer function's visibility test, holds for its
    /// range.
    pub fn occupancy(&self, visible: impl Fn(f32, f32) -> bool + Sync) -> Vec<bool> {
        let is_visible =
            |(brick, &[min, max]): (usize, &[f32; 2])| self.present_cells(brick) != 0 && visible(min, max);
        self.ranges.par_iter().enumerate().map(is_visible).collect()
    }

    /// Returns for each brick the bit mask of its cells for which `visible(min, max)` holds.
    pub fn cell_masks(&self, visible: impl Fn(f32, f32) -> bool + Sync) -> Vec<u64> {
        let mask = |(brick, (range, cells)): (usize, (&[f32; 2], &CellBounds))| {
            if self.present_cells(brick) == 0 || !visible(range[0], range[1]) {
                return 0;
            }
            let bit = |(at, bounds): (usize, &[u8; 2])| {
                let [min, max] = cells::dequantised(*bounds, *range);
                u64::from(visible(min, max)) << at
            };
            cells.iter().enumerate().map(bit).sum::<u64>() & self.present_cells(brick)
        };
        self.ranges.par_iter().zip(&self.cells).enumerate().map(mask).collect()
    }
}

const EMPTY_RANGE: [f32; 2] = [f32::INFINITY, f32::NEG_INFINITY];

fn union(a: [f32; 2], b: [f32; 2]) -> [f32; 2] {
    [a[0].min(b[0]), a[1].max(b[1])]
}

/// Returns the range of voxels that brick `b` covers along an axis of `n` voxels, margins included.
fn covered_voxels(b: usize, n: usize) -> RangeInclusive<usize> {
    let (low, high) = (b * BRICK_EDGE, (b + 1) * BRICK_EDGE - 1 + RANGE_MARGIN);
    low.saturating_sub(RANGE_MARGIN).min(n - 1)..=high.min(n - 1)
}

/// Computes the range of every brick: reduces slices in x and y, then layers of slices in z.
fn ranges(volume: &Volume, dims: [usize; 3]) -> Vec<[f32; 2]> {
    let [nx, ny, nz] = volume.dims();
    let interrupt = CancelToken::current();
    let reduce_slice = |z: usize| -> Vec<[f32; 2]> {
        if interrupt.should_stop() {
            return vec![EMPTY_RANGE; dims[0] * dims[1]];
        }
        let densities = volume.slice_densities(z);
        let rows: Vec<[f32; 2]> = (0..ny * dims[0])
            .map(|at| {
                let row = &densities[at / dims[0] * nx..];
                let seen = &row[covered_voxels(at % dims[0], nx)];
                seen.iter().fold(EMPTY_RANGE, |[low, high], &d| [low.min(d), high.max(d)])
            })
            .collect();
        let column = |x: usize, b: usize| covered_voxels(b, ny).map(move |y| y * dims[0] + x);
        (0..dims[1] * dims[0])
            .map(|at| {
                column(at % dims[0], at / dims[0]).fold(EMPTY_RANGE, |range, row| union(range, rows[row]))
            })
            .collect()
    };
    let per_slice: Vec<Vec<[f32; 2]>> = (0..nz).into_par_iter().map(reduce_slice).collect();
    (0..dims[2])
        .into_par_iter()
        .flat_map_iter(|b| {
            let range = |at: usize| {
                covered_voxels(b, nz).fold(EMPTY_RANGE, |range, z| union(range, per_slice[z][at]))
            };
            (0..dims[0] * dims[1]).map(range).collect::<Vec<_>>()
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Samples;
    use glam::DVec3;

    fn volume_with(dims: [usize; 3], lit: [usize; 3]) -> Volume {
        let mut values = vec![0u8; dims.iter().product()];
        values[lit[0] + dims[0] * (lit[1] + dims[1] * lit[2])] = 255;
        Volume::with_spacing("one", dims, DVec3::ONE, Samples::U8(values)).unwrap()
    }

    #[test]
    fn ranges_cover_voxels_near_brick_borders() {
        // x = 10 lies in brick 1 and within three voxels of brick 0's last voxel, 7.
        let bricks = BrickBounds::from_volume(&volume_with([24, 8, 8], [10, 4, 4]));
        assert_eq!(bricks.dims, [3, 1, 1]);
        assert_eq!(bricks.occupancy(|_, max| max > 0.0), [true, true, false]);
        let bricks = BrickBounds::from_volume(&volume_with([24, 8, 8], [11, 4, 4]));
        assert_eq!(bricks.occupancy(|_, max| max > 0.0), [false, true, false]);
    }

    #[test]
    fn samples_stay_within_brick_ranges() {
        let dims = [19, 11, 9];
        let bricks = BrickBounds::from_volume(&volume_with(dims, [7, 8, 3]));
        for z in -2i32..11 {
            for y in -2i32..13 {
                for x in -2i32..21 {
                    // A sample in the cell at (x, y, z) sees voxels x−1 … x+2 along each axis.
                    let sees = (x - 1..=x + 2).contains(&7)
                        && (y - 1..=y + 2).contains(&8)
                        && (z - 1..=z + 2).contains(&3);
                    let brick = |c: i32, n: usize| (c.max(0) as usize / BRICK_EDGE).min(n - 1);
                    let at = brick(x, bricks.dims[0])
                        + bricks.dims[0]
                            * (brick(y, bricks.dims[1]) + bricks.dims[1] * brick(z, bricks.dims[2]));
                    assert!(!sees || bricks.ranges[at][1] > 0.0, "cell {x} {y} {z} of brick {at}");
                }
            }
        }
    }
}
