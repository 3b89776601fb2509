//! Geometry of light handles: their position in the window, and the light's position after a drag.

use std::f64::consts::TAU;

use eframe::egui::{Pos2, Rect, Vec2, vec2};
use glam::DVec3;

use super::theme;
use crate::app::viewport::view_projection::ViewProjection;
use chiaroscuro_scene::{Camera, LightGeometry, Projection, SceneLight};

/// Radius of the sphere that carries the handles of parallel lights, relative to the volume's radius.
const SPHERE_PER_SUPPORT: f64 = 1.15;
/// Largest radius of the handles' sphere, relative to the distance to the nearest border of the picture, so that it
/// fits.
const SPHERE_PER_VIEW: f64 = 0.9;
/// Least distance to the border that counts, as a share of half the picture's shorter side, so that panning cannot
/// shrink the sphere to nothing.
const MIN_BORDER_DISTANCE: f64 = 0.5;
/// Factor by which one notch of the wheel changes the distance of a perspective light from the eye.
const DISTANCE_PER_NOTCH: f64 = 1.06;
/// Least offset from the line of sight, relative to the distance, at which a light behind the eye gets a handle: 1°.
const MIN_LATERAL_OFFSET: f64 = 0.017;
/// Number of segments of a circle's polyline.
const CIRCLE_POINTS: usize = 96;

/// Placement of a light's handle in the picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct LightHandlePlacement {
    /// Position of the handle, in points.
    pub position: Pos2,
    /// True if the light is further from the eye than the centre of the volume.
    pub is_behind: bool,
    /// Unit vector from the handle towards the light, if the light is outside the picture.
    pub direction_outside: Option<Vec2>,
}

/// Camera over the picture's rectangle, with the sphere for handles of parallel lights.
#[derive(Debug, Clone)]
pub(crate) struct LightHandleView {
    view_projection: ViewProjection,
    radius: f64,
}

impl LightHandleView {
    /// Creates a view. `picture` is in points; `support_radius` is the volume's, in scene units.
    pub(crate) fn new(camera: Camera, picture: Rect, support_radius: f64) -> Self {
        let (width, height) = (f64::from(picture.width()), f64::from(picture.height()).max(1.0));
        // Distance from the centre of the volume to the nearest border, limited below while the centre is near the
        // border.
        let half = width.min(height) / 2.0;
        let room = camera.pixel_from_scene(DVec3::ZERO, width, height).map_or(half, |(x, y, _)| {
            x.min(width - x).min(y).min(height - y).clamp(MIN_BORDER_DISTANCE * half, half)
        });
        let tan = camera.pixel_at_target(width, height) * room * SPHERE_PER_VIEW / camera.distance;
        let fits = match camera.projection {
            // The silhouette of a sphere seen from a finite distance is larger than its radius.
            Projection::Perspective => camera.distance * tan / (1.0 + tan * tan).sqrt(),
            Projection::Orthographic => camera.distance * tan,
        };
        Self {
            view_projection: ViewProjection { camera, picture },
            radius: (SPHERE_PER_SUPPORT * support_radius).min(fits),
        }
    }

    /// Projects a scene point to the window, in points; `None` behind the eye.
    pub(crate) fn project(&self, scene: DVec3) -> Option<Pos2> {
        self.view_projection.project(scene)
    }

    /// Returns true if a window position is inside the picture, inset by the radius of a handle.
    pub(crate) fn contains(&self, at: Pos2) -> bool {
        self.view_projection.picture.shrink(theme::HANDLE_RADIUS).contains(at)
    }

    /// Returns the depth of a scene point: its distance from the eye along the viewing axis.
    fn depth(&self, scene: DVec3) -> f64 {
        (self.view_projection.camera.position() - scene)
            .dot(self.view_projection.camera.scene_from_view().z_axis)
    }

    /// Returns the handle of a light: clamped to the border for a light outside the picture, beside the eye or behind
    /// it; `None` for one directly behind the eye, which has no direction in the picture.
    pub(crate) fn handle(&self, light: &SceneLight) -> Option<LightHandlePlacement> {
        let scene = match light.kind {
            LightGeometry::Parallel => light.direction() * self.radius,
            LightGeometry::Perspective => DVec3::from(light.position),
        };
        let seen = self.project(scene).or_else(|| self.position_outside(scene))?;
        // Clamped to the border along the line from the picture's centre to the light.
        let picture = self.view_projection.picture;
        let half = (picture.size() / 2.0 - Vec2::splat(theme::LIGHT_INSET)).max(Vec2::splat(1.0));
        let out = seen - picture.center();
        let beyond = (out.x.abs() / half.x).max(out.y.abs() / half.y).max(1.0);
        let position = picture.center() + out / beyond;
        let away = seen - position;
        Some(LightHandlePlacement {
            position,
            is_behind: self.depth(scene) > self.depth(DVec3::ZERO) + 1e-9,
            // No arrow if the light is in the picture, be it in the margin that handles avoid.
            direction_outside: (!picture.contains(seen)).then(|| away.normalized()),
        })
    }

    /// Returns a position outside the picture, in the direction of a point that is not in front of the eye.
    fn position_outside(&self, scene: DVec3) -> Option<Pos2> {
        let camera = &self.view_projection.camera;
        let view = camera.scene_from_view();
        let from_eye = scene - camera.position();
        let across = vec2(from_eye.dot(view.x_axis) as f32, -from_eye.dot(view.y_axis) as f32);
        let picture = self.view_projection.picture;
        let is_aside = f64::from(across.length()) > MIN_LATERAL_OFFSET * from_eye.length();
        is_aside.then(|| picture.center() + across.normalized() * picture.size().length())
    }

    /// Unit vector to the right of the picture, in scene space.
    pub(crate) fn right_axis(&self) -> DVec3 {
        self.view_projection.camera.scene_from_view().x_axis
    }

    /// Unit vector towards the eye, in scene space.
    pub(crate) fn eye_axis(&self) -> DVec3 {
        self.view_projection.camera.scene_from_view().z_axis
    }

    /// Intersects the viewing ray of a window position with the plane through `through` that faces the eye, in scene
    /// space.
    pub(crate) fn point_on_facing_plane(&self, through: DVec3, at: Pos2) -> Option<DVec3> {
        let (origin, direction) = self.view_projection.ray(at);
        let normal = self.view_projection.camera.scene_from_view().z_axis;
        let along = (through - origin).dot(normal) / direction.dot(normal);
        along.is_finite().then(|| origin + direction * along)
    }

    /// Moves a light so that its handle lies at `to` in the window.
    pub(crate) fn move_light(&self, light: &mut SceneLight, to: Pos2, behind: bool) {
        let (origin, direction) = self.view_projection.ray(to);
        let position = DVec3::from(light.position);
        light.position = match light.kind {
            LightGeometry::Parallel => {
                (self.direction_on_sphere(origin, direction, behind) * position.length().max(1e-3)).into()
            }
            LightGeometry::Perspective => {
                // A light that is not in front of the eye is placed at the depth of the scene's centre.
                let through = if self.project(position).is_some() { position } else { DVec3::ZERO };
                self.point_on_facing_plane(through, to).map_or(light.position, Into::into)
            }
        };
    }

    /// Intersects a ray with the handles' sphere and returns the direction of the hit from its centre. Rays that miss
    /// the sphere give the nearest point of the silhouette.
    fn direction_on_sphere(&self, origin: DVec3, direction: DVec3, behind: bool) -> DVec3 {
        let middle = -origin.dot(direction);
        let nearest = origin + direction * middle;
        let half_chord = self.radius * self.radius - nearest.length_squared();
        let met = if half_chord > 0.0 {
            let sign = if behind { 1.0 } else { -1.0 };
            nearest + direction * (sign * half_chord.sqrt())
        } else {
            nearest
        };
        met.normalize_or(DVec3::Z)
    }

    /// Moves a perspective light nearer to the eye or further away, along the line of sight.
    pub(crate) fn move_along_sight(&self, light: &mut SceneLight, notches: f64) {
        if light.kind == LightGeometry::Parallel {
            return;
        }
        let position = DVec3::from(light.position);
        let factor = DISTANCE_PER_NOTCH.powf(notches);
        light.position = match self.view_projection.camera.projection {
            Projection::Perspective => (self.view_projection.camera.position()
                + (position - self.view_projection.camera.position()) * factor)
                .into(),
            Projection::Orthographic => {
                let step = self.depth(position) * (factor - 1.0);
                (position - self.view_projection.camera.scene_from_view().z_axis * step).into()
            }
        };
    }

    /// Radius of the sphere that carries the handles of parallel lights, in scene units.
    pub(crate) fn radius(&self) -> f64 {
        self.radius
    }

    /// Returns the great circle of the sphere that faces the eye, in points.
    pub(crate) fn silhouette(&self) -> Vec<Pos2> {
        let view = self.view_projection.camera.scene_from_view();
        self.circle(view.x_axis, view.y_axis)
    }

    /// Returns the great circle through a direction and the viewing axis, in points.
    pub(crate) fn meridian(&self, direction: DVec3) -> Vec<Pos2> {
        let view = self.view_projection.camera.scene_from_view();
        let across = direction.reject_from(view.z_axis).normalize_or(view.x_axis);
        self.circle(across, view.z_axis)
    }

    fn circle(&self, a: DVec3, b: DVec3) -> Vec<Pos2> {
        let at = |i: usize| {
            let (sin, cos) = (i as f64 / CIRCLE_POINTS as f64 * TAU).sin_cos();
            self.project((a * cos + b * sin) * self.radius)
        };
        (0..=CIRCLE_POINTS).filter_map(at).collect()
    }
}

#[cfg(test)]
mod tests {
    use eframe::egui::pos2;

    use super::*;
    use chiaroscuro_scene::FovReference;

    fn view(projection: Projection) -> LightHandleView {
        let picture = Rect::from_min_size(pos2(10.0, 20.0), vec2(640.0, 480.0));
        LightHandleView::new(Camera { projection, ..Camera::default() }, picture, 1.8)
    }

    fn light(kind: LightGeometry) -> SceneLight {
        SceneLight { kind, position: [0.3, -1.5, 0.8], ..SceneLight::default() }
    }

    #[test]
    fn a_dragged_handle_stays_under_the_pointer() {
        for projection in [Projection::Perspective, Projection::Orthographic] {
            for kind in [LightGeometry::Parallel, LightGeometry::Perspective] {
                let (view, mut light) = (view(projection), light(kind));
                let before = view.handle(&light).unwrap();
                let to = before.position + vec2(25.0, 18.0);
                let length = DVec3::from(light.position).length();
                view.move_light(&mut light, to, before.is_behind);
                let after = view.handle(&light).unwrap();
                assert!(
                    after.position.distance(to) < 0.1,
                    "{projection:?} {kind:?}: {after:?}, expected {to:?}"
                );
                assert_eq!(after.is_behind, before.is_behind);
                if kind == LightGeometry::Parallel {
                    assert!((DVec3::from(light.position).length() - length).abs() < 1e-9);
                }
            }
        }
    }

    #[test]
    fn handles_stay_on_their_side_and_in_the_picture() {
        let view = view(Projection::Perspective);
        let mut light = light(LightGeometry::Parallel);
        light.position = (-DVec3::from(light.position)).into();
        let before = view.handle(&light).unwrap();
        assert!(before.is_behind);
        view.move_light(&mut light, before.position + vec2(5.0, 5.0), true);
        assert!(view.handle(&light).unwrap().is_behind);
        // Far beyond the silhouette, to the lower right.
        view.move_light(&mut light, pos2(5000.0, 4000.0), false);
        let handle = view.handle(&light).unwrap();
        assert!(
            view.view_projection.picture.contains(handle.position)
                && handle.position.x > view.view_projection.picture.center().x
        );
        let far = SceneLight {
            kind: LightGeometry::Perspective,
            position: [0.0, 0.0, 90.0],
            ..SceneLight::default()
        };
        if let Some(handle) = view.handle(&far) {
            assert!(view.view_projection.picture.contains(handle.position));
        }
    }

    #[test]
    fn lights_outside_of_the_picture_can_be_taken_into_it() {
        for projection in [Projection::Perspective, Projection::Orthographic] {
            let view = view(projection);
            let (eye, axes) = {
                let camera = &view.view_projection.camera;
                (camera.position(), camera.scene_from_view())
            };
            let picture = view.view_projection.picture;
            for (right, up, back) in [(5.0, 0.0, -4.0), (0.0, 6.0, -4.0), (-6.0, 0.5, 0.0), (6.0, -3.0, 3.0)]
            {
                let place = eye + axes.x_axis * right + axes.y_axis * up + axes.z_axis * back;
                let position = place.into();
                let mut light =
                    SceneLight { kind: LightGeometry::Perspective, position, ..SceneLight::default() };
                let handle = view.handle(&light).expect("one");
                let outside = handle.direction_outside.expect("it is not in the picture");
                assert!(picture.contains(handle.position), "{handle:?}");
                assert!(f64::from(outside.x) * right - f64::from(outside.y) * up > 0.0, "{handle:?}");
                let to = picture.center() + vec2(30.0, -20.0);
                view.move_light(&mut light, to, handle.is_behind);
                let after = view.handle(&light).expect("one");
                assert!(
                    after.position.distance(to) < 0.1 && after.direction_outside.is_none(),
                    "{after:?}, not {to:?}"
                );
            }
            let behind = SceneLight {
                kind: LightGeometry::Perspective,
                position: (eye + axes.z_axis).into(),
                ..SceneLight::default()
            };
            let has_side = projection == Projection::Perspective && view.handle(&behind).is_some();
            assert!(!has_side, "right behind the eye");
        }
    }

    /// Uses a picture narrower than the camera's frame, which the angle of view of its height would cut off.
    #[test]
    fn handles_lie_over_narrow_pictures_of_a_frame() {
        let picture = Rect::from_min_size(pos2(10.0, 20.0), vec2(200.0, 600.0));
        for projection in [Projection::Perspective, Projection::Orthographic] {
            let camera = Camera { projection, fit: FovReference::Frame, ..Camera::default() };
            let view = LightHandleView::new(camera.clone(), picture, 1.8);
            let silhouette = view.silhouette();
            assert!(!silhouette.is_empty() && silhouette.iter().all(|at| picture.contains(*at)));
            // The sphere that carries the handles extends well to both sides.
            let widest = silhouette.iter().map(|at| (at.x - picture.center().x).abs()).fold(0.0, f32::max);
            assert!(widest > 0.6 * picture.width() / 2.0, "{projection:?}: {widest}");
            for kind in [LightGeometry::Parallel, LightGeometry::Perspective] {
                let mut light = light(kind);
                let before = view.handle(&light).unwrap();
                // Projection of the light's position in the picture.
                let shown = match kind {
                    LightGeometry::Parallel => light.direction() * view.radius(),
                    LightGeometry::Perspective => DVec3::from(light.position),
                };
                let (x, y, _) = camera.pixel_from_scene(shown, 200.0, 600.0).unwrap();
                let there = picture.min + vec2(x as f32, y as f32);
                assert!(before.position.distance(there) < 0.1, "{projection:?} {kind:?}: {before:?}");
                let to = before.position + vec2(8.0, 6.0);
                view.move_light(&mut light, to, before.is_behind);
                let after = view.handle(&light).unwrap();
                assert!(after.position.distance(to) < 0.1, "{projection:?} {kind:?}: {after:?}, not {to:?}");
            }
        }
    }

    #[test]
    fn the_wheel_moves_a_perspective_light_along_the_line_of_sight() {
        for projection in [Projection::Perspective, Projection::Orthographic] {
            let (view, mut light) = (view(projection), light(LightGeometry::Perspective));
            let before = view.handle(&light).unwrap().position;
            let depth = view.depth(DVec3::from(light.position));
            view.move_along_sight(&mut light, 1.0);
            assert!(view.handle(&light).unwrap().position.distance(before) < 0.1);
            assert!(view.depth(DVec3::from(light.position)) > depth);
        }
    }
}
