//! Texts of the lights section, of the light chips and of the handles in the picture.

use crate::app::text::{ControlText, control_text};

pub(crate) const PARALLEL: ControlText = control_text(
    "Directional",
    "Parallel rays, as from the sun: shadows are as large as the object that casts them",
);
pub(crate) const PERSPECTIVE: ControlText =
    control_text("Positional", "Rays from one point, as from a lamp: shadows grow with the distance");

pub(crate) const WITH_VOLUME: ControlText =
    control_text("The volume", "The light stays where it is: turning the camera rebuilds no shadows");
pub(crate) const WITH_CAMERA: ControlText =
    control_text("The camera", "The light turns with the camera, like a lamp on the photographer's shoulder");

pub(crate) const ADD: ControlText = control_text("Add light", "Adds a light beside the camera; up to eight");
pub(crate) const REMOVE: ControlText = control_text("Remove light", "Removes this light; undo restores it");

/// Name shown for a light that has none.
pub(crate) const UNNAMED: &str = "Light";
pub(crate) const ON_TIP: &str = "Switches this light on or off; its shadows are kept";
pub(crate) const SELECT_TIP: &str = "Select; its handle in the picture is marked";

pub(crate) const NAME: ControlText = control_text("Name", "Name of this light in the list");
pub(crate) const NAME_HINT: &str = "Name of the light";
pub(crate) const KIND: ControlText = control_text("Kind", "Parallel rays, or rays from one point");
pub(crate) const INTENSITY: ControlText =
    control_text("Intensity", "How bright this light is; costs no new shadows");
pub(crate) const DISTANCE: ControlText =
    control_text("Distance", "From the middle of the volume; near lights spread their shadows");
pub(crate) const LOCK: ControlText = control_text(
    "Attached to",
    "Whether the light stays with the volume or with the camera when the camera turns",
);
pub(crate) const HEADLIGHT: ControlText = control_text(
    "Headlight",
    "Places this light at the camera and keeps it there: everything visible is lit, and shadows are out of \
     sight",
);
pub(crate) const SUGGEST: ControlText = control_text(
    "Suggest…",
    "Searches for positions of this light whose shadows show the shape best, and shows the best three",
);
pub(crate) const DENSITY: ControlText = control_text(
    "Density",
    "Multiplies how strongly material attenuates this light alone; refills its light volume",
);
pub(crate) const CASTS_SHADOWS: ControlText =
    control_text("Casts shadows", "Whether material attenuates this light; a fill light casts no shadows");

pub(crate) const SHAPE: ControlText = control_text(
    "Light shape",
    "Shape of the light source: the larger it appears from the volume, the softer the edges of its shadows",
);
pub(crate) const POINT: ControlText =
    control_text("Point", "Shadows are as sharp as the resolution of the volume allows");
pub(crate) const DISC: ControlText =
    control_text("Disc", "A round plate that faces the volume, like a studio lamp");
pub(crate) const RECTANGLE: ControlText = control_text("Rectangle", "A softbox, or a window");
pub(crate) const SPHERE: ControlText =
    control_text("Ball", "Looks the same from everywhere, like a paper lantern or the sun");
pub(crate) const ANGLE: ControlText = control_text(
    "Width",
    "Angular width of the light as seen from the volume (the sun: half a degree); its edge can be dragged \
     in the picture",
);
pub(crate) const SIZE: ControlText =
    control_text("Width", "Width of the light; its edge can be dragged in the picture");
pub(crate) const ASPECT: ControlText =
    control_text("Width by height", "1 is a square, 2 twice as wide as high");
pub(crate) const ROTATION: ControlText =
    control_text("Turn", "Turns the rectangle about the line to the volume");

pub(crate) const SPOTLIGHT: ControlText = control_text(
    "Spotlight",
    "The light shines only within a cone around the line to the middle of the volume",
);
pub(crate) const CONE: ControlText =
    control_text("Cone", "Angle from the axis of the cone to its edge, where the light ends");
pub(crate) const FALLOFF: ControlText =
    control_text("Falloff", "Angle inside the edge over which the light fades; 0 is a hard edge");

/// Caption of the chip that adds a light.
pub(crate) const ADD_CHIP: &str = "+";

/// Entries in the context menu of a chip.
pub(crate) const MUTE: &str = "Switch off";
pub(crate) const UNMUTE: &str = "Switch on";
pub(crate) const SOLO: &str = "Only this light";

/// Cost of a light's shadows in the tooltip of its chip, where there is no measurement.
pub(crate) const NO_SHADOWS: &str = "casts no shadows";
pub(crate) const SHADOWS_PENDING: &str = "shadows are not filled yet";

/// Accessible name of the checkbox that switches a light on.
pub(crate) fn switch_name(name: &str) -> String {
    format!("{name} on")
}

/// Accessible name of the colour of a light, numbered from 1.
pub(crate) fn color(number: usize) -> String {
    format!("Colour of light {number}")
}

/// Default name of a new light, numbered from 1.
pub(crate) fn default_name(number: usize) -> String {
    format!("Light {number}")
}

/// Accessible name of a light's chip.
pub(crate) fn chip(name: &str, on: bool) -> String {
    let state = if on { "on" } else { "off" };
    format!("Light {name}, {state}")
}

/// Tooltip of a light's chip. `shadows`: cost of its shadows.
pub(crate) fn chip_tip(name: &str, intensity: f64, shadows: &str) -> String {
    format!(
        "{name}: intensity {intensity:.2}, {shadows}\n\
         Click to select, drag its handle or use the arrow keys; right-click for more"
    )
}

/// State of a light volume: cached or being filled, fill time and memory.
pub(crate) fn light_volume(complete: bool, fill_ms: Option<f64>, mebibytes: f64) -> String {
    let state = if complete { "cached" } else { "being filled" };
    let ms = fill_ms.map_or_else(String::new, |ms| format!(", {ms:.0} ms"));
    format!("light volume {state}{ms}, {mebibytes:.1} MiB")
}

/// Accessible name of the handle that moves a light.
pub(crate) fn handle(name: &str) -> String {
    format!("Light handle {name}")
}

/// Accessible name of the handle that widens a spotlight's cone.
pub(crate) fn spotlight_handle(name: &str) -> String {
    format!("Spotlight handle {name}")
}

/// Accessible name of the handle on the border of an area light.
pub(crate) fn size_handle(name: &str) -> String {
    format!("Size handle {name}")
}

/// Tooltip of the button that adds a light, with the estimated cost of its shadows: that of the most expensive light
/// so far.
pub(crate) fn add_tip(cost: Option<&str>) -> String {
    match cost {
        Some(cost) => format!("{}\nIts shadows take about {cost}", ADD.tooltip),
        None => ADD.tooltip.to_owned(),
    }
}
