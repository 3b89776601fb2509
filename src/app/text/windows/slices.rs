//! The window of slices.

use crate::app::text::{Named, named};

pub(crate) const TITLE: &str = "Slices";

/// What is known of the cursor.
pub(crate) const VOXEL: &str = "Voxel";
pub(crate) const VALUE: &str = "Value";
pub(crate) const LABEL: &str = "Label";
pub(crate) const OPACITY: &str = "Opacity";

/// Of lengths of a body.
pub(crate) const RAS_TIP: &str = "RAS: from left to right, from back to front and from feet to head, as in NIfTI; DICOM \
                                  counts the first two the other way round (LPS)";

pub(crate) const LEVEL: Named =
    named("Level", "The value that is a middle grey; drag a slice with the right button, up for brighter");
pub(crate) const WIDTH: Named = named(
    "Window",
    "The width of the window: values from black to white; drag a slice with the right button, to the right for less contrast",
);
pub(crate) const COLORED: Named =
    named("As in the picture", "Where the transfer function shows something, in its colours");
pub(crate) const HINT: &str = "Drag: move the cursor\nWheel: next slice\nRight drag: window and level";

/// Which side of a body is where.
pub(crate) const RADIOLOGICAL: Named =
    named("Radiological", "A body's right is on the left of axial and coronal slices, as if it faced you");
pub(crate) const NEUROLOGICAL: Named = named(
    "Neurological",
    "A body's right is on the right of axial and coronal slices, as if seen from behind",
);

/// A unit of lengths, and from where they count in a body: right, anterior, superior.
pub(crate) fn unit(symbol: &str, is_anatomical: bool) -> String {
    if is_anatomical { format!("{symbol} RAS") } else { symbol.to_owned() }
}

/// A label's number, and its name if it has one.
pub(crate) fn label(number: i64, name: &str) -> String {
    if name.is_empty() { number.to_string() } else { format!("{number} · {name}") }
}

/// What screen readers call the slice across an axis.
pub(crate) fn across(axis: usize) -> String {
    format!("Slice across {}", ["x", "y", "z"][axis])
}

/// What screen readers call the slice of a body across an axis: its sides at the right, the left, the top and the bottom.
pub(crate) fn across_body(axis: usize, [right, left, top, bottom]: &[String; 4]) -> String {
    format!("{}: {right} right, {left} left, {top} top, {bottom} bottom", across(axis))
}

pub(crate) const SAGITTAL: &str = "Sagittal";
pub(crate) const CORONAL: &str = "Coronal";
pub(crate) const AXIAL: &str = "Axial";

/// The axes that span the slices across an axis.
pub(crate) fn span(axis: usize) -> &'static str {
    ["yz", "xz", "xy"][axis]
}

/// The plane of a slice, and which of the slices across an axis it is.
pub(crate) fn plane(name: &str, axis: usize, at: usize) -> String {
    format!("{name} · {} = {at}", ["x", "y", "z"][axis])
}
