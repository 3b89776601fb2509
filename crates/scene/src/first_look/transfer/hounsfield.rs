//! Transfer functions for CT in Hounsfield units: bone and contrast agent are opaque, soft tissue is transparent.

use super::super::domain::DataDomain;
use super::super::palette::DomainPalette;
use super::{FirstTransfer, PaletteStop, quantile, sample_values, transfer_through_stops};
use crate::{ControlPoint, TransferFunction};
use chiaroscuro_volume::Volume;

/// Hounsfield units at which bone and contrast agent begin: spongy bone and enhanced blood are above 130, organs
/// below 80 (100 with contrast agent).
const BONE_HU: f64 = 150.0;

/// Smallest share of voxels of bone or contrast agent: less is noise, or a scan without any. A rod of five voxels'
/// width through a volume of 200 voxels' edge has as much.
const MIN_BONE_SHARE: f64 = 0.0005;

/// Range of the Hounsfield units of compact bone, to which the measured quantile is clamped: spongy bone ends at the
/// first, and long shafts have more than the second.
const COMPACT_BONE_HU: [f64; 2] = [300.0, 700.0];

/// Upper limit in Hounsfield units of the hardest bone, beyond which are enamel and metal; and its smallest distance
/// above compact bone, as much as that is above soft tissue.
const MAX_HARD_HU: f64 = 1600.0;
const MIN_HARD_STEP_HU: f64 = 150.0;

/// Hounsfield units just below 3071, the largest value of 12-bit scanners.
const MAX_CT_HU: f64 = 3000.0;

/// Hounsfield units at the beginning, peak and end of the skin: a voxel that is half air and half body has the middle
/// one. Lungs are below, fat is above; an edge from air to tissue spends half a voxel there.
const SKIN_HU: [f64; 3] = [-600.0, -300.0, -20.0];

/// Hounsfield units at which skin ends, and the body begins within.
pub(crate) const SKIN_END_HU: f64 = SKIN_HU[2];

/// Translucent skin in CT, whose values are those of voxels between air and body.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SkinVeil {
    /// Value of water.
    pub water: f64,
}

impl SkinVeil {
    /// Returns the extinction of skin at a value relative to that at its peak.
    pub(crate) fn relative_extinction(self, value: f64) -> f64 {
        let [begins, peak, ends] = SKIN_HU.map(|units| self.water + units);
        ((value - begins) / (peak - begins)).min((ends - value) / (ends - peak)).max(0.0)
    }

    /// Returns true if a value is within the body.
    pub(crate) fn is_body(self, value: f64) -> bool {
        value > self.water + SKIN_END_HU
    }

    /// Returns a function with skin of a given opacity at its peak added.
    pub(crate) fn add_to(self, function: &TransferFunction, opacity: f64) -> TransferFunction {
        let color = DomainPalette::for_domain(DataDomain::SoftTissue).color_at(0.0);
        let point = |value: f64, opacity: f64| ControlPoint::new(self.water + value, color, opacity);
        let skin = [point(SKIN_HU[0], 0.0), point(SKIN_HU[1], opacity), point(SKIN_HU[2], 0.0)];
        TransferFunction {
            points: skin.into_iter().chain(function.points.iter().copied()).collect(),
            ..function.clone()
        }
    }
}

/// Returns the look of bone; `None` if there is none.
pub(super) fn find_bone(volume: &Volume, water: f64) -> Option<FirstTransfer> {
    let (mut all, start) = (0usize, water + BONE_HU);
    let dense = sample_values(volume, |value| {
        all += 1;
        (value >= start).then_some(value)
    });
    if (dense.len() as f64) < MIN_BONE_SHARE * all as f64 {
        return None;
    }
    // Quantile at which compact bone lies; a scan of soft bones, or of contrast agent alone, has less of it.
    let compact = quantile(&dense, 0.6).clamp(water + COMPACT_BONE_HU[0], water + COMPACT_BONE_HU[1]);
    let hard = quantile(&dense, 0.97).clamp(compact + MIN_HARD_STEP_HU, water + MAX_HARD_HU);
    let stops = [
        (start, 0.0, 0.0),
        (start + 0.3 * (compact - start), 0.25, 0.35),
        (compact, 0.6, 0.8),
        (hard, 0.9, 0.94),
        (water + MAX_CT_HU, 1.0, 0.97),
    ];
    let stops = stops.map(|(value, place, opacity)| PaletteStop { value, place, opacity });
    Some(FirstTransfer::from_values(
        transfer_through_stops(stops, DomainPalette::for_domain(DataDomain::Bone)),
        DataDomain::Bone,
    ))
}
