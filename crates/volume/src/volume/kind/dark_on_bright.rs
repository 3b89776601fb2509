//! Detection of dark objects on a bright background.

use super::sampled::{SampledValues, quantile};
use super::{DataKind, DetectedKind};

/// Share of the values at either end that count as outliers when brightness is measured.
const OUTLIER_SHARE: f64 = 0.005;

/// Minimum brightness of a face's median, relative to the range of values without [`OUTLIER_SHARE`] at either end. Of
/// 36 volumes, faces of those that are bright on dark reach 0.65 at most; and zero, the background of signed fields,
/// is at 0.74 at most, or they would not be balanced enough.
const MIN_BACKGROUND_BRIGHTNESS: f64 = 0.75;

/// Number of the six faces that must show the background: one may cut the object.
pub(super) const MIN_BACKGROUND_FACES: usize = 5;

/// Maximum share of a face that may belong to the object: a rod that leaves through it covers a few hundredths.
pub(super) const MAX_OBJECT_SHARE: f64 = 0.05;

/// Detects volumes whose faces are in the brighter of two classes, which is also the larger one.
pub(super) fn detect_dark_on_bright(sampled: &SampledValues<'_>) -> Option<DetectedKind> {
    let (low, high) = (sampled.quantile(OUTLIER_SHARE), sampled.quantile(1.0 - OUTLIER_SHARE));
    let split = sampled.otsu_threshold();
    // The background must be larger than the object.
    if high <= low || sampled.share_in_range(f64::NEG_INFINITY, split) > 0.5 {
        return None;
    }
    let is_bright = |face: &Vec<f64>| {
        quantile(face, 0.5) >= low + MIN_BACKGROUND_BRIGHTNESS * (high - low)
            && quantile(face, MAX_OBJECT_SHARE) >= split
    };
    let bright = sampled.faces().iter().filter(|face| is_bright(face)).count();
    (bright >= MIN_BACKGROUND_FACES).then(|| {
        let dark = 100.0 * sampled.share_in_range(f64::NEG_INFINITY, split);
        let why = format!(
            "{bright} of the six faces are bright, and {dark:.1} % of the voxels darker than {split:.3}"
        );
        DetectedKind::new(DataKind::DarkOnBright, why)
    })
}
