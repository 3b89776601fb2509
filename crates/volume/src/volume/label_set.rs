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

/// Number of the largest labels that keep classes of their own where labels outnumber the classes, so that each can be
/// shown alone: half of the classes. The others share the second half, in which most neighbours still differ.
const MAX_OWN_CLASSES: usize = MAX_CLASSES / 2;

/// Labels of a volume, at least two.
///
/// Each belongs to a class, which determines its look: up to [`MAX_CLASSES`] labels have classes of their own, in the
/// order of their numbers. If there are more, the background (0, or the lowest label if no voxel is 0) and the largest
/// others keep classes of their own, and the rest share the remaining classes in turn.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LabelSet {
    /// Labels in ascending order of their numbers.
    labels: Vec<CountedLabel>,
    /// Class of each label.
    classes: Vec<u16>,
    /// Rank of the first label of each class, which represents all of them.
    representatives: Vec<usize>,
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
        if labels.len() < 2 {
            return None;
        }
        let classes = if labels.len() <= MAX_CLASSES {
            (0..labels.len() as u16).collect()
        } else {
            shared_classes(&labels)
        };
        let count = labels.len().min(MAX_CLASSES);
        let mut representatives = vec![0; count];
        for (rank, &class) in classes.iter().enumerate().rev() {
            representatives[usize::from(class)] = rank;
        }
        Some(Self { labels, classes, representatives })
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

    /// Returns true if no other label has the class of this one.
    pub fn has_own_class(&self, number: i64) -> bool {
        self.labels
            .binary_search_by_key(&number, |label| label.number)
            .is_ok_and(|rank| self.has_own_classes() || usize::from(self.classes[rank]) <= MAX_OWN_CLASSES)
    }

    /// Returns the first label of a class, which represents all its labels.
    pub fn representative_of_class(&self, class: usize) -> CountedLabel {
        self.labels[self.representatives[class.min(self.representatives.len() - 1)]]
    }

    /// Returns the label that represents the class of a number; the number itself if it has a class of its own or is
    /// not in the set.
    pub fn representative_of(&self, number: i64) -> i64 {
        match self.labels.binary_search_by_key(&number, |label| label.number) {
            Ok(rank) => self.representative_of_class(usize::from(self.classes[rank])).number,
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
        f64::from(self.classes[rank]) / self.class_range().high
    }

    /// Returns the number of the first label of the class nearest to a density.
    pub fn number_at(&self, density: f64) -> i64 {
        let class = self.class_range().value_at(density.clamp(0.0, 1.0)).round() as usize;
        self.representative_of_class(class).number
    }
}

/// Returns the classes of more than [`MAX_CLASSES`] labels: 0 for the background, the next for the largest others in
/// the order of their numbers, and the remaining ones in turn.
fn shared_classes(labels: &[CountedLabel]) -> Vec<u16> {
    let background = labels.binary_search_by_key(&0, |label| label.number).unwrap_or(0);
    let mut by_size: Vec<usize> = (0..labels.len()).filter(|&rank| rank != background).collect();
    by_size.sort_by_key(|&rank| (std::cmp::Reverse(labels[rank].voxels), rank));
    let mut has_own = vec![false; labels.len()];
    by_size.iter().take(MAX_OWN_CLASSES).for_each(|&rank| has_own[rank] = true);
    let (mut own, mut shared) = (0, 0);
    let class = |rank: usize| {
        if rank == background {
            return 0;
        }
        if has_own[rank] {
            own += 1;
            return own;
        }
        shared += 1;
        let first = MAX_OWN_CLASSES as u16 + 1;
        first + (shared - 1) % (MAX_CLASSES as u16 - first)
    };
    (0..labels.len()).map(class).collect()
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
    fn small_labels_share_classes_where_there_are_too_many() {
        // Every fifth label is large, but for a middling one.
        let size = |rank: usize| if rank.is_multiple_of(5) { 100 } else { 1 + u64::from(rank == 7) };
        let labels =
            (0..1000).map(|rank| CountedLabel { number: 7 * rank as i64 - 70, voxels: size(rank) }).collect();
        let labels = LabelSet::new(labels).unwrap();
        assert_eq!(labels.class_count(), MAX_CLASSES);
        let class = |number: i64| (labels.density_of(number as f64) * 255.0).round() as usize;
        // 0 has rank 10. Before it, ranks 0 and 5 are large; 1 is the first small one.
        assert_eq!([0, -70, -35, 35].map(class), [0, 1, 2, 3]);
        assert_eq!([-63, -56].map(class), [MAX_OWN_CLASSES + 1, MAX_OWN_CLASSES + 2]);
        let mut members = vec![0; MAX_CLASSES];
        for label in labels.labels() {
            members[class(label.number)] += 1;
            // All labels have the look of the first one in their class.
            let first = labels.representative_of(label.number);
            assert_eq!(class(first), class(label.number));
            assert_eq!(labels.representative_of_class(class(first)).number, first);
            assert!(first <= label.number && (first == 0) == (label.number == 0));
        }
        for label in labels.labels() {
            assert_eq!(labels.has_own_class(label.number), members[class(label.number)] == 1, "{label:?}");
        }
        // 1000 labels less the background and the largest 128, in 127 classes.
        assert!(members[MAX_OWN_CLASSES + 1..].iter().all(|count| (6..=7).contains(count)), "{members:?}");
        assert_eq!(labels.representative_of(12), 12, "there is no such label");
        assert!((0..200).all(|rank| set(200).representative_of(7 * rank - 70) == 7 * rank - 70));
    }
}
