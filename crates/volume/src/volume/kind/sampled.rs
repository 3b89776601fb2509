//! Sampled voxel values in sorted order, for the detection of the kind of data, and statistics of neighbouring
//! voxels.

use rayon::prelude::*;

use crate::{ValueRange, Volume};

/// Approximate maximum number of sampled voxels; larger volumes are subsampled along each axis.
const MAX_SAMPLES: f64 = (1u64 << 21) as f64;

/// Maximum number of sampled voxels along an edge of a face.
const MAX_FACE_SAMPLES: usize = 128;

/// Criteria of a spike: minimum share of the voxels, and minimum gap to the other values as a share of their range.
/// Edges of objects fill the gap between a measured background and the object. Both match the criteria of padding in
/// the robust range (`values/robust.rs`).
const SPIKE_SHARE: f64 = 0.01;
const SPIKE_GAP: f64 = 0.05;

/// Share of the values at an end that count as outliers when the range of the others is measured: two thousand of the
/// two million sampled voxels.
const OUTLIER_SHARE: f64 = 0.001;

/// Sorted values of sampled voxels.
pub(super) struct SampledValues<'a> {
    volume: &'a Volume,
    /// Values that are finite and not padding, ascending.
    pub(super) values: Vec<f64>,
    /// Padding value declared by the file.
    padding: Option<f64>,
    step: usize,
    /// Lowest and highest value removed by [`Self::without_spikes`], if any.
    spikes: [Option<f64>; 2],
}

impl<'a> SampledValues<'a> {
    pub(super) fn from_volume(volume: &'a Volume) -> Self {
        let [nx, ny, nz] = volume.dims();
        let step = (volume.voxel_count() as f64 / MAX_SAMPLES).cbrt().ceil().max(1.0) as usize;
        let padding = declared_padding(volume);
        let samples = volume.samples();
        let mut values: Vec<f64> = (0..nz)
            .step_by(step)
            .collect::<Vec<_>>()
            .into_par_iter()
            .flat_map_iter(|z| {
                let rows = (0..ny).step_by(step).map(move |y| (z * ny + y) * nx);
                let voxels = rows.flat_map(move |row| (row..row + nx).step_by(step));
                voxels.map(|voxel| samples.value(voxel))
            })
            .filter(|value| is_present(*value, padding))
            .collect();
        values.par_sort_unstable_by(f64::total_cmp);
        Self { volume, values, padding, step, spikes: [None; 2] }
    }

    /// Returns the value below which a share of the voxels lies.
    pub(super) fn quantile(&self, share: f64) -> f64 {
        quantile(&self.values, share)
    }

    /// Returns the share of the voxels with values from `low` to below `high`.
    pub(super) fn share_in_range(&self, low: f64, high: f64) -> f64 {
        let below = |value: f64| self.values.partition_point(|&other| other < value);
        (below(high) - below(low)) as f64 / self.values.len().max(1) as f64
    }

    /// Returns the share of the voxels with exactly this value.
    pub(super) fn share_equal_to(&self, value: f64) -> f64 {
        let count = self.values.iter().filter(|&&other| other == value).count();
        count as f64 / self.values.len().max(1) as f64
    }

    /// Returns true if all values are whole numbers.
    pub(super) fn are_whole_numbers(&self) -> bool {
        self.values.iter().all(|value| value.fract() == 0.0)
    }

    /// Returns the two quantiles at `share` from either end of the values that are no spikes; `None` if there are
    /// none.
    pub(super) fn quantile_range_without_spikes(&self, share: f64) -> Option<ValueRange> {
        let is_spike = |at: fn(&[f64], usize) -> f64| self.spike(at);
        let low = is_spike(|values, at| values[at]);
        let high = is_spike(|values, at| values[values.len() - 1 - at]);
        let first = low.map_or(0, |low| self.values.partition_point(|&value| value <= low));
        let end = high.map_or(self.values.len(), |high| self.values.partition_point(|&value| value < high));
        let rest = self.values.get(first..end).filter(|rest| !rest.is_empty())?;
        Some(ValueRange { low: quantile(rest, share), high: quantile(rest, 1.0 - share) })
    }

    /// Returns the two quantiles of the nonzero values at `share` from either end; `None` if all values are zero.
    pub(super) fn nonzero_quantiles(&self, share: f64) -> Option<ValueRange> {
        let below = self.values.partition_point(|&value| value < 0.0);
        let above = self.values.len() - self.values.partition_point(|&value| value <= 0.0);
        let count = below + above;
        if count == 0 {
            return None;
        }
        let at = |index: usize| {
            // Zeros, which lie between the two, are left out.
            let zeros = self.values.len() - count;
            self.values[if index < below { index } else { index + zeros }]
        };
        let index = (share * count as f64) as usize;
        let index = index.min(count - 1);
        Some(ValueRange { low: at(index), high: at(count - 1 - index) })
    }

    /// Returns, among the neighbours of voxels whose values are beyond `value` (seen from zero), the share beyond
    /// half of it.
    pub(super) fn coherence_beyond(&self, value: f64) -> f64 {
        let is_beyond = |one: f64, value: f64| if value < 0.0 { one <= value } else { one >= value };
        let [strong, alike] = self.fold_neighbour_pairs(
            |[strong, alike]: &mut [f64; 2], one, other| {
                for (one, other) in [(one, other), (other, one)] {
                    if is_beyond(one, value) && Some(one) != self.spikes[0] && Some(one) != self.spikes[1] {
                        *strong += 1.0;
                        *alike += f64::from(u8::from(is_beyond(other, value / 2.0)));
                    }
                }
            },
            |a, b| [a[0] + b[0], a[1] + b[1]],
        );
        if strong > 0.0 { alike / strong } else { 0.0 }
    }

    /// Removes the lowest and the highest value if they are spikes: values of many voxels, far from all others, that
    /// stand for voxels not measured.
    pub(super) fn without_spikes(mut self) -> Self {
        if let Some(spike) = self.spike(|values, at| values[at]) {
            let count = self.values.partition_point(|&value| value <= spike);
            self.values.drain(..count);
            self.spikes[0] = Some(spike);
        }
        if let Some(spike) = self.spike(|values, at| values[values.len() - 1 - at]) {
            let count = self.values.partition_point(|&value| value < spike);
            self.values.truncate(count);
            self.spikes[1] = Some(spike);
        }
        self
    }

    /// Returns the first value of a sequence, accessed by `at`, if it is a spike.
    fn spike(&self, at: impl Fn(&[f64], usize) -> f64) -> Option<f64> {
        let all = self.values.len();
        let first = (all > 0).then(|| at(&self.values, 0))?;
        let count = (0..all).take_while(|&index| at(&self.values, index) == first).count();
        if count == all || (count as f64) < SPIKE_SHARE * all as f64 {
            return None;
        }
        // Criteria refer to the remaining values.
        let rest = (all - count) as f64;
        let next = at(&self.values, count);
        let other_end = at(&self.values, all - 1 - (OUTLIER_SHARE * rest) as usize);
        ((next - first).abs() >= SPIKE_GAP * (other_end - next).abs()).then_some(first)
    }

    /// Returns the distinct values in ascending order, if there are at most `most`.
    pub(super) fn distinct_values(&self, most: usize) -> Option<Vec<f64>> {
        let mut distinct: Vec<f64> = Vec::new();
        for &value in &self.values {
            // 0 and −0 compare as equal.
            if distinct.last() != Some(&value) {
                if distinct.len() == most {
                    return None;
                }
                distinct.push(value);
            }
        }
        Some(distinct)
    }

    /// Accumulates `count` over all pairs of neighbours along an axis, at sampled voxels, that are finite and not
    /// padding.
    pub(super) fn fold_neighbour_pairs<T: Send + Default>(
        &self,
        count: impl Fn(&mut T, f64, f64) + Sync,
        sum: impl Fn(T, T) -> T + Sync + Send,
    ) -> T {
        let [nx, ny, nz] = self.volume.dims();
        let samples = self.volume.samples();
        (0..nz)
            .step_by(self.step)
            .collect::<Vec<_>>()
            .into_par_iter()
            .fold(T::default, |mut total, z| {
                for y in (0..ny).step_by(self.step) {
                    for x in (0..nx).step_by(self.step) {
                        let at = (z * ny + y) * nx + x;
                        let here = samples.value(at);
                        if !is_present(here, self.padding) {
                            continue;
                        }
                        let mut pair = |is_inside: bool, step: usize| {
                            let other = is_inside.then(|| samples.value(at + step));
                            if let Some(other) = other.filter(|&other| is_present(other, self.padding)) {
                                count(&mut total, here, other);
                            }
                        };
                        pair(x + 1 < nx, 1);
                        pair(y + 1 < ny, nx);
                        pair(z + 1 < nz, nx * ny);
                    }
                }
                total
            })
            .reduce(T::default, sum)
    }

    /// Returns the sorted values of each of the six faces, subsampled if there are many, without padding; a face of
    /// only padding is empty.
    pub(super) fn faces(&self) -> [Vec<f64>; 6] {
        std::array::from_fn(|face| {
            let mut values: Vec<f64> = self
                .volume
                .face_voxels(face, MAX_FACE_SAMPLES)
                .map(|voxel| self.volume.samples().value(voxel))
                .filter(|value| is_present(*value, self.padding))
                .collect();
            values.sort_unstable_by(f64::total_cmp);
            values
        })
    }

    /// Returns the threshold that best splits the values into two classes (Otsu 1979), in bins between the outermost
    /// thousandths.
    pub(super) fn otsu_threshold(&self) -> f64 {
        // The number of values of 8-bit data.
        const BINS: usize = 256;
        let (low, high) = (self.quantile(OUTLIER_SHARE), self.quantile(1.0 - OUTLIER_SHARE));
        let value = |bin: usize| low + (high - low) * bin as f64 / BINS as f64;
        let total = self.values.len() as f64;
        let counts: Vec<f64> =
            (0..BINS).map(|bin| total * self.share_in_range(value(bin), value(bin + 1))).collect();
        let all: f64 = counts.iter().sum();
        let sum: f64 = counts.iter().enumerate().map(|(bin, count)| bin as f64 * count).sum();
        let (mut below, mut sum_below, mut best, mut best_bin) = (0.0, 0.0, -1.0, 0);
        for (bin, count) in counts.iter().enumerate() {
            below += count;
            sum_below += bin as f64 * count;
            let above = all - below;
            if below > 0.0 && above > 0.0 {
                let difference = sum_below / below - (sum - sum_below) / above;
                let between = below * above * difference * difference;
                if between > best {
                    (best, best_bin) = (between, bin + 1);
                }
            }
        }
        value(best_bin)
    }
}

/// Returns the value below which a share of sorted values lies; NaN if there are none.
pub(super) fn quantile(values: &[f64], share: f64) -> f64 {
    let at = (share * values.len() as f64) as usize;
    values.get(at.min(values.len().saturating_sub(1))).copied().unwrap_or(f64::NAN)
}

/// Returns the padding value that the file declares, even if the volume has no other values and so shows it.
fn declared_padding(volume: &Volume) -> Option<f64> {
    volume.padding_value().or(volume.metadata().padding)
}

/// Returns true if a value is finite and not padding.
fn is_present(value: f64, padding: Option<f64>) -> bool {
    value.is_finite() && Some(value) != padding
}

/// Returns the distinct values of all voxels in ascending order, without padding, if there are at most `most`.
pub(super) fn distinct_values_of_all_voxels(volume: &Volume, most: usize) -> Option<Vec<f64>> {
    let (samples, padding) = (volume.samples(), declared_padding(volume));
    let mut distinct: Vec<f64> = Vec::new();
    let mut last = f64::NAN;
    for voxel in 0..samples.len() {
        // Adding 0 turns −0 into 0.
        let value = samples.value(voxel) + 0.0;
        // A shortcut: neighbours are mostly equal.
        if value == last || !is_present(value, padding) {
            continue;
        }
        last = value;
        if let Err(at) = distinct.binary_search_by(|other| other.total_cmp(&value)) {
            if distinct.len() == most {
                return None;
            }
            distinct.insert(at, value);
        }
    }
    Some(distinct)
}
