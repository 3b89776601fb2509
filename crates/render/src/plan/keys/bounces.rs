//! Key of the volume of bounced light.

use super::light_lookup::LightAppearance;
use super::lit_lights::ActiveLights;
use super::sky::SkyAppearance;
use super::table::{EyeTableKey, OpacityKey};
use super::uniform_light_color::UniformLightColor;
use crate::plan::{RenderRequest, VolumeKey};
use chiaroscuro_scene::{
    ClassificationOrder, ClippedPart, LightVolumeResolution, ScatteringSettings, sky_direction_set,
};

/// Inputs of the volume of bounced light: the material with its colours, and all light.
#[derive(Debug, Clone, PartialEq)]
pub struct BouncesKey {
    volume: VolumeKey,
    opacity: OpacityKey,
    /// Colours of the material that light bounces off.
    colors: EyeTableKey,
    classification: ClassificationOrder,
    shading_cut: ClippedPart,
    /// Look of each light, with a flag for those that material attenuates.
    lights: Vec<(LightAppearance, bool)>,
    balance: f64,
    /// Number of points that represent an area light.
    points: u32,
    sky: Option<SkyAppearance>,
    emission: f64,
    /// Single colour of all light, if there is one.
    one_color: Option<UniformLightColor>,
    albedo: f64,
    density_scale: f64,
    bounces: u32,
    directions: u32,
    resolution: LightVolumeResolution,
    /// Resolution of a preview's volume.
    preview_resolution: LightVolumeResolution,
}

/// Maximum number of points for an area light: bounced light shows no edges of shadows.
const MAX_LIGHT_POINTS: u32 = 8;

/// Maximum number of bounces in previews, with as many directions: what later ones bring diffuses from them
/// nearly as well as from more.
const PREVIEW_BOUNCES: u32 = 2;
/// Maximum number of directions in previews, see [`PREVIEW_BOUNCES`].
const PREVIEW_DIRECTIONS: u32 = 12;

impl BouncesKey {
    /// Creates the key of the volume that a picture needs; `None` if no light bounces.
    pub fn new(request: &RenderRequest) -> Option<Self> {
        let settings = &request.settings;
        let ScatteringSettings {
            bounces,
            albedo,
            // Applied where the volume is looked up.
            strength: _,
            // Applies only to light that has not bounced yet.
            anisotropy: _,
            density_scale,
            directions,
            resolution,
        } = settings.scattering;
        let lights = ActiveLights::from_settings(settings);
        let has_area = lights.shadowed().iter().any(|lit| lit.light.area.is_some());
        settings.has_bounces().then(|| Self {
            volume: request.volume_key(),
            opacity: OpacityKey::new(settings),
            colors: EyeTableKey::new(settings),
            classification: settings.classification(),
            shading_cut: settings.cuts.shadowing_part(),
            lights: lights
                .all()
                .iter()
                .map(|lit| (LightAppearance::new(&lit.light), lit.is_shadowed()))
                .collect(),
            balance: settings.shadows.balance,
            points: if has_area { settings.shadows.area.samples.min(MAX_LIGHT_POINTS) } else { 1 },
            sky: SkyAppearance::new(settings),
            emission: settings.shading.emission,
            one_color: UniformLightColor::detect(settings),
            albedo,
            density_scale,
            bounces,
            directions: sky_direction_set(directions),
            resolution: settings.shadows.soft_resolution(resolution, request.volume.dims),
            preview_resolution: settings
                .shadows
                .soft_resolution(LightVolumeResolution::Quarter, request.volume.dims),
        })
    }

    /// Returns the key of a preview's volume.
    #[must_use]
    pub fn for_preview(&self) -> Self {
        Self {
            bounces: self.bounces.min(PREVIEW_BOUNCES),
            directions: self.directions.min(PREVIEW_DIRECTIONS),
            resolution: self.preview_resolution,
            points: 1,
            ..self.clone()
        }
    }

    /// Returns the single colour of all light, if there is one.
    pub fn one_color(&self) -> Option<UniformLightColor> {
        self.one_color
    }

    /// Returns the number of simulated bounces.
    pub fn bounces(&self) -> u32 {
        self.bounces
    }

    /// Returns the number of directions in which light is followed on its last bounce.
    pub fn directions(&self) -> u32 {
        self.directions
    }

    /// Returns the number of directions for all bounces except the last.
    pub fn directions_of_a_bounce(&self) -> u32 {
        ScatteringSettings::inner_bounce_directions(self.directions)
    }

    /// Returns the resolution of the volume.
    pub fn resolution(&self) -> LightVolumeResolution {
        self.resolution
    }

    /// Returns the number of points that represent an area light.
    pub fn points(&self) -> u32 {
        self.points
    }
}
