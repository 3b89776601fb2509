//! Key of the volume of bounced light.

use super::lit_lights::LitLights;
use super::one_color::OneColor;
use super::received::LightLook;
use super::sky::SkyLook;
use super::table::{EyeTableKey, OpacityKey};
use crate::model::{Classification, Remains, Resolution, Scattering};
use crate::plan::{Request, VolumeKey};

/// Inputs of the volume of bounced light: the material with its colours, and all light.
#[derive(Debug, Clone, PartialEq)]
pub struct BouncesKey {
    volume: VolumeKey,
    opacity: OpacityKey,
    /// Colours of the material that light bounces off.
    colors: EyeTableKey,
    classification: Classification,
    shading_cut: Remains,
    /// Look of each light, with a flag for those that material attenuates.
    lights: Vec<(LightLook, bool)>,
    balance: f64,
    /// Number of points that represent an area light.
    points: u32,
    sky: Option<SkyLook>,
    emission: f64,
    /// Single colour of all light, if there is one.
    one_color: Option<OneColor>,
    albedo: f64,
    density_scale: f64,
    bounces: u32,
    directions: u32,
    resolution: Resolution,
    /// Resolution of a preview's volume.
    previewed: Resolution,
}

/// Maximum number of points for an area light: bounced light shows no edges of shadows.
const MOST_POINTS: u32 = 8;

/// Maximum number of bounces in previews, with as many directions: the rest of the series is extrapolated from them
/// nearly as well as from more.
const PREVIEW_BOUNCES: u32 = 3;
/// Maximum number of directions in previews, see [`PREVIEW_BOUNCES`].
const PREVIEW_DIRECTIONS: u32 = 14;

impl BouncesKey {
    /// Creates the key of the volume that a picture needs; `None` if no light bounces.
    pub fn of(request: &Request) -> Option<Self> {
        let settings = &request.settings;
        let Scattering {
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
        let lights = LitLights::of(settings);
        let has_area = lights.shadowed().iter().any(|lit| lit.light.area.is_some());
        settings.has_bounces().then(|| Self {
            volume: request.shown_volume(),
            opacity: OpacityKey::of(settings),
            colors: EyeTableKey::of(settings),
            classification: settings.classification(),
            shading_cut: settings.cuts.shading(),
            lights: lights.all().iter().map(|lit| (LightLook::of(&lit.light), lit.is_shadowed())).collect(),
            balance: settings.shadows.balance,
            points: if has_area { settings.shadows.area.samples.min(MOST_POINTS) } else { 1 },
            sky: SkyLook::of(settings),
            emission: settings.shading.emission,
            one_color: OneColor::of(settings),
            albedo,
            density_scale,
            bounces,
            directions,
            resolution: settings.shadows.soft(resolution, request.volume.dims),
            previewed: settings.shadows.soft(Resolution::Quarter, request.volume.dims),
        })
    }

    /// Returns the key of a preview's volume.
    #[must_use]
    pub fn coarse(&self) -> Self {
        Self {
            bounces: self.bounces.min(PREVIEW_BOUNCES),
            directions: self.directions.min(PREVIEW_DIRECTIONS),
            resolution: self.previewed,
            points: 1,
            ..self.clone()
        }
    }

    /// Returns the single colour of all light, if there is one.
    pub fn one_color(&self) -> Option<OneColor> {
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
        Scattering::directions_of_a_bounce(self.directions)
    }

    /// Returns the resolution of the volume.
    pub fn resolution(&self) -> Resolution {
        self.resolution
    }

    /// Returns the number of points that represent an area light.
    pub fn points(&self) -> u32 {
        self.points
    }
}
