//! Texts of the probe ("Why is this dark?"): the sample under the pointer, and the transmittance of each light there.

use crate::app::text::common::LengthUnit;
use crate::app::text::{ControlText, control_text};

pub(crate) const NOTHING: &str = "Nothing is visible here";

/// Reasons why a light does not reach a point or is not attenuated, shown behind the light's name.
pub(crate) const OFF: &str = "off";
pub(crate) const OUTSIDE_CONE: &str = "outside its spotlight cone";
pub(crate) const FACES_AWAY: &str = "the surface faces away from it";
pub(crate) const CASTS_NO_SHADOWS: &str = "casts no shadows";
pub(crate) const SKY: &str = "Sky";
pub(crate) const IN_ITS_WAY: &str = "no light arrives: material blocks it";

/// Value, opacity and position of the probed sample.
pub(crate) fn sample(value: f64, decimals: usize, opacity: f64, place: &str) -> String {
    format!("Value {value:.decimals$}, opacity {:.0} %\n{place}", 100.0 * opacity)
}

/// Value as a number.
pub(crate) fn number(value: f64, decimals: usize) -> String {
    format!("{value:.decimals$}")
}

/// Value or label of a layer at the probed point.
pub(crate) fn layer_value(name: &str, value: &str) -> String {
    format!("{}: {value}", chiaroscuro_files::sanitised(name, 40))
}

/// Number and name of the probed label.
pub(crate) fn label(number: i64, name: &str) -> String {
    if name.is_empty() { format!("Label {number}") } else { format!("Label {number}: {name}") }
}

/// Opacity and position of a probed label, as [`sample`] without a value.
pub(crate) fn label_sample(opacity: f64, place: &str) -> String {
    format!("Opacity {:.0} %\n{place}", 100.0 * opacity)
}

/// Voxel index and world position; of a body in RAS coordinates (towards right, anterior and superior).
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

/// Row of a light with its arrival, or the reason why nothing arrives.
pub(crate) fn light_row(name: &str, reason: &str) -> String {
    format!("{name}: {reason}")
}

/// Transmittance of a light, from 0 to 1, as a percentage.
pub(crate) fn transmittance(share: f64) -> String {
    format!("{:.0} % arrives", 100.0 * share)
}

/// Sky visibility of a point, from 0 to 1, as a percentage.
pub(crate) fn sky_visibility(share: f64) -> String {
    format!("{:.0} % open", 100.0 * share)
}

/// Transmittance of a light with its angle to the surface.
pub(crate) fn arrival(through: &str, angle_deg: Option<f64>) -> String {
    angle_deg.map_or_else(|| through.to_owned(), |angle| format!("{through}, at {angle:.0}° to the surface"))
}

/// Hint below the verdict while the pointer moves.
pub(crate) const CLICK: &str = "Click for remedies; a second click measures a distance";

pub(crate) const ALL_OFF: &str = "Dark: no light is on";

/// Verdict for a light that mostly arrives.
pub(crate) fn verdict_lit(name: &str, share: f64) -> String {
    format!("Lit: {:.0} % of {name} arrives", 100.0 * share)
}

/// Verdict for a surface that faces away from a light.
pub(crate) fn verdict_faces_away(name: &str) -> String {
    format!("Dark: the surface faces away from {name}")
}

/// Verdict for a point outside a light's cone.
pub(crate) fn verdict_outside_cone(name: &str) -> String {
    format!("Dark: outside the spotlight cone of {name}")
}

/// Verdict for a light at grazing incidence.
pub(crate) fn verdict_grazing(name: &str, angle_deg: f64) -> String {
    format!("Dim: {name} meets the surface at only {angle_deg:.0}°")
}

/// Verdict for a light that material absorbs before it arrives.
pub(crate) fn verdict_absorbed(name: &str, share: f64, distance: Option<&str>) -> String {
    // "Dim" where less than 60 % is absorbed, "Dark" otherwise.
    let how = if share < 0.6 { "Dim" } else { "Dark" };
    let share = 100.0 * share;
    match distance {
        Some(distance) => format!("{how}: {share:.0} % of {name} is absorbed {distance} before it arrives"),
        None => format!("{how}: {share:.0} % of {name} is absorbed on its way"),
    }
}

/// Length in the unit of the file.
pub(crate) fn length(length_mm: f64, unit: LengthUnit) -> String {
    format!("{:.1}{}", length_mm / unit.mm, unit.suffix)
}

/// Distance to the point that was clicked before.
pub(crate) fn distance_to_previous(length: &str) -> String {
    format!("{length} from the previous point")
}

pub(crate) const LET_THROUGH: ControlText =
    control_text("Let light through", "Halves the opacity that light meets: light opacity, in Shadows");
pub(crate) const LIFT_SHADOWS: ControlText =
    control_text("Lift shadows", "Adds 0.15 to the light in all shadows: ambient offset, in Shadows");
pub(crate) const MORE_AMBIENT: ControlText =
    control_text("More ambient light", "Adds 0.1 to the ambient light, in Shading");
pub(crate) const CAST_NO_SHADOWS: ControlText =
    control_text("No shadows from it", "This light passes through everything");
pub(crate) const HEADLIGHT: ControlText =
    control_text("Add a headlight", "Adds a weak light at the eye, which casts no shadows");
/// Default name of the light that is added.
pub(crate) const HEADLIGHT_NAME: &str = "Headlight";
pub(crate) const BOTH_SIDES: ControlText =
    control_text("Light both sides", "Surfaces are lit from behind as well, in Shading");
pub(crate) const TURN_TO_EYE: ControlText =
    control_text("Turn it to the eye", "The light moves half of the way to the direction of view");
pub(crate) const WIDEN_CONE: ControlText =
    control_text("Widen the cone", "The cone of the spotlight becomes 30° wider");
pub(crate) const NO_CONE: ControlText = control_text("No spotlight", "The light shines in all directions");
pub(crate) const SWITCH_ON: ControlText = control_text("Switch it on", "Switches on the first light");

/// Verdict where only the sky shines, with the sky visibility from 0 to 1.
pub(crate) fn verdict_sky_only(open: f64) -> String {
    let how = if open < 0.4 { "Dim" } else { "Lit" };
    format!("{how}: the sky is the only light, and {:.0} % of it is visible", 100.0 * open)
}
