//! Set of the labels in a volume, and densities of volumes shown as labels: classes in place of values, so that
//! nothing depends on the labels' numbers.

use std::collections::BTreeMap;

use rayon::prelude::*;

use super::{Samples, Volume};
use crate::ValueRange;

/// Maximum number of distinct labels: more integers than these are measurements.
const MAX_LABELS_IN_VOLUME: usize = 1 << 16;

/// Maximum absolute value of a label's number.
const MAX_LABEL_NUMBER: f64 = (1u64 << 32) as f64;

/// Maximum number of classes that densities can distinguish.
///
/// Tables of looks have 1024 entries, and lookups interpolate between two of them. With 256 classes, all entries
/// within 1023/255/2 = 2.006 of a class's density belong to that class, and a lookup reaches less than one entry
/// further: so a density may be off by 1.006/1023 = 9.8e-4. 16-bit floats are off by half of 2^-11, which is 2.4e-4,
/// 16-bit normalised integers by 7.6e-6. With 512 classes, floats would mix neighbours.
pub const MAX_CLASSES: usize = 256;

/// Label with the number of its voxels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct CountedLabel {
    /// Number that voxels of the label hold.
    pub number: i64,
    /// Count of voxels with the label.
    pub voxels: u64,
}

/// Labels of a volume, at least two.
///
/// Each belongs to a class, which determines its look: up to [`MAX_CLASSES`] labels have classes of their own, in the
/// order of their numbers. If there are more, the background (0, or the lowest label if no voxel is 0) keeps a class
/// of its own, and the others share the remaining classes in turn.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LabelSet {
    /// Labels in ascending order of their numbers.
    labels: Vec<CountedLabel>,
    /// Rank of the background label.
    background_rank: usize,
}

impl LabelSet {
    /// Counts the labels of a volume without missing voxels; `None` if values are not integers, all equal, or more
    /// than [`MAX_LABELS_IN_VOLUME`].
    pub(super) fn from_volume(volume: &Volume) -> Option<Self> {
        let voxels = volume.voxel_count();
        let slice = voxels / volume.dims()[2];
        let missing = volume.missing();
        let is_there = |voxel: usize| missing.is_none_or(|missing| !missing.contains(voxel));
        let counted = (0..volume.dims()[2])
            .into_par_iter()
            .map(|z| count(volume.samples(), (z * slice..(z + 1) * slice).filter(|&voxel| is_there(voxel))))
            .try_reduce(BTreeMap::new, |mut all, more| {
                for (number, voxels) in more {
                    *all.entry(number).or_default() += voxels;
                }
                (all.len() <= MAX_LABELS_IN_VOLUME).then_some(all)
            })?;
        Self::new(counted.into_iter().map(|(number, voxels)| CountedLabel { number, voxels }).collect())
    }

    /// Creates a set of labels, which must ascend by number; `None` if there are fewer than two.
    fn new(labels: Vec<CountedLabel>) -> Option<Self> {
        let around = labels.binary_search_by_key(&0, |label| label.number).unwrap_or(0);
        (labels.len() > 1).then_some(Self { labels, background_rank: around })
    }

    /// Returns all labels in the order of their numbers.
    pub fn labels(&self) -> &[CountedLabel] {
        &self.labels
    }

    /// Returns the number of labels.
    pub fn count_integers(&self) -> usize {
        self.labels.len()
    }

    /// Returns the number of classes in use.
    pub fn class_count(&self) -> usize {
        self.count_integers().min(MAX_CLASSES)
    }

    /// Returns true if every label has a class of its own.
    pub fn has_own_classes(&self) -> bool {
        self.count_integers() <= MAX_CLASSES
    }

    /// Returns the class of the label with the given rank among all.
    fn class_of_rank(&self, rank: usize) -> usize {
        if self.has_own_classes() || rank == self.background_rank {
            return if self.has_own_classes() { rank } else { 0 };
        }
        let among_others = rank - usize::from(rank > self.background_rank);
        1 + among_others % (MAX_CLASSES - 1)
    }

    /// Returns the first label of a class, which represents all its labels.
    pub fn representative_of_class(&self, class: usize) -> CountedLabel {
        let rank = match class {
            _ if self.has_own_classes() => class,
            0 => self.background_rank,
            _ => class - usize::from(class <= self.background_rank),
        };
        self.labels[rank.min(self.count_integers() - 1)]
    }

    /// Returns the label that represents the class of a number; the number itself if it has a class of its own or is
    /// not in the set.
    pub fn representative_of(&self, number: i64) -> i64 {
        match self.labels.binary_search_by_key(&number, |label| label.number) {
            Ok(rank) => self.representative_of_class(self.class_of_rank(rank)).number,
            Err(_) => number,
        }
    }

    /// Returns the range of class indices: from 0 to the last.
    pub fn class_range(&self) -> ValueRange {
        ValueRange::new(0.0, (self.class_count() - 1) as f64)
    }

    /// Returns the density of the label nearest to a value: its class as a share of the last one.
    pub fn density_of(&self, value: f64) -> f64 {
        if !value.is_finite() {
            return 0.0;
        }
        let above = self.labels.partition_point(|label| (label.number as f64) < value);
        let distance = |rank: usize| (self.labels[rank].number as f64 - value).abs();
        let rank = match above {
            0 => 0,
            above if above == self.count_integers() => above - 1,
            above if distance(above - 1) < distance(above) => above - 1,
            above => above,
        };
        self.class_of_rank(rank) as f64 / self.class_range().high
    }

    /// Returns the number of the first label of the class nearest to a density.
    pub fn number_at(&self, density: f64) -> i64 {
        let class = self.class_range().value_at(density.clamp(0.0, 1.0)).round() as usize;
        self.representative_of_class(class).number
    }
}

/// Counts the occurrences of each integer; `None` if there are fractions, or more than [`MAX_LABELS_IN_VOLUME`]
/// numbers.
fn count(samples: &Samples, voxels: impl Iterator<Item = usize>) -> Option<BTreeMap<i64, u64>> {
    let mut counted = BTreeMap::new();
    // Runs of equal values are counted at once: neighbours are mostly equal.
    let (mut last, mut run) = (f64::NAN, 0u64);
    let mut add = |value: f64, run: u64| {
        let is_number = value.fract() == 0.0 && value.abs() <= MAX_LABEL_NUMBER;
        if run > 0 && is_number {
            *counted.entry(value as i64).or_default() += run;
        }
        run == 0 || is_number && counted.len() <= MAX_LABELS_IN_VOLUME
    };
    for voxel in voxels {
        let value = samples.value(voxel);
        if value != last {
            if !add(last, run) {
                return None;
            }
            (last, run) = (value, 0);
        }
        run += 1;
    }
    add(last, run).then_some(counted)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;
    use half::f16;

    fn volume(values: Vec<f32>) -> Volume {
        Volume::with_spacing("t", [values.len(), 1, 1], DVec3::ONE, Samples::F32(values)).unwrap()
    }

    fn set(count: usize) -> LabelSet {
        let labels = (0..count).map(|rank| CountedLabel { number: 7 * rank as i64 - 70, voxels: 1 });
        LabelSet::new(labels.collect()).unwrap()
    }

    #[test]
    fn labels_are_counted_but_for_what_is_missing() {
        let padded = volume(vec![3.0, 3.0, -2.0, 9.0, f32::NAN, 3.0, 255.0]).with_padding(255.0).unwrap();
        let labels = LabelSet::from_volume(&padded).unwrap();
        let found: Vec<_> = labels.labels().iter().map(|label| (label.number, label.voxels)).collect();
        assert_eq!(found, [(-2, 1), (3, 3), (9, 1)]);
        assert_eq!([-2.0, 3.0, 9.0].map(|value| labels.density_of(value)), [0.0, 0.5, 1.0]);
        // Values between labels get the nearest one.
        assert_eq!([-9.0, 5.9, 6.1, 1e9, f64::NAN].map(|v| labels.density_of(v)), [0.0, 0.5, 1.0, 1.0, 0.0]);
        assert_eq!([0.1, 0.3, 1.0].map(|density| labels.number_at(density)), [-2, 3, 9]);
    }

    #[test]
    fn what_are_no_labels_has_none() {
        assert_eq!(LabelSet::from_volume(&volume(vec![1.0, 2.5])), None);
        assert_eq!(LabelSet::from_volume(&volume(vec![1.0, 1e12])), None);
        assert_eq!(LabelSet::from_volume(&volume(vec![1.0, f32::NAN, 1.0])), None, "there is one only");
        let many = |count: u32| {
            let values = Samples::U32((0..count).collect());
            LabelSet::from_volume(
                &Volume::with_spacing("t", [count as usize, 1, 1], DVec3::ONE, values).unwrap(),
            )
        };
        assert_eq!(many(1 << 16).map(|labels| labels.count_integers()), Some(1 << 16));
        assert_eq!(many((1 << 16) + 1), None);
    }

    /// Tests the derivation at [`MAX_CLASSES`] for each number of classes: entries that a lookup mixes belong to the
    /// same class.
    #[test]
    fn classes_survive_both_formats_of_densities() {
        let nearest = |entry: f64, last: f64| (entry * last / 1023.0).round();
        for count in 2..=MAX_CLASSES {
            let labels = set(count);
            let last = labels.class_range().high;
            for label in labels.labels() {
                let density = labels.density_of(label.number as f64) as f32;
                let class = (f64::from(density) * last).round();
                let unorm = f64::from((density * 65535.0).round()) / 65535.0;
                for stored in [f64::from(f16::from_f32(density).to_f32()), unorm] {
                    let low = (stored * 1023.0).floor().min(1022.0);
                    for entry in [low, low + 1.0] {
                        let is_read = entry == low || stored * 1023.0 > low;
                        assert!(!is_read || nearest(entry, last) == class, "{count}: {label:?} {entry}");
                    }
                }
            }
        }
    }

    #[test]
    fn extra_labels_share_classes_except_the_background() {
        let labels = set(1000);
        assert_eq!(labels.class_count(), MAX_CLASSES);
        let class = |number: i64| (labels.density_of(number as f64) * 255.0).round() as usize;
        assert_eq!((class(0), class(-70), class(-63), class(7)), (0, 1, 2, 11));
        // All labels have the look of the first one in their class.
        for label in labels.labels() {
            let first = labels.representative_of(label.number);
            assert_eq!(class(first), class(label.number));
            assert_eq!(labels.representative_of_class(class(first)).number, first);
            assert!(first <= label.number && (first == 0) == (label.number == 0));
        }
        assert_eq!(labels.representative_of(12), 12, "there is no such label");
        assert!((0..200).all(|rank| set(200).representative_of(7 * rank - 70) == 7 * rank - 70));
    }
}
