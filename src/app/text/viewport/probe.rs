//! "Why is this dark?": what is under the pointer, and what of every light gets there.

use crate::app::text::common::LengthUnit;
use crate::app::text::{Named, named};

pub(crate) const NOTHING: &str = "Nothing is seen here";

/// Why a light does not light a point, or is not weakened on its way; behind the name of the light.
pub(crate) const OFF: &str = "off";
pub(crate) const OUTSIDE_HOOD: &str = "outside its spotlight cone";
pub(crate) const FACES_AWAY: &str = "the surface faces away from it";
pub(crate) const CASTS_NO_SHADOWS: &str = "casts no shadows";
pub(crate) const SKY: &str = "Sky";
pub(crate) const IN_ITS_WAY: &str = "nothing arrives: something stands in its way";

/// What is there: value, opacity, and where it is.
pub(crate) fn found(value: f64, decimals: usize, opacity: f64, place: &str) -> String {
    format!("Value {value:.decimals$}, opacity {:.0} %\n{place}", 100.0 * opacity)
}

/// The label that is there.
pub(crate) fn label(number: i64, name: &str) -> String {
    if name.is_empty() { format!("Label {number}") } else { format!("Label {number}: {name}") }
}

/// As [`found`], of a label.
pub(crate) fn found_label(opacity: f64, place: &str) -> String {
    format!("Opacity {:.0} %\n{place}", 100.0 * opacity)
}

/// A voxel, and its place in the world; of a body from left to right, from back to front and from feet to head.
pub(crate) fn place(
    [i, j, k]: [f64; 3],
    world_mm: [f64; 3],
    unit: LengthUnit,
    is_anatomical: bool,
) -> String {
    let [x, y, z] = world_mm.map(|length| length / unit.mm);
    let space = if is_anatomical { " RAS" } else { "" };
    format!("voxel {i:.0}, {j:.0}, {k:.0} · {x:.1}, {y:.1}, {z:.1}{}{space}", unit.suffix)
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

/// Below the sentence, while the pointer moves.
pub(crate) const CLICK: &str = "Click for what helps; a second click measures a distance";

pub(crate) const ALL_OFF: &str = "Dark: no light is on";

/// Most of a light arrives.
pub(crate) fn lit(name: &str, share: f64) -> String {
    format!("Lit: {:.0} % of {name} arrives", 100.0 * share)
}

/// The surface looks away from a light.
pub(crate) fn faces_away(name: &str) -> String {
    format!("Dark: the surface faces away from {name}")
}

/// A light's cone does not reach the place.
pub(crate) fn outside_cone(name: &str) -> String {
    format!("Dark: outside the spotlight cone of {name}")
}

/// A light comes in at a low angle.
pub(crate) fn grazing(name: &str, angle_deg: f64) -> String {
    format!("Dim: {name} falls in at only {angle_deg:.0}° to the surface")
}

/// Material takes a light before it arrives.
pub(crate) fn absorbed(name: &str, share: f64, distance: Option<&str>) -> String {
    // What is left of most of a light is dim, and what is left of little dark.
    let how = if share < 0.6 { "Dim" } else { "Dark" };
    let share = 100.0 * share;
    match distance {
        Some(distance) => format!("{how}: {share:.0} % of {name} is absorbed {distance} before it arrives"),
        None => format!("{how}: {share:.0} % of {name} is absorbed on its way"),
    }
}

/// A length in the unit of the file.
pub(crate) fn length(length_mm: f64, unit: LengthUnit) -> String {
    format!("{:.1}{}", length_mm / unit.mm, unit.suffix)
}

/// How far it is from the place that was clicked before.
pub(crate) fn apart(length: &str) -> String {
    format!("{length} from the previous place")
}

pub(crate) const LET_THROUGH: Named =
    named("Let light through", "Halves what light meets: scale of the light opacity, in Shadows");
pub(crate) const LIFT_SHADOWS: Named =
    named("Lift shadows", "Adds 0.15 to the light in all shadows: ambient offset, in Shadows");
pub(crate) const MORE_AMBIENT: Named =
    named("More ambient light", "Adds 0.1 to the light from everywhere, in Shading");
pub(crate) const NO_SHADOW: Named = named("No shadows of it", "This light goes through everything");
pub(crate) const HEADLIGHT: Named =
    named("Add a headlight", "Adds a weak light at the eye, which casts no shadows");
/// What such a light is called.
pub(crate) const HEADLIGHT_NAME: &str = "Headlight";
pub(crate) const BOTH_SIDES: Named =
    named("Light both sides", "Surfaces are lit from behind as well, in Shading");
pub(crate) const TURN_HERE: Named =
    named("Turn it to the eye", "The light goes half of the way to where you look from");
pub(crate) const WIDEN_CONE: Named = named("Widen the cone", "The cone of the spotlight becomes 30° wider");
pub(crate) const NO_CONE: Named = named("No spotlight", "It shines in all directions");
pub(crate) const SWITCH_ON: Named = named("Switch it on", "The first light shines");

/// Only the sky shines, of which a share is seen.
pub(crate) fn under_sky(open: f64) -> String {
    let how = if open < 0.4 { "Dim" } else { "Lit" };
    format!("{how}: no light is on but the sky, of which {:.0} % is seen", 100.0 * open)
}
