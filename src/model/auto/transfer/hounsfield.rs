//! Transfer functions for CT in Hounsfield units: bone and contrast agent are opaque, soft tissue is transparent.

use super::super::domain::Domain;
use super::super::palette::Palette;
use super::{Found, Stop, quantile, some_values, through};
use crate::data::Volume;
use crate::model::{ControlPoint, TransferFunction};

/// Hounsfield units at which bone and contrast agent begin: spongy bone and enhanced blood are above 130, organs
/// below 80 (100 with contrast agent).
const BONE: f64 = 150.0;

/// Smallest share of voxels of bone or contrast agent: less is noise, or a scan without any. A rod of five voxels'
/// width through a volume of 200 voxels' edge has as much.
const LEAST_BONE: f64 = 0.0005;

/// Range of the Hounsfield units of compact bone, to which the measured quantile is clamped: spongy bone ends at the
/// first, and long shafts have more than the second.
const COMPACT: [f64; 2] = [300.0, 700.0];

/// Upper limit in Hounsfield units of the hardest bone, beyond which are enamel and metal; and its smallest distance
/// above compact bone, as much as that is above soft tissue.
const HARDEST: f64 = 1600.0;
const HARDER: f64 = 150.0;

/// Hounsfield units just below 3071, the largest value of 12-bit scanners.
const END: f64 = 3000.0;

/// Hounsfield units at the beginning, peak and end of the skin: a voxel that is half air and half body has the middle
/// one. Lungs are below, fat is above; an edge from air to tissue spends half a voxel there.
const SKIN: [f64; 3] = [-600.0, -300.0, -20.0];

/// Opacity of translucent skin: two layers of it, and two of the lungs, leave nine tenths of the light.
const VEIL: f64 = 0.03;

/// Returns a function with translucent skin added.
pub(in crate::model::auto) fn with_skin(function: &TransferFunction, water: f64) -> TransferFunction {
    let color = Palette::of(Domain::SoftTissue).at(0.0);
    let point = |value: f64, opacity: f64| ControlPoint::new(water + value, color, opacity);
    let skin = [point(SKIN[0], 0.0), point(SKIN[1], VEIL), point(SKIN[2], 0.0)];
    TransferFunction {
        points: skin.into_iter().chain(function.points.iter().copied()).collect(),
        ..function.clone()
    }
}

/// Returns the look of bone; `None` if there is none.
pub(super) fn find(volume: &Volume, water: f64) -> Option<Found> {
    let (mut all, start) = (0usize, water + BONE);
    let dense = some_values(volume, |value| {
        all += 1;
        (value >= start).then_some(value)
    });
    if (dense.len() as f64) < LEAST_BONE * all as f64 {
        return None;
    }
    // Quantile at which compact bone lies; a scan of soft bones, or of contrast agent alone, has less of it.
    let compact = quantile(&dense, 0.6).clamp(water + COMPACT[0], water + COMPACT[1]);
    let hard = quantile(&dense, 0.97).clamp(compact + HARDER, water + HARDEST);
    let stops = [
        (start, 0.0, 0.0),
        (start + 0.3 * (compact - start), 0.25, 0.35),
        (compact, 0.6, 0.8),
        (hard, 0.9, 0.94),
        (water + END, 1.0, 0.97),
    ];
    let stops = stops.map(|(value, place, opacity)| Stop { value, place, opacity });
    Some(Found::of_values(through(stops, Palette::of(Domain::Bone)), Domain::Bone))
}
