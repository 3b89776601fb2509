//! The part of the section of data that corrects what the file says.

use crate::app::text::{Named, named};
use crate::data::{AxisOrder, SpacingUnit};

/// The part, and why it could not be done.
pub(crate) const TITLE: &str = "Corrections";
pub(crate) const NOT_CORRECTED: &str = "The volume was not corrected";

pub(crate) const SPACING: Named =
    named("Spacing", "How far voxels are apart along the three axes of the file, in the unit below");
pub(crate) const UNIT: Named =
    named("Unit", "The unit of these distances. Where the file says none, voxels have no known size");
pub(crate) const FLIP: Named = named(
    "Flip",
    "Along these axes of the file voxels run the other way: a mirrored object is righted by one of them",
);
pub(crate) const AXIS_ORDER: Named =
    named("Axes", "Where the first, the second and the third axis of the file run");
pub(crate) const ORIENTATION: Named = named(
    "Orientation",
    "Towards which part of a body the three axes of the file run: right or left, anterior or posterior, superior or \
     inferior",
);
pub(crate) const PADDING: Named =
    named("Padding", "The value of voxels that hold nothing: they are neither seen nor counted");
pub(crate) const PADDING_VALUE: Named = named("Padding value", "In the units of the values");
pub(crate) const VALUE_SCALE: Named = named(
    "Values",
    "What the numbers of the file mean: they are multiplied by the first number, and the second is added",
);
pub(crate) const SLOPE: &str = "Slope of the values";
pub(crate) const INTERCEPT: &str = "Intercept of the values";
/// Before and between the two.
pub(crate) const TIMES: &str = "×";
pub(crate) const PLUS: &str = "+";

/// The choice that leaves what the file says.
pub(crate) const IN_FILE: &str = "As in the file";
/// The choice that a body lies nobody knows how, or that there is none.
pub(crate) const UNKNOWN: &str = "Unknown";
/// No value stands for nothing.
pub(crate) const NO_PADDING: &str = "None";
/// One value does.
pub(crate) const TYPED: &str = "Value";
pub(crate) const RESET: Named =
    named("All as in the file", "Takes all corrections back; they are forgotten for this file, too");

/// What axes of files are called.
pub(crate) const AXES: [&str; 3] = ["x", "y", "z"];

/// The distance along an axis, as screen readers call it.
pub(crate) fn spacing_along(axis: &str) -> String {
    format!("Spacing along {axis}")
}

/// The switch that flips an axis.
pub(crate) fn flip(axis: &str) -> String {
    format!("Flip {axis}")
}

/// A unit of distances.
pub(crate) fn unit(unit: SpacingUnit) -> &'static str {
    unit.symbol()
}

/// An order of axes.
pub(crate) fn order(order: AxisOrder) -> &'static str {
    order.name()
}

/// A tip, and what the file says.
pub(crate) fn tip(named: Named, in_file: &str) -> String {
    format!("{}\n\nThe file says: {in_file}", named.tip)
}

/// Where a file says nothing.
pub(crate) const NOTHING_SAID: &str = "nothing";
/// Values are the numbers of the file.
pub(crate) const AS_THEY_ARE: &str = "they are what they are";

/// A volume that was opened is corrected as it was before.
pub(crate) fn as_last_time(corrections: &[String]) -> String {
    format!("Corrected as last time: {}. Undo shows it as the file says", corrections.join("; "))
}
