//! Texts of the clipping section: crop box and clip plane.

use crate::app::text::common::LengthUnit;
use crate::app::text::{ControlText, control_text};

/// Text in place of the section while no volume is open.
pub(crate) const NOTHING_OPEN: &str = "Nothing is open";

/// Names of the axes of the volume.
pub(crate) const AXES: [&str; 3] = ["x", "y", "z"];

const EFFECT_TIP: &str = "Whether the part that is cut away is visible, and whether it casts shadows";

pub(crate) const CROP: ControlText =
    control_text("Crop box", "Cuts away everything outside a box; drag its sides in the picture");
pub(crate) const EXTENT_TIP: &str = "First and last voxel that remain";
/// Separator between the first and the last voxel.
pub(crate) const RANGE_SEPARATOR: &str = "–";
/// Effect on the part outside the crop box.
pub(crate) const OUTSIDE: ControlText = control_text("Outside", EFFECT_TIP);

pub(crate) const PLANE: ControlText = control_text(
    "Clip plane",
    "Cuts away everything in front of a plane; drag its square to move it and the arrow to turn it",
);
pub(crate) const OFFSET: ControlText =
    control_text("Offset", "Distance from the middle of the volume, in the direction that the plane faces");
pub(crate) const FACING: ControlText =
    control_text("Facing", "Direction that the plane faces; everything in front of it is cut away");
pub(crate) const FLIP: ControlText = control_text("Flip", "Cuts the other side away");
pub(crate) const TOWARDS_EYE: ControlText =
    control_text("Towards the eye", "Turns the plane perpendicular to the line of sight");
/// Effect on the part in front of the clip plane.
pub(crate) const IN_FRONT: ControlText = control_text("In front", EFFECT_TIP);

pub(crate) const REMOVED: &str = "Hidden, no shadow";
pub(crate) const HIDDEN: &str = "Hidden, shadow stays";
pub(crate) const SHADOWLESS: &str = "Visible, no shadow";

/// Extent of the crop box along an axis, as the tooltip of its reset button names it.
pub(crate) fn crop(axis: &str) -> String {
    format!("crop {axis}")
}

/// Range of voxels inside the crop box along an axis.
pub(crate) fn voxels(from: f64, to: f64) -> String {
    format!("{from:.0} … {to:.0}")
}

/// Accessible name of the first voxel inside the box along an axis.
pub(crate) fn crop_from(axis: &str) -> String {
    format!("Crop {axis} from")
}

/// Accessible name of the last voxel inside the box along an axis.
pub(crate) fn crop_to(axis: &str) -> String {
    format!("Crop {axis} to")
}

/// Length of the crop box along an axis.
pub(crate) fn length(length_mm: f64, unit: LengthUnit) -> String {
    let length = length_mm / unit.mm;
    if length < 100.0 { format!("{length:.1}{}", unit.suffix) } else { format!("{length:.0}{}", unit.suffix) }
}

/// Tooltip of the button that turns the clip plane across an axis.
pub(crate) fn across_tooltip(axis: &str) -> String {
    format!("Perpendicular to the {axis} axis")
}

/// Accessible name of the list of effects on a part: outside the box or in front of the plane.
pub(crate) fn effect_name(part: &str) -> String {
    format!("{part}: effect")
}
