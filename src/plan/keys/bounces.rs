//! What the volume is made from that holds light which has bounced.

use super::lit_lights::LitLights;
use super::one_color::OneColor;
use super::received::LightLook;
use super::sky::SkyLook;
use super::table::{EyeTableKey, OpacityKey};
use crate::model::{Classification, Remains, Resolution, Scattering};
use crate::plan::{Request, VolumeKey};

/// Everything that bounced light is made from: what it meets, in which colours, and all light that there is.
#[derive(Debug, Clone, PartialEq)]
pub struct BouncesKey {
    volume: VolumeKey,
    opacity: OpacityKey,
    /// What it bounces off has colours.
    colors: EyeTableKey,
    classification: Classification,
    shading_cut: Remains,
    /// Each light, and whether material attenuates it.
    lights: Vec<(LightLook, bool)>,
    balance: f64,
    /// How many points stand for lights that have a size.
    points: u32,
    sky: Option<SkyLook>,
    emission: f64,
    /// That of all light, if there is one.
    one_color: Option<OneColor>,
    albedo: f64,
    density_scale: f64,
    bounces: u32,
    directions: u32,
    resolution: Resolution,
    /// That of previews.
    previewed: Resolution,
}

/// Most points that stand for a light: what has bounced shows no edge of a shadow.
const MOST_POINTS: u32 = 8;

/// Previews follow so many bounces, in so many directions: the end of the series is told from them nearly as from more.
const PREVIEW_BOUNCES: u32 = 3;
/// See [`PREVIEW_BOUNCES`].
const PREVIEW_DIRECTIONS: u32 = 14;

impl BouncesKey {
    /// The key of the volume that a picture needs; `None` where no light bounces.
    pub fn of(request: &Request) -> Option<Self> {
        let settings = &request.settings;
        let Scattering {
            bounces,
            albedo,
            // Where it is looked up.
            strength: _,
            // Of what has not bounced yet.
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

    /// The key of a preview's volume.
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

    /// The colour of all light, if there is one.
    pub fn one_color(&self) -> Option<OneColor> {
        self.one_color
    }

    /// How many bounces are followed.
    pub fn bounces(&self) -> u32 {
        self.bounces
    }

    /// In how many directions light is followed on its last bounce.
    pub fn directions(&self) -> u32 {
        self.directions
    }

    /// And on all before.
    pub fn directions_of_a_bounce(&self) -> u32 {
        Scattering::directions_of_a_bounce(self.directions)
    }

    /// How finely.
    pub fn resolution(&self) -> Resolution {
        self.resolution
    }

    /// How many points stand for lights that have a size.
    pub fn points(&self) -> u32 {
        self.points
    }
}
