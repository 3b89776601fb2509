//! "Why is this dark?": what is under the pointer, and what of every light gets there.

use crate::app::text::common::LengthUnit;

pub(crate) const NOTHING: &str = "Nothing is seen here";

/// Why a light does not light a point, or is not weakened on its way; behind the name of the light.
pub(crate) const OFF: &str = "off";
pub(crate) const OUTSIDE_HOOD: &str = "outside its hood";
pub(crate) const FACES_AWAY: &str = "the surface faces away from it";
pub(crate) const CASTS_NO_SHADOWS: &str = "casts no shadows";
pub(crate) const SKY: &str = "Sky";
pub(crate) const IN_ITS_WAY: &str = "nothing arrives: something stands in its way";

/// What is there: value, opacity, and where it is.
pub(crate) fn found(value: f64, decimals: usize, opacity: f64, place: &str) -> String {
    format!("Value {value:.decimals$}, opacity {:.0} %\n{place}", 100.0 * opacity)
}

/// The label that is there, and as [`found`].
pub(crate) fn found_label(number: i64, name: &str, opacity: f64, place: &str) -> String {
    let name = if name.is_empty() { String::new() } else { format!(": {name}") };
    format!("Label {number}{name}, opacity {:.0} %\n{place}", 100.0 * opacity)
}

/// A voxel, and its place in the world.
pub(crate) fn place([i, j, k]: [f64; 3], world_mm: [f64; 3], unit: LengthUnit) -> String {
    let [x, y, z] = world_mm.map(|length| length / unit.mm);
    format!("voxel {i:.0}, {j:.0}, {k:.0} · {x:.1}, {y:.1}, {z:.1}{}", unit.suffix)
}

/// A light, and what of it gets there or why nothing does.
pub(crate) fn of_light(name: &str, reason: &str) -> String {
    format!("{name}: {reason}")
}

/// How much of a light gets there, as a share.
pub(crate) fn arrives(share: f64) -> String {
    format!("{:.0} % arrives", 100.0 * share)
}

/// How open a place is to the sky, as a share.
pub(crate) fn open(share: f64) -> String {
    format!("{:.0} % open", 100.0 * share)
}

/// How much of a light gets there, and at what angle.
pub(crate) fn arrival(through: &str, angle_deg: Option<f64>) -> String {
    angle_deg.map_or_else(|| through.to_owned(), |angle| format!("{through}, at {angle:.0}° to the surface"))
}
