//! Key of the volume of sky visibility.

use super::table::OpacityKey;
use crate::plan::{RenderRequest, VolumeKey};
use chiaroscuro_scene::{
    ClassificationOrder, ClippedPart, LightVolumeResolution, SceneAxis, Settings, SkyMode, sky_direction_set,
};

/// Inputs of the volume of sky visibility: no colours, no brightness, no rotation.
#[derive(Debug, Clone, PartialEq)]
pub struct SkyKey {
    volume: VolumeKey,
    opacity: OpacityKey,
    classification: ClassificationOrder,
    shading_cut: ClippedPart,
    density_scale: f64,
    /// `true` if dense material has surfaces that face the sky.
    has_surfaces: bool,
    directions: u32,
    resolution: LightVolumeResolution,
    /// Resolution of a preview's volume.
    preview_resolution: LightVolumeResolution,
}

/// Maximum number of directions in previews: open planes differ by 2 % of their light (root mean square over their
/// tilts), with 6 directions by 5 %.
const PREVIEW_DIRECTIONS: u32 = 12;

impl SkyKey {
    /// Creates the key of the volume that a picture needs; `None` if nothing attenuates a sky.
    pub fn new(request: &RenderRequest) -> Option<Self> {
        let settings = &request.settings;
        settings.has_sky_volume().then(|| Self {
            volume: request.volume_key(),
            opacity: OpacityKey::new(settings),
            classification: settings.classification(),
            shading_cut: settings.cuts.shadowing_part(),
            density_scale: settings.sky.density_scale,
            has_surfaces: settings.shading.has_surfaces(),
            directions: sky_direction_set(settings.sky.directions),
            resolution: settings.shadows.soft_resolution(settings.sky.resolution, request.volume.dims),
            preview_resolution: settings
                .shadows
                .soft_resolution(LightVolumeResolution::Quarter, request.volume.dims),
        })
    }

    /// Returns the key of a preview's volume.
    #[must_use]
    pub fn for_preview(&self) -> Self {
        let directions = self.directions.min(PREVIEW_DIRECTIONS);
        Self { directions, resolution: self.preview_resolution, ..self.clone() }
    }

    /// Returns the number of directions from which light is followed.
    pub fn directions(&self) -> u32 {
        self.directions
    }

    /// Returns the resolution of the volume.
    pub fn resolution(&self) -> LightVolumeResolution {
        self.resolution
    }

    /// Returns `true` if dense material has surfaces that face the sky.
    pub fn has_surfaces(&self) -> bool {
        self.has_surfaces
    }

    /// Returns the factor of the extinction.
    pub fn density_scale(&self) -> f64 {
        self.density_scale
    }
}

/// Look of a sky from samples.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct SkyAppearance {
    mode: SkyMode,
    intensity: f64,
    colors: [[f32; 3]; 3],
    lean_deg: [f64; 2],
    /// Mean radiance of an environment map, and its slopes.
    picture: Option<([f64; 3], [[f64; 3]; 3])>,
    /// Axis relative to which the sky is tilted.
    up: Option<SceneAxis>,
}

impl SkyAppearance {
    /// Extracts the look of the sky; `None` if there is none.
    pub(super) fn new(settings: &Settings) -> Option<Self> {
        let sky = &settings.sky;
        let is_plain = sky.mode == SkyMode::White;
        let is_gradient = sky.mode == SkyMode::Gradient;
        sky.is_on().then_some(Self {
            mode: sky.mode,
            intensity: sky.intensity,
            colors: if is_gradient { [sky.zenith, sky.horizon, sky.ground] } else { [[1.0; 3]; 3] },
            picture: (sky.mode == SkyMode::Picture).then_some((sky.picture.mean, sky.picture.slope)),
            lean_deg: if is_plain { [0.0; 2] } else { [sky.tilt_deg, sky.turn_deg] },
            up: (!is_plain).then_some(settings.camera.up),
        })
    }
}
