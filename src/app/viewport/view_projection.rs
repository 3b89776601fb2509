//! From the scene to the window and back: the camera over the picture's rectangle.

use eframe::egui::{Pos2, Rect, vec2};
use glam::DVec3;

use crate::model::Camera;

/// The camera over the picture's rectangle, in points.
#[derive(Debug, Clone)]
pub(crate) struct ViewProjection {
    /// Where the eye is.
    pub camera: Camera,
    /// In points.
    pub picture: Rect,
}

impl ViewProjection {
    fn size(&self) -> (f64, f64) {
        (f64::from(self.picture.width()), f64::from(self.picture.height()).max(1.0))
    }

    /// Where a scene point is seen; `None` behind the eye.
    pub(crate) fn point(&self, scene: DVec3) -> Option<Pos2> {
        let (width, height) = self.size();
        let (x, y, _) = self.camera.pixel_from_scene(scene, width, height)?;
        Some(self.picture.min + vec2(x as f32, y as f32))
    }

    /// The line of sight through a point of the window: origin and unit direction, in scene space.
    pub(crate) fn ray(&self, at: Pos2) -> (DVec3, DVec3) {
        let (width, height) = self.size();
        let offset = at - self.picture.min;
        self.camera.ray_through(f64::from(offset.x), f64::from(offset.y), width, height)
    }

    /// How far along a line (in lengths of `along`) it comes nearest to what is under a point of the window;
    /// `None` where the eye looks along the line.
    pub(crate) fn along(&self, at: Pos2, from: DVec3, along: DVec3) -> Option<f64> {
        let (origin, direction) = self.ray(at);
        let between = from - origin;
        // The line's own part across the line of sight: with its length goes how well the place is known.
        let across = along - direction * along.dot(direction);
        let sharpness = across.dot(along);
        (sharpness > 1e-4 * along.length_squared()).then(|| -across.dot(between) / sharpness)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::Projection;
    use eframe::egui::pos2;

    #[test]
    fn lines_are_followed_under_the_pointer() {
        for projection in [Projection::Perspective, Projection::Orthographic] {
            let picture = Rect::from_min_size(pos2(10.0, 20.0), vec2(640.0, 480.0));
            let view_projection =
                ViewProjection { camera: Camera { projection, ..Camera::default() }, picture };
            let (from, along) = (DVec3::new(0.2, -0.3, 0.1), DVec3::new(0.0, 0.4, 0.5));
            for share in [-0.7, 0.0, 1.2] {
                let at = view_projection.point(from + along * share).unwrap();
                let found = view_projection.along(at, from, along).unwrap();
                assert!((found - share).abs() < 1e-4, "{projection:?}: {found}, expected {share}");
            }
            let (_, direction) = view_projection.ray(pos2(330.0, 260.0));
            assert_eq!(view_projection.along(pos2(330.0, 260.0), DVec3::ZERO, direction), None);
        }
    }
}
