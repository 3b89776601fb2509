//! Detection of CT scans by Hounsfield units: peaks at air or lung and at soft tissue, and little between them.

use super::sampled::SampledValues;
use super::{DataKind, DetectedKind};
use crate::volume::Volume;
use crate::{Modality, ValueRange};

/// Returns the value of water if values are Hounsfield units: scanners without negative numbers add 1024.
pub(super) fn water_value(volume: &Volume) -> f64 {
    if volume.value_range().low < MIN_SOFT_TISSUE_HU { 0.0 } else { 1024.0 }
}

/// Hounsfield units below which the only tissue is lung. Scans that show air reach far below; those with an offset of
/// 1024 go below zero only by noise.
const MIN_SOFT_TISSUE_HU: f64 = -200.0;

/// Hounsfield units of air around the body, with its noise.
const AIR_HU: [f64; 2] = [-1050.0, -950.0];

/// Hounsfield units of air within lungs: inflated lung has −950 to −650, and air in the windpipe the rest.
const LUNG_HU: [f64; 2] = [-1050.0, -650.0];

/// Range of the lowest value of a scan of lungs: air is −1000, and its noise ends within 200 below it.
const LOWEST_HU: ValueRange = ValueRange { low: -1200.0, high: -900.0 };

/// Share of the voxels that may lie below [`LOWEST_HU`]: streaks beside metal.
const STREAK_SHARE: f64 = 0.001;

/// Detects CT scans: Hounsfield units have peaks at air and at soft tissue, and little between them, i.e. lungs and
/// partial volumes at surfaces. In scans cropped to the chest, lungs stand for the air.
pub(super) fn detect_hounsfield(volume: &Volume, sampled: &SampledValues<'_>) -> Option<DetectedKind> {
    let water = water_value(volume);
    // Without negative numbers, MR scans whose tissue is at a thousand have the same peaks.
    let is_ct = volume.metadata().modality == Modality::Ct;
    if water > 0.0 && !is_ct {
        return None;
    }
    let share = |low: f64, high: f64| sampled.share_in_range(water + low, water + high);
    // Fat, water, muscle and blood are within 150 of zero. Between air and them are partial volumes, and beyond them
    // spongy bone: windows well apart from both peaks, whose noise is a few tens.
    let soft = share(-150.0, 150.0);
    // Densities per Hounsfield unit, so that windows of different widths compare.
    let (between, beyond) = (share(-650.0, -250.0) / 400.0, share(350.0, 650.0) / 300.0);
    let is_soft_peak = soft >= MIN_PEAK_SHARE && soft / 300.0 >= MIN_PEAK_RATIO * between.max(beyond);
    let peak = |[low, high]: [f64; 2]| {
        let air = share(low, high);
        (air >= MIN_PEAK_SHARE && air / (high - low) >= MIN_PEAK_RATIO * between).then_some(air)
    };
    let lungs = || peak(LUNG_HU).filter(|_| has_lowest_of_air(volume, sampled, water));
    let found = is_soft_peak.then(|| {
        let air = peak(AIR_HU).map(|air| (air, "air"));
        air.or_else(|| lungs().map(|lungs| (lungs, "lung")))
    });
    // A scan may show no air; then its header must state CT, and the soft tissue must be as much as both peaks
    // together.
    let shown = || (is_ct && soft >= 2.0 * MIN_PEAK_SHARE).then(|| (share(AIR_HU[0], AIR_HU[1]), "air"));
    let (air, material) = found.flatten().or_else(shown)?;
    let why = format!(
        "{:.0} % of the values are near that of {material}, {:.0} % near that of soft tissue",
        100.0 * air,
        100.0 * soft
    );
    Some(DetectedKind::new(DataKind::HounsfieldCt { water }, why))
}

/// Returns true if the lowest values are those of air, and what else is known does not speak against a scan: numbers
/// are whole, or the file says where a body's sides are.
fn has_lowest_of_air(volume: &Volume, sampled: &SampledValues<'_>, water: f64) -> bool {
    // Padding below air is a spike, and so may be air itself, to which many scans are clipped.
    let lowest = [
        Some(sampled.quantile(STREAK_SHARE)),
        sampled.quantile_range_without_spikes(STREAK_SHARE).map(|ends| ends.low),
    ];
    let is_air = lowest.into_iter().flatten().any(|lowest| LOWEST_HU.contains(lowest - water))
        && sampled.share_equal_to(water) <= MAX_ZERO_SHARE;
    is_air && (volume.is_anatomical() || sampled.are_whole_numbers())
}

/// Minimum share of the values in each of the peaks of air and soft tissue: a head in wide air has 26 % and 57 %, a
/// chest 21 % and 28 %; a limb in a tank of air has a few percent of the second.
const MIN_PEAK_SHARE: f64 = 0.03;

/// Minimum ratio of the density in a peak to that between the peaks. Measured: 3 and more; evenly spread values have
/// 1.
const MIN_PEAK_RATIO: f64 = 2.0;

/// Minimum share of values near that of soft tissue in a scan of a body, however the rest is spread: an eighth of a
/// chest is muscle and blood at least.
const MIN_SOFT_SHARE: f64 = 0.1;

/// Largest share of voxels of exactly zero in Hounsfield units, spread over tens of them by noise: backgrounds of
/// signed maps have more.
const MAX_ZERO_SHARE: f64 = 0.05;

/// Returns true if values of a body are whole numbers that begin at air, and many are those of soft tissue: too much
/// like Hounsfield units for deviations from zero, whatever their peaks.
pub(super) fn is_like_hounsfield(volume: &Volume, sampled: &SampledValues<'_>) -> bool {
    let is_body = volume.is_anatomical() || volume.metadata().modality == Modality::Ct;
    is_body
        && sampled.are_whole_numbers()
        && LOWEST_HU.contains(sampled.quantile(0.0))
        && sampled.share_in_range(-150.0, 150.0) > MIN_SOFT_SHARE
        && sampled.share_equal_to(0.0) <= MAX_ZERO_SHARE
}

#[cfg(test)]
mod tests {
    use super::super::KindName;
    use super::super::tests::{bell, chest, kind, values, volume_of};
    use super::*;
    use crate::Samples;
    use glam::DVec3;

    /// Returns the kind of values of a body.
    fn kind_in_body(values: &[f64]) -> KindName {
        volume_of(Samples::F64(values.to_vec())).with_anatomical_axes(true).kind().kind.name()
    }

    /// Returns a chest whose surroundings are cut off, so that lungs are the only air.
    fn cropped_chest() -> Vec<f64> {
        values(|p, at| chest(0.5 * p, at))
    }

    #[test]
    fn lungs_stand_for_air_where_the_body_fills_the_box() {
        let chest = cropped_chest();
        let share = |low: f64, high: f64| {
            chest.iter().filter(|&&value| low <= value && value < high).count() as f64 / chest.len() as f64
        };
        assert!(share(-1050.0, -950.0) < MIN_PEAK_SHARE && share(-950.0, -650.0) > 0.1);
        // A windpipe, whose air is the lowest value.
        let with_windpipe: Vec<f64> = chest
            .iter()
            .enumerate()
            .map(|(at, &value)| if at % 40 == 20 { -1000.0 } else { value })
            .collect();
        assert_eq!(kind(&with_windpipe), KindName::HounsfieldCt);
        // Resampled, so that values are no longer whole.
        let resampled: Vec<f64> = with_windpipe.iter().map(|value| value + 0.25).collect();
        assert_eq!(kind_in_body(&resampled), KindName::HounsfieldCt);
        // With padding outside the scanner's field of view.
        let padded: Vec<f64> = with_windpipe
            .iter()
            .enumerate()
            .map(|(at, &value)| if at % 40 < 2 { -3024.0 } else { value })
            .collect();
        assert_eq!(kind(&padded), KindName::HounsfieldCt);
    }

    #[test]
    fn two_materials_at_other_values_are_no_lungs_and_tissue() {
        // Shapes of a chest with other values: 400 above, 500 below, and an eighth as large.
        let chest = cropped_chest();
        for (scale, offset) in [(1.0, 400.0), (1.0, -500.0), (0.125, 0.0)] {
            let other: Vec<f64> = chest.iter().map(|value| (value * scale + offset).round()).collect();
            assert_ne!(kind(&other), KindName::HounsfieldCt, "{scale} {offset}");
        }
        // Amplitudes of layers of rock, as whole numbers: from −1000 to 1000, most of them near zero.
        let layers = values(|p, at| (900.0 * (9.0 * p.z + p.x).sin().powi(3) + 30.0 * bell(at, 3)).round());
        assert_eq!(kind(&layers), KindName::Signed);
        // A map of deviations within a head, with zero around it.
        let lobes = |p: DVec3, at| (1000.0 * (4.0 * p.x).sin() + 20.0 * bell(at, 1)).round();
        let map = values(|p, at| if p.length() < 0.8 { lobes(p, at) } else { 0.0 });
        assert_eq!(kind_in_body(&map), KindName::Signed);
    }

    #[test]
    fn tissue_without_peaks_of_air_is_never_signed() {
        // From air to tissue in a ramp as even as that of scatter, symmetric about zero.
        let blurred = values(|p, at| (980.0 * p.x + 4.0 * bell(at, 2)).round());
        assert_ne!(kind_in_body(&blurred), KindName::Signed);
        assert_eq!(kind(&blurred), KindName::Signed, "unless it is of no body");
    }
}
