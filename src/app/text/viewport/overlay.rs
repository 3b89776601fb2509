//! The overlay over the picture: scale bar and cube.

/// What is written on the sides of the cube: signs of axes, or for bodies what lies there (right, left, anterior,
/// posterior, superior, inferior).
pub(crate) const RIGHT: [&str; 2] = ["+x", "R"];
pub(crate) const LEFT: [&str; 2] = ["−x", "L"];
pub(crate) const ANTERIOR: [&str; 2] = ["+y", "A"];
pub(crate) const POSTERIOR: [&str; 2] = ["−y", "P"];
pub(crate) const SUPERIOR: [&str; 2] = ["+z", "S"];
pub(crate) const INFERIOR: [&str; 2] = ["−z", "I"];

pub(crate) const KILOMETRES: &str = "km";
pub(crate) const METRES: &str = "m";
pub(crate) const CENTIMETRES: &str = "cm";
pub(crate) const MILLIMETRES: &str = "mm";
pub(crate) const MICROMETRES: &str = "µm";
pub(crate) const NANOMETRES: &str = "nm";
/// Where nobody knows how large voxels are.
pub(crate) const VOXELS: &str = "voxels";

/// How long the scale bar is.
pub(crate) fn length(value: f64, unit: &str) -> String {
    format!("{value} {unit}")
}
