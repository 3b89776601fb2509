//! Transfer functions and label tables of label maps: every label has its colour, and all are equally opaque. The
//! function over values is used if the table is removed.

use std::collections::BTreeSet;

use super::super::MIN_VISIBLE_OPACITY;
use super::label_visibility::decide_visibility;
use crate::{
    ColorMixing, ControlPoint, DensityRange, Easing, LUT_SIZE, LabelLook, LabelTable, MAX_POINTS,
    OpacityInterpolation, Settings, TransferFunction, oklab_from_linear,
};
use chiaroscuro_volume::{ValueRange, Volume};

/// Half the distance between labels, which are integers: a label's interval begins halfway to the one below.
const HALF_LABEL: f64 = 0.5;

/// Returns a step function that shows every label; 0 and below are background.
pub(super) fn label_transfer(volume: &Volume) -> TransferFunction {
    let numbers = label_numbers(volume);
    let step = |value, color, opacity| ControlPoint {
        easing: Easing::Step,
        ..ControlPoint::new(value, color, opacity)
    };
    let lowest = numbers.first().map_or(1.0, |&number| number as f64);
    // Opacity is 0 below the first label.
    let mut points = vec![step(lowest - 1.0, [1.0; 3], 0.0)];
    points.extend(numbers.iter().map(|&number| {
        let LabelLook { color, opacity, .. } = label_look(volume, number);
        step(number as f64 - HALF_LABEL, color, opacity)
    }));
    TransferFunction { points, interpolation: OpacityInterpolation::Opacity, mixing: ColorMixing::Light }
}

/// Returns the range in which labels are distinguished best. A baked table has [`LUT_SIZE`] entries evenly spaced
/// over the range, and values between two entries are mixtures.
pub(crate) fn label_range(volume: &Volume) -> DensityRange {
    let numbers = label_numbers(volume);
    let (Some(&first), Some(&last)) = (numbers.first(), numbers.last()) else { return DensityRange::Full };
    let steps = (LUT_SIZE - 1) as f64;
    // With two or more entries per number, both entries next to it have its own colour.
    if 2.0 * volume.value_range().span() <= steps {
        return DensityRange::Full;
    }
    // Otherwise the first entry is background, and the second lies on the lowest number: one entry per number, if
    // there are enough. If not, neighbouring numbers may share a colour, but the lowest do not fade into the
    // background, unless they are as close to zero, which is background.
    let step = ((last - first) as f64 / (steps - 1.0)).max(1.0);
    let nothing = (first as f64 - step).max(0.0);
    let span = steps * step;
    // Numbers too large to be distinguished have no range.
    ValueRange::non_degenerate(nothing, nothing + span).map_or(DensityRange::Full, DensityRange::Typed)
}

/// Distance of two colours in Oklab below which they count as the same: half of the smallest distance between label
/// colours.
const SAME_COLOR_DISTANCE: f64 = 0.0075;

/// Returns a table with a look for each class's label; empty if values are not labels.
pub(crate) fn label_table(volume: &Volume) -> LabelTable {
    let Some(labels) = volume.labels() else { return LabelTable::default() };
    let numbers = (0..labels.class_count()).map(|class| labels.representative_of_class(class).number);
    let mut table = numbers.map(|number| (number, label_look(volume, number))).collect();
    decide_visibility(&mut table, volume);
    table
}

/// Returns the look of a label, with name and colour from the file if it has them.
fn label_look(volume: &Volume, number: i64) -> LabelLook {
    let own = LabelLook::default_for(number);
    let Some(label) = volume.metadata().labels.get(number) else { return own };
    LabelLook { name: label.name.clone(), color: label.color.unwrap_or(own.color), ..own }
}

/// Returns the number of labels that are invisible with the settings, or not in their own colour, judged by the baked
/// table that images use.
pub(crate) fn count_lost_labels(settings: &Settings, volume: &Volume) -> usize {
    let drawn = settings.resolved_for(volume);
    let volume = volume.with_density_mapping(settings.shown_content(&volume.ranges()));
    let function = &drawn.layer().transfer;
    let table = function.bake(volume.table_range(), 1.0, 1.0);
    // Accumulated over the whole label, because a veil is not lost.
    let thickness = |number: i64| {
        let labels = volume.labels().map_or(&[][..], |labels| labels.labels());
        let own = labels.iter().find(|label| label.number == number);
        own.map_or(1.0, |label| (label.voxels as f64).cbrt())
    };
    let is_lost = |number: &i64| {
        let density = volume.density_of(*number as f64);
        // Position in label classes, or else the value itself, also beyond the shown range.
        let place =
            volume.shown_labels().map_or(*number as f64, |labels| labels.class_range().value_at(density));
        let [red, green, blue, depth] = table.sample(density);
        let opacity = 1.0 - (-depth * thickness(*number)).exp();
        let [found, own] = [[red, green, blue], function.sample(place).color].map(oklab_from_linear);
        let apart = found.iter().zip(own).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt();
        opacity < MIN_VISIBLE_OPACITY || apart > SAME_COLOR_DISTANCE
    };
    label_numbers(&volume).iter().filter(|number| is_lost(number)).count()
}

/// Returns the labels that occur, in ascending order; at most as many as a function can have points.
fn label_numbers(volume: &Volume) -> Vec<i64> {
    let samples = volume.samples();
    let mut found = BTreeSet::new();
    let mut last = f64::NAN;
    for voxel in 0..samples.len() {
        let value = samples.value(voxel);
        if value == last {
            continue;
        }
        last = value;
        let is_number = value.is_finite() && Some(value) != volume.padding_value();
        if value >= HALF_LABEL && is_number && found.len() < MAX_POINTS - 1 {
            found.insert(value.round() as i64);
        }
    }
    found.into_iter().collect()
}
