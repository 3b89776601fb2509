//! Visibility of labels in first looks: whether 0 is a label like others, and which of many that fill their box.

use std::collections::BTreeMap;

use crate::LabelTable;
use chiaroscuro_volume::{CountedLabel, LabelSet, Volume};

/// Number of the volume's faces from which 0 surrounds the labels: a grain in a corner touches three.
const MIN_FACES_OF_BACKGROUND: u32 = 4;

/// Ratio of the voxels of 0 to those of the median label above which 0 is the background, wherever it lies: as much
/// as the largest of twenty equal seeds' cells has.
const MAX_RATIO_OF_LABEL: u64 = 3;

/// Smallest number of other labels among which 0 can be one like others; beside one or two it is their background.
const MIN_OTHER_LABELS: usize = 3;

/// Share of empty voxels below which labels fill their box, so that nothing inside can be seen.
const MIN_EMPTY_SHARE: f64 = 0.05;

/// Labels that are shown of many that fill their box: their largest number, the number of faces that each may touch
/// (more than two are cut off all around), and their smallest share of the volume.
const MAX_SHOWN: usize = 12;
const MAX_FACES_OF_SHOWN: u32 = 2;
const MIN_SHARE_OF_SHOWN: f64 = 0.0005;

/// Shows label 0 where it is no background, and of many labels that fill their box only the largest inside.
///
/// Many are more than there are classes: their colours repeat, and a box painted with them says nothing.
pub(crate) fn decide_visibility(table: &mut LabelTable, volume: &Volume) {
    let Some(labels) = volume.labels() else { return };
    let touched = touched_faces(volume);
    let faces = |number: i64| touched.get(&number).map_or(0, |faces| faces.count_ones());
    let has_background = is_background(labels, faces(0));
    if !has_background && labels.labels().iter().any(|label| label.number == 0) {
        table.entry_mut(0).visible = true;
    }
    let filled: u64 =
        labels.labels().iter().filter(|label| label.number != 0 || !has_background).map(|l| l.voxels).sum();
    let all = volume.voxel_count() as f64;
    if labels.has_own_classes() || all - filled as f64 >= MIN_EMPTY_SHARE * all {
        return;
    }
    let mut largest: Vec<CountedLabel> = labels.labels().to_vec();
    largest.sort_by_key(|label| std::cmp::Reverse(label.voxels));
    let is_inside = |label: &CountedLabel| {
        let is_label = label.number != 0 || !has_background;
        is_label
            && labels.has_own_class(label.number)
            && faces(label.number) <= MAX_FACES_OF_SHOWN
            && label.voxels as f64 >= MIN_SHARE_OF_SHOWN * all
    };
    let shown: Vec<i64> =
        largest.iter().filter(|label| is_inside(label)).take(MAX_SHOWN).map(|label| label.number).collect();
    if !shown.is_empty() {
        table.modify_all(|number, look| look.visible &= shown.contains(&number));
    }
}

/// Returns a table, and says how many labels it hides, if any.
pub(super) fn with_report(table: LabelTable, volume: &Volume) -> LabelTable {
    let hidden = table.iter().filter(|(number, look)| *number != 0 && !look.visible).count();
    if hidden > 0 {
        log::warn!(
            "{}: its {} labels fill the box, and hide each other: only the {} largest inside are shown",
            volume.name(),
            volume.labels().map_or(0, LabelSet::count_integers),
            table.iter().filter(|(_, look)| look.visible).count()
        );
    }
    table
}

/// Returns true if 0 is the background of labels, whose median it exceeds by far or which it surrounds.
fn is_background(labels: &LabelSet, faces: u32) -> bool {
    let own = labels.labels().iter().find(|label| label.number == 0).map_or(0, |label| label.voxels);
    let mut others: Vec<u64> =
        labels.labels().iter().filter(|label| label.number != 0).map(|label| label.voxels).collect();
    others.sort_unstable();
    let median = others.get(others.len() / 2).copied().unwrap_or(0);
    faces >= MIN_FACES_OF_BACKGROUND || own > MAX_RATIO_OF_LABEL * median || others.len() < MIN_OTHER_LABELS
}

/// Returns for each label the faces of the volume that it touches, as bits.
fn touched_faces(volume: &Volume) -> BTreeMap<i64, u8> {
    let mut touched: BTreeMap<i64, u8> = BTreeMap::new();
    for face in 0..6 {
        for voxel in volume.face_voxels(face, usize::MAX) {
            if volume.missing().is_none_or(|missing| !missing.contains(voxel)) {
                *touched.entry(volume.samples().value(voxel) as i64).or_default() |= 1 << face;
            }
        }
    }
    touched
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::super::label_table;
    use super::*;
    use chiaroscuro_volume::Samples;

    const N: usize = 32;

    /// Returns the cells of `count` pseudo-random seeds, numbered from 0, within a part of the volume; `outside` it.
    fn cells(count: u64, is_inside: impl Fn(DVec3) -> bool, first: i32, outside: i32) -> Volume {
        let part = |seed: u64, axis: u64| {
            let mut state = (seed * 3 + axis + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
            state = (state ^ (state >> 31)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
            (state >> 11) as f64 / (1u64 << 53) as f64 * N as f64
        };
        let seeds: Vec<DVec3> =
            (0..count).map(|seed| DVec3::new(part(seed, 0), part(seed, 1), part(seed, 2))).collect();
        let label = |at: usize| {
            let place = DVec3::from([at % N, at / N % N, at / N / N].map(|c| c as f64 + 0.5));
            let apart = |seed: &usize| seeds[*seed].distance_squared(place);
            let nearest = (0..seeds.len()).min_by(|a, b| apart(a).total_cmp(&apart(b))).unwrap_or(0);
            if is_inside(place) { first + nearest as i32 } else { outside }
        };
        Volume::with_spacing("t", [N; 3], DVec3::ONE, Samples::I32((0..N * N * N).map(label).collect()))
            .unwrap()
    }

    fn shown(volume: &Volume) -> Vec<i64> {
        label_table(volume).iter().filter(|(_, look)| look.visible).map(|(number, _)| number).collect()
    }

    #[test]
    fn zero_is_a_grain_where_grains_fill_the_box() {
        let grains = cells(20, |_| true, 0, 0);
        assert!(shown(&grains).contains(&0), "a hole in the box");
        assert_eq!(shown(&grains).len(), grains.labels().unwrap().count_integers());
        // Numbered from 1, there is no 0.
        assert!(!shown(&cells(20, |_| true, 1, 0)).contains(&0));
    }

    #[test]
    fn zero_around_labels_or_between_them_is_nothing() {
        let middle = DVec3::splat(N as f64 / 2.0);
        let ball = cells(20, |place| place.distance(middle) < 14.0, 1, 0);
        assert!(!shown(&ball).contains(&0), "it surrounds a ball");
        // A cavity in the middle, which touches no face but is larger than the labels.
        let cavity = cells(20, |place| place.distance(middle) > 13.0, 1, 0);
        assert!(!shown(&cavity).contains(&0));
        // A floor of two layers below labels, on five faces.
        let below = cells(20, |place| place.z > 2.0, 1, 0);
        assert!(!shown(&below).contains(&0));
    }

    #[test]
    fn of_many_labels_that_fill_their_box_the_largest_inside_are_shown() {
        let many = cells(400, |_| true, 1, 0);
        let seen = shown(&many);
        assert!((6..=MAX_SHOWN).contains(&seen.len()), "{seen:?}");
        // Fewer labels, and as many in a ball, are all shown.
        let few = cells(60, |_| true, 1, 0);
        assert_eq!(shown(&few).len(), few.labels().unwrap().count_integers());
        let middle = DVec3::splat(N as f64 / 2.0);
        let ball = cells(700, |place| place.distance(middle) < 15.0, 1, 0);
        assert!(!ball.labels().unwrap().has_own_classes() && shown(&ball).len() > 200);
    }
}
