//! Texts of multiple scattering: the settings of light that bounces.

use crate::app::text::{ControlText, control_text};

pub(crate) const BOUNCES: ControlText = control_text(
    "Bounces",
    "Number of times that light is scattered inside: 0 is off, and about four already glow",
);
pub(crate) const ALBEDO: ControlText = control_text(
    "Albedo",
    "Share of the light that a bounce keeps: near 1 material is milky and glows, near 0 it is dark",
);
pub(crate) const DENSITY: ControlText = control_text(
    "Bounce density",
    "How strongly material attenuates bounced light: less lets it in deeper, as in wax",
);
pub(crate) const STRENGTH: ControlText =
    control_text("Bounced light", "Brightness of bounced light in the picture");
pub(crate) const ANISOTROPY: ControlText = control_text(
    "Anisotropy",
    "Above 0, light is scattered forward, as by clouds and smoke, which glow in front of it; below 0, \
     backward",
);
pub(crate) const DIRECTIONS: ControlText = control_text(
    "Bounce directions",
    "Number of directions of light on its last bounce: more is smoother, and takes longer",
);
