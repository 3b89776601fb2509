//! Label maps: every label has its colour, and all are equally opaque. The table says so, and a curve over values that
//! stands for it where the table is taken away.

use std::collections::BTreeSet;

use crate::data::Volume;
use crate::model::{
    ControlPoint, Easing, Interpolation, LabelLook, LabelTable, MAX_POINTS, Mixing, Settings,
    TransferFunction,
};

/// Opacity below which a label counts as lost.
const LEAST_OPACITY: f64 = 0.05;

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

/// How many of the labels that there are settings do not show.
pub(in crate::model::auto) fn lost_labels(settings: &Settings, volume: &Volume) -> usize {
    let drawn = settings.as_drawn(volume);
    let volume = volume.showing(settings.shown(&volume.ranges()));
    let opacity = |number: i64| {
        let density = volume.density_of(number as f64);
        // The classes of labels; values as they are, also beyond those that are shown.
        let place = volume.shown_labels().map_or(number as f64, |labels| labels.classes().at(density));
        drawn.transfer.opacity_at(place)
    };
    numbers(&volume).into_iter().filter(|&number| opacity(number) < LEAST_OPACITY).count()
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
