//! Deviations to both sides of zero: both are shown where they are strong, and zero is not.

use super::super::domain::{Domain, roughness};
use super::super::palette::Palette;
use super::known_part::known_part;
use super::{Found, Stop, of_points, quantile, some_values, through};
use crate::data::Volume;
use crate::model::ControlPoint;

/// Share of all energy (squares) that strong values have: what is shown is as much of the field as what is not.
const ENERGY: f64 = 0.5;

/// Strong values are beyond so many deviations of noise, of which the median of the magnitudes is a measure that
/// strong values hardly change: 1.4826 medians are a deviation of normal noise (1 / Φ⁻¹(3/4)), of which 1.2 % are beyond
/// 2.5 deviations.
const DEVIATIONS: f64 = 2.5;
const DEVIATION_PER_MEDIAN: f64 = 1.4826;

/// Roughness up to which a field has no noise: layers of rock have 0.05, statistical maps 0.44 and more; well apart
/// from both.
const SMOOTH: f64 = 0.2;

/// Share of the values that is shown at least, however strong noise is: three times what is left of normal noise.
const LEAST_STRONG: f64 = 0.04;

/// How far the bulk of what is strong is above where that begins at least, and its peaks above the bulk: as steep as
/// opacities are at most, lest surfaces end as abruptly as voxels do.
const STEEPEST: f64 = 1.15;

/// Light that is left behind the part in which a field is known, as thick as a cube of its voxels: what is strong on its
/// far side is still seen, and so is where it ends.
const LEFT_BEHIND: f64 = 0.55;

/// Grey glass, as light as the palest colours of the field.
const GLASS: [f32; 3] = [0.8; 3];

/// The part in which the field is known, as a veil: everything but exactly zero, up to where it is strong.
fn glass(volume: &Volume, threshold: f64) -> Option<[ControlPoint; 6]> {
    let thickness = (known_part(volume)? as f64).cbrt();
    let opacity = 1.0 - LEFT_BEHIND.powf(1.0 / thickness.max(1.0));
    let point = |share: f64, opacity: f64| ControlPoint::new(share * threshold, GLASS, opacity);
    // As close to zero and to what is strong as tables can tell.
    Some([
        point(-0.98, opacity),
        point(-0.04, opacity),
        point(-0.02, 0.0),
        point(0.02, 0.0),
        point(0.04, opacity),
        point(0.98, opacity),
    ])
}

/// Shows both sides; nothing where all values are zero. Fields that are known in a part of their box only show that as
/// glass: what is strong lies somewhere.
pub(super) fn find(volume: &Volume) -> Option<Found> {
    // The energy of one outlier can be more than that of all others.
    let matters = volume.ranges().robust;
    let magnitudes =
        some_values(volume, |value| (value != 0.0 && matters.contains(value)).then_some(value.abs()));
    // Fields without noise have none to hide.
    let has_noise = roughness(volume) > SMOOTH;
    let threshold = threshold(&magnitudes, has_noise);
    if threshold <= 0.0 {
        return None;
    }
    let strong = &magnitudes[magnitudes.partition_point(|&value| value < threshold)..];
    // As of other objects: the bulk of what is strong, and its peaks.
    let bulk = quantile(strong, 0.6).max(threshold * STEEPEST);
    let peak = quantile(strong, 0.97).max(bulk * STEEPEST);
    let mut points = Vec::new();
    for is_negative in [true, false] {
        let sign = if is_negative { -1.0 } else { 1.0 };
        let stops = [
            (threshold, 0.0, 0.0),
            (threshold + 0.35 * (bulk - threshold), 0.35, 0.4),
            (bulk, 0.65, 0.75),
            (peak, 1.0, 0.94),
        ];
        let side = stops.map(|(magnitude, place, opacity)| Stop { value: sign * magnitude, place, opacity });
        points.extend(through(side, Palette::diverging(is_negative)).points);
    }
    let glass = glass(volume, threshold);
    points.extend(glass.into_iter().flatten());
    Some(Found { has_veil: glass.is_some(), ..Found::of_values(of_points(points), Domain::Simulation) })
}

/// The magnitude from which values are strong, of magnitudes in order.
fn threshold(magnitudes: &[f64], has_noise: bool) -> f64 {
    let total: f64 = magnitudes.iter().map(|value| value * value).sum();
    // From the strongest down until half of the energy is there.
    let mut sum = 0.0;
    let of_energy = magnitudes.iter().rev().find(|&value| {
        sum += value * value;
        sum >= ENERGY * total
    });
    let of_energy = of_energy.copied().unwrap_or(0.0);
    if !has_noise {
        return of_energy;
    }
    let of_noise = DEVIATIONS * DEVIATION_PER_MEDIAN * quantile(magnitudes, 0.5);
    of_energy.max(of_noise).min(quantile(magnitudes, 1.0 - LEAST_STRONG))
}
