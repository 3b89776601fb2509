//! Occupied cells of a label map: those near voxels of visible labels.
//!
//! The numbers of labels say nothing about their looks, so ranges of densities in cells ([`crate::BrickBounds`]) mostly
//! include some visible label. Here each voxel is looked at instead.

use rayon::prelude::*;

use super::bricks::BrickBounds;
use super::cells::{BRICK_EDGE, CELL_EDGE};
use crate::Volume;

/// Cells along the edge of a brick.
const CELLS_PER_BRICK_EDGE: usize = BRICK_EDGE / CELL_EDGE;

/// Bricks and cells of a volume in which a sample can meet a visible voxel.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CellOccupancy {
    /// Flag for each brick of 8³ voxels, x fastest.
    pub bricks: Vec<bool>,
    /// Bit mask for each brick of the cells that an unstretched kernel fills: a cell, or one beside it, has a visible
    /// voxel.
    pub cells: Vec<u64>,
}

impl CellOccupancy {
    /// Looks for voxels whose density is visible, and that are not missing, in a volume with these bricks.
    pub fn from_labels(
        volume: &Volume,
        known: &BrickBounds,
        is_visible: impl Fn(f32) -> bool + Sync,
    ) -> Self {
        let bricks = known.dims;
        let dims = bricks.map(|n| n * CELLS_PER_BRICK_EDGE);
        let near = dilated(cells_with_visible_voxels(volume, dims, is_visible), dims);
        let cell = |brick: usize, at: usize| {
            let place = [brick % bricks[0], brick / bricks[0] % bricks[1], brick / (bricks[0] * bricks[1])];
            let edge = CELLS_PER_BRICK_EDGE;
            let inside = [at % edge, at / edge % edge, at / (edge * edge)];
            let [x, y, z] = [0, 1, 2].map(|axis| place[axis] * edge + inside[axis]);
            x + dims[0] * (y + dims[1] * z)
        };
        let count = CELLS_PER_BRICK_EDGE.pow(3);
        let numbers = || 0..bricks.iter().product();
        let mask = |brick: usize| {
            (0..count).map(|at| u64::from(near[cell(brick, at)]) << at).sum::<u64>()
                & known.present_cells(brick)
        };
        let cells = numbers().map(mask).collect();
        // Samples of a brick reach three voxels beyond it (`bricks.rs`), which is two cells.
        let around = dilated(near, dims);
        let is_occupied =
            |brick: usize| known.present_cells(brick) != 0 && (0..count).any(|at| around[cell(brick, at)]);
        Self { bricks: numbers().map(is_occupied).collect(), cells }
    }
}

/// Returns a flag for each cell of a grid of `dims` cells that contains a visible voxel.
fn cells_with_visible_voxels(
    volume: &Volume,
    dims: [usize; 3],
    is_visible: impl Fn(f32) -> bool + Sync,
) -> Vec<bool> {
    let [nx, _, nz] = volume.dims();
    let layer = |k: usize| {
        let mut cells = vec![false; dims[0] * dims[1]];
        for z in (k * CELL_EDGE..nz).take(CELL_EDGE) {
            // Neighbours are mostly equal.
            let mut last = (f32::NAN, false);
            for (at, density) in volume.slice_densities(z).into_iter().enumerate() {
                if density != last.0 {
                    last = (density, is_visible(density));
                }
                if last.1 {
                    cells[at % nx / CELL_EDGE + dims[0] * (at / nx / CELL_EDGE)] = true;
                }
            }
        }
        cells
    };
    (0..dims[2]).into_par_iter().flat_map_iter(layer).collect()
}

/// Returns the flags of the cells that are set or beside one that is, along any axis.
fn dilated(cells: Vec<bool>, dims: [usize; 3]) -> Vec<bool> {
    let strides = [1, dims[0], dims[0] * dims[1]];
    (0..3).fold(cells, |cells, axis| {
        let (count, stride) = (dims[axis], strides[axis]);
        let is_near = |at: usize| {
            let place = at / stride % count;
            cells[at] || (place > 0 && cells[at - stride]) || (place + 1 < count && cells[at + stride])
        };
        (0..cells.len()).into_par_iter().map(is_near).collect()
    })
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::{DensityMapping, Samples};

    const DIMS: [usize; 3] = [37, 21, 18];

    /// Returns a label map of pseudo-random runs of 200 labels.
    fn label_map() -> Volume {
        let mut state = 1u32;
        let mut next = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            state >> 24
        };
        let mut label = 0;
        let values = (0..DIMS.iter().product()).map(|_| {
            if next() < 24 {
                label = next() * 200 / 256;
            }
            label as u16
        });
        let values = Samples::U16(values.collect());
        Volume::with_spacing("labels", DIMS, DVec3::ONE, values)
            .unwrap()
            .with_density_mapping(DensityMapping::Labels)
    }

    #[test]
    fn samples_that_meet_a_visible_voxel_lie_in_set_cells() {
        let volume = label_map();
        let wanted = volume.density_of(77.0) as f32;
        let found = CellOccupancy::from_labels(&volume, &BrickBounds::from_volume(&volume), |density| {
            density == wanted
        });
        let bricks = DIMS.map(|n| n.div_ceil(BRICK_EDGE));
        let of = |c: [usize; 3]| {
            let brick = [0, 1, 2].map(|axis| c[axis] / BRICK_EDGE);
            let [i, j, k] = [0, 1, 2].map(|axis| c[axis] % BRICK_EDGE / CELL_EDGE);
            (brick[0] + bricks[0] * (brick[1] + bricks[1] * brick[2]), i + 4 * (j + 4 * k))
        };
        let densities: Vec<f32> = (0..DIMS[2]).flat_map(|z| volume.slice_densities(z)).collect();
        let mut seen = 0;
        for (at, _) in densities.iter().enumerate().filter(|(_, density)| **density == wanted) {
            seen += 1;
            let voxel = [at % DIMS[0], at / DIMS[0] % DIMS[1], at / (DIMS[0] * DIMS[1])];
            // A sample between voxels c and c + 1 sees voxels c − 1 … c + 2 along each axis.
            for offset in 0..64 {
                let c = [offset % 4, offset / 4 % 4, offset / 16];
                let sample = [0, 1, 2].map(|axis| (voxel[axis] + 1).checked_sub(c[axis]));
                let [Some(x), Some(y), Some(z)] = sample else { continue };
                let place = [x, y, z];
                if (0..3).all(|axis| place[axis] < DIMS[axis]) {
                    let (brick, cell) = of(place);
                    assert!(found.bricks[brick] && found.cells[brick] >> cell & 1 == 1, "{place:?}");
                }
            }
        }
        assert!(seen > 3);
    }

    #[test]
    fn far_fewer_cells_are_set_than_by_ranges() {
        let volume = label_map();
        let wanted = volume.density_of(77.0) as f32;
        let found = CellOccupancy::from_labels(&volume, &BrickBounds::from_volume(&volume), |density| {
            density == wanted
        });
        let by_range =
            BrickBounds::from_volume(&volume).cell_masks(|low, high| low <= wanted && wanted <= high);
        let count = |masks: &[u64]| masks.iter().map(|mask| mask.count_ones()).sum::<u32>();
        assert!(5 * count(&found.cells) < count(&by_range), "{} {}", count(&found.cells), count(&by_range));
        let none = CellOccupancy::from_labels(&volume, &BrickBounds::from_volume(&volume), |_| false);
        assert!(none.bricks.iter().all(|brick| !brick) && count(&none.cells) == 0);
    }
}
