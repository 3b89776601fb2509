//! Image-based lighting: sky and key light from an environment map.

use glam::DVec3;

use super::area_light::LightShape;
use super::sky::{EnvironmentLight, SkyMode};
use super::{LightGeometry, LightLock, LightSettings, MAX_LIGHTS};
use crate::environment_map::{BrightLight, EnvironmentMap};
use crate::{MAX_LIGHT_ANGLE_DEG, Settings, srgb_from_linear};

/// Name of the light that an environment map adds.
pub const ENVIRONMENT_LIGHT_NAME: &str = "Surroundings";

/// Distance of the added light from the centre, in scene units; only its direction matters.
const LIGHT_DISTANCE: f64 = 3.8;

/// Angular width in degrees below which a light's shadows are as sharp as those of a point.
const MIN_AREA_DEG: f64 = 0.3;

impl Settings {
    /// Lights the scene by an environment map: by a sky with its linear part, and a light for its brightest spot.
    /// Other lights are switched off; one that an earlier map added is replaced.
    ///
    /// The map is rotated so that its light comes from the side of the previous key light, which had been placed for
    /// the object. Its brightness includes the previous exposure compensation for shadows (balance), which is no
    /// longer re-measured: the map defines how bright each light is.
    pub fn apply_environment_map(&mut self, surroundings: &EnvironmentMap) {
        let up = self.camera.up;
        let upright_from_scene = up.scene_from_upright().transpose();
        let azimuth_of = |towards: DVec3| towards.y.atan2(towards.x).to_degrees();
        let key = self.lights.iter().find(|light| light.needs_volume());
        let key = key.map(|light| upright_from_scene * light.resolve(&self.camera).direction());
        let sky = &mut self.sky;
        sky.mode = SkyMode::Picture;
        // The balance applies to lights only.
        sky.intensity = surroundings.brightness * self.shadows.balance;
        sky.picture = EnvironmentLight {
            name: surroundings.name.clone(),
            mean: surroundings.mean,
            slope: surroundings.slope.map(Into::into),
        };
        sky.tilt_deg = 0.0;
        sky.turn_deg = match (key, surroundings.light) {
            (Some(key), Some(light)) => azimuth_of(key) - azimuth_of(light.direction),
            _ => 0.0,
        };
        self.lights.retain(|light| light.name != ENVIRONMENT_LIGHT_NAME);
        self.lights.iter_mut().for_each(|light| light.on = false);
        if let Some(BrightLight { direction: towards, color, intensity, angle_deg }) = surroundings.light {
            let place = self.sky.scene_from_sky(up) * towards * LIGHT_DISTANCE;
            self.lights.truncate(MAX_LIGHTS - 1);
            let shape = if angle_deg < MIN_AREA_DEG { LightShape::Point } else { LightShape::Disc };
            let light = LightSettings {
                name: ENVIRONMENT_LIGHT_NAME.to_owned(),
                kind: LightGeometry::Parallel,
                position: place.into(),
                color: color.map(|c| srgb_from_linear(c) as f32),
                // Surfaces reflect this share of lights, and all of a sky.
                intensity: intensity / self.shading.diffuse.max(0.05),
                lock: LightLock::Scene,
                shape,
                angle_deg: angle_deg.min(MAX_LIGHT_ANGLE_DEG),
                ..LightSettings::default()
            };
            self.lights.insert(0, light);
        }
        self.shadows.keep_balanced = false;
        self.sanitise();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::SceneAxis;

    fn surroundings() -> EnvironmentMap {
        EnvironmentMap {
            name: "yard.hdr".to_owned(),
            mean: [0.9, 1.0, 1.3],
            slope: [DVec3::Z * 0.2; 3],
            brightness: 0.3,
            light: Some(BrightLight {
                direction: DVec3::new(0.0, -0.6, 0.8),
                color: [1.0, 0.9, 0.5],
                intensity: 0.7,
                angle_deg: 2.0,
            }),
        }
    }

    #[test]
    fn light_comes_from_where_the_key_stood_as_high_as_in_the_picture() {
        for up in SceneAxis::ALL {
            let mut settings = Settings::default();
            settings.shadows.balance = 2.0;
            settings.camera.up = up;
            settings.lights = vec![LightSettings {
                position: (up.scene_from_upright() * DVec3::new(3.0, 0.0, 1.0)).into(),
                ..LightSettings::default()
            }];
            settings.apply_environment_map(&surroundings());
            let [light, other] = &settings.lights[..] else { panic!("{:?}", settings.lights) };
            assert!(!other.on && light.on && light.name == ENVIRONMENT_LIGHT_NAME);
            let towards = up.scene_from_upright().transpose() * DVec3::from(light.position).normalize();
            assert!((towards - DVec3::new(0.6, 0.0, 0.8)).length() < 1e-9, "{up:?}: {towards}");
            assert_eq!((settings.sky.mode, settings.sky.intensity), (SkyMode::Picture, 0.6));
            // A second map replaces the first.
            settings.apply_environment_map(&surroundings());
            assert_eq!(settings.lights.len(), 2);
        }
    }

    #[test]
    fn surroundings_without_a_light_leave_none_on() {
        let mut settings = Settings::default();
        settings.apply_environment_map(&EnvironmentMap { light: None, ..surroundings() });
        assert!(settings.lights.iter().all(|light| !light.on) && !settings.lights.is_empty());
        assert_eq!(settings.sky.picture.name, "yard.hdr");
    }

    #[test]
    fn as_many_lights_stay_as_a_picture_can_have() {
        let mut settings =
            Settings { lights: vec![LightSettings::default(); MAX_LIGHTS], ..Settings::default() };
        settings.apply_environment_map(&surroundings());
        assert_eq!(
            (settings.lights.len(), settings.lights[0].name.as_str()),
            (MAX_LIGHTS, ENVIRONMENT_LIGHT_NAME)
        );
    }
}
