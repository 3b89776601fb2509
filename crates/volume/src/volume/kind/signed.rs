//! Detection of signed fields: deviations from zero, to both sides of it.

use super::dark_on_bright::MAX_OBJECT_SHARE;
use super::sampled::{SampledValues, quantile};
use super::{DataKind, DetectedKind};
use crate::ValueRange;

/// Detects signed fields: they reach about as far below zero as above, in lobes rather than single voxels.
pub(super) fn detect_signed(sampled: &SampledValues<'_>) -> Option<DetectedKind> {
    let ValueRange { low: below, high: above } = sampled.nonzero_quantiles(SIGNED_OUTLIER_SHARE)?;
    let balance = below.abs().min(above) / below.abs().max(above);
    if below >= 0.0 || above <= 0.0 || balance < MIN_SIGNED_BALANCE {
        return None;
    }
    if !deviates_from_zero(sampled, below, above) {
        return None;
    }
    // The background of a signed field is zero: faces far below it are the dark margin of a scan.
    let is_all_strong = |face: &Vec<f64>| {
        quantile(face, 1.0 - MAX_OBJECT_SHARE) <= below / 2.0
            || quantile(face, MAX_OBJECT_SHARE) >= above / 2.0
    };
    if sampled.faces().iter().filter(|face| is_all_strong(face)).count() >= MAX_STRONG_FACES {
        return None;
    }
    let coherence = sampled.coherence_beyond(below / 2.0).min(sampled.coherence_beyond(above / 2.0));
    (coherence >= MIN_LOBE_COHERENCE).then(|| {
        let why = format!(
            "values reach from {below:.3} to {above:.3} in lobes on both sides of zero: {:.0} % of strong values have \
             similar neighbours",
            100.0 * coherence
        );
        DetectedKind::new(DataKind::Signed, why)
    })
}

/// Share of the nonzero values at either end that count as outliers: fewer form no visible lobe.
const SIGNED_OUTLIER_SHARE: f64 = 0.002;

/// Minimum ratio of the weaker side of a signed field to the stronger. Six of six signed fields have 0.49 and more,
/// noise below zero beside a signal above it rarely 0.3: a threshold well apart from both.
const MIN_SIGNED_BALANCE: f64 = 0.35;

/// Number of faces with only strong values at which a field is not signed; fewer may cut an object.
const MAX_STRONG_FACES: usize = 5;

/// Minimum share of neighbours of strong values that are at least half as strong. In lobes it is 0.9 and more; in
/// white noise 0.1.
const MIN_LOBE_COHERENCE: f64 = 0.5;

/// Number of bins between the ends of the values in which their modes are sought: each is 4 % of the range, so that
/// values within 2 % of it around zero share the middle bin.
const MODE_BINS: usize = 25;

/// Depth of the valley between two modes, relative to the lower one, below which they are apart; and the share of the
/// values' density at the higher one that the lower one must reach: less is a tail.
const MAX_VALLEY_SHARE: f64 = 0.5;
const MIN_MODE_SHARE: f64 = 0.2;

/// Largest distance between one of two modes and the other's mirror image at which the field is the same on both
/// sides of zero (two phases, a wave), as a share of the range: two bins.
const MAX_MODE_ASYMMETRY: f64 = 0.08;

/// Returns true if values deviate from zero: it is the most common of them, or within their only mode, or between two
/// modes that are equally far from it. Two materials on either side of zero by chance, such as air and tissue in
/// Hounsfield units, are not.
fn deviates_from_zero(sampled: &SampledValues<'_>, below: f64, above: f64) -> bool {
    // A bin is centred on zero.
    let width = (above - below) / MODE_BINS as f64;
    let (first, last) = ((below / width).floor() as i64, (above / width).ceil() as i64);
    let share = |bin: i64| {
        let middle = bin as f64 * width;
        sampled.share_in_range(middle - width / 2.0, middle + width / 2.0)
    };
    let shares: Vec<f64> = (first..=last).map(share).collect();
    let zero = (-first) as usize;
    let highest = |part: &[f64]| (0..part.len()).max_by(|&a, &b| part[a].total_cmp(&part[b])).unwrap_or(0);
    let mode = highest(&shares);
    if mode == zero {
        return true;
    }
    // Highest mode that a valley separates from the first.
    let other = (0..shares.len())
        .filter(|&bin| {
            let [low, high] = [bin.min(mode), bin.max(mode)];
            let valley = shares[low..=high].iter().copied().fold(f64::INFINITY, f64::min);
            shares[bin] >= MIN_MODE_SHARE * shares[mode] && valley < MAX_VALLEY_SHARE * shares[bin]
        })
        .max_by(|&a, &b| shares[a].total_cmp(&shares[b]));
    match other {
        Some(other) => {
            let sum = (mode + other) as f64 - 2.0 * zero as f64;
            other == zero || sum.abs() <= MAX_MODE_ASYMMETRY * MODE_BINS as f64
        }
        // Within the mode, not in its tail.
        None => shares[zero] >= MAX_VALLEY_SHARE * shares[mode],
    }
}

#[cfg(test)]
mod tests {
    use super::super::KindName;
    use super::super::tests::{bell, bump, kind, values};
    use glam::DVec3;

    #[test]
    fn two_materials_on_either_side_of_zero_are_no_deviations() {
        // Two materials at −0.85 and 0.4: as in a scan in arbitrary units.
        let two = values(|p, at| if p.length() < 0.8 { 0.4 } else { -0.85 } + 0.03 * bell(at, 1));
        assert_ne!(kind(&two), KindName::Signed);
        // Temperatures, of which most are far from freezing.
        let warm = values(|p, at| 18.0 - 30.0 * bump(p, DVec3::X * 0.5, 0.3) + bell(at, 2));
        assert_ne!(kind(&warm), KindName::Signed);
    }

    #[test]
    fn waves_phases_and_shifted_noise_deviate_from_zero() {
        // A wave is most often at its crests; two phases are hardly ever at zero.
        let wave = values(|p, _| (9.0 * p.x + 3.0 * p.y).sin());
        let phases =
            values(|p, _| (6.0 * ((5.0 * p.x).sin() + (4.0 * p.y).cos() + (6.0 * p.z).sin())).tanh());
        // Lobes about a mean that is hardly zero.
        let shifted = values(|p, _| 0.03 + (4.0 * p.x).sin() * (3.0 * p.y).cos() * (5.0 * p.z).sin());
        for (index, field) in [wave, phases, shifted].iter().enumerate() {
            assert_eq!(kind(field), KindName::Signed, "{index}");
        }
    }
}
