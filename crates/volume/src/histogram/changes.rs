//! Histogram of densities and of their changes: borders between materials are arcs in it, and materials are spots.

use rayon::prelude::*;

use crate::{CancelToken, Volume};

/// Number of columns, of equal ranges of densities.
const COLUMNS: usize = 256;

/// Number of rows, of equal ranges of changes.
const ROWS: usize = 128;

/// Number of rows in which changes up to [`LARGEST_CHANGE`] are counted before the axis is known.
const FINE_ROWS: usize = 4096;

/// Largest change of a density over a voxel: half of the range between both neighbours along each of three axes, √¾.
const LARGEST_CHANGE: f64 = 0.866_025_403_784_438_6;

/// Share of the voxels whose changes may lie above the axis: a ten-thousandth, mostly noise.
const BEYOND_AXIS: f64 = 1e-4;

/// Histogram of densities and of their changes over a voxel.
#[derive(Debug, Clone, PartialEq)]
pub struct ChangeHistogram {
    /// Largest change of the axis, in densities.
    pub largest: f64,
    /// Number of voxels in each of [`Self::SIZE`] bins, row by row from the smallest changes. The last row also counts
    /// what lies above it.
    pub counts: Vec<u32>,
}

impl ChangeHistogram {
    /// Number of columns and rows.
    pub const SIZE: [usize; 2] = [COLUMNS, ROWS];

    /// Counts the voxels of a volume; `None` if it is interrupted. Missing and hidden voxels are not counted, and have
    /// no part in the changes of those beside them.
    pub fn from_volume(volume: &Volume, interrupt: &CancelToken) -> Option<Self> {
        let empty = || vec![0_u32; COLUMNS * FINE_ROWS];
        let count = |mut counts: Vec<u32>, z: usize| {
            if !interrupt.should_stop() {
                count_slice(volume, z, &mut counts);
            }
            counts
        };
        let sum = |mut a: Vec<u32>, b: Vec<u32>| {
            a.iter_mut().zip(b).for_each(|(a, b)| *a = a.saturating_add(b));
            a
        };
        let fine = (0..volume.dims()[2]).into_par_iter().fold(empty, count).reduce(empty, sum);
        (!interrupt.should_stop()).then(|| Self::from_fine(&fine))
    }

    /// Merges rows, so that nearly all changes fill the axis.
    fn from_fine(fine: &[u32]) -> Self {
        let in_row = |row: usize| fine[row * COLUMNS..][..COLUMNS].iter().map(|&n| u64::from(n)).sum::<u64>();
        let total: u64 = (0..FINE_ROWS).map(in_row).sum();
        let mut above = 0;
        let last = (ROWS..FINE_ROWS).rev().find(|&row| {
            above += in_row(row);
            above as f64 > BEYOND_AXIS * total as f64
        });
        let merged = last.map_or(1, |last| (last + 1).div_ceil(ROWS));
        let mut counts = vec![0_u32; COLUMNS * ROWS];
        for (at, &count) in fine.iter().enumerate() {
            let row = (at / COLUMNS / merged).min(ROWS - 1);
            let bin = &mut counts[row * COLUMNS + at % COLUMNS];
            *bin = bin.saturating_add(count);
        }
        Self { largest: LARGEST_CHANGE * (merged * ROWS) as f64 / FINE_ROWS as f64, counts }
    }
}

/// Counts the voxels of a slice.
fn count_slice(volume: &Volume, z: usize, counts: &mut [u32]) {
    let [nx, ny, nz] = volume.dims();
    let densities = |z: usize| volume.slice_densities(z);
    let slices = [z.saturating_sub(1), z, (z + 1).min(nz - 1)].map(densities);
    let is_whole = !volume.has_absent_voxels();
    let is_present = |x: usize, y: usize, z: usize| is_whole || volume.presence(x + nx * (y + ny * z)) >= 0.5;
    for y in 0..ny {
        for x in 0..nx {
            if !is_present(x, y, z) {
                continue;
            }
            let own = slices[1][x + nx * y];
            let beside = |is_inside: bool, [x, y, z]: [usize; 3], slice: usize| {
                if is_inside && is_present(x, y, z) { slices[slice][x + nx * y] } else { own }
            };
            let pairs = [
                [beside(x > 0, [x.wrapping_sub(1), y, z], 1), beside(x + 1 < nx, [x + 1, y, z], 1)],
                [beside(y > 0, [x, y.wrapping_sub(1), z], 1), beside(y + 1 < ny, [x, y + 1, z], 1)],
                [beside(z > 0, [x, y, z.wrapping_sub(1)], 0), beside(z + 1 < nz, [x, y, z + 1], 2)],
            ];
            let change = pairs.map(|[a, b]| (0.5 * f64::from(b - a)).powi(2)).iter().sum::<f64>().sqrt();
            let column = ((f64::from(own) * COLUMNS as f64) as usize).min(COLUMNS - 1);
            let row = ((change / LARGEST_CHANGE * FINE_ROWS as f64) as usize).min(FINE_ROWS - 1);
            let bin = &mut counts[row * COLUMNS + column];
            *bin = bin.saturating_add(1);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Samples;
    use glam::DVec3;

    #[test]
    fn materials_are_spots_and_borders_lie_above_them() {
        let values = (0..4096).map(|at| if at % 16 < 8 { 0.0 } else { 200.0_f32 }).collect();
        let volume = Volume::with_spacing("halves", [16; 3], DVec3::ONE, Samples::F32(values)).unwrap();
        let found = ChangeHistogram::from_volume(&volume, &CancelToken::default()).unwrap();
        let at = |density: f64, change: f64| {
            let row = ((change / found.largest * ROWS as f64) as usize).min(ROWS - 1);
            found.counts[row * COLUMNS + ((density * COLUMNS as f64) as usize).min(COLUMNS - 1)]
        };
        assert_eq!([at(0.0, 0.0), at(1.0, 0.0), at(0.0, 0.5), at(1.0, 0.5)], [7 * 256, 7 * 256, 256, 256]);
        assert_eq!(found.counts.iter().sum::<u32>(), 4096);
        assert!((0.5..0.52).contains(&found.largest), "{}", found.largest);
    }

    #[test]
    fn missing_voxels_have_no_borders_and_an_interruption_no_result() {
        let value = |at: usize| if at % 8 == 4 { f32::NAN } else { (at % 8 / 4) as f32 };
        let samples = Samples::F32((0..512).map(value).collect());
        let volume = Volume::with_spacing("gap", [8; 3], DVec3::ONE, samples).unwrap();
        let found = ChangeHistogram::from_volume(&volume, &CancelToken::default()).unwrap();
        assert_eq!(found.counts[0], 256);
        assert_eq!(found.counts[COLUMNS - 1], 192);
        assert_eq!(found.counts.iter().sum::<u32>(), 448);
        let token = CancelToken::default();
        token.cancel();
        assert_eq!(ChangeHistogram::from_volume(&volume, &token), None);
    }
}
