//! Outline of an area light in the picture, and the handle on it that changes the light's size.

use std::f64::consts::TAU;

use eframe::egui::{Id, Painter, Pos2, Shape, Stroke, Ui};
use glam::DVec3;

use super::geometry::View;
use super::grip::grip;
use crate::app::common::theme;
use crate::app::text;
use crate::model::{LightArea, LightKind, LightShape, MAX_LIGHT_ANGLE_DEG, MAX_LIGHT_SIZE, SceneLight};

/// Radius of the handle, in points.
const RADIUS: f32 = 5.0;

/// Number of segments of a round outline.
const CORNERS: usize = 72;

/// Smallest sizes that can be dragged, in scene units and in degrees: an outline without extent could not be grabbed.
const LEAST_SIZE: f64 = 0.02;
const LEAST_ANGLE_DEG: f64 = 0.5;

/// New size of a light that is being dragged.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Dragged {
    /// Width of a perspective light, in scene units.
    Size(f64),
    /// Angular diameter of a parallel light, in degrees.
    AngleDeg(f64),
}

/// Placement of an area light in scene space, as displayed.
#[derive(Debug, Clone, Copy)]
struct Shown {
    area: LightArea,
    kind: LightKind,
    middle: DVec3,
    /// Scene units per unit of the light's extent: a parallel light is displayed at the distance of its handle.
    scale: f64,
}

impl Shown {
    fn of(view: &View, light: &SceneLight) -> Option<Self> {
        let (middle, scale) = match light.kind {
            LightKind::Parallel => (light.direction() * view.radius(), view.radius()),
            LightKind::Perspective => (light.position.into(), 1.0),
        };
        light.area.map(|area| Self { area, kind: light.kind, middle, scale })
    }

    /// Returns the outline in scene space: a circle, or four corners. A ball is a circle from every direction.
    fn outline(&self, view: &View) -> Vec<DVec3> {
        let LightArea { shape, right, up, near: _ } = self.area;
        let at = |x: DVec3, y: DVec3| self.middle + (x + y) * self.scale;
        let round = |a: DVec3, b: DVec3| {
            let corner = |index: usize| {
                let (sin, cos) = (index as f64 / CORNERS as f64 * TAU).sin_cos();
                at(a * cos, b * sin)
            };
            (0..=CORNERS).map(corner).collect()
        };
        match shape {
            LightShape::Rectangle => [(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0), (1.0, 1.0)]
                .map(|(x, y)| at(right * x, up * y))
                .into(),
            LightShape::Ball => {
                let across = view.right();
                round(across * right.length(), across.cross(view.towards()) * right.length())
            }
            LightShape::Point | LightShape::Disc => round(right, up),
        }
    }

    /// Returns the vector from the centre to the middle of one side of the outline, in scene units.
    fn side(&self, view: &View, side: Side) -> DVec3 {
        let LightArea { shape, right, up, near: _ } = self.area;
        let radius = right.length();
        let (right, up) = match shape {
            LightShape::Ball => (view.right() * radius, view.right().cross(view.towards()) * radius),
            _ => (right, up),
        };
        let out = match side {
            Side::Right => right,
            Side::Up => up,
            Side::Left => -right,
            Side::Down => -up,
        };
        out * self.scale
    }

    /// Returns the side of the outline that is furthest from the centre in the picture: others may be hidden by the
    /// light's handle.
    fn clearest(&self, view: &View) -> Option<Side> {
        let middle = view.point(self.middle)?;
        let away = |side: Side| {
            let at = view.point(self.middle + self.side(view, side)).filter(|&at| view.shows(at))?;
            Some((side, at.distance(middle)))
        };
        let seen = Side::ALL.into_iter().filter_map(away);
        seen.max_by(|(_, a), (_, b)| a.total_cmp(b)).map(|(side, _)| side)
    }

    /// Returns the size at which the outline passes through a point; the smallest one for points across the centre.
    fn through(&self, out: DVec3, point: DVec3) -> Dragged {
        let grown = ((point - self.middle).dot(out) / out.length_squared()).max(0.0);
        let half = self.area.right.length() * grown;
        match self.kind {
            LightKind::Perspective => Dragged::Size((2.0 * half).clamp(LEAST_SIZE, MAX_LIGHT_SIZE)),
            LightKind::Parallel => {
                let angle_deg = (2.0 * half.atan()).to_degrees();
                Dragged::AngleDeg(angle_deg.clamp(LEAST_ANGLE_DEG, MAX_LIGHT_ANGLE_DEG))
            }
        }
    }
}

/// Side of the outline on which the handle lies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Side {
    Right,
    Up,
    Left,
    Down,
}

impl Side {
    const ALL: [Self; 4] = [Self::Right, Self::Up, Self::Left, Self::Down];
}

/// State of the size handle between frames.
#[derive(Debug, Default)]
pub(crate) struct SizeHandle {
    /// Side of the outline of the drag in progress.
    dragged: Option<Side>,
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
        view: &View,
        light: &SceneLight,
        (name, index): (&str, usize),
    ) -> Option<Dragged> {
        let dragged = self.dragged.take();
        self.active = false;
        let shown = Shown::of(view, light)?;
        paint_outline(painter, view, &shown, light);
        let side = dragged.or_else(|| shown.clearest(view))?;
        let out = shown.side(view, side);
        let edge = shown.middle + out;
        let seen = view.point(edge)?;
        let name = text::lights::size_handle(name);
        let grip = grip(ui, seen, RADIUS, Id::unique("size handle").with(index), &name);
        self.dragged = grip.is_dragged.then_some(side);
        self.active = grip.is_active;
        let radius = RADIUS + if self.active { 1.0 } else { 0.0 };
        painter.circle(seen, radius, theme::color(light.color), Stroke::new(1.5, theme::OUTLINE));
        Some(shown.through(out, view.facing(edge, grip.moved_to?)?))
    }
}

fn paint_outline(painter: &Painter, view: &View, shown: &Shown, light: &SceneLight) {
    let seen: Option<Vec<Pos2>> = shown.outline(view).into_iter().map(|point| view.point(point)).collect();
    let Some(seen) = seen else { return };
    painter.add(Shape::line(seen.clone(), Stroke::new(3.5, theme::OUTLINE.gamma_multiply(0.5))));
    painter.add(Shape::line(seen, Stroke::new(1.5, theme::color(light.color).gamma_multiply(0.9))));
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{Camera, Light};
    use eframe::egui::{Rect, vec2};

    fn shown(light: &Light) -> (View, Shown) {
        let picture = Rect::from_min_size(Pos2::new(10.0, 20.0), vec2(800.0, 600.0));
        let view = View::new(Camera::default(), picture, 1.2);
        let shown = Shown::of(&view, &light.in_scene(&Camera::default())).expect("a size");
        (view, shown)
    }

    #[test]
    fn the_border_follows_the_pointer() {
        for shape in [LightShape::Disc, LightShape::Rectangle, LightShape::Ball] {
            for kind in [LightKind::Parallel, LightKind::Perspective] {
                let light = Light {
                    kind,
                    shape,
                    position: [0.4, -2.1, 1.4],
                    size: 0.8,
                    angle_deg: 20.0,
                    ..Light::default()
                };
                let (view, shown) = shown(&light);
                let width = |dragged: Dragged| match dragged {
                    Dragged::Size(width) | Dragged::AngleDeg(width) => width,
                };
                let same = if kind == LightKind::Parallel { light.angle_deg } else { light.size };
                for side in Side::ALL {
                    let out = shown.side(&view, side);
                    let here = shown.through(out, shown.middle + out);
                    assert!((width(here) - same).abs() < 1e-9, "{shape:?} {kind:?}: {here:?}");
                    let wider = shown.through(out, shown.middle + out * 1.5);
                    assert!(width(wider) > 1.3 * same, "{shape:?} {kind:?}: {wider:?}");
                    let beyond = shown.through(out, shown.middle - out);
                    assert!((0.0..=LEAST_ANGLE_DEG).contains(&width(beyond)) && width(beyond) > 0.0);
                }
                let clearest = shown.clearest(&view).expect("a side that is seen");
                let away = |side| {
                    let middle = view.point(shown.middle).expect("seen");
                    view.point(shown.middle + shown.side(&view, side)).expect("seen").distance(middle)
                };
                assert!(Side::ALL.into_iter().all(|side| away(side) <= away(clearest)));
                // The side's middle is a point of the outline, or nearer to the centre than its corners.
                let outline = shown.outline(&view);
                let reach = |point: &DVec3| (*point - shown.middle).length();
                let farthest = outline.iter().map(reach).fold(0.0, f64::max);
                assert!(farthest >= shown.side(&view, Side::Right).length() - 1e-9);
            }
        }
    }
}
