//! Turntable animation: a full rotation of the camera, or of one light, around the vertical axis.

use glam::{DQuat, DVec3};

use super::Settings;

impl Settings {
    /// Returns the look after a share of a full turn, 0 … 1, of the light with the given index about the vertical
    /// axis, or of the camera if there is none. An index without a light changes nothing.
    #[must_use]
    pub fn at_turntable_angle(&self, light: Option<usize>, share: f64) -> Self {
        let mut turned = self.clone();
        match light {
            None => turned.camera.azimuth_deg = (self.camera.azimuth_deg + 360.0 * share).rem_euclid(360.0),
            Some(index) => {
                if let Some(scene_light) = turned.lights.get_mut(index) {
                    let world = DVec3::from(scene_light.resolve(&self.camera).position);
                    let turn =
                        DQuat::from_axis_angle(self.camera.up.direction(), std::f64::consts::TAU * share);
                    scene_light.set_scene_position(turn * world, &self.camera);
                }
            }
        }
        turned
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_whole_turn_ends_where_it_began() {
        let settings = Settings::default();
        for light in [None, Some(0)] {
            let (start, half, end) = (
                settings.at_turntable_angle(light, 0.0),
                settings.at_turntable_angle(light, 0.5),
                settings.at_turntable_angle(light, 1.0),
            );
            assert_ne!(half, start);
            let place = |s: &Settings| (DVec3::from(s.lights[0].position), s.camera.azimuth_deg);
            assert!((place(&start).0 - place(&end).0).length() < 1e-9);
            assert!((place(&start).1 - place(&end).1).abs() < 1e-9);
        }
        assert_eq!(
            settings.at_turntable_angle(Some(0), 0.3).lights[0].position[2],
            settings.lights[0].position[2]
        );
        assert_eq!(settings.at_turntable_angle(Some(9), 0.3), settings);
    }
}
