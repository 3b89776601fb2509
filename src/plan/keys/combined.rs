//! What the combined light volume is made from.

use super::light::LightKey;
use super::lit_lights::LitLights;
use super::received::{LightLook, ReceivedLight};
use super::table::EyeTableKey;
use crate::model::{Length, Remains, Settings, Sides};
use crate::plan::{RenderOptions, Request};

/// Everything that the volume is made from that holds the diffuse light of all shadowed lights (P §4).
#[derive(Debug, Clone, PartialEq)]
pub struct CombinedKey {
    lights: Vec<(LightLook, Option<LightKey>)>,
    received: ReceivedLight,
    /// Density step from which a sample counts as a surface, and the length to which it refers.
    surface_gradient: f64,
    unit: Length,
    /// To which side of a surface opacity falls, where only that is lit.
    sides: Option<EyeTableKey>,
    /// Faces that are seen have normals of their own.
    seen: Remains,
    /// What is left of light that counts as none.
    min_transmittance: f32,
}

impl CombinedKey {
    /// The key for the lights of a picture; `None` where each keeps its own volume.
    pub fn of(request: &Request, options: &RenderOptions) -> Option<Self> {
        let settings: &Settings = &request.settings;
        // A preview moves one light: the volumes of the others serve it again and again.
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
