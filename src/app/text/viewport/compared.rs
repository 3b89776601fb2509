//! Texts of the section that compares two looks.

use crate::app::text::{Named, named};
use crate::model::Variant;

pub(crate) const ON: Named =
    named("Compare two looks", "Shows two looks in one picture: drag the line between them (C)");
pub(crate) const DIFFERENCE: Named = named(
    "Show the difference",
    "What lies between the two, eight times as bright; grey where they differ evenly",
);

const SIDE_TIP: &str = "Which look is on this side";

pub(crate) const LEFT: Named = named("Left", SIDE_TIP);
pub(crate) const RIGHT: Named = named("Right", SIDE_TIP);

pub(crate) const KEEP: Named = named(
    "Keep this look on the right",
    "Then change something: the left side follows, the right side stays",
);
pub(crate) const WITH_FILE: Named =
    named("Compare with a file…", "Settings or a preset, laid over the look as it is now");
pub(crate) const TAKE_RIGHT: Named = named("Take the right look", "Makes the right look the current one");

/// Accessible name of the list of looks for a side.
pub(crate) fn look(side: &str) -> String {
    format!("{side} look")
}

/// Name of a look in the comparison.
pub(crate) fn variant(variant: &Variant) -> &'static str {
    match variant {
        Variant::Current => "This look",
        Variant::Off => "No shadows",
        Variant::Splat => "Splatting",
        Variant::Raycast => "Per voxel",
        Variant::Direct => "Per sample",
        Variant::Scatter => "Scattered",
        Variant::FirstTouch => "First touch",
        Variant::Look(_) => "Saved look",
        Variant::View(_) => "Saved view",
    }
}
