//! Texts of the window of orthogonal slices.

use crate::app::text::{ControlText, control_text};

pub(crate) const TITLE: &str = "Slices";

/// Rows of the readout at the cursor.
pub(crate) const VOXEL: &str = "Voxel";
pub(crate) const VALUE: &str = "Value";
pub(crate) const LABEL: &str = "Label";
pub(crate) const OPACITY: &str = "Opacity";

/// Tooltip of positions in RAS coordinates.
pub(crate) const RAS_TIP: &str = "RAS: from left to right, from back to front and from feet to head, as in NIfTI; DICOM \
                                  counts the first two the other way round (LPS)";

pub(crate) const LEVEL: ControlText = control_text(
    "Level",
    "The value shown as middle grey; drag a slice with the right button, up for brighter",
);
pub(crate) const WIDTH: ControlText = control_text(
    "Window",
    "The width of the window: values from black to white; drag a slice with the right button, to the right for less contrast",
);
pub(crate) const COLORED: ControlText = control_text(
    "As in the picture",
    "Adds the colours of the transfer function and of other layers, by their opacity",
);
pub(crate) const HINT: &str = "Drag: move the cursor\nWheel: next slice\nRight drag: window and level";

/// Display conventions for left and right of a body.
pub(crate) const RADIOLOGICAL: ControlText = control_text(
    "Radiological",
    "A body's right is on the left of axial and coronal slices, as if it faced you",
);
pub(crate) const NEUROLOGICAL: ControlText = control_text(
    "Neurological",
    "A body's right is on the right of axial and coronal slices, as if seen from behind",
);

/// Unit of length, with the suffix RAS in anatomical coordinates.
pub(crate) fn unit(symbol: &str, is_anatomical: bool) -> String {
    if is_anatomical { format!("{symbol} RAS") } else { symbol.to_owned() }
}

/// Number of a label, with its name if there is one.
pub(crate) fn label(number: i64, name: &str) -> String {
    if name.is_empty() { number.to_string() } else { format!("{number} · {name}") }
}

/// Accessible name of the slice across an axis.
pub(crate) fn slice_name(axis: usize) -> String {
    format!("Slice across {}", ["x", "y", "z"][axis])
}

/// Accessible name of an anatomical slice across an axis, with the body's sides at the right, left, top and bottom.
pub(crate) fn anatomical_slice_name(axis: usize, [right, left, top, bottom]: &[String; 4]) -> String {
    format!("{}: {right} right, {left} left, {top} top, {bottom} bottom", slice_name(axis))
}

pub(crate) const SAGITTAL: &str = "Sagittal";
pub(crate) const CORONAL: &str = "Coronal";
pub(crate) const AXIAL: &str = "Axial";

/// Axes that span the slices across an axis.
pub(crate) fn axes(axis: usize) -> &'static str {
    ["yz", "xz", "xy"][axis]
}

/// Plane of a slice, and its index along the axis.
pub(crate) fn plane(name: &str, axis: usize, at: usize) -> String {
    format!("{name} · {} = {at}", ["x", "y", "z"][axis])
}
