//! Bricks of 8³ voxels with the smallest and largest density that a sample inside can see.
//!
//! A sample at `p` (index space) belongs to brick `floor(p / 8)`, clamped to the grid, and its
//! kernel of radius two sees voxels `floor(p) − 1 … floor(p) + 2`; with two quadrature points it
//! looks from up to 0.58 voxel further on. A brick's range therefore covers its voxels and three more
//! on every side, and the 0 of the outside where that leaves the grid: skipping a brick whose range
//! is transparent can then not change any pixel.

use rayon::prelude::*;

use super::Volume;

/// Voxels along the edge of a brick.
pub const BRICK_EDGE: usize = 8;

/// How far a brick's range looks beyond its voxels: the kernel's radius of 2 and one for the
/// quadrature offset, at most 2 · 0.289 voxel with the thickest slab.
const REACH: usize = 3;

/// Density ranges of all bricks of a volume.
#[derive(Debug, Clone, PartialEq)]
pub struct Bricks {
    /// Bricks along x, y, z: ⌈dims / 8⌉.
    pub dims: [usize; 3],
    /// (smallest, largest) density that a sample in the brick can see, x fastest.
    pub ranges: Vec<[f32; 2]>,
}

impl Bricks {
    /// Finds the ranges of a volume's bricks.
    pub fn of(volume: &Volume) -> Self {
        let voxels = volume.dims();
        let dims = voxels.map(|n| n.div_ceil(BRICK_EDGE));
        // Pass 1: every slice reduced in x and y; pass 2: the slices of a layer reduced in z.
        let per_slice: Vec<Vec<[f32; 2]>> =
            (0..voxels[2]).into_par_iter().map(|z| reduce_slice(volume, z, dims)).collect();
        let ranges = (0..dims[2])
            .into_par_iter()
            .flat_map_iter(|bz| {
                let (first, last, outside) = reach(bz, voxels[2]);
                let mut layer = vec![EMPTY; dims[0] * dims[1]];
                for slice in &per_slice[first..=last] {
                    for (range, seen) in layer.iter_mut().zip(slice) {
                        *range = union(*range, *seen);
                    }
                }
                if outside {
                    for range in &mut layer {
                        *range = union(*range, [0.0, 0.0]);
                    }
                }
                layer
            })
            .collect();
        Self { dims, ranges }
    }

    /// For every brick whether a transfer function shows anything of it: `visible(min, max)`.
    pub fn occupancy(&self, visible: impl Fn(f32, f32) -> bool + Sync) -> Vec<bool> {
        self.ranges.par_iter().map(|&[min, max]| visible(min, max)).collect()
    }
}

const EMPTY: [f32; 2] = [f32::INFINITY, f32::NEG_INFINITY];

fn union(a: [f32; 2], b: [f32; 2]) -> [f32; 2] {
    [a[0].min(b[0]), a[1].max(b[1])]
}

/// First and last voxel that brick `b` looks at along an axis of `n` voxels, and whether it looks outside.
fn reach(b: usize, n: usize) -> (usize, usize, bool) {
    let (low, high) = (b * BRICK_EDGE, (b + 1) * BRICK_EDGE - 1 + REACH);
    (low.saturating_sub(REACH), high.min(n - 1), low < REACH || high > n - 1)
}

fn reduce_slice(volume: &Volume, z: usize, dims: [usize; 3]) -> Vec<[f32; 2]> {
    let [nx, ny, _] = volume.dims();
    let densities = volume.slice_densities(z);
    let mut rows = vec![EMPTY; dims[0] * ny];
    for y in 0..ny {
        let row = &densities[y * nx..(y + 1) * nx];
        for bx in 0..dims[0] {
            let (first, last, outside) = reach(bx, nx);
            let start = if outside { [0.0, 0.0] } else { EMPTY };
            rows[y * dims[0] + bx] = row[first..=last].iter().fold(start, |range, &d| union(range, [d, d]));
        }
    }
    let mut bricks = vec![EMPTY; dims[0] * dims[1]];
    for by in 0..dims[1] {
        let (first, last, outside) = reach(by, ny);
        for bx in 0..dims[0] {
            let start = if outside { [0.0, 0.0] } else { EMPTY };
            bricks[by * dims[0] + bx] =
                (first..=last).fold(start, |range, y| union(range, rows[y * dims[0] + bx]));
        }
    }
    bricks
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::Samples;
    use glam::DVec3;

    fn volume_with(dims: [usize; 3], lit: [usize; 3]) -> Volume {
        let mut values = vec![0u8; dims.iter().product()];
        values[lit[0] + dims[0] * (lit[1] + dims[1] * lit[2])] = 255;
        Volume::with_spacing("one", dims, DVec3::ONE, Samples::U8(values)).unwrap()
    }

    #[test]
    fn a_voxel_near_a_border_is_seen_from_both_sides() {
        // x = 10 lies in brick 1 and within three voxels of brick 0's last voxel, 7.
        let bricks = Bricks::of(&volume_with([24, 8, 8], [10, 4, 4]));
        assert_eq!(bricks.dims, [3, 1, 1]);
        assert_eq!(bricks.occupancy(|_, max| max > 0.0), [true, true, false]);
        let bricks = Bricks::of(&volume_with([24, 8, 8], [11, 4, 4]));
        assert_eq!(bricks.occupancy(|_, max| max > 0.0), [false, true, false]);
    }

    #[test]
    fn every_sample_sees_only_what_its_brick_announces() {
        let dims = [19, 11, 9];
        let bricks = Bricks::of(&volume_with(dims, [7, 8, 3]));
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
