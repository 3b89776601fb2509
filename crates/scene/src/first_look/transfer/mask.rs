//! Transfer functions for binary masks: a surface halfway between the two values.

use super::super::palette::MASK_COLOR;
use super::super::threshold::otsu_threshold;
use super::transfer_from_points;
use crate::srgb_from_lch;
use crate::{ControlPoint, TransferFunction};
use chiaroscuro_volume::{DataKind, Histogram, Volume};

/// Half the width of the surface's opacity ramp, as a share of the values' range: a surface, not a haze; and not so
/// sharp that voxels show.
const RAMP_HALF_WIDTH: f64 = 0.1;

/// Returns a function that shows the higher of the two values.
pub(super) fn mask_transfer(volume: &Volume, histogram: &Histogram) -> TransferFunction {
    let range = volume.ranges().robust;
    let half = match volume.kind().kind {
        DataKind::Mask => range.value_at(0.5),
        // For other data treated as a mask, Otsu's split.
        _ => volume.value_of(otsu_threshold(histogram)),
    };
    let width = RAMP_HALF_WIDTH * range.span();
    let color = srgb_from_lch(MASK_COLOR);
    let point = |value, opacity| ControlPoint::new(value, color, opacity);
    transfer_from_points(vec![
        point(half - width, 0.0),
        point(half + width, 0.9),
        point(range.high.max(half + 2.0 * width), 0.95),
    ])
}
