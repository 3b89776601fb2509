//! Detection of masks and label maps: few distinct values, each of which fills regions.

use super::dark_on_bright::{MAX_OBJECT_SHARE, MIN_BACKGROUND_FACES};
use super::sampled::{SampledValues, distinct_values_of_all_voxels};
use super::{DataKind, DetectedKind};
use crate::{MAX_LABELS, Volume};

/// Minimum share of equal pairs among pairs of labelled neighbours. Label maps have 0.88 and more, the closest scalar
/// volume has 0.76.
const MIN_EQUAL_PAIRS: f64 = 0.85;

/// Minimum share of equal pairs for the median label: the smallest labels may be specks. Values that occur only at
/// borders of an object, as between material and air, have hardly any equal neighbours; labels that fill regions have
/// mostly equal ones.
const MIN_EQUAL_PAIRS_OF_MEDIAN: f64 = 0.5;

/// Minimum share of unequal neighbours that are not adjacent in the order of all values. Along smooth fields of few
/// values it is close to 0, in label maps 0.84 and more: a threshold well apart from both.
const MIN_JUMPS: f64 = 0.3;

/// Minimum number of values at which label maps must have such jumps: three nested labels have none. Fewer labels are
/// numbered from 1 with at most one or two gaps; other numbers, such as 0, 90 and 220, denote materials.
const MIN_VALUES_FOR_JUMPS: usize = 5;

/// Maximum number of a label: labels are integers no larger than counts of objects.
const LARGEST_LABEL: f64 = (1u64 << 32) as f64;

/// Counts the labels of a volume, without the lowest value, which is the background.
pub(super) fn count_labels(volume: &Volume) -> usize {
    let distinct =
        distinct_values_of_all_voxels(volume, MAX_LABELS + 1).map_or(MAX_LABELS + 1, |all| all.len());
    // Everything is labelled if the lowest value is above zero.
    distinct.saturating_sub(usize::from(volume.value_range().low <= 0.0))
}

/// Detects masks: two values, of which the higher is not the background.
pub(super) fn detect_mask(volume: &Volume, sampled: &SampledValues<'_>) -> Option<DetectedKind> {
    // Early exit: most volumes have more values among the sampled voxels already.
    sampled.distinct_values(2)?;
    let all = distinct_values_of_all_voxels(volume, 2)?;
    let [low, high] = all[..] else { return None };
    let is_around = |value: f64| {
        sampled.faces().iter().filter(|face| is_nearly_uniform(face, value)).count() >= MIN_BACKGROUND_FACES
    };
    // If the background is also the larger part, the object is the lower value.
    if is_around(high) && sampled.share_equal_to(low) < 0.5 {
        return Some(DetectedKind::new(
            DataKind::DarkOnBright,
            format!("the lower of two values is surrounded by the higher, {high}"),
        ));
    }
    Some(DetectedKind::new(DataKind::Mask, format!("there are two values, {low} and {high}")))
}

/// Returns true if a face shows one value, apart from the share that may belong to an object.
fn is_nearly_uniform(face: &[f64], value: f64) -> bool {
    let equal = face.iter().filter(|&&other| other == value).count();
    !face.is_empty() && equal as f64 >= (1.0 - MAX_OBJECT_SHARE) * face.len() as f64
}

/// Statistics of pairs of neighbouring voxels.
#[derive(Default)]
struct NeighbourStatistics {
    /// Counts for each value except the lowest: all pairs with values other than the lowest, and equal pairs.
    of_value: Vec<LabelPairCounts>,
    unequal: f64,
    jumps: f64,
}

#[derive(Default, Clone, Copy)]
struct LabelPairCounts {
    all: f64,
    equal: f64,
}

impl NeighbourStatistics {
    fn add(mut self, other: Self) -> Self {
        if self.of_value.is_empty() {
            return other;
        }
        for (one, more) in self.of_value.iter_mut().zip(&other.of_value) {
            one.all += more.all;
            one.equal += more.equal;
        }
        self.unequal += other.unequal;
        self.jumps += other.jumps;
        self
    }
}

/// Detects label maps: integers that fill regions and end abruptly.
pub(super) fn detect_label_map(volume: &Volume, sampled: &SampledValues<'_>) -> Option<DetectedKind> {
    let distinct = sampled.distinct_values(MAX_LABELS)?;
    if distinct.len() < 2 || distinct.iter().any(|value| value.fract() != 0.0 || value.abs() > LARGEST_LABEL)
    {
        return None;
    }
    let rank = |value: f64| distinct.partition_point(|&other| other < value);
    let pairs = sampled.fold_neighbour_pairs(
        |pairs: &mut NeighbourStatistics, one, other| {
            if pairs.of_value.is_empty() {
                pairs.of_value = vec![LabelPairCounts::default(); distinct.len()];
            }
            if one == other {
                if one > distinct[0] {
                    let pair = &mut pairs.of_value[rank(one).min(distinct.len() - 1)];
                    pair.all += 2.0;
                    pair.equal += 2.0;
                }
                return;
            }
            let ranks = [rank(one), rank(other)];
            pairs.unequal += 1.0;
            pairs.jumps += f64::from(u8::from(ranks[0].abs_diff(ranks[1]) > 1));
            if one > distinct[0] && other > distinct[0] {
                for rank in ranks.map(|rank| rank.min(distinct.len() - 1)) {
                    pairs.of_value[rank].all += 1.0;
                }
            }
        },
        NeighbourStatistics::add,
    );
    let mut shares: Vec<f64> =
        pairs.of_value.iter().filter(|pair| pair.all > 0.0).map(|pair| pair.equal / pair.all).collect();
    shares.sort_by(f64::total_cmp);
    let typical = shares.get(shares.len() / 2).copied()?;
    let sum = |part: fn(&LabelPairCounts) -> f64| pairs.of_value.iter().map(part).sum::<f64>();
    let equal = sum(|pair| pair.equal) / sum(|pair| pair.all);
    let jumps = pairs.jumps / pairs.unequal.max(1.0);
    let span = distinct[distinct.len() - 1] - distinct[0];
    let are_counted = distinct.len() < MIN_VALUES_FOR_JUMPS && span <= 2.0 * distinct.len() as f64;
    let is_abrupt = are_counted || jumps >= MIN_JUMPS;
    (equal >= MIN_EQUAL_PAIRS && typical >= MIN_EQUAL_PAIRS_OF_MEDIAN && is_abrupt).then(|| {
        let why = format!(
            "{} whole numbers fill regions: {:.0} % of neighbours are equal, and {:.0} % of the others far apart",
            distinct.len(),
            100.0 * equal,
            100.0 * jumps
        );
        DetectedKind::new(DataKind::LabelMap { count: count_labels(volume) }, why)
    })
}
