//! Key of the combined light volume.

use super::light::LightKey;
use super::lit_lights::LitLights;
use super::received::{LightLook, ReceivedLight};
use super::table::EyeTableKey;
use crate::model::{Length, Remains, Settings, Sides};
use crate::plan::{RenderOptions, Request};

/// Inputs of the volume that holds the diffuse light of all shadowed lights (P §4).
#[derive(Debug, Clone, PartialEq)]
pub struct CombinedKey {
    lights: Vec<(LightLook, Option<LightKey>)>,
    received: ReceivedLight,
    /// Density gradient from which a sample counts as a surface, and the length to which it refers.
    surface_gradient: f64,
    unit: Length,
    /// Eye's table, which decides on the lit side of a surface, if only one side is lit.
    sides: Option<EyeTableKey>,
    /// Visible cuts: their faces have normals of their own.
    seen: Remains,
    /// Transmittance below which light counts as none.
    min_transmittance: f32,
}

impl CombinedKey {
    /// Creates the key for the lights of a picture; `None` if each light keeps its own volume.
    pub fn of(request: &Request, options: &RenderOptions) -> Option<Self> {
        let settings: &Settings = &request.settings;
        // A preview moves only one light, and reuses the volumes of the others.
        (settings.combines_lights() && request.coarse.is_none()).then(|| Self {
            lights: LitLights::of(settings)
                .shadowed()
                .iter()
                .map(|lit| (LightLook::of(&lit.light), LightKey::of(request, lit.index)))
                .collect(),
            received: ReceivedLight::of(settings),
            surface_gradient: settings.shading.surface_gradient,
            unit: settings.opacity_unit,
            sides: (settings.shading.sides == Sides::One).then(|| EyeTableKey::of(settings)),
            seen: settings.cuts.seen(),
            min_transmittance: options.min_transmittance,
        })
    }
}
