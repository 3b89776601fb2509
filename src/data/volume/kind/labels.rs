//! Masks and label maps: few values, each of which fills regions.

use super::inverted::{FACES, MOST_OF_OBJECT};
use super::sampled::{Sampled, distinct_of_all};
use super::{DataKind, KindFound};
use crate::data::{MAX_LABELS, Volume};

/// Share of neighbours, both of them of some label, that have the same one, at least. Label maps have 0.88 and more,
/// the scalar volume that comes nearest 0.76.
const LEAST_EQUAL: f64 = 0.85;

/// The same for the label in the middle of all, at least: the smallest may be specks. Values that only occur where an
/// object ends, as between a thing and air, have hardly any neighbours like them; of a label that fills regions most are.
const LEAST_EQUAL_OF_ONE: f64 = 0.5;

/// Share of unequal neighbours that are not next to each other in the order of all values, at least. Along smooth
/// fields of few values it is next to nothing, in label maps 0.84 and more: well apart from both.
const LEAST_JUMPS: f64 = 0.3;

/// From so many values on there are jumps in label maps: of three labels around each other there are none. Those count
/// from one, or leave out one or two; other numbers, such as 0, 90 and 220, are of materials.
const VALUES_WITH_JUMPS: usize = 5;

/// Values that only labels have are whole, and not too large for a number that counts things.
const LARGEST_LABEL: f64 = (1u64 << 32) as f64;

/// How many labels a volume has, without the lowest value, which is what is around them.
pub(super) fn count(volume: &Volume) -> usize {
    let distinct = distinct_of_all(volume, MAX_LABELS + 1).map_or(MAX_LABELS + 1, |all| all.len());
    // Everything is labelled where the lowest value is above zero.
    distinct.saturating_sub(usize::from(volume.value_range().low <= 0.0))
}

/// Two values, one of which is not all around.
pub(super) fn mask(volume: &Volume, sampled: &Sampled<'_>) -> Option<KindFound> {
    // Most volumes have more among the first few voxels already.
    sampled.distinct(2)?;
    let all = distinct_of_all(volume, 2)?;
    let [low, high] = all[..] else { return None };
    let is_around =
        |value: f64| sampled.faces().iter().filter(|face| is_mostly(face, value)).count() >= FACES;
    // What surrounds an object of which there is more is its border.
    if is_around(high) && sampled.share_of(low) < 0.5 {
        return Some(KindFound::new(
            DataKind::DarkOnBright,
            format!("the lower of two values is surrounded by the higher, {high}"),
        ));
    }
    Some(KindFound::new(DataKind::Mask, format!("there are two values, {low} and {high}")))
}

/// Whether a face shows one value, but for the share that may be of an object.
fn is_mostly(face: &[f64], value: f64) -> bool {
    let equal = face.iter().filter(|&&other| other == value).count();
    !face.is_empty() && equal as f64 >= (1.0 - MOST_OF_OBJECT) * face.len() as f64
}

/// Neighbours, counted.
#[derive(Default)]
struct Pairs {
    /// For each value but the lowest: pairs of it with any other but the lowest, and with itself.
    of_value: Vec<Pair>,
    unequal: f64,
    jumps: f64,
}

#[derive(Default, Clone, Copy)]
struct Pair {
    all: f64,
    equal: f64,
}

impl Pairs {
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

/// Whole numbers that fill regions and end abruptly.
pub(super) fn label_map(volume: &Volume, sampled: &Sampled<'_>) -> Option<KindFound> {
    let distinct = sampled.distinct(MAX_LABELS)?;
    if distinct.len() < 2 || distinct.iter().any(|value| value.fract() != 0.0 || value.abs() > LARGEST_LABEL)
    {
        return None;
    }
    let rank = |value: f64| distinct.partition_point(|&other| other < value);
    let pairs = sampled.pairs(
        |pairs: &mut Pairs, one, other| {
            if pairs.of_value.is_empty() {
                pairs.of_value = vec![Pair::default(); distinct.len()];
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
        Pairs::add,
    );
    let mut shares: Vec<f64> =
        pairs.of_value.iter().filter(|pair| pair.all > 0.0).map(|pair| pair.equal / pair.all).collect();
    shares.sort_by(f64::total_cmp);
    let typical = shares.get(shares.len() / 2).copied()?;
    let sum = |part: fn(&Pair) -> f64| pairs.of_value.iter().map(part).sum::<f64>();
    let equal = sum(|pair| pair.equal) / sum(|pair| pair.all);
    let jumps = pairs.jumps / pairs.unequal.max(1.0);
    let span = distinct[distinct.len() - 1] - distinct[0];
    let are_counted = distinct.len() < VALUES_WITH_JUMPS && span <= 2.0 * distinct.len() as f64;
    let is_abrupt = are_counted || jumps >= LEAST_JUMPS;
    (equal >= LEAST_EQUAL && typical >= LEAST_EQUAL_OF_ONE && is_abrupt).then(|| {
        let why = format!(
            "{} whole numbers fill regions: {:.0} % of neighbours are equal, and {:.0} % of the others far apart",
            distinct.len(),
            100.0 * equal,
            100.0 * jumps
        );
        KindFound::new(DataKind::LabelMap { count: count(volume) }, why)
    })
}
