//! Cells of 2³ voxels with bounds of the density that is reconstructed inside.
//!
//! A cubic B-spline between two voxels is a Bézier curve whose control values are averages of the four nearest
//! voxels: (c₋₁+4c₀+c₁)/6, (2c₀+c₁)/3, (c₀+2c₁)/3, (c₀+4c₁+c₂)/6. The curve stays within their range, which is far
//! narrower than that of the voxels themselves: around material in air, only half as many cells can show it. The
//! prefiltered kernel interpolates between (c₋₁+10c₀+c₁)/12 and (c₀+10c₁+c₂)/12. In three dimensions the bounds are
//! computed axis by axis, with intervals instead of numbers.
//!
//! A Gaussian is no B-spline, but near σ = 0.6 voxels it is close to one: [`BOUNDS_SLACK`] covers the difference.

use rayon::prelude::*;

use crate::Volume;
use crate::cancellation::CancelToken;

/// Edge of a brick in voxels; the bounds of its cells are stored together.
pub const BRICK_EDGE: usize = 8;

/// Edge of a cell, in voxels.
pub const CELL_EDGE: usize = 2;

/// Cells along the edge of a brick.
const CELLS_PER_BRICK_EDGE: usize = BRICK_EDGE / CELL_EDGE;

/// Number of cells in a brick.
const CELLS_PER_BRICK: usize = CELLS_PER_BRICK_EDGE * CELLS_PER_BRICK_EDGE * CELLS_PER_BRICK_EDGE;

/// Largest difference of a Gaussian's σ from [`BOUNDED_SIGMA`], in voxels, at which the cells' bounds hold.
pub const SIGMA_TOLERANCE: f64 = 0.02;
/// Standard deviation, in voxels, of the Gaussians for which the cells' bounds hold.
pub const BOUNDED_SIGMA: f64 = 0.6;

/// Share of the four voxels' range, per axis, by which bounds are widened. A Gaussian's weights differ from averages
/// of the control values' by at most 0.0224 (half the sum of the differences; σ = 0.58), and texture filtering, whose
/// weights have 8 fractional bits, adds 1/256 = 0.0039.
const BOUNDS_SLACK: f32 = 1.0 / 32.0;

/// Layers of bricks that are processed together: their cells depend on five slices of voxels besides their own 16.
const BRICK_LAYERS_PER_CHUNK: usize = 2;

/// Bounds of a brick's cells, x fastest, in 255ths of the brick's own range, rounded outwards.
pub type CellBounds = [[u8; 2]; CELLS_PER_BRICK];

/// Computes the bounds of the cells of all bricks, given the density ranges of the bricks.
pub(super) fn bounds(volume: &Volume, dims: [usize; 3], ranges: &[[f32; 2]]) -> Vec<CellBounds> {
    let layer = dims[0] * dims[1];
    let chunks = ranges.par_chunks(BRICK_LAYERS_PER_CHUNK * layer).enumerate();
    let interrupt = CancelToken::current();
    chunks
        .flat_map_iter(|(at, ranges)| {
            bounds_of_layers(volume, dims, at * BRICK_LAYERS_PER_CHUNK, ranges, &interrupt)
        })
        .collect()
}

/// Computes the bounds of the cells in a few layers of bricks.
fn bounds_of_layers(
    volume: &Volume,
    dims: [usize; 3],
    first: usize,
    ranges: &[[f32; 2]],
    interrupt: &CancelToken,
) -> Vec<CellBounds> {
    let groups = dims.map(|n| n * CELLS_PER_BRICK_EDGE);
    let wide = [groups[0], groups[1]];
    let layers = ranges.len() / (dims[0] * dims[1]);
    let voxels = volume.dims();
    // Range of cells in these layers, and of the slices that their kernels cover.
    let end = first + layers;
    let low = if first == 0 { -2 } else { (first * BRICK_EDGE) as isize };
    let high = if end == dims[2] { last_cell(voxels[2], groups[2]) } else { (end * BRICK_EDGE) as isize - 1 };
    let mut planes = Vec::new();
    for z in low - 1..=high + 2 {
        if interrupt.should_stop() {
            return Vec::new();
        }
        planes.push(CellIntervals::from_slice(volume, z, wide));
    }
    let mut bounds = vec![CellIntervals::empty(wide[0] * wide[1]); layers * CELLS_PER_BRICK_EDGE];
    for z in low..=high {
        if interrupt.should_stop() {
            return Vec::new();
        }
        let taps = &planes[(z - low) as usize..][..4];
        let group = group_of(z, groups[2]) - first * CELLS_PER_BRICK_EDGE;
        bounds[group].include([&taps[0], &taps[1], &taps[2], &taps[3]]);
    }
    let brick = |at: usize| {
        let [x, y, z] = [at % dims[0], at / dims[0] % dims[1], at / (dims[0] * dims[1])];
        std::array::from_fn(|cell| {
            let [i, j, k] = [
                cell % CELLS_PER_BRICK_EDGE,
                cell / CELLS_PER_BRICK_EDGE % CELLS_PER_BRICK_EDGE,
                cell / (CELLS_PER_BRICK_EDGE * CELLS_PER_BRICK_EDGE),
            ];
            let inside = x * CELLS_PER_BRICK_EDGE + i + wide[0] * (y * CELLS_PER_BRICK_EDGE + j);
            let plane = &bounds[z * CELLS_PER_BRICK_EDGE + k];
            quantised([plane.low[inside], plane.high[inside]], ranges[at])
        })
    };
    (0..ranges.len()).map(brick).collect()
}

/// Returns the last cell between voxels whose kernel covers any of `n` voxels, or the last of the `groups` along an
/// axis.
fn last_cell(n: usize, groups: usize) -> isize {
    n.max(groups * CELL_EDGE - 1) as isize
}

/// Returns the group of two that contains the cell between voxels `c` and `c + 1`, clamped to the grid.
fn group_of(c: isize, groups: usize) -> usize {
    (c.div_euclid(CELL_EDGE as isize).max(0) as usize).min(groups - 1)
}

/// Quantises bounds to 255ths of a range, rounded outwards.
pub(super) fn quantised([low, high]: [f32; 2], [from, to]: [f32; 2]) -> [u8; 2] {
    let scale = 255.0 / (to - from).max(1e-9);
    // Casts from float to integer saturate.
    let floor = ((low - from) * scale).floor() as u8;
    let ceil = ((high - from) * scale).ceil() as u8;
    [floor, ceil]
}

/// Converts quantised [`CellBounds`] of one cell back to densities.
pub(super) fn dequantised([low, high]: [u8; 2], [from, to]: [f32; 2]) -> [f32; 2] {
    [low, high].map(|level| from + f32::from(level) / 255.0 * (to - from))
}

/// Density intervals of a plane or a row of cells.
#[derive(Clone)]
struct CellIntervals {
    low: Vec<f32>,
    high: Vec<f32>,
}

impl CellIntervals {
    /// Creates intervals that include nothing yet.
    fn empty(count: usize) -> Self {
        Self { low: vec![f32::INFINITY; count], high: vec![f32::NEG_INFINITY; count] }
    }

    /// Computes the bounds of slice `z` along x and y, for `wide` groups of cells.
    fn from_slice(volume: &Volume, z: isize, wide: [usize; 2]) -> Self {
        let [nx, ny, nz] = volume.dims();
        let mut plane = Self::empty(wide[0] * wide[1]);
        // Beyond the grid, densities are clamped to the border.
        let densities = volume.slice_densities(z.clamp(0, nz as isize - 1) as usize);
        let rows: Vec<Self> = densities.chunks_exact(nx).map(|row| Self::from_row(row, wide[0])).collect();
        let row = |y: isize| &rows[y.clamp(0, ny as isize - 1) as usize];
        let mut bounds = vec![Self::empty(wide[0]); wide[1]];
        for y in -2..=last_cell(ny, wide[1]) {
            bounds[group_of(y, wide[1])].include([row(y - 1), row(y), row(y + 1), row(y + 2)]);
        }
        for (row, target) in bounds.iter().zip(0..) {
            let range = target * wide[0]..(target + 1) * wide[0];
            plane.low[range.clone()].copy_from_slice(&row.low);
            plane.high[range].copy_from_slice(&row.high);
        }
        plane
    }

    /// Computes the bounds of a row of voxels along x, for `groups` groups of cells.
    fn from_row(row: &[f32], groups: usize) -> Self {
        let last = last_cell(row.len(), groups);
        let cells = (last + 3) as usize;
        // Three voxels of padding before the row, for the kernel of the first cell, and as many as needed behind it.
        let at = |x: usize| row[x.saturating_sub(3).min(row.len() - 1)];
        let padded: Vec<f32> = (0..cells + 3).map(at).collect();
        let taps = std::array::from_fn(|tap| &padded[tap..tap + cells]);
        let mut bounds = Self::empty(cells);
        include(taps, taps, &mut bounds.low, &mut bounds.high);
        let mut grouped = Self::empty(groups);
        for (cell, c) in (-2..=last).enumerate() {
            let group = group_of(c, groups);
            grouped.low[group] = min_number(grouped.low[group], bounds.low[cell]);
            grouped.high[group] = max_number(grouped.high[group], bounds.high[cell]);
        }
        grouped
    }

    /// Widens the intervals by all values that a kernel can reconstruct from four neighbours between the middle two.
    fn include(&mut self, taps: [&Self; 4]) {
        include(taps.map(|tap| &tap.low[..]), taps.map(|tap| &tap.high[..]), &mut self.low, &mut self.high);
    }
}

/// Widens intervals by the bounds of curves whose four coefficients lie in the intervals `lows` … `highs`.
fn include(lows: [&[f32]; 4], highs: [&[f32]; 4], low: &mut [f32], high: &mut [f32]) {
    let taps = lows.map(|tap| &tap[..low.len()]);
    let tops = highs.map(|tap| &tap[..low.len()]);
    let high = &mut high[..low.len()];
    for at in 0..low.len() {
        let (under, over) = (taps.map(|tap| tap[at]), tops.map(|tap| tap[at]));
        let floor = under.into_iter().fold(f32::INFINITY, min_number);
        let ceiling = over.into_iter().fold(f32::NEG_INFINITY, max_number);
        let slack = BOUNDS_SLACK * (ceiling - floor);
        let lowest = control_values(under).into_iter().fold(f32::INFINITY, min_number) - slack;
        let highest = control_values(over).into_iter().fold(f32::NEG_INFINITY, max_number) + slack;
        low[at] = min_number(low[at], max_number(lowest, floor));
        high[at] = max_number(high[at], min_number(highest, ceiling));
    }
}

/// Returns values whose range bounds the curve between its middle coefficients: control values of the cubic B-spline,
/// and end points of the prefiltered kernel's line.
fn control_values([a, b, c, d]: [f32; 4]) -> [f32; 6] {
    let (twelfth, sixth, third) = (1.0 / 12.0, 1.0 / 6.0, 1.0 / 3.0);
    [
        (a + 4.0 * b + c) * sixth,
        (2.0 * b + c) * third,
        (b + 2.0 * c) * third,
        (b + 4.0 * c + d) * sixth,
        (a + 10.0 * b + c) * twelfth,
        (b + 10.0 * c + d) * twelfth,
    ]
}

/// Returns the smaller number, like `f32::min` but in one instruction: densities are never NaN.
fn min_number(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

fn max_number(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{BrickBounds, Samples};
    use glam::DVec3;

    /// Creates sparse noise from a fixed seed; five of eight voxels are 0.
    fn noise(dims: [usize; 3]) -> Volume {
        let mut state = 1u32;
        let mut next = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            let byte = (state >> 24) as u8;
            if state >> 20 & 7 < 5 { 0 } else { byte }
        };
        let values = (0..dims.iter().product()).map(|_| next()).collect();
        Volume::with_spacing("noise", dims, DVec3::ONE, Samples::U8(values)).unwrap()
    }

    /// Kernel weights of the four neighbours at a fraction of a voxel.
    type Weights = fn(f64) -> [f64; 4];

    fn b_spline(f: f64) -> [f64; 4] {
        let g = 1.0 - f;
        [
            g.powi(3) / 6.0,
            2.0 / 3.0 - f * f * (2.0 - f) / 2.0,
            2.0 / 3.0 - g * g * (2.0 - g) / 2.0,
            f.powi(3) / 6.0,
        ]
    }

    fn prefiltered(f: f64) -> [f64; 4] {
        [1.0 - f, 10.0 - 9.0 * f, 1.0 + 9.0 * f, f].map(|weight| weight / 12.0)
    }

    fn gaussian(f: f64, sigma: f64) -> [f64; 4] {
        let weights = [f + 1.0, f, 1.0 - f, 2.0 - f].map(|d| (-d * d / (2.0 * sigma * sigma)).exp());
        weights.map(|weight| weight / weights.iter().sum::<f64>())
    }

    /// Returns the volume surrounded by a margin of empty voxels.
    fn with_empty_margin(inner: &Volume, margin: usize) -> Volume {
        let dims = inner.dims().map(|n| n + 2 * margin);
        let value = |at: usize| {
            let place = [at % dims[0], at / dims[0] % dims[1], at / (dims[0] * dims[1])];
            let [x, y, z] = place.map(|c| c.wrapping_sub(margin));
            let [nx, ny, nz] = inner.dims();
            if x < nx && y < ny && z < nz { inner.value(x, y, z) as u8 } else { 0 }
        };
        let values = (0..dims.iter().product()).map(value).collect();
        Volume::with_spacing("margin", dims, DVec3::ONE, Samples::U8(values)).unwrap()
    }

    /// Returns the mean width of the bounds of the cells in and around a part of a volume, `margin` voxels inside it,
    /// and asserts that no kernel exceeds them.
    fn mean_width(volume: &Volume, margin: isize) -> f64 {
        let bricks = BrickBounds::from_volume(volume);
        let kernels: [Weights; 4] = [b_spline, prefiltered, |f| gaussian(f, 0.58), |f| gaussian(f, 0.62)];
        let dims = volume.dims().map(|n| n as isize);
        let density = |p: [isize; 3]| {
            let [x, y, z] = std::array::from_fn(|axis| p[axis].clamp(0, dims[axis] - 1) as usize);
            volume.density_of(volume.value(x, y, z))
        };
        let mut loose = 0.0;
        for at in 0..(15 * 10 * 21) {
            let cell = [at % 15 - 2, at / 15 % 10 - 2, at / 150 - 2].map(|c| c + margin);
            let whole: [usize; 3] =
                std::array::from_fn(|axis| group_of(cell[axis], CELLS_PER_BRICK_EDGE * bricks.dims[axis]));
            let [bx, by, bz] = whole.map(|group| group / CELLS_PER_BRICK_EDGE);
            let [x, y, z] = whole.map(|group| group % CELLS_PER_BRICK_EDGE);
            let brick = bx + bricks.dims[0] * (by + bricks.dims[1] * bz);
            let [low, high] = dequantised(
                bricks.cells[brick][x + CELLS_PER_BRICK_EDGE * (y + CELLS_PER_BRICK_EDGE * z)],
                bricks.ranges[brick],
            );
            for (kernel, phase) in kernels.iter().flat_map(|kernel| (0..27).map(move |phase| (kernel, phase)))
            {
                let weights = [phase % 3, phase / 3 % 3, phase / 9].map(|f: i32| kernel(f64::from(f) / 2.0));
                let sum: f64 = (0..64)
                    .map(|tap| {
                        let tap = [tap % 4, tap / 4 % 4, tap / 16];
                        let weight: f64 = (0..3).map(|axis| weights[axis][tap[axis]]).product();
                        weight * density(std::array::from_fn(|axis| cell[axis] + tap[axis] as isize - 1))
                    })
                    .sum();
                let range = f64::from(low) - 1e-6..=f64::from(high) + 1e-6;
                assert!(range.contains(&sum), "cell {cell:?}, phase {phase}: {sum} outside {range:?}");
            }
            loose += f64::from(high - low);
        }
        loose / f64::from(15 * 10 * 21)
    }

    #[test]
    fn no_kernel_leaves_the_bounds_of_a_cell() {
        let noise = noise([11, 6, 17]);
        // Without a margin: beyond the grid, densities are those at its border.
        mean_width(&noise, 0);
        let width = mean_width(&with_empty_margin(&noise, 4), 4);
        assert!(width < 0.6, "bounds are too wide to be of use: {width}");
    }

    #[test]
    fn cells_reveal_empty_space_inside_bricks() {
        let mut values = vec![0u8; 24 * 24 * 24];
        values[13 + 24 * (13 + 24 * 13)] = 255;
        let volume = Volume::with_spacing("one", [24; 3], DVec3::ONE, Samples::U8(values)).unwrap();
        let bricks = BrickBounds::from_volume(&volume);
        // The voxel is visible between voxels 11 and 15: cells 5 … 7 along each axis.
        let shown = |threshold: f32| -> u32 {
            bricks.cell_masks(|_, max| max > threshold).iter().map(|mask| mask.count_ones()).sum()
        };
        assert_eq!(shown(0.0), 27);
        // Only the cell that contains it reaches the peak of (2/3)³ = 0.30; its neighbours see at most 0.07.
        assert_eq!(shown(0.25), 1);
    }
}
