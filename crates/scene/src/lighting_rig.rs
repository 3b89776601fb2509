//! Lighting rigs: sets of lights that are known to work together, placed relative to the camera.

use glam::DVec3;

use super::{Camera, LightDirection, LightLock, LightSettings, LightShape};

/// Distance of the lights from the centre of the volume, in scene units: outside its half diagonal of at most √3.
const LIGHT_DISTANCE: f64 = 3.0;

/// Intensity of the fill light relative to a key of 1: with 0.18, shadows darkened a fifth less of the visible object
/// (of thirteen volumes, by 30 % or more), and nothing was nearly black with either.
const FILL_INTENSITY: f64 = 0.10;

/// Angular width in degrees of the lights of a first look: softboxes of half a metre from three. Shadows keep their
/// shape, and lose the hard edge of a lamp.
const SOFTBOX_DEG: f64 = 10.0;

/// Position of the rim light in view space, right, up and towards the viewer, for a key light on the left: 40° behind
/// the image plane, so that it grazes what the viewer sees, and above the middle, so that hollows stay dark.
const RIM_PLACE: [f64; 3] = [0.75, 0.5, -0.75];

/// Intensity of the rim light relative to a key of 1: its line is brighter than the side in shadow, and no brighter
/// than the side in light.
const RIM_INTENSITY: f64 = 0.6;

/// Named arrangement of lights.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LightingRig {
    /// Warm key light with a size from the upper left, and a cool rim light from behind: the lights of a first look,
    /// for which a sky brightens shadows.
    KeyAndRim,
    /// Warm key light from the upper left, and a cool fill light without shadows.
    KeyAndFill,
    /// Key, fill and a back light that draws the outline: the portrait photographer's three-point lighting.
    KeyFillBack,
    /// One hard light from far to the side, which brings out relief.
    ThreeQuarter,
    /// Two lights from behind: bright edges and a dark front.
    Rim,
    /// Sunlight from straight above, as at noon.
    FromAbove,
    /// Light at the camera that moves with it: all visible surfaces are lit, and shadows are hidden.
    Headlight,
}

impl LightingRig {
    /// All rigs in the order of menus.
    pub const ALL: [Self; 7] = [
        Self::KeyAndRim,
        Self::KeyAndFill,
        Self::KeyFillBack,
        Self::ThreeQuarter,
        Self::Rim,
        Self::FromAbove,
        Self::Headlight,
    ];

    /// Returns the rig's name in menus.
    pub fn name(self) -> &'static str {
        match self {
            Self::KeyAndRim => "Key and rim",
            Self::KeyAndFill => "Key and fill",
            Self::KeyFillBack => "Key, fill and back",
            Self::ThreeQuarter => "From the side",
            Self::Rim => "Rim",
            Self::FromAbove => "From above",
            Self::Headlight => "Headlight",
        }
    }

    /// Returns the rig's lights for a camera. All but the headlight then keep their positions in the scene.
    pub fn lights(self, camera: &Camera) -> Vec<LightSettings> {
        let view = camera.scene_from_view();
        // Coordinates are right, up and towards the camera.
        let at =
            |place: [f64; 3]| (view * (DVec3::from(place).normalize_or(DVec3::Z) * LIGHT_DISTANCE)).into();
        let [key, fill] = key_and_fill(camera, LightDirection::DEFAULT_KEY);
        let white_light = |name: &str, position, intensity| LightSettings {
            name: name.to_owned(),
            position,
            intensity,
            ..LightSettings::default()
        };
        match self {
            Self::KeyAndRim => key_and_rim(camera, LightDirection::DEFAULT_KEY).to_vec(),
            Self::KeyAndFill => vec![key, fill],
            Self::KeyFillBack => {
                let back = LightSettings {
                    color: [0.86, 0.92, 1.0],
                    ..white_light("Back", at([0.55, 0.75, -0.8]), 0.7)
                };
                vec![LightSettings { intensity: 0.9, ..key }, fill, back]
            }
            Self::ThreeQuarter => {
                vec![
                    white_light("Side", at([-0.9, 0.35, 0.3]), 1.1),
                    LightSettings { intensity: 0.1, ..fill },
                ]
            }
            Self::Rim => vec![
                white_light("Rim left", at([-0.8, 0.35, -0.6]), 1.0),
                LightSettings {
                    color: [0.8, 0.88, 1.0],
                    ..white_light("Rim right", at([0.85, 0.2, -0.6]), 0.8)
                },
                LightSettings { intensity: 0.1, ..fill },
            ],
            // Straight down, regardless of the view; a little towards the viewer, so that fronts are not black.
            Self::FromAbove => {
                let up = camera.up.direction();
                let towards_viewer = view.z_axis.reject_from(up).normalize_or(DVec3::ZERO);
                let place = (up + 0.35 * towards_viewer).normalize_or(up) * LIGHT_DISTANCE;
                vec![white_light("Sun", place.into(), 1.1), LightSettings { intensity: 0.15, ..fill }]
            }
            Self::Headlight => {
                vec![LightSettings {
                    lock: LightLock::Camera,
                    ..white_light("Headlight", [0.0, 0.0, LIGHT_DISTANCE], 1.0)
                }]
            }
        }
    }
}

/// Returns a warm key light from the given direction, and the cool fill light on the other side of the viewer.
pub fn key_and_fill(camera: &Camera, place: LightDirection) -> [LightSettings; 2] {
    let view = camera.scene_from_view();
    let at = |way: DVec3| (view * (way.normalize_or(DVec3::Z) * LIGHT_DISTANCE)).into();
    let key = LightSettings {
        name: "Key".to_owned(),
        position: at(place.view_direction()),
        color: [1.0, 0.95, 0.87],
        ..LightSettings::default()
    };
    let across = if place.is_right() { -1.0 } else { 1.0 };
    let fill = LightSettings {
        name: "Fill".to_owned(),
        position: at(DVec3::new(0.8 * across, 0.1, 0.6)),
        color: [0.74, 0.85, 1.0],
        intensity: FILL_INTENSITY,
        casts_shadows: false,
        ..LightSettings::default()
    };
    [key, fill]
}

/// Returns a warm key light with a size from the given direction, and a cool rim light behind the object on the other
/// side, which separates it from a dark background.
pub fn key_and_rim(camera: &Camera, place: LightDirection) -> [LightSettings; 2] {
    let [key, fill] = key_and_fill(camera, place);
    let across = if place.is_right() { -1.0 } else { 1.0 };
    let behind = DVec3::new(RIM_PLACE[0] * across, RIM_PLACE[1], RIM_PLACE[2]);
    let key = LightSettings { shape: LightShape::Disc, angle_deg: SOFTBOX_DEG, ..key };
    let rim = LightSettings {
        name: "Rim".to_owned(),
        shape: key.shape,
        angle_deg: key.angle_deg,
        position: (camera.scene_from_view() * (behind.normalize_or(DVec3::NEG_Z) * LIGHT_DISTANCE)).into(),
        intensity: RIM_INTENSITY,
        casts_shadows: true,
        ..fill
    };
    [key, rim]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_sun_is_above_whatever_is_up() {
        for up in crate::SceneAxis::ALL {
            let sun = LightingRig::FromAbove.lights(&Camera { up, ..Camera::default() })[0].position;
            // 0.35 towards the viewer for 1 upwards.
            assert!(DVec3::from(sun).normalize().dot(up.direction()) > 0.94, "{up:?}");
        }
    }

    #[test]
    fn the_fill_is_across_from_the_key() {
        let camera = Camera { azimuth_deg: 33.0, ..Camera::default() };
        let view = camera.scene_from_view().transpose();
        for place in LightDirection::search_candidates() {
            let [key, fill] = key_and_fill(&camera, place).map(|light| view * DVec3::from(light.position));
            assert!(key.x * fill.x < 0.0, "{place:?}");
            assert!((key.normalize() - place.view_direction()).length() < 1e-9);
        }
    }

    #[test]
    fn rigs_follow_the_camera_they_were_made_for() {
        let (front, side) = (Camera::default(), Camera { azimuth_deg: 40.0, ..Camera::default() });
        for rig in LightingRig::ALL {
            let lights = [rig.lights(&front), rig.lights(&side)];
            assert!(!lights[0].is_empty());
            for (a, b) in lights[0].iter().zip(&lights[1]) {
                let seen = |light: &LightSettings, camera: &Camera| {
                    camera.scene_from_view().transpose() * DVec3::from(light.resolve(camera).position)
                };
                assert!((seen(a, &front) - seen(b, &side)).length() < 1e-9, "{rig:?} {}", a.name);
                assert!(
                    (DVec3::from(a.position).length() - LIGHT_DISTANCE).abs() < 1e-9,
                    "{rig:?} {}",
                    a.name
                );
            }
        }
    }
}
