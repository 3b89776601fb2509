//! Light volumes that a request needs and that are not filled yet, and the light that previews leave out for them.

use chiaroscuro_render::plan::FrameKeys;
use chiaroscuro_scene::LightSimplification;

/// Light volumes that a request needs and that are not filled yet.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct MissingLightVolumes {
    /// Number of volumes that must be filled.
    pub count: usize,
    /// True if other volumes can be used as they are.
    pub has_usable: bool,
    /// Parts of the light that a slow adapter leaves out of previews.
    pub simplification: LightSimplification,
}

/// Intensity up to which a sky is weak: previews may show it as if nothing hid it until the picture is refined.
const WEAK_SKY: f64 = 0.3;

impl MissingLightVolumes {
    /// Creates the value for a request whose volumes are all there.
    pub(crate) const NONE: Self =
        Self { count: 0, has_usable: false, simplification: LightSimplification::NONE };

    /// Counts the full-quality light volumes that a picture would have to fill after the picture `last_full`; sky
    /// visibility counts as one, since it takes about as long, and multiple scattering as four. `sky_intensity` is
    /// that of the look.
    pub(crate) fn new(last_full: Option<&FrameKeys>, full: &FrameKeys, sky_intensity: f64) -> Self {
        // The first look has filled all of them.
        let Some(last_full) = last_full else { return Self::NONE };
        Self::between(last_full, full, sky_intensity)
    }

    /// Counts the light volumes of a picture of which none is filled, as of another time step.
    pub(crate) fn all_of(full: &FrameKeys, sky_intensity: f64) -> Self {
        let lights = full.lights.iter().map(|_| None).collect();
        let none = FrameKeys { lights, combined: None, sky: None, bounces: None, ..full.clone() };
        Self::between(&none, full, sky_intensity)
    }

    fn between(last_full: &FrameKeys, full: &FrameKeys, sky_intensity: f64) -> Self {
        let lights = full.count_lights_missing_in(last_full);
        let is_sky_missing = full.sky.is_some() && full.sky != last_full.sky;
        let with_open_sky = is_sky_missing && sky_intensity <= WEAK_SKY;
        let bounces = 4 * usize::from(full.bounces.is_some() && full.bounces != last_full.bounces);
        Self {
            count: lights + usize::from(is_sky_missing && !with_open_sky) + bounces,
            has_usable: full.lights.iter().flatten().count() > lights,
            simplification: LightSimplification {
                without_sizes: full.lacks_area_light_in(last_full),
                with_open_sky,
                without_bounces: false,
            },
        }
    }
}
