//! Light, material and floor of a first look, except for the positions of its lights.

use super::domain::DataDomain;
use crate::{
    AreaLightSampling, FloorSettings, LightVolumeResolution, PhongShading, ShadowSettings, SkyMode,
    SkySettings,
};

/// Ambient coefficient of a first look if its sky, which replaces ambient light, is switched off. Shadows of a key and
/// a weak fill light darken 0.155 of an object's pixels by 30 % or more then (the median of thirteen volumes), and
/// nothing is nearly black; with the default of 0.15, and a fill of 0.18, it was 0.117.
const FIRST_LOOK_AMBIENT: f64 = 0.10;

/// Returns the shading of a domain: metal has strong highlights.
pub(super) fn shading(domain: DataDomain) -> PhongShading {
    let usual = PhongShading { ambient: FIRST_LOOK_AMBIENT, ..PhongShading::default() };
    match domain {
        DataDomain::Metal => PhongShading { specular: 0.5, shininess: 48.0, ..usual },
        _ => usual,
    }
}

/// Intensity of the sky of a first look: twice the ambient light that it replaces, because hollows get less of it.
const SKY_INTENSITY: f64 = 0.2;

/// Directions of the sky of a first look, with a resolution of a quarter. Against twice the directions at half the
/// resolution they change 0.24 % of the light (RMS of a head and an engine), in a sixth of the time.
const SKY_DIRECTIONS: u32 = 48;

/// Radius of the floor of a first look, in scene units: it ends behind the object, near the horizon of usual views,
/// and beyond the other edges of the picture, so that it shows no pool of light.
const FLOOR_RADIUS: f64 = 8.0;

/// Returns the floor of a first look, which is off until its lights are known.
pub(super) fn wide_floor() -> FloorSettings {
    FloorSettings { radius: FLOOR_RADIUS, ..FloorSettings::default() }
}

/// Minimum number of blocks along the longest edge for soft light in a first look, whose resolution is a quarter:
/// volumes of fewer than 160 voxels have half of it, and of fewer than 80 all.
const LEAST_BLOCKS: u32 = 40;

/// Returns the shadows of a first look: with soft light at a quarter of the resolution, a head of 256 voxels takes 1.3 s
/// of processor time more than under a hard light, and with half of it 1.9 s.
pub(super) fn soft_shadows() -> ShadowSettings {
    let usual = ShadowSettings::default();
    let area = AreaLightSampling { resolution: LightVolumeResolution::Quarter, ..usual.area };
    ShadowSettings { area, least_blocks: LEAST_BLOCKS, ..usual }
}

/// Returns the sky of a first look.
pub(super) fn weak_sky() -> SkySettings {
    SkySettings {
        mode: SkyMode::Gradient,
        intensity: SKY_INTENSITY,
        directions: SKY_DIRECTIONS,
        resolution: LightVolumeResolution::Quarter,
        ..SkySettings::default()
    }
}

/// Returns the shading of pictures: every place is as bright as its colour, without a relief.
pub(super) fn evenly_lit() -> PhongShading {
    PhongShading { ambient: 1.0, diffuse: 0.0, specular: 0.0, ..PhongShading::default() }
}
