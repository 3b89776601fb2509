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

/// The plane of the slice across an axis, and where it lies; of bodies by its name.
pub(crate) fn plane(axis: usize, at: usize, is_anatomical: bool) -> String {
    let axes = ["x", "y", "z"][axis];
    let plane = match (is_anatomical, axis) {
        (true, 0) => "sagittal",
        (true, 1) => "coronal",
        (true, _) => "axial",
        (false, 0) => "yz",
        (false, 1) => "xz",
        (false, _) => "xy",
    };
    format!("{plane} · {axes} = {at}")
}
