//! Texts of the sky section: ambient occlusion, gradients and environment maps.

use crate::app::text::{ControlText, control_text};

pub(crate) const MODE: ControlText =
    control_text("Soft light", "From all around: hollows and undersides keep it out");
pub(crate) const OFF: ControlText =
    control_text("Off", "The same everywhere: the ambient light of the shading");
pub(crate) const WHITE: ControlText =
    control_text("White", "Ambient occlusion: hollows are darker than what stands out");
pub(crate) const GRADIENT: ControlText =
    control_text("Sky", "Other colours from above than from the horizon and from below");
pub(crate) const PICTURE: ControlText = control_text(
    "Picture",
    "Surroundings in a panorama: their colours as far as they change evenly with the direction, and their brightest light \
     as a light of its own",
);
pub(crate) const ENVIRONMENT_MAP: ControlText =
    control_text("Surroundings", "The panorama whose light this is");
pub(crate) const CHOOSE: &str = "Choose…";
/// Text in place of the name of an environment map.
pub(crate) const NO_ENVIRONMENT_MAP: &str = "none yet: white";
pub(crate) const INTENSITY: ControlText =
    control_text("Brightness", "What an open white surface gives back of it");
pub(crate) const ZENITH: ControlText = control_text("Above", "Colour of the sky overhead");
pub(crate) const HORIZON: ControlText = control_text("Horizon", "Colour all around");
pub(crate) const GROUND: ControlText = control_text("Below", "Colour that comes from the ground");
pub(crate) const TILT: ControlText =
    control_text("Tilt", "How far its brightest side leans from overhead: 90° is a large window");
pub(crate) const TURN: ControlText = control_text("Turn", "To which side it leans, about the vertical");
pub(crate) const DENSITY: ControlText =
    control_text("Density", "How much of this light material takes away, compared with other light");
pub(crate) const DIRECTIONS: ControlText =
    control_text("Directions", "From how many sides light is followed: more is smoother, and takes longer");
