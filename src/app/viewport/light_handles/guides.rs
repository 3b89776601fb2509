//! Guide lines for a light being moved: its height over the floor, the sphere of directions, the cone of a spotlight.

use std::f64::consts::TAU;

use eframe::egui::{Painter, Pos2, Shape, Stroke};
use glam::DVec3;

use super::geometry::LightHandleView;
use crate::app::common::theme;
use chiaroscuro_scene::{LightGeometry, SceneLight};

/// Number of segments of a circle.
const CIRCLE_SEGMENTS: usize = 72;
/// Number of lines from a spotlight to the rim of its cone.
const CONE_LINES: usize = 6;

/// Paints the guide lines of a light in scene space. `up` is the vertical axis, `floor` the floor's height along it.
pub(crate) fn paint_guides(
    painter: &Painter,
    view: &LightHandleView,
    light: &SceneLight,
    up: DVec3,
    floor: f64,
) {
    let line = |points: &[DVec3], strength: f32| {
        let seen: Option<Vec<Pos2>> = points.iter().map(|&point| view.project(point)).collect();
        if let Some(seen) = seen {
            painter.add(Shape::line(seen, Stroke::new(1.0, theme::GUIDE.gamma_multiply(strength))));
        }
    };
    if light.kind == LightGeometry::Parallel {
        for (circle, strength) in [(view.silhouette(), 0.5), (view.meridian(light.direction()), 0.35)] {
            painter.add(Shape::line(circle, Stroke::new(1.0, theme::GUIDE.gamma_multiply(strength))));
        }
    }
    let place = match light.kind {
        LightGeometry::Parallel => light.direction() * view.radius(),
        LightGeometry::Perspective => light.position.into(),
    };
    let FloorProjection { circle: ring, projection: foot, middle } = FloorProjection::new(place, up, floor);
    line(&ring, 0.3);
    line(&[middle, foot], 0.3);
    line(&[place, foot], 0.6);
    for rib in spotlight_cone(light) {
        line(&rib, 0.6);
    }
    if let (Some(from), Some(to)) = (view.project(place), view.project(DVec3::ZERO)) {
        let stroke = Stroke::new(1.0, theme::GUIDE.gamma_multiply(0.7));
        painter.extend(Shape::dashed_line(&[from, to], stroke, 4.0, 4.0));
    }
}

/// Position of a light relative to the floor.
struct FloorProjection {
    /// Circle of the floor's points at the same distance from the axis.
    circle: Vec<DVec3>,
    /// Perpendicular projection of the light onto the floor.
    projection: DVec3,
    /// Centre of the circle.
    middle: DVec3,
}

impl FloorProjection {
    fn new(place: DVec3, up: DVec3, floor: f64) -> Self {
        let middle = up * floor;
        let across = place.reject_from(up);
        let (one, other) = up.any_orthonormal_pair();
        let at = |corner: usize| {
            let (sin, cos) = (corner as f64 / CIRCLE_SEGMENTS as f64 * TAU).sin_cos();
            middle + (one * cos + other * sin) * across.length()
        };
        Self { circle: (0..=CIRCLE_SEGMENTS).map(at).collect(), projection: middle + across, middle }
    }
}

/// Returns the polylines of a spotlight's cone, cut at the distance of the volume's centre: the rim, and lines to it.
/// Empty without a spotlight.
fn spotlight_cone(light: &SceneLight) -> Vec<Vec<DVec3>> {
    if light.kind != LightGeometry::Perspective || !light.hood.on {
        return Vec::new();
    }
    let place = DVec3::from(light.position);
    let axis = -light.direction();
    let reach = place.length();
    let across = axis.any_orthonormal_vector();
    let up = axis.cross(across);
    let rim = |share: f64| {
        let (sin, cos) = (share * TAU).sin_cos();
        let slope = light.hood.half_angle_deg.to_radians().tan();
        place + (axis + (across * cos + up * sin) * slope) * reach
    };
    let circle = (0..=CIRCLE_SEGMENTS).map(|corner| rim(corner as f64 / CIRCLE_SEGMENTS as f64)).collect();
    let ribs = (0..CONE_LINES).map(|rib| vec![place, rim(rib as f64 / CONE_LINES as f64)]);
    std::iter::once(circle).chain(ribs).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use chiaroscuro_scene::Spotlight;

    #[test]
    fn lights_stand_over_the_floor() {
        let stand = FloorProjection::new(DVec3::new(3.0, -4.0, 2.0), DVec3::Z, -1.0);
        assert_eq!(
            (stand.projection, stand.middle),
            (DVec3::new(3.0, -4.0, -1.0), DVec3::new(0.0, 0.0, -1.0))
        );
        assert!(stand.circle.iter().all(|point| ((*point - stand.middle).length() - 5.0).abs() < 1e-9));
        let stand = FloorProjection::new(DVec3::new(3.0, -4.0, 2.0), DVec3::NEG_X, -1.0);
        assert_eq!((stand.projection, stand.middle), (DVec3::new(1.0, -4.0, 2.0), DVec3::X));
        assert!(stand.circle.iter().all(|point| (point.x - 1.0).abs() < 1e-9));
    }

    #[test]
    fn cones_are_as_wide_as_their_hoods() {
        let hooded = Spotlight { on: true, half_angle_deg: 30.0, rim_deg: 5.0 };
        let mut light = SceneLight {
            kind: LightGeometry::Perspective,
            position: [0.0, 0.0, 2.0],
            hood: hooded,
            ..SceneLight::default()
        };
        let cone = spotlight_cone(&light);
        assert_eq!(cone.len(), 1 + CONE_LINES);
        let place = DVec3::from(light.position);
        for point in &cone[0] {
            let angle = (*point - place).angle_between(DVec3::NEG_Z).to_degrees();
            assert!((angle - 30.0).abs() < 1e-9 && point.z.abs() < 1e-9, "{point}");
        }
        light.hood.on = false;
        assert!(spotlight_cone(&light).is_empty());
    }
}
