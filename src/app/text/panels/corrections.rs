//! Texts of the corrections of file metadata, in the data section.

use crate::app::text::{ControlText, control_text};
use chiaroscuro_volume::{AxisOrder, SpacingUnit};

/// Title of the group, followed by the headline of its error message.
pub(crate) const TITLE: &str = "Corrections";
pub(crate) const CORRECTION_FAILED: &str = "The volume was not corrected";

pub(crate) const SPACING: ControlText =
    control_text("Spacing", "Distance between voxels along the three axes of the file, in the unit below");
pub(crate) const UNIT: ControlText =
    control_text("Unit", "Unit of the spacing. If the file states none, the size of voxels is unknown");
pub(crate) const FLIP: ControlText = control_text(
    "Flip",
    "Reverses the voxels along these axes of the file; flipping one axis corrects a mirrored object",
);
pub(crate) const AXIS_ORDER: ControlText =
    control_text("Axes", "Directions of the first, second and third axis of the file");
pub(crate) const ORIENTATION: ControlText = control_text(
    "Orientation",
    "Anatomical directions of the three axes of the file: right or left, anterior or posterior, superior \
     or inferior",
);
pub(crate) const PADDING: ControlText =
    control_text("Padding", "Value of voxels without data, which are neither shown nor counted");
pub(crate) const PADDING_VALUE: ControlText = control_text("Padding value", "In the units of the values");
pub(crate) const VALUE_SCALE: ControlText = control_text(
    "Values",
    "The values of the file are multiplied by the first number (slope), and the second (intercept) is added",
);
pub(crate) const SLOPE: &str = "Slope of the values";
pub(crate) const INTERCEPT: &str = "Intercept of the values";
/// Signs before the slope and between slope and intercept.
pub(crate) const TIMES: &str = "×";
pub(crate) const PLUS: &str = "+";

/// Choice that keeps the metadata of the file.
pub(crate) const IN_FILE: &str = "As in the file";
/// Choice of an unknown orientation, or of an object that is no body.
pub(crate) const UNKNOWN: &str = "Unknown";
/// Choice without a padding value.
pub(crate) const NO_PADDING: &str = "None";
/// Choice of a padding value that is typed.
pub(crate) const PADDING_TYPED: &str = "Value";
pub(crate) const HIDE_TABLE: ControlText = control_text(
    "Hide table",
    "Finds the table under a body in a scan, and hides it with its shadow; the voxels of the file stay as they are",
);
/// Hint where no table was found.
pub(crate) const NO_TABLE: &str = "No table was found";
pub(crate) const RESET: ControlText =
    control_text("All as in the file", "Removes all corrections, also those remembered for this file");

/// Names of the axes of the file.
pub(crate) const AXES: [&str; 3] = ["x", "y", "z"];

/// Accessible name of the voxel spacing along an axis.
pub(crate) fn spacing_along(axis: &str) -> String {
    format!("Spacing along {axis}")
}

/// Accessible name of the checkbox that flips an axis.
pub(crate) fn flip(axis: &str) -> String {
    format!("Flip {axis}")
}

/// Symbol of a unit of voxel spacing.
pub(crate) fn unit(unit: SpacingUnit) -> &'static str {
    unit.symbol()
}

/// Name of an axis order.
pub(crate) fn order(order: AxisOrder) -> &'static str {
    order.name()
}

/// Tooltip of a correction, with the value that the file has.
pub(crate) fn tooltip_with_metadata(named: ControlText, in_file: &str) -> String {
    format!("{}\n\nThe file says: {in_file}", named.tooltip)
}

/// Text in place of metadata that the file lacks.
pub(crate) const NO_METADATA: &str = "nothing";
/// Text for the scale of the values as opened: they are neither multiplied nor shifted.
pub(crate) const NO_SCALE: &str = "slope 1, intercept 0";

/// Message after a reopened volume was given the corrections of the last time.
pub(crate) fn restored(corrections: &[String]) -> String {
    format!("Corrected as last time: {}. Undo removes the corrections", corrections.join("; "))
}
