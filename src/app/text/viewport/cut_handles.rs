//! Accessible names of the handles of crop box and clip plane.

pub(crate) const PLANE_DIRECTION: &str = "Clip plane, direction";
pub(crate) const PLANE_POSITION: &str = "Clip plane, position";

/// Accessible name of a side of the crop box, given by its axis and end.
pub(crate) fn crop_side(axis: usize, is_high: bool) -> String {
    format!("Crop box, side {}{}", if is_high { "+" } else { "−" }, ["x", "y", "z"][axis])
}
