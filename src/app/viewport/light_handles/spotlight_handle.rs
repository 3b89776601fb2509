//! Handle on the rim of a spotlight's cone: dragging it changes the cone's angle.

use std::f64::consts::FRAC_PI_4;
use std::ops::RangeInclusive;

use eframe::egui::{Id, Painter, Rect, Stroke, StrokeKind, Ui, Vec2};
use glam::DVec3;

use super::geometry::LightHandleView;
use super::small_handle::interact_small_handle;
use crate::app::common::theme;
use crate::app::text;
use chiaroscuro_scene::{LightGeometry, SceneLight, Spotlight};

/// Range of half angles that can be dragged, in degrees; the same as in the side panel.
const HALF_ANGLES_DEG: RangeInclusive<f64> = 1.0..=89.0;

/// Half the edge length of the handle, in points.
const HALF_EDGE: f32 = 5.0;

/// Returns true if the light is a spotlight with a visible cone.
fn has_cone(light: &SceneLight) -> bool {
    light.kind == LightGeometry::Perspective && light.hood.on
}

/// Candidate positions of the handle along the cone, as fractions of the depth of the volume's centre.
const LENGTH_FRACTIONS: [f64; 4] = [1.0, 0.7, 0.45, 0.25];

/// Candidate positions around the cone, in eighths of a turn from the right: sides before corners.
const ANGLE_EIGHTHS: [u8; 8] = [0, 4, 2, 6, 1, 3, 5, 7];

/// Position on a cone: a line from its tip, and a fraction of its length.
#[derive(Debug, Clone, Copy, PartialEq)]
struct ConePosition {
    eighth: u8,
    share: f64,
}

impl ConePosition {
    /// Unit vector perpendicular to the cone's axis, towards the line.
    fn radial_direction(self, view: &LightHandleView, light: &SceneLight) -> DVec3 {
        let axis = light.direction();
        let right = view.right_axis().reject_from(axis).normalize_or(axis.any_orthonormal_vector());
        let (sin, cos) = (f64::from(self.eighth) * FRAC_PI_4).sin_cos();
        right * cos + axis.cross(right) * sin
    }

    fn scene_point(self, view: &LightHandleView, light: &SceneLight) -> DVec3 {
        let position = DVec3::from(light.position);
        let slope = light.hood.half_angle_deg.to_radians().tan();
        position
            + (self.radial_direction(view, light) * slope - light.direction())
                * position.length()
                * self.share
    }

    /// Returns the first candidate that lies in the picture, as far from the light as possible.
    fn first_visible(view: &LightHandleView, light: &SceneLight) -> Option<Self> {
        let spots =
            LENGTH_FRACTIONS.iter().flat_map(|&share| ANGLE_EIGHTHS.map(|eighth| Self { eighth, share }));
        let is_seen =
            |spot: &Self| view.project(spot.scene_point(view, light)).is_some_and(|at| view.contains(at));
        spots.into_iter().find(is_seen)
    }

    /// Returns the half angle of the cone through a point, in degrees; the smallest one if the point is across the
    /// axis.
    fn half_angle_deg(self, view: &LightHandleView, light: &SceneLight, through: DVec3) -> f64 {
        let ray = through - DVec3::from(light.position);
        let is_beyond = ray.dot(self.radial_direction(view, light)) < 0.0;
        let angle = if is_beyond { 0.0 } else { (-light.direction()).angle_between(ray).to_degrees() };
        angle.clamp(*HALF_ANGLES_DEG.start(), *HALF_ANGLES_DEG.end())
    }
}

/// State of the spotlight handle between frames.
#[derive(Debug, Default)]
pub(crate) struct SpotlightHandle {
    /// Position on the cone of the drag in progress.
    dragged: Option<ConePosition>,
    /// True if the pointer is on the handle or drags it.
    active: bool,
}

impl SpotlightHandle {
    /// Returns true if the pointer is on the handle or drags it.
    pub(crate) fn is_active(&self) -> bool {
        self.active
    }

    /// Shows the handle of a light in scene space. Returns the half angle that it is dragged to, in degrees.
    pub(crate) fn show(
        &mut self,
        ui: &Ui,
        painter: &Painter,
        view: &LightHandleView,
        light: &SceneLight,
        name: &str,
        index: usize,
    ) -> Option<f64> {
        let dragged = self.dragged.take();
        self.active = false;
        let spot =
            dragged.or_else(|| ConePosition::first_visible(view, light)).filter(|_| has_cone(light))?;
        let at = spot.scene_point(view, light);
        let seen = view.project(at)?;
        let name = text::lights::spotlight_handle(name);
        let grip = interact_small_handle(ui, seen, HALF_EDGE, Id::unique("hood handle").with(index), &name);
        self.dragged = grip.is_dragged.then_some(spot);
        self.active = grip.is_active;
        let edge = Vec2::splat(2.0 * HALF_EDGE + if self.active { 2.0 } else { 0.0 });
        let square = Rect::from_center_size(seen, edge);
        let outline = Stroke::new(1.5, theme::OUTLINE);
        painter.rect(square, 1.0, theme::color(light.color), outline, StrokeKind::Outside);
        let half_angle_deg =
            spot.half_angle_deg(view, light, view.point_on_facing_plane(at, grip.moved_to?)?);
        // Never so far that the handle could not be grabbed any more.
        let hood = Spotlight { half_angle_deg, ..light.hood };
        let moved = spot.scene_point(view, &SceneLight { hood, ..*light });
        view.project(moved).is_some_and(|at| view.contains(at)).then_some(half_angle_deg)
    }
}

#[cfg(test)]
mod tests {
    use eframe::egui::Pos2;

    use super::*;
    use chiaroscuro_scene::Camera;

    #[test]
    fn the_cone_follows_the_pointer() {
        let picture = Rect::from_min_size(Pos2::new(10.0, 20.0), Vec2::new(800.0, 600.0));
        let view = LightHandleView::new(Camera::default(), picture, 1.2);
        let mut light = SceneLight {
            kind: LightGeometry::Perspective,
            position: [0.4, -1.1, 2.0],
            hood: Spotlight { on: true, half_angle_deg: 20.0, rim_deg: 5.0 },
            ..SceneLight::default()
        };
        let spot = ConePosition::first_visible(&view, &light).unwrap();
        assert_eq!(spot, ConePosition { eighth: 0, share: 1.0 });
        let at = spot.scene_point(&view, &light);
        let seen = view.project(at).unwrap();
        assert!((spot.half_angle_deg(&view, &light, at) - 20.0).abs() < 1e-9, "where it is, nothing changes");
        assert!(seen.x > view.project(DVec3::ZERO).unwrap().x, "on the right");
        let wider = view.point_on_facing_plane(at, seen + Vec2::new(40.0, 0.0)).unwrap();
        let angle = spot.half_angle_deg(&view, &light, wider);
        assert!(angle > 21.0);
        light.hood.half_angle_deg = angle;
        let followed = view.project(spot.scene_point(&view, &light)).unwrap();
        assert!((followed - seen).x > 20.0, "{:?}", followed - seen);
        let beyond = view.point_on_facing_plane(at, seen - Vec2::new(500.0, 0.0)).unwrap();
        let closed = spot.half_angle_deg(&view, &light, beyond);
        assert_eq!(closed, 1.0, "closed, and not open to the other side");
        // At any position of the light, some spot of its cone can be grabbed.
        for position in [[0.0, 0.0, 6.0], [4.0, 3.0, 2.0], [-5.0, 0.1, 0.0], [0.0, 3.0, -1.0]] {
            let light = SceneLight { position, ..light };
            let spot = ConePosition::first_visible(&view, &light).expect("a spot");
            assert!(view.contains(view.project(spot.scene_point(&view, &light)).unwrap()));
        }
        light.hood.on = false;
        assert!(!has_cone(&light));
    }
}
