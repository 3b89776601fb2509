//! Key of the combined light volume.

use super::light::LightKey;
use super::light_lookup::{LightAppearance, LightLookupKey};
use super::lit_lights::ActiveLights;
use super::table::EyeTableKey;
use crate::plan::{RenderOptions, RenderRequest};
use chiaroscuro_scene::{ClippedPart, LitSides, OpacityLength, Settings};

/// Inputs of the volume that holds the diffuse light of all shadowed lights (P §4).
#[derive(Debug, Clone, PartialEq)]
pub struct CombinedKey {
    lights: Vec<(LightAppearance, Option<LightKey>)>,
    received: LightLookupKey,
    /// Density gradient from which a sample counts as a surface, and the length to which it refers.
    surface_gradient: f64,
    unit: OpacityLength,
    /// Share of light that material without a surface scatters in each direction.
    amid: f64,
    /// Eye's table, which decides on the lit side of a surface, if only one side is lit.
    sides: Option<EyeTableKey>,
    /// Visible cuts: their faces have normals of their own.
    seen: ClippedPart,
    /// Transmittance below which light counts as none.
    min_transmittance: f32,
}

impl CombinedKey {
    /// Creates the key for the lights of a picture; `None` if each light keeps its own volume.
    pub fn new(request: &RenderRequest, options: &RenderOptions) -> Option<Self> {
        let settings: &Settings = &request.settings;
        // A preview moves only one light, and reuses the volumes of the others.
        (settings.combines_lights() && request.preview_resolution.is_none()).then(|| Self {
            lights: ActiveLights::from_settings(settings)
                .shadowed()
                .iter()
                .map(|lit| (LightAppearance::new(&lit.light), LightKey::new(request, lit.index)))
                .collect(),
            received: LightLookupKey::new(settings),
            surface_gradient: settings.shading.surface_gradient,
            unit: settings.layer().opacity_unit,
            amid: settings.light_amid_material(),
            sides: (settings.shading.sides == LitSides::One).then(|| EyeTableKey::new(settings)),
            seen: settings.cuts.visible_part(),
            min_transmittance: options.switches.min_transmittance,
        })
    }
}
