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
    /// The same of the octants of every brick, x fastest within it, for samples at one point and
    /// kernels that are not stretched: they see a voxel less before and two behind their own.
    pub octants: Vec<[[f32; 2]; 8]>,
}

impl Bricks {
    /// Finds the ranges of a volume's bricks.
    pub fn of(volume: &Volume) -> Self {
        let dims = volume.dims().map(|n| n.div_ceil(BRICK_EDGE));
        let ranges = ranges(volume, dims, &Cells { edge: BRICK_EDGE, before: REACH, behind: REACH });
        let halves = dims.map(|n| 2 * n);
        let of_halves = self::ranges(volume, halves, &Cells { edge: BRICK_EDGE / 2, before: 1, behind: 2 });
        let octant = |brick: usize, octant: usize| {
            let [x, y, z] = [brick % dims[0], brick / dims[0] % dims[1], brick / (dims[0] * dims[1])];
            let (x, y, z) = (2 * x + octant % 2, 2 * y + octant / 2 % 2, 2 * z + octant / 4);
            of_halves[x + halves[0] * (y + halves[1] * z)]
        };
        let octants = (0..ranges.len()).map(|brick| std::array::from_fn(|at| octant(brick, at))).collect();
        Self { dims, ranges, octants }
    }

    /// For every brick whether a transfer function shows anything of it: `visible(min, max)`.
    pub fn occupancy(&self, visible: impl Fn(f32, f32) -> bool + Sync) -> Vec<bool> {
        self.ranges.par_iter().map(|&[min, max]| visible(min, max)).collect()
    }

    /// For every brick its octants of which a transfer function shows anything, a bit each.
    pub fn octant_masks(&self, visible: impl Fn(f32, f32) -> bool + Sync) -> Vec<u8> {
        let mask = |octants: &[[f32; 2]; 8]| {
            let bit = |at: usize| u8::from(visible(octants[at][0], octants[at][1])) << at;
            (0..8).map(bit).sum()
        };
        self.octants.par_iter().map(mask).collect()
    }
}

const EMPTY: [f32; 2] = [f32::INFINITY, f32::NEG_INFINITY];

fn union(a: [f32; 2], b: [f32; 2]) -> [f32; 2] {
    [a[0].min(b[0]), a[1].max(b[1])]
}

/// Cubes of voxels, and how many voxels further their samples see on either side.
struct Cells {
    edge: usize,
    before: usize,
    behind: usize,
}

impl Cells {
    /// First and last voxel that cell `b` looks at along an axis of `n` voxels, if any, and whether it
    /// looks outside.
    fn reach(&self, b: usize, n: usize) -> (Option<(usize, usize)>, bool) {
        let (low, high) = (b * self.edge, (b + 1) * self.edge - 1 + self.behind);
        let first = low.saturating_sub(self.before);
        ((first < n).then_some((first, high.min(n - 1))), low < self.before || high > n - 1)
    }

    /// The union of what lies in reach of cell `b`, and of nothing where it looks outside.
    fn gather(&self, b: usize, n: usize, at: impl Fn(usize) -> [f32; 2]) -> [f32; 2] {
        let (inside, outside) = self.reach(b, n);
        let start = if outside { [0.0, 0.0] } else { EMPTY };
        inside.map_or(start, |(first, last)| (first..=last).fold(start, |range, i| union(range, at(i))))
    }
}

/// The range of every cell: slices reduced in x and y, then layers of slices in z.
fn ranges(volume: &Volume, dims: [usize; 3], cells: &Cells) -> Vec<[f32; 2]> {
    let [nx, ny, nz] = volume.dims();
    let reduce_slice = |z: usize| -> Vec<[f32; 2]> {
        let densities = volume.slice_densities(z);
        let rows: Vec<[f32; 2]> = (0..ny * dims[0])
            .map(|at| {
                let (row, (inside, outside)) =
                    (&densities[at / dims[0] * nx..], cells.reach(at % dims[0], nx));
                let start = if outside { [0.0, 0.0] } else { EMPTY };
                let seen = inside.map_or(&row[..0], |(first, last)| &row[first..=last]);
                seen.iter().fold(start, |[low, high], &d| [low.min(d), high.max(d)])
            })
            .collect();
        (0..dims[1] * dims[0])
            .map(|at| cells.gather(at / dims[0], ny, |y| rows[y * dims[0] + at % dims[0]]))
            .collect()
    };
    let per_slice: Vec<Vec<[f32; 2]>> = (0..nz).into_par_iter().map(reduce_slice).collect();
    (0..dims[2])
        .into_par_iter()
        .flat_map_iter(|b| {
            (0..dims[0] * dims[1]).map(|at| cells.gather(b, nz, |z| per_slice[z][at])).collect::<Vec<_>>()
        })
        .collect()
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
    fn every_sample_sees_only_what_its_octant_announces() {
        let dims = [19, 11, 9];
        let lit = [7i32, 8, 3];
        let bricks = Bricks::of(&volume_with(dims, lit.map(|c| c as usize)));
        let masks = bricks.octant_masks(|_, max| max > 0.0);
        for at in 0..15 * 15 * 23 {
            let cell = [at % 23 - 2, at / 23 % 15 - 2, at / (23 * 15) - 2];
            let sees = (0..3).all(|axis| (cell[axis] - 1..=cell[axis] + 2).contains(&lit[axis]));
            let brick: [usize; 3] = std::array::from_fn(|axis| {
                (cell[axis].max(0) as usize / BRICK_EDGE).min(bricks.dims[axis] - 1)
            });
            let half = |axis: usize| {
                (cell[axis].div_euclid(BRICK_EDGE as i32 / 2) - 2 * brick[axis] as i32).clamp(0, 1) as usize
            };
            let mask = masks[brick[0] + bricks.dims[0] * (brick[1] + bricks.dims[1] * brick[2])];
            let shown = mask >> (half(0) + 2 * half(1) + 4 * half(2)) & 1 == 1;
            assert!(!sees || shown, "cell {cell:?}");
        }
        assert!(masks.iter().map(|mask| mask.count_ones()).sum::<u32>() < 30, "most octants see nothing");
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
