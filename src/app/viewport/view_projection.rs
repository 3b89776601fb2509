//! View projection: mapping from the scene to the window and back, for a camera over the picture's rectangle.

use eframe::egui::{Pos2, Rect, vec2};
use glam::DVec3;

use chiaroscuro_scene::Camera;

/// Camera together with the picture's rectangle in the window, in points.
#[derive(Debug, Clone)]
pub(crate) struct ViewProjection {
    /// Camera that the picture is seen through.
    pub camera: Camera,
    /// Rectangle of the picture, in points.
    pub picture: Rect,
}

impl ViewProjection {
    fn size(&self) -> (f64, f64) {
        (f64::from(self.picture.width()), f64::from(self.picture.height()).max(1.0))
    }

    /// Projects a scene point to the window, in points; `None` behind the eye.
    pub(crate) fn project(&self, scene: DVec3) -> Option<Pos2> {
        let (width, height) = self.size();
        let (x, y, _) = self.camera.pixel_from_scene(scene, width, height)?;
        Some(self.picture.min + vec2(x as f32, y as f32))
    }

    /// Returns the viewing ray through a point of the window: origin and unit direction, in scene space.
    pub(crate) fn ray(&self, at: Pos2) -> (DVec3, DVec3) {
        let (width, height) = self.size();
        let offset = at - self.picture.min;
        self.camera.ray_through(f64::from(offset.x), f64::from(offset.y), width, height)
    }

    /// Returns the position on a line, in lengths of `along`, that is nearest to the viewing ray through a point of
    /// the window; `None` if the line is parallel to the ray.
    pub(crate) fn nearest_on_line(&self, at: Pos2, from: DVec3, along: DVec3) -> Option<f64> {
        let (origin, direction) = self.ray(at);
        let between = from - origin;
        // Component of the line's direction perpendicular to the ray; the shorter it is, the less accurate the
        // position.
        let across = along - direction * along.dot(direction);
        let sharpness = across.dot(along);
        (sharpness > 1e-4 * along.length_squared()).then(|| -across.dot(between) / sharpness)
    }
}

#[cfg(test)]
mod tests {
    use eframe::egui::pos2;

    use super::*;
    use chiaroscuro_scene::Projection;

    #[test]
    fn lines_are_followed_under_the_pointer() {
        for projection in [Projection::Perspective, Projection::Orthographic] {
            let picture = Rect::from_min_size(pos2(10.0, 20.0), vec2(640.0, 480.0));
            let view_projection =
                ViewProjection { camera: Camera { projection, ..Camera::default() }, picture };
            let (from, along) = (DVec3::new(0.2, -0.3, 0.1), DVec3::new(0.0, 0.4, 0.5));
            for share in [-0.7, 0.0, 1.2] {
                let at = view_projection.project(from + along * share).unwrap();
                let found = view_projection.nearest_on_line(at, from, along).unwrap();
                assert!((found - share).abs() < 1e-4, "{projection:?}: {found}, expected {share}");
            }
            let (_, direction) = view_projection.ray(pos2(330.0, 260.0));
            assert_eq!(view_projection.nearest_on_line(pos2(330.0, 260.0), DVec3::ZERO, direction), None);
        }
    }
}
