//! Texts of the section that compares two looks.

use crate::app::text::{ControlText, control_text};
use chiaroscuro_scene::ComparisonVariant;

pub(crate) const ON: ControlText =
    control_text("Compare two looks", "Shows two looks in one picture: drag the line between them (C)");
pub(crate) const DIFFERENCE: ControlText = control_text(
    "Show the difference",
    "The absolute difference of the two, eight times as bright; black where they are equal",
);

const SIDE_TIP: &str = "The look on this side";

pub(crate) const LEFT: ControlText = control_text("Left", SIDE_TIP);
pub(crate) const RIGHT: ControlText = control_text("Right", SIDE_TIP);

pub(crate) const KEEP: ControlText = control_text(
    "Keep this look on the right",
    "Then change something: the left side follows, the right side stays",
);
pub(crate) const WITH_FILE: ControlText =
    control_text("Compare with a file…", "Settings or a preset, laid over the look as it is now");
pub(crate) const TAKE_RIGHT: ControlText =
    control_text("Take the right look", "Makes the look on the right the current one");

/// Accessible name of the list of looks for a side.
pub(crate) fn look_list_name(side: &str) -> String {
    format!("{side} look")
}

/// Name of a look in the comparison.
pub(crate) fn variant_name(variant: &ComparisonVariant) -> &'static str {
    match variant {
        ComparisonVariant::Current => "This look",
        ComparisonVariant::Off => "No shadows",
        ComparisonVariant::Splat => "Splatting",
        ComparisonVariant::Raycast => "Per voxel",
        ComparisonVariant::Direct => "Per sample",
        ComparisonVariant::Scatter => "Scattered",
        ComparisonVariant::FirstTouch => "First touch",
        ComparisonVariant::Look(_) => "Saved look",
        ComparisonVariant::View(_) => "Saved view",
    }
}
