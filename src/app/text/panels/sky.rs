//! Texts of the sky section: ambient occlusion, gradients and environment maps.

use crate::app::text::{Named, named};

pub(crate) const MODE: Named = named("Soft light", "From all around: hollows and undersides keep it out");
pub(crate) const OFF: Named = named("Off", "The same everywhere: the ambient light of the shading");
pub(crate) const WHITE: Named = named("White", "Ambient occlusion: hollows are darker than what stands out");
pub(crate) const GRADIENT: Named =
    named("Sky", "Other colours from above than from the horizon and from below");
pub(crate) const PICTURE: Named = named(
    "Picture",
    "Surroundings in a panorama: their colours as far as they change evenly with the direction, and their brightest light \
     as a light of its own",
);
pub(crate) const SURROUNDINGS: Named = named("Surroundings", "The panorama whose light this is");
pub(crate) const CHOOSE: &str = "Choose…";
/// Text in place of the name of an environment map.
pub(crate) const NO_SURROUNDINGS: &str = "none yet: white";
pub(crate) const INTENSITY: Named = named("Brightness", "What an open white surface gives back of it");
pub(crate) const ZENITH: Named = named("Above", "Colour of the sky overhead");
pub(crate) const HORIZON: Named = named("Horizon", "Colour all around");
pub(crate) const GROUND: Named = named("Below", "Colour that comes from the ground");
pub(crate) const TILT: Named =
    named("Tilt", "How far its brightest side leans from overhead: 90° is a large window");
pub(crate) const TURN: Named = named("Turn", "To which side it leans, about the vertical");
pub(crate) const DENSITY: Named =
    named("Density", "How much of this light material takes away, compared with other light");
pub(crate) const DIRECTIONS: Named =
    named("Directions", "From how many sides light is followed: more is smoother, and takes longer");
