//! Texts of the shading section.

use crate::app::text::{ControlText, control_text};
use chiaroscuro_scene::RenderMode;

pub(crate) const MODE: ControlText =
    control_text("Mode", "The rule by which the values along a ray become a colour");
const MATTER: ControlText = control_text("Matter", "Material: its opacity hides what lies behind");
const SURFACE: ControlText = control_text(
    "Surface",
    "An opaque surface at one value; a click in the picture takes the value from there",
);
const MAXIMUM: ControlText =
    control_text("Maximum", "The largest value along each ray, in the colours of the curve");
const MINIMUM: ControlText =
    control_text("Minimum", "The smallest value along each ray, in the colours of the curve");
const MEAN: ControlText = control_text("Mean", "The mean of the values along each ray, as in a radiograph");
pub(crate) const ISOVALUE: ControlText = control_text(
    "Isovalue",
    "The value at which the surface lies; a click in the picture takes the value from there",
);
pub(crate) const ISOVALUE_OF_CURVE: &str = "Takes it from the curve: where its opacity reaches a half";
pub(crate) const LIT: ControlText =
    control_text("Lit", "Shades what the maximum belongs to, with shadows, at its side towards the eye");
/// Note where a mode is asked for that labels cannot have.
pub(crate) const LABELS_ARE_MATTER: &str = "Labels have no order, and are always shown as material";
/// Hint where a mode shows no light.
pub(crate) const UNLIT: &str = "Colours of the curve, without light";

/// Name and tooltip of a render mode.
pub(crate) fn mode_text(mode: RenderMode) -> ControlText {
    match mode {
        RenderMode::Matter => MATTER,
        RenderMode::Surface => SURFACE,
        RenderMode::Maximum => MAXIMUM,
        RenderMode::Minimum => MINIMUM,
        RenderMode::Mean => MEAN,
    }
}

/// Note after the key that changes the mode.
pub(crate) fn mode_note(mode: RenderMode) -> String {
    let named = mode_text(mode);
    format!("{}: {}", named.name, named.tooltip)
}

pub(crate) const EMISSION: ControlText =
    control_text("Emission", "Light that material gives off by itself; for glowing data");
pub(crate) const AMBIENT: ControlText = control_text(
    "Ambient",
    "Light from everywhere, never shadowed: too much of it flattens the shape; a sky replaces it",
);
pub(crate) const DIFFUSE: ControlText =
    control_text("Diffuse", "Light that a surface scatters evenly: shows its orientation");
pub(crate) const SPECULAR: ControlText =
    control_text("Specular", "Highlights; for surfaces that should look polished");
pub(crate) const SHININESS: ControlText = control_text("Shininess", "Higher makes highlights smaller");
pub(crate) const SURFACE_GRADIENT: ControlText = control_text(
    "Surface gradient",
    "The density step at which material counts as a surface; higher makes noise and haze look soft",
);

pub(crate) const SIDES: ControlText =
    control_text("Lit sides", "Sides of a surface that receive light from lights with shadows");
pub(crate) const ONE_SIDE: ControlText =
    control_text("Outer", "The side towards lower opacity: clean edges, dark backs");
pub(crate) const BOTH_SIDES: ControlText =
    control_text("Both", "Light reaches through surfaces, as in the paper");

pub(crate) const EXPOSURE: ControlText = control_text(
    "Exposure",
    "How bright the volume and its floor are shown; the background and the shadows stay",
);
pub(crate) const TONE_MAP: ControlText =
    control_text("Tone map", "How light brighter than the screen is shown");
pub(crate) const NEUTRAL: ControlText =
    control_text("Neutral", "Keeps colours up to 80 %, then rolls off smoothly");
pub(crate) const CLIP: ControlText = control_text("Clip", "Clips at full brightness; exact below");

pub(crate) const ANTIALIASING: ControlText = control_text(
    "Antialiasing",
    "Rays through each pixel where there are edges, in the picture at rest and in exports: more are smoother",
);
pub(crate) const NO_ANTIALIASING: ControlText =
    control_text("Off", "One ray through the middle of each pixel: jagged edges");
pub(crate) const FOUR_RAYS: ControlText = control_text("4", "Edges in four steps");
pub(crate) const EIGHT_RAYS: ControlText = control_text("8", "Edges in eight steps");
pub(crate) const SIXTEEN_RAYS: ControlText =
    control_text("16", "Edges in sixteen steps, for prints; takes four times as long as 4");

pub(crate) const BACKGROUND: ControlText =
    control_text("Background", "Colours behind the volume, at the top and at the bottom");
pub(crate) const BACKGROUND_TOP: &str = "Background top";
pub(crate) const BACKGROUND_BOTTOM: &str = "Background bottom";
