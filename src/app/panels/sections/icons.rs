//! Icons of the side panel's sections, drawn as shapes: no font has all of them.

use eframe::egui::{Color32, Painter, Pos2, Rect, Shape, Stroke, StrokeKind, Vec2, vec2};
use std::f32::consts::{PI, TAU};

use crate::app::text::sections::{CAMERA, COMPARE, CUTS, DATA, FLOOR, LIGHTS, SHADING, SHADOWS, SOFT_LIGHT};

/// Half of an icon's edge, in points.
const ICON_RADIUS: f32 = 7.0;

/// Painter of an icon, in coordinates from −1 to 1 around its centre.
struct IconPainter<'p> {
    painter: &'p Painter,
    middle: Pos2,
    ink: Color32,
}

impl IconPainter<'_> {
    fn stroke(&self) -> Stroke {
        Stroke::new(1.3, self.ink)
    }

    fn position(&self, x: f32, y: f32) -> Pos2 {
        self.middle + vec2(x, y) * ICON_RADIUS
    }

    fn line(&self, points: &[[f32; 2]]) {
        let points: Vec<_> = points.iter().map(|&[x, y]| self.position(x, y)).collect();
        self.painter.add(Shape::line(points, self.stroke()));
    }

    fn polygon(&self, points: &[[f32; 2]], fill: Color32) {
        let points = points.iter().map(|&[x, y]| self.position(x, y)).collect();
        self.painter.add(Shape::convex_polygon(points, fill, self.stroke()));
    }

    fn circle(&self, x: f32, y: f32, radius: f32, fill: Color32) {
        self.painter.circle(self.position(x, y), radius * ICON_RADIUS, fill, self.stroke());
    }
}

/// Polyline of a circular arc, with angles in radians.
fn arc([x, y]: [f32; 2], radius: f32, from: f32, to: f32) -> Vec<[f32; 2]> {
    let step = |at: usize| from + (to - from) * at as f32 / 16.0;
    (0..=16).map(|at| [x + radius * step(at).cos(), y + radius * step(at).sin()]).collect()
}

/// Paints the icon of a section, identified by its title.
pub(super) fn paint(painter: &Painter, title: &str, middle: Pos2, ink: Color32) {
    let pen = IconPainter { painter, middle, ink };
    let (empty, half) = (Color32::TRANSPARENT, ink.gamma_multiply(0.45));
    match title {
        LIGHTS => {
            pen.circle(0.0, 0.0, 0.4, half);
            for ray in 0..8 {
                let (sine, cosine) = (TAU * ray as f32 / 8.0).sin_cos();
                pen.line(&[[0.65 * cosine, 0.65 * sine], [cosine, sine]]);
            }
        }
        SHADOWS => {
            pen.circle(0.0, 0.0, 0.85, empty);
            pen.polygon(&arc([0.0, 0.0], 0.85, -0.5 * PI, 0.5 * PI), ink);
        }
        SOFT_LIGHT => {
            pen.polygon(&arc([0.0, 0.6], 0.95, PI, TAU), half);
            pen.line(&arc([0.0, 0.6], 0.45, PI, TAU));
        }
        SHADING => {
            pen.circle(0.0, 0.0, 0.85, half);
            pen.painter.circle_filled(pen.position(-0.3, -0.3), 0.28 * ICON_RADIUS, ink);
        }
        CUTS => {
            pen.polygon(&[[-0.8, -0.8], [0.1, -0.8], [0.8, -0.1], [0.8, 0.8], [-0.8, 0.8]], empty);
            pen.polygon(&[[0.1, -0.8], [0.8, -0.1], [0.1, -0.1]], half);
        }
        FLOOR => {
            pen.circle(0.0, -0.35, 0.5, half);
            pen.line(&[[-1.0, 0.8], [1.0, 0.8]]);
            pen.line(&[[-0.35, 0.45], [0.7, 0.45]]);
        }
        CAMERA => {
            let body = Rect::from_center_size(pen.position(0.0, 0.1), vec2(2.0, 1.3) * ICON_RADIUS);
            painter.rect(body, 2.0, empty, pen.stroke(), StrokeKind::Middle);
            pen.circle(0.0, 0.1, 0.38, half);
            pen.line(&[[-0.35, -0.8], [0.35, -0.8]]);
        }
        COMPARE => {
            let whole = Rect::from_center_size(middle, Vec2::new(1.9, 1.5) * ICON_RADIUS);
            let (left, _) = whole.split_left_right_at_fraction(0.5);
            painter.rect_filled(left, 1.0, half);
            painter.rect(whole, 2.0, empty, pen.stroke(), StrokeKind::Middle);
            pen.line(&[[0.0, -1.0], [0.0, 1.0]]);
        }
        DATA => {
            let corner = |at: usize| {
                let (sine, cosine) = (TAU * (at as f32 / 6.0 - 0.25)).sin_cos();
                [0.95 * cosine, 0.95 * sine]
            };
            let corners: [[f32; 2]; 6] = std::array::from_fn(corner);
            pen.polygon(&corners, empty);
            pen.polygon(&[corners[0], corners[1], [0.0, 0.0], corners[5]], half);
            pen.line(&[[0.0, 0.0], corners[3]]);
        }
        _ => {}
    }
}
