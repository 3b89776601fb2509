//! Label maps: every label has its colour, and all are equally opaque.

use std::collections::BTreeSet;

use super::super::palette::category;
use crate::data::Volume;
use crate::model::{ControlPoint, Easing, Interpolation, MAX_POINTS, Mixing, TransferFunction};

/// Opacity of all labels: one hides what is behind it within a voxel or two.
const OPACITY: f64 = 0.9;

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
        let said = volume.hints().labels.get(number).and_then(|label| label.color);
        step(number as f64 - HALF, said.unwrap_or_else(|| category(number)), OPACITY)
    }));
    TransferFunction { points, interpolation: Interpolation::Opacity, mixing: Mixing::Light }
}

/// How many of the labels that there are a function does not show.
pub(in crate::model::auto) fn lost_labels(function: &TransferFunction, volume: &Volume) -> usize {
    numbers(volume).into_iter().filter(|&number| function.opacity_at(number as f64) < LEAST_OPACITY).count()
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
