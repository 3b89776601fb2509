//! Robust value range: without padding and outliers, so that no single voxel can change it by much.
//!
//! It follows from the ranks of the values of at most [`MAX_SAMPLES`] voxels, so the order of voxels matters only
//! for larger volumes, which are sampled. The range follows an offset or scale of the values, and depends on the
//! number type only by rounding outwards to integers.

use rayon::prelude::*;

use super::samples::with_samples;
use crate::cancellation::CancelToken;
use crate::{Samples, ValueRange, VoxelType};

/// Maximum number of sampled voxels: the 0.01 % at either end are 26 of them, whose rank is uncertain by a fifth.
const MAX_SAMPLES: usize = 1 << 18;

/// Number of voxels that one parallel task processes.
const CHUNK_VOXELS: usize = 1 << 16;

/// Number of most extreme voxels at either end that are always ignored: the ninth of a million normally distributed
/// values is 0.3 % of their range below the eighth.
const IGNORED_EXTREMES: usize = 8;

/// Minimum number of voxels for each of [`IGNORED_EXTREMES`]: in smaller volumes fewer are ignored, in very small
/// ones none.
const VOXELS_PER_IGNORED_EXTREME: usize = 1024;

/// Maximum number of distinct values of a mask or a small label map, whose values are names: none of them is an
/// outlier.
const MAX_LABEL_VALUES: usize = 16;

/// One voxel of this many lies below the lower end of the usual values, and one above the upper end: 0.01 %.
const VOXELS_PER_OUTLIER: usize = 10_000;

/// Criterion of padding: more than one voxel of this many has the lowest (or highest) value.
const VOXELS_PER_PADDING: usize = 100;

/// Criterion of padding: minimum gap between it and all other values, as a share of the range of all but one in
/// `VOXELS_PER_GAP_OUTLIER` voxels at either end.
const MIN_PADDING_GAP: f64 = 0.05;
const VOXELS_PER_GAP_OUTLIER: usize = 1000;

/// Criterion of padding: more than one voxel of this many is no padding; fewer would merely lie between two values.
const VOXELS_PER_NON_PADDING: usize = 20;

/// An end of the range is moved out to the extreme value if the distance is less than this share of the range.
const MAX_WIDENING: f64 = 0.5;

/// Margin that remains between padding and the other values, as a share of the range: padding may be the background
/// of the object, whose border would be lost otherwise.
const PADDING_MARGIN: f64 = 1.0 / 16.0;

/// An end nearer than this share of the range to the extreme value is snapped to it: less than the 1 % by which a
/// single voxel may move an end.
const SNAP_TOLERANCE: f64 = 1.0 / 128.0;

/// Value ranges of a volume: of all values, and the robust one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ValueRanges {
    /// Range from the smallest finite value of the file to the largest.
    pub all: ValueRange,
    /// Robust range, without padding and outliers.
    pub robust: ValueRange,
}

impl ValueRanges {
    /// Ranges that are both 0 … 1.
    pub const UNIT: Self = Self::without_outliers(ValueRange::UNIT);

    /// Creates ranges of which the robust one includes all values.
    pub const fn without_outliers(all: ValueRange) -> Self {
        Self { all, robust: all }
    }

    /// Returns the ranges that hold these and others, as of several time steps.
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        let union = |a: ValueRange, b: ValueRange| ValueRange::new(a.low.min(b.low), a.high.max(b.high));
        Self { all: union(self.all, other.all), robust: union(self.robust, other.robust) }
    }

    /// Finds the robust range of values that span `all`.
    #[cfg(test)]
    fn from_samples(samples: &Samples, all: ValueRange) -> Self {
        Self::from_samples_except(samples, all, f64::NAN)
    }

    /// Finds the robust range of values that span `all`, ignoring voxels of the value `left_out`.
    pub(crate) fn from_samples_except(samples: &Samples, all: ValueRange, excluded: f64) -> Self {
        let Some(found) =
            ValueRange::non_degenerate(all.low, all.high).and_then(|_| robust_range(samples, excluded))
        else {
            return Self::without_outliers(all);
        };
        let near = SNAP_TOLERANCE * found.span();
        let mut robust = found;
        if !matches!(samples.voxel_type(), VoxelType::F32 | VoxelType::F64) {
            robust = ValueRange::new(found.low.floor(), found.high.ceil());
        }
        if robust.low - all.low <= near {
            robust.low = all.low;
        }
        if all.high - robust.high <= near {
            robust.high = all.high;
        }
        Self { all, robust }
    }
}

/// Returns the quantile at `share` (0 … 1) of the finite values other than `left_out`, estimated from evenly spread
/// voxels; 0 if there are none.
pub(crate) fn quantile(samples: &Samples, left_out: f64, share: f64) -> f64 {
    let values = sorted_samples(samples, left_out);
    let at = (share.clamp(0.0, 1.0) * values.len() as f64) as usize;
    values.get(at).or(values.last()).copied().unwrap_or_default()
}

/// Returns the finite values of evenly spread voxels other than `left_out`, sorted.
pub(super) fn sorted_samples(samples: &Samples, left_out: f64) -> Vec<f64> {
    let mut values = sampled_values(samples, left_out);
    values.par_sort_unstable_by(f64::total_cmp);
    values
}

/// Returns the finite values of evenly spread voxels other than `left_out`, in the order of the voxels.
pub(super) fn sampled_values(samples: &Samples, left_out: f64) -> Vec<f64> {
    let stride = samples.len().div_ceil(MAX_SAMPLES).max(1);
    let value = |at: usize| {
        let first = at * stride;
        // A pseudo-random voxel of each stride, so that the sampling cannot alias with the rows of the volume.
        let hash = ((at as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 33) as usize;
        samples.value(first + hash % stride.min(samples.len() - first))
    };
    let all = (0..samples.len().div_ceil(stride)).into_par_iter().map(value);
    all.filter(|value| value.is_finite() && *value != left_out).collect()
}

/// Lowest and highest values seen, sorted from the outermost inwards.
struct Extremes {
    lows: Vec<f64>,
    highs: Vec<f64>,
}

impl Extremes {
    /// Creates `count` placeholders at either end.
    fn empty(count: usize) -> Self {
        Self { lows: vec![f64::INFINITY; count], highs: vec![f64::NEG_INFINITY; count] }
    }

    fn include_low(&mut self, value: f64) {
        if let Some(last) = self.lows.last_mut().filter(|last| value < **last) {
            *last = value;
            self.lows.sort_unstable_by(f64::total_cmp);
        }
    }

    fn include_high(&mut self, value: f64) {
        if let Some(last) = self.highs.last_mut().filter(|last| value > **last) {
            *last = value;
            self.highs.sort_unstable_by(|a, b| b.total_cmp(a));
        }
    }

    fn include(mut self, value: f64) -> Self {
        self.include_low(value);
        self.include_high(value);
        self
    }

    fn union(mut self, other: &Self) -> Self {
        other.lows.iter().for_each(|&value| self.include_low(value));
        other.highs.iter().for_each(|&value| self.include_high(value));
        self
    }
}

/// Returns the range of the finite values strictly between `above` and `below` and other than `left_out`, without the
/// `few` most extreme voxels at either end; `None` if it has no length.
#[expect(trivial_numeric_casts, clippy::unnecessary_cast, reason = "one of the eight types is f64 already")]
fn trimmed_range(samples: &Samples, left_out: f64, few: usize, above: f64, below: f64) -> Option<ValueRange> {
    let interrupt = CancelToken::current();
    let found = with_samples!(samples, values => values
        .par_chunks(CHUNK_VOXELS)
        .map(|chunk| {
            if interrupt.should_stop() {
                return Extremes::empty(few + 1);
            }
            let values = chunk.iter().map(|&value| value as f64);
            // Comparisons with NaN are false.
            let counts = |value: &f64| above < *value && *value < below && *value != left_out;
            values.filter(counts).fold(Extremes::empty(few + 1), Extremes::include)
        })
        .reduce(|| Extremes::empty(few + 1), |a, b| a.union(&b)));
    let range = ValueRange::non_degenerate(found.lows[few], found.highs[few])?;
    range.span().is_finite().then_some(range)
}

/// Returns true if sorted values have at most [`MAX_LABEL_VALUES`] distinct ones.
pub(super) fn has_few_distinct(values: &[f64]) -> bool {
    values.windows(2).filter(|pair| pair[0] < pair[1]).take(MAX_LABEL_VALUES).count() < MAX_LABEL_VALUES
}

/// Returns the number of leading values, of a sequence sorted from one end, that are padding; 0 if there is none.
fn padding_count(values: &[f64]) -> usize {
    let (n, rare) = (values.len(), values.len() / VOXELS_PER_GAP_OUTLIER);
    let usual = (values[n - 1 - rare] - values[rare]).abs();
    let count = values.iter().take_while(|&&value| value == values[0]).count();
    let others = &values[count..];
    if count * VOXELS_PER_PADDING <= n || others.len() * VOXELS_PER_NON_PADDING <= n {
        return 0;
    }
    let gap = (others[others.len() / VOXELS_PER_OUTLIER] - values[0]).abs();
    if gap >= MIN_PADDING_GAP * usual { count } else { 0 }
}

/// Returns the distance by which an end of the `usual` range is moved outwards, given the distances from there to the
/// extreme value and to padding beyond it.
fn widening(usual: ValueRange, to_last: f64, padding: Option<f64>) -> f64 {
    let most = MAX_WIDENING * usual.span();
    let by = if to_last < most { to_last } else { 0.0 };
    match padding {
        None => by,
        Some(padding) if padding < most => padding,
        Some(_) => by + PADDING_MARGIN * usual.span(),
    }
}

/// Computes the robust range; `None` if, apart from a few voxels, there is only one value.
fn robust_range(samples: &Samples, left_out: f64) -> Option<ValueRange> {
    let few = (samples.len() / VOXELS_PER_IGNORED_EXTREME).min(IGNORED_EXTREMES);
    let whole = trimmed_range(samples, left_out, few, f64::NEG_INFINITY, f64::INFINITY)?;
    let mut values = sorted_samples(samples, left_out);
    values.retain(|&value| whole.contains(value));
    if values.is_empty() || has_few_distinct(&values) {
        return Some(whole);
    }
    let above = padding_count(&values.iter().rev().copied().collect::<Vec<_>>());
    let below = padding_count(&values);
    if values.len() <= below + above {
        return Some(whole);
    }
    let rest = &values[below..values.len() - above];
    let unusual = rest.len() / VOXELS_PER_OUTLIER;
    let Some(usual) = ValueRange::non_degenerate(rest[unusual], rest[rest.len() - 1 - unusual]) else {
        return Some(whole);
    };
    let (first, last) = (values[0], values[values.len() - 1]);
    let last_values = if below + above == 0 {
        whole
    } else {
        let bound = |is_padded: bool, padding: f64, open: f64| if is_padded { padding } else { open };
        let above_low = bound(below > 0, first, f64::NEG_INFINITY);
        trimmed_range(samples, left_out, few, above_low, bound(above > 0, last, f64::INFINITY))
            .unwrap_or(usual)
    };
    let usual = ValueRange::new(usual.low.max(last_values.low), usual.high.min(last_values.high));
    let low = widening(usual, usual.low - last_values.low, (below > 0).then_some(usual.low - first));
    let high = widening(usual, last_values.high - usual.high, (above > 0).then_some(last - usual.high));
    Some(ValueRange::new(usual.low - low, usual.high + high))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn robust_range_of(values: Vec<f64>) -> ValueRange {
        let all = values.iter().filter(|value| value.is_finite());
        let all = all.fold(ValueRange::new(f64::INFINITY, f64::NEG_INFINITY), |range, &value| {
            ValueRange::new(range.low.min(value), range.high.max(value))
        });
        ValueRanges::from_samples(&Samples::F64(values), all).robust
    }

    /// Makes pseudo-random numbers between 0 and 1, mostly near 0, from a fixed seed.
    fn numbers(count: usize) -> Vec<f64> {
        let mut state = 7u64;
        let mut next = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 40) as f64 / f64::from(1 << 24)
        };
        (0..count).map(|_| next() * next()).collect()
    }

    fn close(a: ValueRange, b: ValueRange) -> bool {
        (a.low - b.low).abs().max((a.high - b.high).abs()) <= 0.01 * b.span()
    }

    #[test]
    fn no_single_voxel_matters() {
        for count in [20_000, 40_000, 300_000] {
            let values = numbers(count);
            let before = robust_range_of(values.clone());
            assert!(before.low.abs() < 0.01 && before.high > 0.9, "{before:?}");
            for odd in [1e30, -1e30, 30_000.0, -2.0, 1.1, 1.5, f64::NAN, f64::INFINITY, 0.5] {
                let mut changed = values.clone();
                changed[count / 3] = odd;
                assert!(close(robust_range_of(changed), before), "{odd} among {count}");
            }
        }
    }

    #[test]
    fn padding_and_outliers_are_excluded() {
        let values = numbers(40_000);
        let before = robust_range_of(values.clone());
        for padding in [-3.0, -32_768.0, 7.0, 1e9] {
            let mut padded = values.clone();
            padded.extend(vec![padding; 10_000]);
            let after = robust_range_of(padded);
            let room = 1.01 * PADDING_MARGIN * before.span();
            assert!(
                after.low <= before.low + 1e-9 && after.low >= before.low - room,
                "{padding}: {after:?}, {before:?}"
            );
            assert!(
                after.high >= before.high - 1e-9 && after.high <= before.high + room,
                "{padding}: {after:?}, {before:?}"
            );
        }
        // Hot voxels, fewer than one in ten thousand.
        let mut hot = numbers(200_000);
        let before = robust_range_of(hot.clone());
        hot[1000..1015].fill(500.0);
        let after = robust_range_of(hot);
        assert!(after.high <= before.high && after.high > 0.85, "{after:?}");
    }

    #[test]
    fn backgrounds_near_object_values_are_no_padding() {
        // Tissue of 0.3 … 1 in a background of exactly 0.
        let mut values: Vec<f64> = numbers(20_000).into_iter().map(|value| 0.3 + 0.7 * value).collect();
        values.extend(vec![0.0; 20_000]);
        assert_eq!(robust_range_of(values).low, 0.0);
        // The background is far from steel of 0.95 … 1: only a margin for the object's border stays in the range.
        let mut values: Vec<f64> = numbers(20_000).into_iter().map(|value| 0.95 + 0.05 * value).collect();
        values.extend(vec![0.0; 20_000]);
        let found = robust_range_of(values);
        assert!(found.low < 0.949 && found.low > 0.94, "{found:?}");
    }

    #[test]
    fn masks_labels_and_constants_keep_their_values() {
        let all = |values: Vec<f64>| {
            let low = values.iter().copied().fold(f64::INFINITY, f64::min);
            let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            assert_eq!(robust_range_of(values), ValueRange::new(low, high));
        };
        all(vec![7.0; 5000]);
        all((0..50_000).map(|at| f64::from(u8::from(at < 30))).collect());
        all((0..50_000).map(|at| f64::from(at % 50 / 46)).collect());
        all((0..50_000).map(|at| f64::from(at % 7) * 300.0).collect());
        // A single voxel: there is nothing else to show.
        all((0..5000).map(|at| f64::from(u8::from(at == 9))).collect());
        all(vec![1.0, 2.0]);
        // A mask with a single outlier.
        let mut mask: Vec<f64> = (0..50_000).map(|at| f64::from(at % 2)).collect();
        mask[100] = 1e30;
        assert_eq!(robust_range_of(mask), ValueRange::UNIT);
    }

    #[test]
    fn scale_offset_and_number_type_do_not_matter() {
        let values: Vec<f64> = numbers(60_000).into_iter().map(|value| (value * 4000.0).round()).collect();
        let before = robust_range_of(values.clone());
        let moved = robust_range_of(values.iter().map(|value| 3.0 * value - 500.0).collect());
        assert_eq!(moved, ValueRange::new(3.0 * before.low - 500.0, 3.0 * before.high - 500.0));
        let all = ValueRange::new(0.0, values.iter().copied().fold(0.0, f64::max));
        for samples in [
            Samples::U16(values.iter().map(|&value| value as u16).collect()),
            Samples::I32(values.iter().map(|&value| value as i32).collect()),
            Samples::F32(values.iter().map(|&value| value as f32).collect()),
        ] {
            assert_eq!(ValueRanges::from_samples(&samples, all).robust, before);
        }
        let mut turned = values;
        turned.reverse();
        assert_eq!(robust_range_of(turned), before);
    }
}
