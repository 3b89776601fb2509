//! Transfer functions for signed fields, deviations from zero: strong values of both signs are shown, and zero is
//! not.

use super::super::domain::{DataDomain, roughness};
use super::super::palette::DomainPalette;
use super::box_filling::{fills_box, is_coherent};
use super::masked_field::masked_voxel_count;
use super::{
    FirstTransfer, PaletteStop, TransferStyle, quantile, sample_values, transfer_from_points,
    transfer_through_stops,
};
use crate::ControlPoint;
use chiaroscuro_volume::Volume;

/// Share of the total energy (sum of squares) in the values that are shown: as much of the field is shown as hidden.
const ENERGY_SHARE: f64 = 0.5;

/// Threshold of strong values in standard deviations of noise. The deviation is estimated from the median of the
/// magnitudes, which strong values hardly change: for normal noise it is 1.4826 medians (1 / Φ⁻¹(3/4)), and 1.2 % of
/// the values are beyond 2.5 deviations.
const NOISE_DEVIATIONS: f64 = 2.5;
const DEVIATION_PER_MEDIAN: f64 = 1.4826;

/// Largest roughness of a field without noise: layers of rock have 0.05, statistical maps 0.44 and more; well apart
/// from both.
const MAX_NOISELESS_ROUGHNESS: f64 = 0.2;

/// Smallest share of values to show, however strong noise is: three times the share of normal noise beyond the
/// threshold.
const MIN_STRONG_SHARE: f64 = 0.04;

/// Smallest share of values to show of a field that fills its box, such as layers of rock, which are as rough across
/// as noise: they are strong everywhere, and a twentieth of them is crumbs.
const MIN_SHARE_OF_FULL: f64 = 0.1;

/// Smallest ratio of the bulk of strong values to their threshold, and of their peaks to the bulk: limits the
/// steepness of opacity, so that surfaces do not end as abruptly as voxels.
const MIN_STEP_RATIO: f64 = 1.15;

/// Transmittance of the known part of a field, as thick as a cube of its voxels: strong values on its far side are
/// visible through it in their own colours, and so is its outline. With 0.55 it is grey smoke.
const VEIL_TRANSMITTANCE: f64 = 0.72;

/// White of the glass, whose haze is then bright.
const GLASS_COLOR: [f32; 3] = [0.93; 3];

/// Returns the known part of a masked field as a veil: all values from just above zero to the threshold.
fn known_part_veil(volume: &Volume, threshold: f64) -> Option<[ControlPoint; 6]> {
    let thickness = (masked_voxel_count(volume)? as f64).cbrt();
    let opacity = 1.0 - VEIL_TRANSMITTANCE.powf(1.0 / thickness.max(1.0));
    let point = |share: f64, opacity: f64| ControlPoint::new(share * threshold, GLASS_COLOR, opacity);
    // As close to zero and to the threshold as tables can resolve.
    Some([
        point(-0.98, opacity),
        point(-0.04, opacity),
        point(-0.02, 0.0),
        point(0.02, 0.0),
        point(0.04, opacity),
        point(0.98, opacity),
    ])
}

/// Builds a function that shows both signs; `None` if all values are zero. The known part of a masked field is shown
/// as glass, to locate the strong values.
pub(super) fn find_signed(volume: &Volume) -> Option<FirstTransfer> {
    // One outlier can have more energy than all other values.
    let matters = volume.ranges().robust;
    let magnitudes =
        sample_values(volume, |value| (value != 0.0 && matters.contains(value)).then_some(value.abs()));
    // In a field without noise, all values are signal.
    let has_noise = roughness(volume) > MAX_NOISELESS_ROUGHNESS;
    let threshold = strong_threshold(&magnitudes, has_noise);
    let most = quantile(&magnitudes, 1.0 - MIN_SHARE_OF_FULL);
    let is_full = fills_box(volume, 0.0) && is_coherent(volume, most);
    let threshold = if is_full { threshold.min(most) } else { threshold };
    if threshold <= 0.0 {
        return None;
    }
    let strong = &magnitudes[magnitudes.partition_point(|&value| value < threshold)..];
    // As for other objects: the bulk of strong values, and their peaks.
    let bulk = quantile(strong, 0.6).max(threshold * MIN_STEP_RATIO);
    let peak = quantile(strong, 0.97).max(bulk * MIN_STEP_RATIO);
    let mut points = Vec::new();
    for is_negative in [true, false] {
        let sign = if is_negative { -1.0 } else { 1.0 };
        let stops = [
            (threshold, 0.0, 0.0),
            (threshold + 0.35 * (bulk - threshold), 0.35, 0.4),
            (bulk, 0.65, 0.75),
            (peak, 1.0, 0.94),
        ];
        let side =
            stops.map(|(magnitude, place, opacity)| PaletteStop { value: sign * magnitude, place, opacity });
        points.extend(transfer_through_stops(side, DomainPalette::diverging(is_negative)).points);
    }
    // There is nothing around a field that fills its box.
    let glass = if is_full { None } else { known_part_veil(volume, threshold) };
    points.extend(glass.into_iter().flatten());
    Some(FirstTransfer {
        style: if glass.is_some() { TransferStyle::Veiled } else { TransferStyle::Object },
        ..FirstTransfer::from_values(transfer_from_points(points), DataDomain::Simulation)
    })
}

/// Returns the magnitude above which values are strong, from sorted magnitudes.
fn strong_threshold(magnitudes: &[f64], has_noise: bool) -> f64 {
    let total: f64 = magnitudes.iter().map(|value| value * value).sum();
    // From the largest down, until half of the energy is reached.
    let mut sum = 0.0;
    let of_energy = magnitudes.iter().rev().find(|&value| {
        sum += value * value;
        sum >= ENERGY_SHARE * total
    });
    let of_energy = of_energy.copied().unwrap_or(0.0);
    if !has_noise {
        return of_energy;
    }
    let of_noise = NOISE_DEVIATIONS * DEVIATION_PER_MEDIAN * quantile(magnitudes, 0.5);
    of_energy.max(of_noise).min(quantile(magnitudes, 1.0 - MIN_STRONG_SHARE))
}
