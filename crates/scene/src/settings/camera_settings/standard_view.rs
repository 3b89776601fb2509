//! Standard views and camera navigation: views along the axes and from a corner, zooming at the pointer, changing the
//! target.

use glam::{DVec2, DVec3};

use crate::{Camera, Projection, SceneAxis};

/// Standard view of the scene from one side or from a corner.
///
/// Its axes refer to upright space, where z is up, and turn with the up axis ([`SceneAxis::scene_from_upright`]). The
/// front of an object is not known in general.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StandardView {
    /// View from the +x side.
    PlusX,
    /// View from the −x side.
    MinusX,
    /// View from the +y side.
    PlusY,
    /// View from the −y side.
    MinusY,
    /// View from +z: from above.
    PlusZ,
    /// View from −z: from below.
    MinusZ,
    /// Isometric view from a corner: all three axes appear equally long.
    Isometric,
}

impl StandardView {
    /// All standard views, in the order of menus.
    pub const ALL: [Self; 7] =
        [Self::PlusX, Self::MinusX, Self::PlusY, Self::MinusY, Self::PlusZ, Self::MinusZ, Self::Isometric];

    /// Returns the view's name in menus, for a given up axis.
    pub fn name(self, up: SceneAxis) -> &'static str {
        let Some(side) = self.side() else { return "Isometric" };
        let [from, above, below] = match SceneAxis::nearest(up.scene_from_upright() * side.direction()) {
            SceneAxis::PlusX => ["From +x", "From above (+x)", "From below (+x)"],
            SceneAxis::MinusX => ["From −x", "From above (−x)", "From below (−x)"],
            SceneAxis::PlusY => ["From +y", "From above (+y)", "From below (+y)"],
            SceneAxis::MinusY => ["From −y", "From above (−y)", "From below (−y)"],
            SceneAxis::PlusZ => ["From +z", "From above (+z)", "From below (+z)"],
            SceneAxis::MinusZ => ["From −z", "From above (−z)", "From below (−z)"],
        };
        match self {
            Self::PlusZ => above,
            Self::MinusZ => below,
            _ => from,
        }
    }

    /// Returns the viewing side in upright space; `None` for the corner.
    fn side(self) -> Option<SceneAxis> {
        match self {
            Self::PlusX => Some(SceneAxis::PlusX),
            Self::MinusX => Some(SceneAxis::MinusX),
            Self::PlusY => Some(SceneAxis::PlusY),
            Self::MinusY => Some(SceneAxis::MinusY),
            Self::PlusZ => Some(SceneAxis::PlusZ),
            Self::MinusZ => Some(SceneAxis::MinusZ),
            Self::Isometric => None,
        }
    }

    /// Returns azimuth and elevation in degrees.
    pub(crate) fn angles_deg(self) -> [f64; 2] {
        match self {
            Self::PlusX => [0.0, 0.0],
            Self::MinusX => [180.0, 0.0],
            Self::PlusY => [90.0, 0.0],
            Self::MinusY => [270.0, 0.0],
            // +y up, as on a map.
            Self::PlusZ => [270.0, 90.0],
            Self::MinusZ => [270.0, -90.0],
            // Between +x and −y; atan(1/√2) is the angle between a cube's diagonal and its face.
            Self::Isometric => [315.0, std::f64::consts::FRAC_1_SQRT_2.atan().to_degrees()],
        }
    }

    /// Returns the standard view whose side is nearest to a direction of the scene, for a given up axis.
    pub fn nearest_side(direction: DVec3, up: SceneAxis) -> Self {
        match SceneAxis::nearest(up.scene_from_upright().transpose() * direction) {
            SceneAxis::PlusX => Self::PlusX,
            SceneAxis::MinusX => Self::MinusX,
            SceneAxis::PlusY => Self::PlusY,
            SceneAxis::MinusY => Self::MinusY,
            SceneAxis::PlusZ => Self::PlusZ,
            SceneAxis::MinusZ => Self::MinusZ,
        }
    }
}

impl Camera {
    /// Moves the camera to a standard view, at the same distance from the same target.
    pub fn set_standard_view(&mut self, view: StandardView) {
        [self.azimuth_deg, self.elevation_deg] = view.angles_deg();
        self.roll_deg = 0.0;
    }

    /// Moves the camera as [`Self::set_standard_view`], for a body, whose front is known: the corner is one between
    /// its front and its head.
    pub fn set_standard_view_of_body(&mut self, view: StandardView) {
        self.set_standard_view(view);
        if view != StandardView::Isometric {
            return;
        }
        // In the scene of a body, +y is its front and +z its head.
        let shows = |camera: &Self| {
            let eye = camera.scene_from_view().z_axis;
            eye.y + eye.z
        };
        let [first, _] = view.angles_deg();
        for quarter in 1..4 {
            let other = Self { azimuth_deg: (first + 90.0 * f64::from(quarter)) % 360.0, ..self.clone() };
            // Two corners show equally much; rounding must not choose between them.
            if shows(&other) > shows(self) + 1e-9 {
                *self = other;
            }
        }
    }

    /// Switches between perspective and orthographic projection.
    pub fn toggle_projection(&mut self) {
        self.projection = match self.projection {
            Projection::Perspective => Projection::Orthographic,
            Projection::Orthographic => Projection::Perspective,
        };
    }

    /// Frames the same region as another camera, from the direction of this one.
    pub fn copy_framing(&mut self, other: &Self) {
        self.target = other.target;
        self.fit = other.fit;
        // The same width at the target, regardless of the field of view.
        let ratio = (other.fov_y_deg.to_radians() / 2.0).tan() / (self.fov_y_deg.to_radians() / 2.0).tan();
        self.distance = other.distance * ratio;
    }

    /// Zooms by `factor` (below 1: nearer) so that a point in the target's plane stays at its pixel, in an image of
    /// `size` pixels.
    pub fn zoom_at(&mut self, factor: f64, pixel: DVec2, size: DVec2) {
        let before = self.distance;
        let unit = self.pixel_at_target(size.x, size.y.max(1.0));
        let view = self.scene_from_view();
        let aside =
            view.x_axis * ((pixel.x - size.x / 2.0) * unit) + view.y_axis * ((size.y / 2.0 - pixel.y) * unit);
        self.zoom(factor);
        let share = 1.0 - self.distance / before;
        self.target = (DVec3::from(self.target) + aside * share).into();
    }

    /// Makes a point the orbit centre without rotating the camera: the image stays the same, unless the point is
    /// off-centre; then it moves to the middle.
    pub fn set_orbit_centre(&mut self, point: DVec3) {
        let view = self.scene_from_view();
        let depth = (self.position() - point).dot(view.z_axis);
        if self.projection == Projection::Perspective && depth > 1e-3 {
            self.distance = depth.clamp(0.05, 100.0);
        }
        self.target = point.into();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::FovReference;

    #[test]
    fn the_corner_of_a_body_shows_its_front_and_its_head() {
        for up in SceneAxis::ALL {
            let mut camera = Camera { up, ..Camera::default() };
            camera.set_standard_view_of_body(StandardView::Isometric);
            let eye = camera.scene_from_view().z_axis;
            // The third axis is equally visible, on the right or on the left of the body.
            assert!(eye.abs().abs_diff_eq(DVec3::splat(3f64.sqrt().recip()), 1e-9), "{up:?}: {eye}");
            let is_lying_down = matches!(up, SceneAxis::MinusY | SceneAxis::MinusZ);
            assert!(is_lying_down || (eye.y > 0.0 && eye.z > 0.0), "{up:?}: {eye}");
        }
        // Side views are unchanged.
        let (mut body, mut other) = (Camera::default(), Camera::default());
        body.set_standard_view_of_body(StandardView::PlusX);
        other.set_standard_view(StandardView::PlusX);
        assert_eq!(body, other);
    }

    #[test]
    fn sides_are_seen_from_where_their_names_say() {
        let signs = [("+x", DVec3::X), ("+y", DVec3::Y), ("+z", DVec3::Z)];
        let minus = [("−x", DVec3::NEG_X), ("−y", DVec3::NEG_Y), ("−z", DVec3::NEG_Z)];
        for up in SceneAxis::ALL {
            for (sign, from) in signs.into_iter().chain(minus) {
                let view = StandardView::nearest_side(from, up);
                let name = view.name(up);
                assert!(name.contains(sign), "{up:?}: {name} for {sign}");
                let mut camera = Camera { up, roll_deg: 20.0, ..Camera::default() };
                camera.set_standard_view(view);
                let axes = camera.scene_from_view();
                assert!((axes.z_axis - from).length() < 1e-9, "{view:?}");
                let is_level = from.dot(up.direction()) == 0.0;
                assert_eq!(is_level, !name.contains("above") && !name.contains("below"), "{name}");
                assert_eq!(name.contains("above"), from == up.direction(), "{name}");
                if is_level {
                    assert!((axes.y_axis - up.direction()).length() < 1e-9, "{view:?} is upright");
                }
            }
        }
        let mut camera = Camera::default();
        camera.set_standard_view(StandardView::Isometric);
        let towards = camera.scene_from_view().z_axis;
        assert!((towards - DVec3::new(1.0, -1.0, 1.0).normalize()).length() < 1e-9);
    }

    #[test]
    fn the_point_under_the_pointer_stays_when_zooming() {
        for projection in [Projection::Perspective, Projection::Orthographic] {
            for (fit, size) in [
                (FovReference::Height, DVec2::new(640.0, 480.0)),
                (FovReference::Frame, DVec2::new(200.0, 480.0)),
            ] {
                let mut camera = Camera { projection, fit, target: [0.2, -0.1, 0.3], ..Camera::default() };
                let view = camera.scene_from_view();
                // Point in the plane through the target.
                let point = DVec3::from(camera.target) + 0.4 * view.x_axis - 0.3 * view.y_axis;
                let (x, y, _) = camera.pixel_from_scene(point, size.x, size.y).unwrap();
                camera.zoom_at(0.6, DVec2::new(x, y), size);
                let (x1, y1, _) = camera.pixel_from_scene(point, size.x, size.y).unwrap();
                assert!((x1 - x).abs() < 1e-9 && (y1 - y).abs() < 1e-9, "{camera:?}: {x} {y} → {x1} {y1}");
            }
        }
    }

    #[test]
    fn a_new_middle_keeps_the_size_of_what_is_seen_there() {
        let mut camera = Camera::default();
        let view = camera.scene_from_view();
        let point = DVec3::from(camera.target) + 0.5 * view.z_axis + 0.1 * view.x_axis;
        let eye = camera.position();
        camera.set_orbit_centre(point);
        let (x, y, _) = camera.pixel_from_scene(point, 640.0, 480.0).unwrap();
        assert!((x - 320.0).abs() < 1e-9 && (y - 240.0).abs() < 1e-9);
        assert!(((camera.position() - eye).dot(view.z_axis)).abs() < 1e-9, "no nearer, no further");
    }

    #[test]
    fn framing_as_another_keeps_the_direction() {
        let other = Camera {
            distance: 4.0,
            fov_y_deg: 30.0,
            target: [0.1, 0.0, 0.0],
            fit: FovReference::Frame,
            ..Camera::default()
        };
        let mut camera = Camera { azimuth_deg: 10.0, fov_y_deg: 60.0, distance: 9.0, ..Camera::default() };
        camera.copy_framing(&other);
        for aspect in [2.0, 0.5] {
            let (found, wanted) = (camera.half_height_at_target(aspect), other.half_height_at_target(aspect));
            assert!((found - wanted).abs() < 1e-9, "{aspect}: {found}, not {wanted}");
        }
        assert_eq!((camera.azimuth_deg, camera.target), (10.0, other.target));
    }
}
