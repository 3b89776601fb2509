//! Texts of multiple scattering: the settings of light that bounces.

use crate::app::text::{ControlText, control_text};

pub(crate) const BOUNCES: ControlText =
    control_text("Bounces", "How often light bounces inside: none is off, and some four already glow");
pub(crate) const ALBEDO: ControlText = control_text(
    "Albedo",
    "What a bounce keeps of the light: near 1 matter is milky and glows, near 0 it is dark",
);
pub(crate) const DENSITY: ControlText = control_text(
    "Bounce density",
    "How much this light meets of the material: less lets it in deeper, as into wax",
);
pub(crate) const STRENGTH: ControlText =
    control_text("Bounced light", "What is shown of light that has bounced");
pub(crate) const ANISOTROPY: ControlText = control_text(
    "Anisotropy",
    "Clouds and smoke scatter light on as it came, and glow before it; below 0 they throw it back",
);
pub(crate) const DIRECTIONS: ControlText = control_text(
    "Bounce directions",
    "To how many sides light is followed on its last bounce: more is smoother, and takes longer",
);
