//! The window of slices.

use crate::app::text::{Named, named};

pub(crate) const TITLE: &str = "Slices";

/// What is known of the cursor.
pub(crate) const VOXEL: &str = "Voxel";
pub(crate) const VALUE: &str = "Value";
pub(crate) const OPACITY: &str = "Opacity";

pub(crate) const BLACK: &str = "Black";
pub(crate) const WHITE: &str = "White";
/// Of black and white.
pub(crate) const LEVEL_TIP: &str = "Drag a slice with the right button, too";
pub(crate) const COLORED: Named =
    named("As in the picture", "Where the transfer function shows something, in its colours");
pub(crate) const HINT: &str = "Drag: move the cursor\nWheel: next slice\nRight drag: grey levels";

/// What screen readers call the slice across an axis.
pub(crate) fn across(axis: usize) -> String {
    format!("Slice across {}", ["x", "y", "z"][axis])
}
