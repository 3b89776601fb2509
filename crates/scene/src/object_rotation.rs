//! Object orientation: standing the object up or laying it down by rotating camera and lights in quarter turns. The
//! data are not resampled or moved.

use glam::{DMat3, DVec3};

use super::{Camera, LightLock, SceneAxis, Settings};

/// Rotation of the object, as the viewer perceives it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ObjectRotation {
    /// Quarter turn about the horizontal axis across the image, top away from the viewer: what stood lies on its
    /// back.
    TipBack,
    /// Rotation that makes the given scene axis point up.
    MakeUpright(SceneAxis),
}

/// Rotation of camera and lights, opposite to the object's apparent rotation: whole quarter turns about scene axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CameraLightRotation(DMat3);

/// Returns the rotation by a quarter turn about a scene axis.
fn quarter_turn(axis: SceneAxis) -> DMat3 {
    rounded_matrix(DMat3::from_axis_angle(axis.direction(), std::f64::consts::FRAC_PI_2))
}

/// Rounds a matrix's elements to integers, which removes rounding errors from quarter turns.
fn rounded_matrix(matrix: DMat3) -> DMat3 {
    DMat3::from_cols(matrix.x_axis.round(), matrix.y_axis.round(), matrix.z_axis.round())
}

impl Camera {
    /// Returns the horizontal scene axis that is nearest to the camera's right.
    fn horizontal_right_axis(&self) -> SceneAxis {
        let right = self.scene_from_view().x_axis;
        SceneAxis::nearest(right.reject_from(self.up.direction()))
    }

    /// Returns the rotation of camera and lights that makes the object appear to turn as requested from this camera.
    pub fn rotation_for(&self, turn: ObjectRotation) -> CameraLightRotation {
        CameraLightRotation(match turn {
            ObjectRotation::TipBack => quarter_turn(self.horizontal_right_axis()),
            ObjectRotation::MakeUpright(up) => {
                let (from, to) = (self.up.direction(), up.direction());
                let across = from.cross(to);
                if across != DVec3::ZERO {
                    quarter_turn(SceneAxis::nearest(across))
                } else if from == to {
                    DMat3::IDENTITY
                } else {
                    let half = quarter_turn(self.horizontal_right_axis());
                    half * half
                }
            }
        })
    }

    /// Rotates the camera together with the lights.
    fn rotate(&mut self, room: DMat3) {
        let upright = room * self.up.scene_from_upright();
        self.up = SceneAxis::nearest(upright.z_axis);
        // The remaining rotation is one about the vertical axis.
        let about_up = self.up.scene_from_upright().transpose() * upright;
        let angle_deg = about_up.x_axis.y.atan2(about_up.x_axis.x).to_degrees().round();
        self.azimuth_deg = (self.azimuth_deg + angle_deg).rem_euclid(360.0);
    }
}

impl Settings {
    /// Rotates camera and lights, so that the object appears to turn the other way about the camera's target.
    /// Clipping stays with the data, and the floor keeps its distance from the centre of the scene.
    pub fn rotate_camera_and_lights(&mut self, CameraLightRotation(room): CameraLightRotation) {
        // Angles would be normalised to their ranges, which would count as a change.
        if room == DMat3::IDENTITY {
            return;
        }
        self.camera.rotate(room);
        for light in self.lights.iter_mut().filter(|light| light.lock == LightLock::Scene) {
            light.position = (room * DVec3::from(light.position)).into();
        }
    }

    /// Turns the object as the viewer perceives it, by rotating camera and lights the opposite way.
    pub fn rotate_object(&mut self, turn: ObjectRotation) {
        self.rotate_camera_and_lights(self.camera.rotation_for(turn));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{LightingRig, Projection};

    fn looks() -> impl Iterator<Item = Settings> {
        SceneAxis::ALL.into_iter().flat_map(|up| {
            [-60.0, 10.0, 100.0, 190.0, 300.0].map(|azimuth_deg| {
                let camera = Camera { up, azimuth_deg, roll_deg: 5.0, ..Camera::default() };
                Settings { lights: LightingRig::KeyFillBack.lights(&camera), camera, ..Settings::default() }
            })
        })
    }

    /// Returns the light positions in view axes.
    fn seen(settings: &Settings) -> Vec<DVec3> {
        let view_from_scene = settings.camera.scene_from_view().transpose();
        let place = |light: &crate::LightSettings| DVec3::from(light.resolve(&settings.camera).position);
        settings.lights.iter().map(|light| view_from_scene * place(light)).collect()
    }

    #[test]
    fn the_object_turns_as_it_is_seen_and_light_and_view_stay() {
        for before in looks() {
            let mut after = before.clone();
            after.rotate_object(ObjectRotation::TipBack);
            for (a, b) in seen(&before).into_iter().zip(seen(&after)) {
                assert!((a - b).length() < 1e-9, "the light comes from where it came from");
            }
            assert_eq!(after.camera.elevation_deg, before.camera.elevation_deg);
            // Elevation and roll of zero, so that the scene's vertical is the image's.
            let level = |camera: &Camera| {
                let camera = Camera { elevation_deg: 0.0, roll_deg: 0.0, ..camera.clone() };
                camera.scene_from_view()
            };
            // One point of the object, in both views.
            let top = before.camera.up.direction();
            let seen_before = level(&before.camera).transpose() * top;
            let seen_after = level(&after.camera).transpose() * top;
            assert!((seen_before - DVec3::Y).length() < 1e-9);
            assert!(seen_after.z < -0.7 && seen_after.y.abs() < 1e-9, "on its back: {seen_after}");
        }
    }

    #[test]
    fn four_quarters_are_a_whole_turn() {
        for before in looks() {
            let mut after = before.clone();
            for _ in 0..4 {
                after.rotate_object(ObjectRotation::TipBack);
            }
            let camera = |settings: &Settings| settings.camera.scene_from_view();
            assert_eq!(after.camera.up, before.camera.up);
            assert!((camera(&after).z_axis - camera(&before).z_axis).length() < 1e-9);
            assert!((camera(&after).y_axis - camera(&before).y_axis).length() < 1e-9);
            for (a, b) in after.lights.iter().zip(&before.lights) {
                assert!((DVec3::from(a.position) - DVec3::from(b.position)).length() < 1e-12);
            }
        }
    }

    #[test]
    fn any_axis_can_be_stood_on_end() {
        for before in looks() {
            for up in SceneAxis::ALL {
                let mut after = before.clone();
                after.rotate_object(ObjectRotation::MakeUpright(up));
                assert_eq!(after.camera.up, up);
                for (a, b) in seen(&before).into_iter().zip(seen(&after)) {
                    assert!((a - b).length() < 1e-9);
                }
                if up == before.camera.up {
                    assert_eq!(after, before);
                }
            }
        }
    }

    #[test]
    fn the_picture_is_that_of_the_turned_object() {
        for before in looks() {
            for projection in [Projection::Perspective, Projection::Orthographic] {
                let mut after = before.clone();
                after.camera.projection = projection;
                let old = after.camera.clone();
                after.rotate_object(ObjectRotation::TipBack);
                // Quarter turn about the axis that was nearest to the right.
                let turned = |point: DVec3| quarter_turn(old.horizontal_right_axis()).transpose() * point;
                for point in [DVec3::new(0.3, -0.2, 0.5), DVec3::new(-0.6, 0.1, 0.2)] {
                    let found = after.camera.pixel_from_scene(point, 300.0, 200.0).unwrap();
                    let wanted = old.pixel_from_scene(turned(point), 300.0, 200.0).unwrap();
                    assert!((found.0 - wanted.0).abs() < 1e-9 && (found.1 - wanted.1).abs() < 1e-9);
                }
            }
        }
    }
}
