//! Histogram of the densities of a volume.

pub(crate) mod changes;

use super::cancellation::CancelToken;
use super::{MissingVoxels, Volume};

/// Number of bins of a histogram: fine enough for 12-bit data whose object spans a tenth of the range.
pub const HISTOGRAM_BINS: usize = 1024;

/// Counts of densities in equal bins over the volume's value range.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Histogram {
    /// Voxels per bin; bin `i` of `n` holds densities in `[i/n, (i+1)/n)`, the last one also 1.
    pub counts: Vec<u64>,
    /// Number of voxels that are not missing.
    pub total: u64,
}

impl Histogram {
    /// Counts a volume's voxels in [`HISTOGRAM_BINS`] bins.
    pub fn from_volume(volume: &Volume) -> Self {
        Self::with_bins(volume, HISTOGRAM_BINS)
    }

    fn with_bins(volume: &Volume, bins: usize) -> Self {
        use rayon::prelude::*;
        let missing = volume.missing();
        let empty = || vec![0u64; bins];
        let interrupt = CancelToken::current();
        let counts = (0..volume.dims()[2])
            .into_par_iter()
            .fold(empty, |mut counts, z| {
                if interrupt.should_stop() {
                    return counts;
                }
                let densities = volume.slice_densities(z);
                let first = z * densities.len();
                let is_there = |at: usize| missing.is_none_or(|missing| !missing.contains(first + at));
                for (_, density) in densities.into_iter().enumerate().filter(|(at, _)| is_there(*at)) {
                    counts[((density * bins as f32) as usize).min(bins - 1)] += 1;
                }
                counts
            })
            .reduce(empty, |mut a, b| {
                a.iter_mut().zip(b).for_each(|(a, b)| *a += b);
                a
            });
        Self { counts, total: (volume.voxel_count() - missing.map_or(0, MissingVoxels::count)) as u64 }
    }

    /// Returns the density below which a share of `fraction` (0 … 1) of the voxels lies, to one bin.
    pub fn percentile(&self, fraction: f64) -> f64 {
        let wanted = fraction * self.total as f64;
        let mut seen = 0.0;
        for (bin, &count) in self.counts.iter().enumerate() {
            seen += count as f64;
            if seen >= wanted && count > 0 {
                return bin as f64 / self.counts.len() as f64;
            }
        }
        1.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Samples;
    use glam::DVec3;

    #[test]
    fn counts_and_percentiles() {
        let values = Samples::U8((0..=255).collect());
        let volume = Volume::with_spacing("ramp", [16, 4, 4], DVec3::ONE, values).unwrap();
        let histogram = Histogram::with_bins(&volume, 256);
        assert_eq!(histogram.counts.iter().sum::<u64>(), 256);
        assert!((histogram.percentile(0.5) - 0.5).abs() < 0.01);
        assert_eq!(histogram.percentile(0.0), 0.0);
    }
}
