//! Texts of the shading section.

use crate::app::text::{Named, named};

pub(crate) const EMISSION: Named =
    named("Emission", "Light that material gives off by itself; for glowing data");
pub(crate) const AMBIENT: Named = named(
    "Ambient",
    "Light from everywhere, never shadowed: too much of it flattens the shape; a sky takes its place",
);
pub(crate) const DIFFUSE: Named =
    named("Diffuse", "Light that a surface scatters evenly: shows how it is turned");
pub(crate) const SPECULAR: Named = named("Specular", "Highlights; for surfaces that should look polished");
pub(crate) const SHININESS: Named = named("Shininess", "How small highlights are");
pub(crate) const SURFACE_GRADIENT: Named = named(
    "Surface gradient",
    "The density step at which material counts as a surface; higher makes noise and haze look soft",
);

pub(crate) const SIDES: Named = named("Lit sides", "Which sides of a surface shadowed light falls on");
pub(crate) const ONE_SIDE: Named = named("Outer", "The side that opacity falls to: clean edges, dark backs");
pub(crate) const BOTH_SIDES: Named = named("Both", "Light reaches through surfaces, as in the paper");

pub(crate) const EXPOSURE: Named =
    named("Exposure", "How bright the volume and its floor are shown; the background and the shadows stay");
pub(crate) const TONE_MAP: Named =
    named("Tone map", "What happens to light that is brighter than the screen");
pub(crate) const NEUTRAL: Named = named("Neutral", "Keeps colours up to 80 %, then rolls off smoothly");
pub(crate) const CLIP: Named = named("Clip", "Cuts at full brightness; exact below");

pub(crate) const BACKGROUND: Named = named("Background", "Behind the volume, from the top to the bottom");
pub(crate) const BACKGROUND_TOP: &str = "Background top";
pub(crate) const BACKGROUND_BOTTOM: &str = "Background bottom";
