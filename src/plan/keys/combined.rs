//! What the combined light volume, and the look of a light, are made from.

use super::eye::ReceivedLight;
use super::light::LightKey;
use super::lit_lights::LitLights;
use crate::model::{Hood, Length, LightKind, Remains, SceneLight, Settings};
use crate::plan::{RenderOptions, Request};

/// A light as samples see it: what moving a parallel light outwards does not change.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct LightLook {
    kind: LightKind,
    /// The position, or for a parallel light the direction.
    placed: [f64; 3],
    color: [f32; 3],
    intensity: f64,
    hood: Option<Hood>,
    density_scale: f64,
}

impl LightLook {
    /// What samples see of a light.
    pub(super) fn of(light: &SceneLight) -> Self {
        let SceneLight { kind, position, color, intensity, on: _, casts_shadows: _, hood, density_scale } =
            *light;
        let placed = match kind {
            LightKind::Parallel => light.direction().into(),
            LightKind::Perspective => position,
        };
        let hood = (hood.on && kind == LightKind::Perspective).then_some(hood);
        Self { kind, placed, color, intensity, hood, density_scale }
    }
}

/// Everything that the volume is made from that holds the diffuse light of all shadowed lights (P §4).
#[derive(Debug, Clone, PartialEq)]
pub struct CombinedKey {
    lights: Vec<(LightLook, Option<LightKey>)>,
    received: ReceivedLight,
    /// Density step from which a sample counts as a surface, and the length to which it refers.
    surface_gradient: f64,
    unit: Length,
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
            received: ReceivedLight::of(&settings.shadows),
            surface_gradient: settings.shading.surface_gradient,
            unit: settings.opacity_unit,
            seen: settings.cuts.seen(),
            min_transmittance: options.min_transmittance,
        })
    }
}
