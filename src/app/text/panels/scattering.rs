//! Texts of multiple scattering: the settings of light that bounces.

use crate::app::text::{Named, named};

pub(crate) const BOUNCES: Named =
    named("Bounces", "How often light bounces inside: none is off, and some four already glow");
pub(crate) const ALBEDO: Named =
    named("Albedo", "What a bounce keeps of the light: near 1 matter is milky and glows, near 0 it is dark");
pub(crate) const DENSITY: Named =
    named("Bounce density", "How much this light meets of the material: less lets it in deeper, as into wax");
pub(crate) const STRENGTH: Named = named("Bounced light", "What is shown of light that has bounced");
pub(crate) const ANISOTROPY: Named = named(
    "Anisotropy",
    "Clouds and smoke scatter light on as it came, and glow before it; below 0 they throw it back",
);
pub(crate) const DIRECTIONS: Named = named(
    "Bounce directions",
    "To how many sides light is followed on its last bounce: more is smoother, and takes longer",
);
