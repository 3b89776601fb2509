//! Outline of an area light in the picture, and the handle on it that changes the light's size.

use std::f64::consts::TAU;

use eframe::egui::{Id, Painter, Pos2, Shape, Stroke, Ui};
use glam::DVec3;

use super::geometry::LightHandleView;
use super::small_handle::interact_small_handle;
use crate::app::common::theme;
use crate::app::text;
use chiaroscuro_scene::{
    LightArea, LightGeometry, LightShape, MAX_LIGHT_ANGLE_DEG, MAX_LIGHT_SIZE, SceneLight,
};

/// Radius of the handle, in points.
const HANDLE_RADIUS: f32 = 5.0;

/// Number of segments of a round outline.
const OUTLINE_SEGMENTS: usize = 72;

/// Smallest sizes that can be dragged, in scene units and in degrees: an outline without extent could not be grabbed.
const MIN_SIZE: f64 = 0.02;
const MIN_ANGLE_DEG: f64 = 0.5;

/// New size of a light that is being dragged.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum DraggedLightSize {
    /// Width of a perspective light, in scene units.
    Size(f64),
    /// Angular diameter of a parallel light, in degrees.
    AngleDeg(f64),
}

/// Placement of an area light in scene space, as displayed.
#[derive(Debug, Clone, Copy)]
struct AreaLightPlacement {
    area: LightArea,
    kind: LightGeometry,
    middle: DVec3,
    /// Scene units per unit of the light's extent: a parallel light is displayed at the distance of its handle.
    scale: f64,
}

impl AreaLightPlacement {
    fn from_light(view: &LightHandleView, light: &SceneLight) -> Option<Self> {
        let (middle, scale) = match light.kind {
            LightGeometry::Parallel => (light.direction() * view.radius(), view.radius()),
            LightGeometry::Perspective => (light.position.into(), 1.0),
        };
        light.area.map(|area| Self { area, kind: light.kind, middle, scale })
    }

    /// Returns the outline in scene space: a circle, or four corners. A ball is a circle from every direction.
    fn outline(&self, view: &LightHandleView) -> Vec<DVec3> {
        let LightArea { shape, right, up, near: _ } = self.area;
        let at = |x: DVec3, y: DVec3| self.middle + (x + y) * self.scale;
        let round = |a: DVec3, b: DVec3| {
            let corner = |index: usize| {
                let (sin, cos) = (index as f64 / OUTLINE_SEGMENTS as f64 * TAU).sin_cos();
                at(a * cos, b * sin)
            };
            (0..=OUTLINE_SEGMENTS).map(corner).collect()
        };
        match shape {
            LightShape::Rectangle => [(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0), (1.0, 1.0)]
                .map(|(x, y)| at(right * x, up * y))
                .into(),
            LightShape::Ball => {
                let across = view.right_axis();
                round(across * right.length(), across.cross(view.eye_axis()) * right.length())
            }
            LightShape::Point | LightShape::Disc => round(right, up),
        }
    }

    /// Returns the vector from the centre to the middle of one side of the outline, in scene units.
    fn side_offset(&self, view: &LightHandleView, side: OutlineSide) -> DVec3 {
        let LightArea { shape, right, up, near: _ } = self.area;
        let radius = right.length();
        let (right, up) = match shape {
            LightShape::Ball => {
                (view.right_axis() * radius, view.right_axis().cross(view.eye_axis()) * radius)
            }
            _ => (right, up),
        };
        let out = match side {
            OutlineSide::Right => right,
            OutlineSide::Up => up,
            OutlineSide::Left => -right,
            OutlineSide::Down => -up,
        };
        out * self.scale
    }

    /// Returns the side of the outline that is furthest from the centre in the picture: others may be hidden by the
    /// light's handle.
    fn most_visible_side(&self, view: &LightHandleView) -> Option<OutlineSide> {
        let middle = view.project(self.middle)?;
        let away = |side: OutlineSide| {
            let at =
                view.project(self.middle + self.side_offset(view, side)).filter(|&at| view.contains(at))?;
            Some((side, at.distance(middle)))
        };
        let seen = OutlineSide::ALL.into_iter().filter_map(away);
        seen.max_by(|(_, a), (_, b)| a.total_cmp(b)).map(|(side, _)| side)
    }

    /// Returns the size at which the outline passes through a point; the smallest one for points across the centre.
    fn size_through(&self, out: DVec3, point: DVec3) -> DraggedLightSize {
        let grown = ((point - self.middle).dot(out) / out.length_squared()).max(0.0);
        let half = self.area.right.length() * grown;
        match self.kind {
            LightGeometry::Perspective => {
                DraggedLightSize::Size((2.0 * half).clamp(MIN_SIZE, MAX_LIGHT_SIZE))
            }
            LightGeometry::Parallel => {
                let angle_deg = (2.0 * half.atan()).to_degrees();
                DraggedLightSize::AngleDeg(angle_deg.clamp(MIN_ANGLE_DEG, MAX_LIGHT_ANGLE_DEG))
            }
        }
    }
}

/// Side of the outline on which the handle lies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum OutlineSide {
    Right,
    Up,
    Left,
    Down,
}

impl OutlineSide {
    const ALL: [Self; 4] = [Self::Right, Self::Up, Self::Left, Self::Down];
}

/// State of the size handle between frames.
#[derive(Debug, Default)]
pub(crate) struct SizeHandle {
    /// Side of the outline of the drag in progress.
    dragged: Option<OutlineSide>,
    /// True if the pointer is on the handle or drags it.
    active: bool,
}

impl SizeHandle {
    /// Returns true if the pointer is on the handle or drags it.
    pub(crate) fn is_active(&self) -> bool {
        self.active
    }

    /// Shows a light's outline and its size handle. Returns the size that it is dragged to.
    pub(crate) fn show(
        &mut self,
        ui: &Ui,
        painter: &Painter,
        view: &LightHandleView,
        light: &SceneLight,
        (name, index): (&str, usize),
    ) -> Option<DraggedLightSize> {
        let dragged = self.dragged.take();
        self.active = false;
        let shown = AreaLightPlacement::from_light(view, light)?;
        paint_outline(painter, view, &shown, light);
        let side = dragged.or_else(|| shown.most_visible_side(view))?;
        let out = shown.side_offset(view, side);
        let edge = shown.middle + out;
        let seen = view.project(edge)?;
        let name = text::lights::size_handle(name);
        let grip =
            interact_small_handle(ui, seen, HANDLE_RADIUS, Id::unique("size handle").with(index), &name);
        self.dragged = grip.is_dragged.then_some(side);
        self.active = grip.is_active;
        let radius = HANDLE_RADIUS + if self.active { 1.0 } else { 0.0 };
        painter.circle(seen, radius, theme::color(light.color), Stroke::new(1.5, theme::OUTLINE));
        Some(shown.size_through(out, view.point_on_facing_plane(edge, grip.moved_to?)?))
    }
}

fn paint_outline(painter: &Painter, view: &LightHandleView, shown: &AreaLightPlacement, light: &SceneLight) {
    let seen: Option<Vec<Pos2>> = shown.outline(view).into_iter().map(|point| view.project(point)).collect();
    let Some(seen) = seen else { return };
    painter.add(Shape::line(seen.clone(), Stroke::new(3.5, theme::OUTLINE.gamma_multiply(0.5))));
    painter.add(Shape::line(seen, Stroke::new(1.5, theme::color(light.color).gamma_multiply(0.9))));
}

#[cfg(test)]
mod tests {
    use eframe::egui::{Rect, vec2};

    use super::*;
    use chiaroscuro_scene::{Camera, LightSettings};

    fn shown(light: &LightSettings) -> (LightHandleView, AreaLightPlacement) {
        let picture = Rect::from_min_size(Pos2::new(10.0, 20.0), vec2(800.0, 600.0));
        let view = LightHandleView::new(Camera::default(), picture, 1.2);
        let shown =
            AreaLightPlacement::from_light(&view, &light.resolve(&Camera::default())).expect("a size");
        (view, shown)
    }

    #[test]
    fn the_border_follows_the_pointer() {
        for shape in [LightShape::Disc, LightShape::Rectangle, LightShape::Ball] {
            for kind in [LightGeometry::Parallel, LightGeometry::Perspective] {
                let light = LightSettings {
                    kind,
                    shape,
                    position: [0.4, -2.1, 1.4],
                    size: 0.8,
                    angle_deg: 20.0,
                    ..LightSettings::default()
                };
                let (view, shown) = shown(&light);
                let width = |dragged: DraggedLightSize| match dragged {
                    DraggedLightSize::Size(width) | DraggedLightSize::AngleDeg(width) => width,
                };
                let same = if kind == LightGeometry::Parallel { light.angle_deg } else { light.size };
                for side in OutlineSide::ALL {
                    let out = shown.side_offset(&view, side);
                    let here = shown.size_through(out, shown.middle + out);
                    assert!((width(here) - same).abs() < 1e-9, "{shape:?} {kind:?}: {here:?}");
                    let wider = shown.size_through(out, shown.middle + out * 1.5);
                    assert!(width(wider) > 1.3 * same, "{shape:?} {kind:?}: {wider:?}");
                    let beyond = shown.size_through(out, shown.middle - out);
                    assert!((0.0..=MIN_ANGLE_DEG).contains(&width(beyond)) && width(beyond) > 0.0);
                }
                let clearest = shown.most_visible_side(&view).expect("a side that is seen");
                let away = |side| {
                    let middle = view.project(shown.middle).expect("seen");
                    view.project(shown.middle + shown.side_offset(&view, side))
                        .expect("seen")
                        .distance(middle)
                };
                assert!(OutlineSide::ALL.into_iter().all(|side| away(side) <= away(clearest)));
                // The side's middle is a point of the outline, or nearer to the centre than its corners.
                let outline = shown.outline(&view);
                let reach = |point: &DVec3| (*point - shown.middle).length();
                let farthest = outline.iter().map(reach).fold(0.0, f64::max);
                assert!(farthest >= shown.side_offset(&view, OutlineSide::Right).length() - 1e-9);
            }
        }
    }
}
