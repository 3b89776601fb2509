//! Label maps with a table of looks, against the reference.

use chiaroscuro_reference::ReferenceFault;
use chiaroscuro_scene::{ClassificationOrder, LabelLook, LabelTable, Settings};
use chiaroscuro_volume::{Samples, Volume};
use glam::DVec3;

use super::mutations::differs_in_volume;
use super::{SIZE, check_volume, round_to_f16};
use crate::common::{Dataset, new_renderer, render};
use crate::compare::{channels_f32, compare};
use crate::scenes;
use crate::thresholds::SAME_WEIGHTS;

/// Values of the creature at which the labels change.
const LABEL_THRESHOLDS: [u8; 4] = [20, 80, 150, 200];

/// Label map of the creature: the label is chosen by the number of steps below a voxel's value.
fn label_map(numbers: [u8; 5]) -> Volume {
    let n = 32;
    let creature = scenes::creature(n, DVec3::ONE);
    let voxels = (0..n * n * n).map(|voxel| {
        let value = creature.samples().value(voxel);
        numbers[LABEL_THRESHOLDS.iter().filter(|&&step| value >= f64::from(step)).count()]
    });
    Volume::with_spacing("labels", [n; 3], DVec3::ONE, Samples::U8(voxels.collect())).expect("a volume")
}

/// Look that hides one of the labels, and in which one is transparent.
fn look(numbers: [u8; 5]) -> Settings {
    let mut labels = LabelTable::default();
    for (at, number) in numbers.into_iter().enumerate() {
        let color = [0.2 + 0.2 * at as f32, 0.9 - 0.15 * at as f32, [0.1, 0.8][at % 2]];
        let opacity = [0.0, 0.3, 0.8, 0.9, 0.7][at];
        let visible = at != 2;
        *labels.entry_mut(number.into()) =
            LabelLook { color, opacity, visible, ..LabelLook::default_for(number.into()) };
    }
    scenes::look().with_labels(labels)
}

#[test]
fn labels_are_classified_by_their_table_before_they_are_spread() {
    let numbers = [0, 3, 9, 40, 250];
    let settings = look(numbers);
    assert_eq!(settings.sampling.classification, ClassificationOrder::Post, "whatever it says");
    check_volume("labels", label_map(numbers), &settings, Some(round_to_f16));
}

#[test]
fn crisp_labels_have_a_wider_blur_and_steep_edges() {
    let numbers = [0, 3, 9, 40, 250];
    let mut settings = look(numbers);
    settings.sampling.classification = ClassificationOrder::PreCrisp;
    check_volume("crisp labels", label_map(numbers), &settings, Some(round_to_f16));
}

#[test]
fn mistakes_at_crisp_edges_are_noticed() {
    let numbers = [0, 3, 9, 40, 250];
    let mut settings = look(numbers);
    settings.sampling.classification = ClassificationOrder::PreCrisp;
    let differs = |from, to| differs_in_volume(label_map(numbers), &settings, from, to, ReferenceFault::None);
    let choice = "select(sum, wide, wide.r > sum.r)";
    assert!(!differs(choice, "select(sum, wide, wide.r >= sum.r)"), "alike where both are");
    assert!(differs(choice, "wide"));
    assert!(differs("vec3f(0.25), vec3f(0.5)", "vec3f(0.24), vec3f(0.52)"));
}

/// Label numbers change no bit unless their order changes, which the table's look-ups round differently.
#[test]
fn numbers_of_labels_change_no_pixel() {
    let mut renderer = new_renderer();
    let mut picture = |numbers: [u8; 5]| {
        render(&mut renderer, &Dataset::new(label_map(numbers)), &look(numbers), SIZE).linear
    };
    let before = picture([0, 3, 9, 40, 250]);
    assert!(before == picture([1, 2, 100, 101, 102]));
    let turned = picture([250, 40, 9, 3, 1]);
    compare("turned around", &channels_f32(&turned), &channels_f32(&before), SAME_WEIGHTS)
        .unwrap_or_else(|err| panic!("{err}"));
    let mut other = look([0, 3, 9, 40, 250]);
    other.layer_mut().labels.entry_mut(9).visible = true;
    let shown = render(&mut renderer, &Dataset::new(label_map([0, 3, 9, 40, 250])), &other, SIZE).linear;
    assert!(before != shown, "the hidden one is there");
}
