//! Objects that are darker than what is around them.

use super::sampled::{Sampled, quantile};
use super::{DataKind, KindFound};

/// Share of the values at either end that are outliers where it is asked how bright something is.
const OUTERMOST: f64 = 0.005;

/// Where in the range of the values (without [`OUTERMOST`] on either side) the middle of the surroundings lies, at
/// least. Of 36 volumes, faces of those that are bright on dark are at 0.65 at most; and zero, which is around signed
/// fields, is at 0.74 at most, or they would not be balanced enough.
const LEAST_BRIGHTNESS: f64 = 0.75;

/// Faces that show the surroundings: one may cut the object.
pub(super) const FACES: usize = 5;

/// Share of a face that may be of the object: a rod that leaves through it has a few hundredths.
pub(super) const MOST_OF_OBJECT: f64 = 0.05;

/// Faces of the volume in the upper of its two classes, which is the larger.
pub(super) fn dark_on_bright(sampled: &Sampled<'_>) -> Option<KindFound> {
    let (low, high) = (sampled.quantile(OUTERMOST), sampled.quantile(1.0 - OUTERMOST));
    let split = sampled.split();
    // What is around is more than the object.
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
