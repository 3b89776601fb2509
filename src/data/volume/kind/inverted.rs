//! Detection of dark objects on a bright background.

use super::sampled::{Sampled, quantile};
use super::{DataKind, KindFound};

/// Share of the values at either end that count as outliers when brightness is measured.
const OUTERMOST: f64 = 0.005;

/// Minimum brightness of a face's median, relative to the range of values without [`OUTERMOST`] at either end. Of 36
/// volumes, faces of those that are bright on dark reach 0.65 at most; and zero, the background of signed fields, is
/// at 0.74 at most, or they would not be balanced enough.
const LEAST_BRIGHTNESS: f64 = 0.75;

/// Number of the six faces that must show the background: one may cut the object.
pub(super) const FACES: usize = 5;

/// Maximum share of a face that may belong to the object: a rod that leaves through it covers a few hundredths.
pub(super) const MOST_OF_OBJECT: f64 = 0.05;

/// Detects volumes whose faces are in the brighter of two classes, which is also the larger one.
pub(super) fn dark_on_bright(sampled: &Sampled<'_>) -> Option<KindFound> {
    let (low, high) = (sampled.quantile(OUTERMOST), sampled.quantile(1.0 - OUTERMOST));
    let split = sampled.split();
    // The background must be larger than the object.
    if high <= low || sampled.share(f64::NEG_INFINITY, split) > 0.5 {
        return None;
    }
    let is_bright = |face: &Vec<f64>| {
        quantile(face, 0.5) >= low + LEAST_BRIGHTNESS * (high - low)
            && quantile(face, MOST_OF_OBJECT) >= split
    };
    let bright = sampled.faces().iter().filter(|face| is_bright(face)).count();
    (bright >= FACES).then(|| {
        let dark = 100.0 * sampled.share(f64::NEG_INFINITY, split);
        let why = format!(
            "{bright} of the six faces are bright, and {dark:.1} % of the voxels darker than {split:.3}"
        );
        KindFound::new(DataKind::DarkOnBright, why)
    })
}
