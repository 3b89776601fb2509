//! What screen readers call the handles of the crop box and the clip plane.

pub(crate) const PLANE_DIRECTION: &str = "Clip plane, direction";
pub(crate) const PLANE_PLACE: &str = "Clip plane, place";

/// A side of the crop box: across which axis, and whether at its high end.
pub(crate) fn crop_side(axis: usize, is_high: bool) -> String {
    format!("Crop box, side {}{}", if is_high { "+" } else { "−" }, ["x", "y", "z"][axis])
}
