//! Texts of the sky section: ambient occlusion, gradients and environment maps.

use crate::app::text::{ControlText, control_text};

pub(crate) const MODE: ControlText =
    control_text("Soft light", "Light from all directions: hollows and undersides receive less of it");
pub(crate) const OFF: ControlText =
    control_text("Off", "Only the ambient light of the shading, the same everywhere");
pub(crate) const WHITE: ControlText =
    control_text("White", "Ambient occlusion: hollows are darker than exposed parts");
pub(crate) const GRADIENT: ControlText =
    control_text("Sky", "Different colours from above, from the horizon and from below");
pub(crate) const PICTURE: ControlText = control_text(
    "Picture",
    "Light from an environment map (a panorama): its colours, as far as they change evenly with the \
     direction, and its brightest light as a separate light",
);
pub(crate) const ENVIRONMENT_MAP: ControlText =
    control_text("Environment map", "The panorama that lights the volume");
pub(crate) const CHOOSE: &str = "Choose…";
/// Text in place of the name of an environment map.
pub(crate) const NO_ENVIRONMENT_MAP: &str = "none yet: white";
pub(crate) const INTENSITY: ControlText =
    control_text("Brightness", "Brightness of a white surface that nothing occludes");
pub(crate) const ZENITH: ControlText = control_text("Above", "Colour of the sky overhead");
pub(crate) const HORIZON: ControlText = control_text("Horizon", "Colour all around");
pub(crate) const GROUND: ControlText = control_text("Below", "Colour that comes from the ground");
pub(crate) const TILT: ControlText =
    control_text("Tilt", "Angle between its brightest side and overhead: 90° is a large window");
pub(crate) const TURN: ControlText = control_text("Turn", "Direction of the tilt, about the vertical axis");
pub(crate) const DENSITY: ControlText =
    control_text("Density", "How strongly material attenuates this light, compared with other light");
pub(crate) const DIRECTIONS: ControlText = control_text(
    "Directions",
    "Number of directions from which light is followed: more is smoother, and takes longer",
);
/// Texts of the sets of directions, in the order of their sizes.
pub(crate) const DIRECTION_SETS: [ControlText; 5] = [
    control_text("6", "For a first impression: shadows in six directions"),
    control_text("12", "As in previews"),
    control_text("24", "Fine for soft material; on surfaces it shows as a faint weave"),
    control_text("48", "On surfaces, faint copies of the shadows of thin objects"),
    control_text("96", "Even on surfaces, too, in twice the time"),
];
