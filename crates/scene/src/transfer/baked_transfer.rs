//! Baked transfer functions: lookup tables of colour and extinction, with derived tables.

use super::LUT_SIZE;

/// Lookup table of a transfer function over a value range: linear RGB and extinction per scene unit.
#[derive(Debug, Clone, PartialEq)]
pub struct BakedTransfer {
    /// Table of [`LUT_SIZE`] entries, evenly spaced over densities 0 … 1, both ends included.
    pub entries: Vec<[f32; 4]>,
    /// Sign of the slope of extinction for each entry: 1 where it rises with density, −1 where it falls, and values
    /// between amid a change. Tells to which side of a surface opacity falls.
    pub slope_signs: Vec<f32>,
    /// Range maxima of extinction: for each power of two up to [`LUT_SIZE`] and each entry, the largest of that many
    /// entries from there on.
    pub range_maxima: Vec<f32>,
    /// Integrals over densities from 0 to each entry, in units of the entries' spacing: of linear RGB times extinction,
    /// and of extinction.
    pub integrals: Vec<[f32; 4]>,
}

/// Decay length, in entries, of a change's influence on `sides`: one step of 8-bit data.
const SLOPE_DECAY: f64 = LUT_SIZE as f64 / 256.0;

/// Returns for each entry the balance of rises and falls around it, (rises − falls) / (rises + falls), each weighted
/// by e^(−distance/[`SLOPE_DECAY`]): on a plateau the nearest change decides. 1 if nothing changes anywhere.
fn slope_signs(entries: &[[f32; 4]]) -> Vec<f32> {
    let fade = (-1.0 / SLOPE_DECAY).exp();
    let steps: Vec<f64> =
        entries.windows(2).map(|pair| f64::from(pair[1][3]) - f64::from(pair[0][3])).collect();
    let add = |sum: &mut [f64; 2], step: f64| {
        *sum = [sum[0] * fade + step.max(0.0), sum[1] * fade + (-step).max(0.0)];
        Some(*sum)
    };
    let before = std::iter::once([0.0; 2]).chain(steps.iter().scan([0.0; 2], |sum, &step| add(sum, step)));
    let mut behind: Vec<_> = steps.iter().rev().scan([0.0; 2], |sum, &step| add(sum, step)).collect();
    behind.reverse();
    before
        .zip(behind.into_iter().chain([[0.0; 2]]))
        .map(|([rises, falls], [rises_behind, falls_behind])| {
            let (rises, falls) = (rises + rises_behind, falls + falls_behind);
            if rises + falls > 0.0 { ((rises - falls) / (rises + falls)) as f32 } else { 1.0 }
        })
        .collect()
}

/// Returns the largest extinctions over runs of 1, 2, 4 … [`LUT_SIZE`] entries; runs end with the table.
fn range_maxima(entries: &[[f32; 4]]) -> Vec<f32> {
    let count = entries.len();
    let mut runs: Vec<f32> = entries.iter().map(|entry| entry[3]).collect();
    for power in 0..count.ilog2() {
        let shorter = runs.len() - count;
        for at in 0..count {
            let second = (at + (1 << power)).min(count - 1);
            runs.push(runs[shorter + at].max(runs[shorter + second]));
        }
    }
    runs
}

/// Returns colour times extinction, and extinction.
fn weighted([r, g, b, extinction]: [f32; 4]) -> [f64; 4] {
    [r * extinction, g * extinction, b * extinction, extinction].map(f64::from)
}

/// Returns the means between each entry and the next, of colour times extinction and of extinction, for a function
/// that is linear there.
fn linear_means(entries: &[[f32; 4]]) -> Vec<[f64; 4]> {
    let mean = |pair: &[[f32; 4]]| {
        let (a, b) = (weighted(pair[0]), weighted(pair[1]));
        std::array::from_fn(|i| 0.5 * (a[i] + b[i]))
    };
    entries.windows(2).map(mean).collect()
}

/// Returns the integrals from the first entry to each.
fn integrals(means: &[[f64; 4]]) -> Vec<[f32; 4]> {
    let mut sum = [0.0_f64; 4];
    let steps = means.iter().map(|mean| {
        (0..4).for_each(|i| sum[i] += mean[i]);
        sum.map(|sum| sum as f32)
    });
    std::iter::once([0.0; 4]).chain(steps).collect()
}

/// Largest number of runs of visible entries with which a range is compared one by one, which takes less time than
/// looking up counts of entries.
const MAX_COMPARED_RUNS: usize = 4;

impl BakedTransfer {
    /// Creates a table from [`LUT_SIZE`] entries between which the function is linear.
    pub(super) fn new(entries: Vec<[f32; 4]>) -> Self {
        let means = linear_means(&entries);
        Self::with_means(entries, &means)
    }

    /// Creates a table from [`LUT_SIZE`] entries and the function's means between each and the next, of colour times
    /// extinction and of extinction.
    pub(super) fn with_means(entries: Vec<[f32; 4]>, means: &[[f64; 4]]) -> Self {
        Self {
            slope_signs: slope_signs(&entries),
            range_maxima: range_maxima(&entries),
            integrals: integrals(means),
            entries,
        }
    }

    /// Creates a white table whose extinction rises linearly from 0 to `largest`: for volumes that store shares of
    /// it.
    pub fn linear_ramp(largest: f32) -> Self {
        let last = (LUT_SIZE - 1) as f32;
        Self::new((0..LUT_SIZE).map(|entry| [1.0, 1.0, 1.0, largest * entry as f32 / last]).collect())
    }

    /// Creates a white table with the same extinction everywhere.
    pub fn constant(extinction: f32) -> Self {
        Self::new(vec![[1.0, 1.0, 1.0, extinction]; LUT_SIZE])
    }

    /// Returns all numbers in the order of the shaders' declaration (`volume/material.wgsl`).
    pub fn to_f32s(&self) -> Vec<f32> {
        let Self { entries, slope_signs: sides, range_maxima: peaks, integrals } = self;
        let (entries, integrals) = (entries.iter().flatten(), integrals.iter().flatten());
        entries.chain(sides).chain(peaks).chain(integrals).copied().collect()
    }

    /// Returns the largest extinction of any density, per scene unit.
    pub fn max_extinction(&self) -> f32 {
        self.entries.iter().map(|[.., extinction]| *extinction).fold(0.0, f32::max)
    }

    /// Returns true if the lowest density has any extinction.
    pub fn is_lowest_visible(&self) -> bool {
        self.entries[0][3] > 0.0
    }

    /// Returns true if both tables have extinction at the same densities; its amount and the colour may differ.
    pub fn has_same_visibility(&self, other: &Self) -> bool {
        let pairs = self.entries.iter().zip(&other.entries);
        self.entries.len() == other.entries.len()
            && pairs.into_iter().all(|(a, b)| (a[3] > 0.0) == (b[3] > 0.0))
    }

    /// Returns a test for extinction at any density in `[min, max]`. It includes the table entries around the range,
    /// since values between entries are interpolated, and one more on either side, since densities are rounded when
    /// they are uploaded.
    pub fn visibility_test(&self) -> impl Fn(f32, f32) -> bool + Sync + use<> {
        let is_visible: Vec<bool> = self.entries.iter().map(|entry| entry[3] > 0.0).collect();
        // Runs of visible entries, each as an open interval that ends two entries before its first and two behind its
        // last: a range that overlaps it includes or neighbours a visible entry.
        let mut runs: Vec<[f32; 2]> = Vec::new();
        let mut at = 0.0;
        for run in is_visible.chunk_by(|a, b| a == b) {
            let end = at + run.len() as f32;
            if run[0] {
                runs.push([at - 2.0, end + 1.0]);
            }
            at = end;
        }
        // counts[i] is the number of visible entries below i.
        let counts: Vec<u32> = std::iter::once(0)
            .chain(is_visible.iter().scan(0, |seen, &visible| {
                *seen += u32::from(visible);
                Some(*seen)
            }))
            .collect();
        let last = LUT_SIZE - 1;
        move |min, max| {
            let (min, max) = (min * last as f32, max * last as f32);
            if runs.len() <= MAX_COMPARED_RUNS {
                return runs.iter().any(|&[before, behind]| max > before && min < behind);
            }
            let low = (min.floor() as usize).saturating_sub(1).min(last);
            let high = (max.ceil() as usize + 1).min(last);
            counts[high + 1] > counts[low]
        }
    }

    /// Returns a test for extinction at a density that is not interpolated, such as that of a label: the nearest entry
    /// is its own.
    pub fn exact_visibility_test(&self) -> impl Fn(f32) -> bool + Sync + use<> {
        let is_visible: Vec<bool> = self.entries.iter().map(|entry| entry[3] > 0.0).collect();
        let last = LUT_SIZE - 1;
        move |density| is_visible[((density * last as f32).round() as usize).min(last)]
    }

    /// Returns the largest extinction of densities from `low` to `high`.
    pub fn max_extinction_in(&self, low: f64, high: f64) -> f64 {
        let at = |density: f64| density.clamp(0.0, 1.0) * (LUT_SIZE - 1) as f64;
        let (first, last) = (at(low).floor() as usize, at(high).ceil() as usize);
        self.entries[first..=last].iter().map(|entry| f64::from(entry[3])).fold(0.0, f64::max)
    }

    /// Returns the side to which opacity falls at a density, from the nearest entry.
    pub fn slope_sign(&self, density: f64) -> f64 {
        let at = density.clamp(0.0, 1.0) * (LUT_SIZE - 1) as f64;
        f64::from(self.slope_signs[at.round() as usize])
    }

    /// Returns linear RGB and extinction per scene unit at a density, interpolated in f64.
    pub fn sample(&self, density: f64) -> [f64; 4] {
        let at = density.clamp(0.0, 1.0) * (LUT_SIZE - 1) as f64;
        let low = (at as usize).min(LUT_SIZE - 2);
        let t = at - low as f64;
        std::array::from_fn(|i| {
            let (a, b) = (f64::from(self.entries[low][i]), f64::from(self.entries[low + 1][i]));
            a + (b - a) * t
        })
    }
}

#[cfg(test)]
mod tests {
    use super::{BakedTransfer, LUT_SIZE};
    use crate::{ControlPoint, TransferFunction};
    use chiaroscuro_volume::ValueRange;

    fn sides(points: &[(f64, f64)]) -> Vec<f32> {
        let points = points.iter().map(|&(value, opacity)| ControlPoint::new(value, [1.0; 3], opacity));
        let function = TransferFunction { points: points.collect(), ..TransferFunction::default() };
        function.bake(ValueRange::UNIT, 1.0, 1.0).slope_signs
    }

    #[test]
    fn sides_are_those_of_the_nearest_change() {
        // A rise, a plateau, and a fall.
        let found = sides(&[(0.0, 0.0), (0.2, 0.0), (0.3, 0.8), (0.7, 0.8), (0.8, 0.0)]);
        let at = |density: f64| found[(density * 1023.0) as usize];
        for rising in [0.0, 0.1, 0.25, 0.3, 0.45] {
            assert!(at(rising) > 0.99, "{rising}: {}", at(rising));
        }
        for falling in [0.55, 0.7, 0.75, 0.9, 1.0] {
            assert!(at(falling) < -0.99, "{falling}: {}", at(falling));
        }
        // There is no jump between them.
        assert!(found.windows(2).all(|pair| (pair[1] - pair[0]).abs() < 0.3));
    }

    #[test]
    fn the_largest_extinction_of_a_range_is_found_in_two_runs() {
        let points = [(0.0, 0.1), (0.2, 0.0), (0.3, 0.9), (0.31, 0.2), (0.7, 0.5), (1.0, 0.4)]
            .map(|(value, opacity)| ControlPoint::new(value, [1.0; 3], opacity));
        let function = TransferFunction { points: points.to_vec(), ..TransferFunction::default() };
        let baked = function.bake(ValueRange::UNIT, 1.0, 1.0);
        assert_eq!(baked.range_maxima.len(), 11 * 1024);
        for first in (0..1024_usize).step_by(37) {
            for last in (first..1024).step_by(29) {
                let power = (last - first + 1).ilog2();
                let run = |at: usize| f64::from(baked.range_maxima[1024 * power as usize + at]);
                let found = run(first).max(run(last + 1 - (1 << power)));
                let expected = baked.max_extinction_in(first as f64 / 1023.0, last as f64 / 1023.0);
                assert_eq!(found, expected, "{first} … {last}");
            }
        }
    }

    #[test]
    fn mirrored_curves_have_mirrored_sides() {
        let curve = [(0.0, 0.0), (0.3, 0.1), (0.35, 0.9), (0.6, 0.2), (1.0, 0.7)];
        let mut mirrored = curve.map(|(value, opacity)| (1.0 - value, opacity));
        mirrored.reverse();
        let (found, other) = (sides(&curve), sides(&mirrored));
        for (a, b) in found.iter().zip(other.iter().rev()) {
            assert!((a + b).abs() < 1e-3, "{a} {b}");
        }
        assert!(sides(&[(0.0, 0.5), (1.0, 0.5)]).iter().all(|&side| side == 1.0), "nothing changes");
    }

    /// Tests combs of a few teeth, which are compared one by one, and of many, which are counted.
    #[test]
    fn ranges_between_visible_values_are_empty() {
        for teeth in [1, 3, 40] {
            let width = LUT_SIZE / teeth;
            let is_visible = |entry: usize| entry % width > width / 2;
            let entries = (0..LUT_SIZE).map(|entry| [1.0, 1.0, 1.0, f32::from(u8::from(is_visible(entry)))]);
            let visible = BakedTransfer::new(entries.collect()).visibility_test();
            let density = |entry: f32| entry / (LUT_SIZE - 1) as f32;
            for first in 0..LUT_SIZE - 4 {
                for last in first..first + 4 {
                    let expected = (first.saturating_sub(1)..=(last + 1).min(LUT_SIZE - 1)).any(is_visible);
                    // Between entries, so that rounding of densities does not matter.
                    let (min, max) = (density(first as f32 + 0.2), density(last as f32 - 0.2).max(0.0));
                    assert_eq!(visible(min, max), expected, "{teeth}: {first} {last}");
                }
            }
        }
    }
}
