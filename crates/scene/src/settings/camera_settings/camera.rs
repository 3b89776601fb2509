//! Orbit camera in scene space: projection, framing, orbiting, panning, zooming and picking rays.

use glam::{DMat3, DVec3};
use serde::{Deserialize, Serialize};

use super::scene_axis::SceneAxis;

/// Camera projection: perspective or orthographic.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Projection {
    /// Perspective projection: rays meet at the camera position.
    Perspective,
    /// Orthographic projection: rays are parallel, and the scale is that of the perspective projection at the target.
    Orthographic,
}

/// Aspect ratio of the frame of [`FovReference::Frame`]: between those of screens and of pages.
pub const FRAME_ASPECT: f64 = 4.0 / 3.0;

/// Reference of the field of view: decides what is visible in images of different aspect ratios.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum FovReference {
    /// Height of the image. Narrow images show less at the sides.
    #[default]
    Height,
    /// Height of the largest 4:3 frame in the middle of the image, which is entirely visible at any aspect ratio:
    /// narrow images show more above and below.
    Frame,
}

/// Camera that orbits a target, upright in a scene in which one axis points up.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Camera {
    /// Projection: perspective or orthographic.
    pub projection: Projection,
    /// Scene axis that points up. Azimuth and elevation refer to the scene rotated accordingly
    /// ([`SceneAxis::scene_from_upright`]), and the floor lies below along this axis; the data are not moved. Cameras
    /// saved before the setting existed have z up.
    #[serde(default)]
    pub up: SceneAxis,
    /// Azimuth in degrees of the direction from the target to the camera; with z up, counted from +x towards +y.
    pub azimuth_deg: f64,
    /// Elevation in degrees of the direction from the target to the camera, above the horizontal plane; above 90 it
    /// passes over the top.
    pub elevation_deg: f64,
    /// Roll in degrees about the viewing axis.
    pub roll_deg: f64,
    /// Point in the middle of the image, in scene units.
    pub target: [f64; 3],
    /// Distance from the target to the camera, in scene units.
    pub distance: f64,
    /// Full vertical field of view in degrees, of the image or of its frame, as selected by `fit`.
    pub fov_y_deg: f64,
    /// Reference of the field of view. Cameras saved before the setting existed refer to the height.
    #[serde(default)]
    pub fit: FovReference,
}

impl Camera {
    /// Returns the camera's right, up and backward axes (from the target to the camera) as columns, in scene space.
    ///
    /// Built from rotations alone, so that it has no pole: orbiting over the top continues.
    pub fn scene_from_view(&self) -> DMat3 {
        let azimuth = DMat3::from_rotation_z(self.azimuth_deg.to_radians());
        let elevation = DMat3::from_rotation_y(-self.elevation_deg.to_radians());
        // At azimuth 0 and elevation 0 the camera is on +x and looks along −x with z up: right is +y.
        let looking_along_minus_x = DMat3::from_cols(DVec3::Y, DVec3::Z, DVec3::X);
        let roll = DMat3::from_rotation_z(self.roll_deg.to_radians());
        self.up.scene_from_upright() * azimuth * elevation * looking_along_minus_x * roll
    }

    /// Interpolates towards another camera, taking the shorter way around; `None` if projection, up axis or fit
    /// differ.
    pub fn interpolate(&self, other: &Self, share: f64) -> Option<Self> {
        let is_alike = (self.projection, self.up, self.fit) == (other.projection, other.up, other.fit);
        let mix = |from: f64, to: f64| from + (to - from) * share;
        let turned = |from: f64, to: f64| mix(from, from + (to - from + 180.0).rem_euclid(360.0) - 180.0);
        is_alike.then(|| Self {
            azimuth_deg: turned(self.azimuth_deg, other.azimuth_deg),
            elevation_deg: turned(self.elevation_deg, other.elevation_deg),
            roll_deg: turned(self.roll_deg, other.roll_deg),
            target: std::array::from_fn(|axis| mix(self.target[axis], other.target[axis])),
            // Geometric interpolation, so that the apparent size changes at an even rate.
            distance: self.distance * (other.distance / self.distance).powf(share),
            fov_y_deg: mix(self.fov_y_deg, other.fov_y_deg),
            ..self.clone()
        })
    }

    /// Returns the camera position in scene space.
    pub fn position(&self) -> DVec3 {
        DVec3::from(self.target) + self.scene_from_view().z_axis * self.distance
    }

    /// Returns half the height at the target, in scene units, of an image with the given aspect ratio.
    pub fn half_height_at_target(&self, aspect: f64) -> f64 {
        let heights_per_frame = match self.fit {
            // The frame is as wide as the image, and lower.
            FovReference::Frame if aspect > 0.0 && aspect < FRAME_ASPECT => FRAME_ASPECT / aspect,
            FovReference::Frame | FovReference::Height => 1.0,
        };
        self.distance * (self.fov_y_deg.to_radians() / 2.0).tan() * heights_per_frame
    }

    /// Returns the edge of a pixel at the target, in scene units.
    pub fn pixel_at_target(&self, width: f64, height: f64) -> f64 {
        2.0 * self.half_height_at_target(width / height) / height
    }

    /// Projects a scene point: returns its pixel position from the top left, and its depth along the viewing axis
    /// (positive in front of the camera). `None` behind a perspective camera.
    pub fn pixel_from_scene(&self, point: DVec3, width: f64, height: f64) -> Option<(f64, f64, f64)> {
        let offset = self.scene_from_view().transpose() * (point - self.position());
        let depth = -offset.z;
        let scale = match self.projection {
            Projection::Perspective if depth > 1e-9 => self.distance / depth,
            Projection::Perspective => return None,
            Projection::Orthographic => 1.0,
        };
        let pixels_per_unit = height / 2.0 / self.half_height_at_target(width / height);
        let x = width / 2.0 + offset.x * scale * pixels_per_unit;
        let y = height / 2.0 - offset.y * scale * pixels_per_unit;
        Some((x, y, depth))
    }

    /// Returns the ray through a pixel (from the top left): origin and unit direction, in scene space.
    pub fn ray_through(&self, x: f64, y: f64, width: f64, height: f64) -> (DVec3, DVec3) {
        let view = self.scene_from_view();
        let unit = self.pixel_at_target(width, height);
        let across = view.x_axis * ((x - width / 2.0) * unit) + view.y_axis * ((height / 2.0 - y) * unit);
        match self.projection {
            Projection::Perspective => {
                (self.position(), (across - view.z_axis * self.distance).normalize_or(-view.z_axis))
            }
            Projection::Orthographic => (self.position() + across, -view.z_axis),
        }
    }

    /// Orbits the target by a drag in degrees; the scene follows the pointer.
    pub fn orbit(&mut self, right_deg: f64, down_deg: f64) {
        self.azimuth_deg = (self.azimuth_deg - right_deg).rem_euclid(360.0);
        self.elevation_deg = (self.elevation_deg + down_deg + 180.0).rem_euclid(360.0) - 180.0;
    }

    /// Moves the target so that the scene follows a drag of `dx`, `dy` pixels (y down) in an image of the given size.
    pub fn pan(&mut self, dx: f64, dy: f64, width: f64, height: f64) {
        let view = self.scene_from_view();
        let unit = self.pixel_at_target(width, height);
        let target = DVec3::from(self.target) - view.x_axis * (dx * unit) + view.y_axis * (dy * unit);
        self.target = target.into();
    }

    /// Moves the camera nearer (`factor` below 1) or farther, within sensible limits.
    pub fn zoom(&mut self, factor: f64) {
        // From 1/50 of the volume to far enough that it is a dot.
        self.distance = (self.distance * factor).clamp(0.05, 100.0);
    }
}

impl Default for Camera {
    /// Returns a three-quarter view from above.
    fn default() -> Self {
        Self {
            projection: Projection::Perspective,
            up: SceneAxis::PlusZ,
            azimuth_deg: -60.0,
            elevation_deg: 28.0,
            roll_deg: 0.0,
            target: [0.0; 3],
            distance: 5.2,
            fov_y_deg: 30.0,
            fit: FovReference::Height,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_view_leads_to_another_by_the_shorter_way() {
        let from = Camera { azimuth_deg: 170.0, distance: 2.0, ..Camera::default() };
        let to = Camera { azimuth_deg: -170.0, distance: 8.0, target: [0.0, 0.0, 0.4], ..Camera::default() };
        let half = from.interpolate(&to, 0.5).unwrap();
        assert!((half.azimuth_deg - 180.0).abs() < 1e-9 && (half.distance - 4.0).abs() < 1e-9, "{half:?}");
        assert!((half.target[2] - 0.2).abs() < 1e-9);
        assert_eq!(from.interpolate(&to, 0.0), Some(from.clone()));
        let end = from.interpolate(&to, 1.0).unwrap();
        assert!((end.scene_from_view().z_axis - to.scene_from_view().z_axis).length() < 1e-9);
        // Cameras with different projections cannot be interpolated.
        assert_eq!(from.interpolate(&Camera { projection: Projection::Orthographic, ..to }, 0.5), None);
    }

    #[test]
    fn axes_are_right_up_backward() {
        let camera = Camera { azimuth_deg: -90.0, elevation_deg: 0.0, ..Camera::default() };
        let view = camera.scene_from_view();
        assert!((view.x_axis - DVec3::X).length() < 1e-12, "from −y, right is +x");
        assert!((view.y_axis - DVec3::Z).length() < 1e-12);
        assert!((view.z_axis + DVec3::Y).length() < 1e-12);
        assert!((camera.position() - DVec3::new(0.0, -5.2, 0.0)).length() < 1e-12);
    }

    /// Returns cameras with every combination of projection and fit.
    fn cameras() -> impl Iterator<Item = Camera> {
        [Projection::Perspective, Projection::Orthographic].into_iter().flat_map(|projection| {
            [FovReference::Height, FovReference::Frame].map(|fit| Camera {
                projection,
                fit,
                roll_deg: 20.0,
                target: [0.1, 0.2, -0.3],
                ..Camera::default()
            })
        })
    }

    #[test]
    fn pixels_and_rays_agree() {
        for camera in cameras() {
            for (width, height) in [(640.0, 480.0), (300.0, 300.0), (90.0, 160.0), (100.0, 400.0)] {
                let point = DVec3::new(0.4, -0.7, 0.2);
                let (x, y, _) = camera.pixel_from_scene(point, width, height).unwrap();
                let (origin, direction) = camera.ray_through(x, y, width, height);
                let miss = (point - origin).reject_from(direction).length();
                assert!(miss < 1e-12, "{camera:?} misses by {miss} in {width} × {height}");
            }
        }
    }

    #[test]
    fn the_scene_follows_a_pan() {
        for mut camera in cameras() {
            // Point in the plane through the target, in which a pan moves.
            let point = DVec3::from(camera.target);
            for (width, height) in [(800.0, 600.0), (200.0, 600.0)] {
                let (x0, y0, _) = camera.pixel_from_scene(point, width, height).unwrap();
                camera.pan(30.0, -20.0, width, height);
                let (x1, y1, _) = camera.pixel_from_scene(point, width, height).unwrap();
                let miss = (x1 - x0 - 30.0).abs().max((y1 - y0 + 20.0).abs());
                assert!(miss < 1e-9, "{camera:?}: {x0} {y0} → {x1} {y1}");
            }
        }
    }

    #[test]
    fn the_angle_is_the_heights_whatever_the_shape() {
        let camera = Camera::default();
        assert_eq!(camera.fit, FovReference::Height);
        let half = camera.distance * (camera.fov_y_deg.to_radians() / 2.0).tan();
        for aspect in [3.0, FRAME_ASPECT, 1.0, 0.25] {
            assert_eq!(camera.half_height_at_target(aspect), half);
        }
    }

    #[test]
    fn a_frame_is_as_high_as_wide_pictures_and_as_wide_as_narrow_ones() {
        let height = Camera::default();
        let frame = Camera { fit: FovReference::Frame, ..Camera::default() };
        for (width, to) in [(1800.0, 600.0), (1280.0, 720.0), (640.0, 480.0), (800.0, 600.0)] {
            assert_eq!(frame.half_height_at_target(width / to), height.half_height_at_target(width / to));
        }
        let half_width = FRAME_ASPECT * height.half_height_at_target(FRAME_ASPECT);
        for aspect in [1.3, 1.0, 9.0 / 16.0, 0.25] {
            let found = frame.half_height_at_target(aspect) * aspect;
            assert!((found / half_width - 1.0).abs() < 1e-12, "{aspect}: {found}, not {half_width}");
        }
        // An invalid aspect ratio shows nothing, but numbers stay finite.
        for aspect in [0.0, -1.0, f64::NAN] {
            assert!(frame.half_height_at_target(aspect).is_finite());
        }
    }

    #[test]
    fn passing_over_the_top_keeps_turning() {
        let mut camera = Camera { elevation_deg: 89.0, ..Camera::default() };
        let before = camera.scene_from_view();
        camera.orbit(0.0, 2.0);
        let after = camera.scene_from_view();
        let turned = (before.y_axis.dot(after.y_axis)).clamp(-1.0, 1.0).acos().to_degrees();
        assert!((turned - 2.0).abs() < 1e-6, "turned by {turned} degrees");
    }
}
