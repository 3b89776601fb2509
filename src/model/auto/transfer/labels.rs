//! Label maps: every label has its colour, and all are equally opaque. The table says so, and a curve over values that
//! stands for it where the table is taken away.

use std::collections::BTreeSet;

use super::super::LEAST_SHOWN;
use crate::data::{ValueRange, Volume};
use crate::model::{
    ControlPoint, DensityRange, Easing, Interpolation, LUT_SIZE, LabelLook, LabelTable, MAX_POINTS, Mixing,
    Settings, TransferFunction, oklab_from_linear,
};

/// Labels are whole numbers: from halfway to the one below on, it is this one.
const HALF: f64 = 0.5;

/// Shows every label; 0 and what is below is no label.
pub(super) fn transfer(volume: &Volume) -> TransferFunction {
    let numbers = numbers(volume);
    let step = |value, color, opacity| ControlPoint {
        easing: Easing::Step,
        ..ControlPoint::new(value, color, opacity)
    };
    let lowest = numbers.first().map_or(1.0, |&number| number as f64);
    // Nothing below the first.
    let mut points = vec![step(lowest - 1.0, [1.0; 3], 0.0)];
    points.extend(numbers.iter().map(|&number| {
        let LabelLook { color, opacity, .. } = look(volume, number);
        step(number as f64 - HALF, color, opacity)
    }));
    TransferFunction { points, interpolation: Interpolation::Opacity, mixing: Mixing::Light }
}

/// The range in which labels are told apart as far as that can be. A table of a function has [`LUT_SIZE`] entries that are
/// evenly spread over the range, and what lies between two of them is a mixture.
pub(in crate::model::auto) fn range(volume: &Volume) -> DensityRange {
    let numbers = numbers(volume);
    let (Some(&first), Some(&last)) = (numbers.first(), numbers.last()) else { return DensityRange::Full };
    let steps = (LUT_SIZE - 1) as f64;
    // With two entries for each number or more, both of those beside it are its own.
    if 2.0 * volume.value_range().span() <= steps {
        return DensityRange::Full;
    }
    // Else the first entry is that of nothing, and the second lies on the lowest number: one on each number, if there are
    // enough. If not, numbers beside each other may share a colour, but the lowest do not fade into nothing, unless they
    // are so near zero, which is what is around.
    let step = ((last - first) as f64 / (steps - 1.0)).max(1.0);
    let nothing = (first as f64 - step).max(0.0);
    let span = steps * step;
    // Numbers beyond all that can be told apart have no range.
    ValueRange::spread(nothing, nothing + span).map_or(DensityRange::Full, DensityRange::Typed)
}

/// How far a colour may be from another in Oklab to be taken for it: half of what the most alike of the colours of labels
/// are apart.
const ALIKE: f64 = 0.0075;

/// A look for each label that stands for a class; empty where values are no labels.
pub(in crate::model::auto) fn table(volume: &Volume) -> LabelTable {
    let Some(labels) = volume.labels() else { return LabelTable::default() };
    let numbers = (0..labels.class_count()).map(|class| labels.first_of_class(class).number);
    numbers.map(|number| (number, look(volume, number))).collect()
}

/// The look of a label as the file has it, as far as it does.
fn look(volume: &Volume, number: i64) -> LabelLook {
    let own = LabelLook::of(number);
    let Some(label) = volume.hints().labels.get(number) else { return own };
    LabelLook { name: label.name.clone(), color: label.color.unwrap_or(own.color), ..own }
}

/// How many of the labels that there are settings do not show, or in a colour that is not the one that they give it. What
/// counts is the table that pictures are made with.
pub(in crate::model::auto) fn lost_labels(settings: &Settings, volume: &Volume) -> usize {
    let drawn = settings.as_drawn(volume);
    let volume = volume.showing(settings.shown(&volume.ranges()));
    let function = &drawn.transfer;
    let table = function.bake(volume.table_range(), 1.0, 1.0);
    // Of a label as a whole: a veil is not lost.
    let thickness = |number: i64| {
        let labels = volume.labels().map_or(&[][..], |labels| labels.labels());
        let own = labels.iter().find(|label| label.number == number);
        own.map_or(1.0, |label| (label.voxels as f64).cbrt())
    };
    let is_lost = |number: &i64| {
        let density = volume.density_of(*number as f64);
        // The classes of labels; values as they are, also beyond those that are shown.
        let place = volume.shown_labels().map_or(*number as f64, |labels| labels.classes().at(density));
        let [red, green, blue, depth] = table.sample(density);
        let opacity = 1.0 - (-depth * thickness(*number)).exp();
        let [found, own] = [[red, green, blue], function.at(place).0].map(oklab_from_linear);
        let apart = found.iter().zip(own).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt();
        opacity < LEAST_SHOWN || apart > ALIKE
    };
    numbers(&volume).iter().filter(|number| is_lost(number)).count()
}

/// The labels that there are, lowest first; as many as a function can have points.
fn numbers(volume: &Volume) -> Vec<i64> {
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
        if value >= HALF && is_number && found.len() < MAX_POINTS - 1 {
            found.insert(value.round() as i64);
        }
    }
    found.into_iter().collect()
}
