//! Plane of values and of their changes: places in it, and its painting.

use eframe::egui::{self, Align2, Color32, FontId, Pos2, Rect, Stroke, StrokeKind, Ui};

use super::super::plot::PlotAxes;
use crate::app::common::theme;
use crate::app::text;
use chiaroscuro_scene::MaterialBox;
use chiaroscuro_volume::ValueRange;

/// Opacity of the fill of a material that is opaque, in 255ths: the histogram is seen through it.
const FILL: f64 = 150.0;

/// Least opacity of the fill, so that faint materials have a colour, in 255ths.
const MIN_FILL: f64 = 40.0;

/// Radius of the dot for what is under the pointer in the picture, in points.
const DOT_RADIUS: f32 = 4.5;

/// Plane whose horizontal axis has values, and whose vertical one has their changes.
#[derive(Debug, Clone, Copy)]
pub(super) struct MaterialPlane {
    /// Axes with the values, and with changes as shares of the largest.
    pub axes: PlotAxes,
    /// Largest change that is shown, in data units.
    pub largest: f64,
}

impl MaterialPlane {
    /// Returns the values and the changes that the axes span.
    fn spans(&self) -> [ValueRange; 2] {
        [self.axes.range, ValueRange::new(0.0, self.largest)]
    }

    /// Returns the value and the change at a position, clamped to the plane.
    pub(super) fn place_at(&self, at: Pos2) -> [f64; 2] {
        let (value, share) = self.axes.value_and_opacity_at(at);
        [value, share * self.largest]
    }

    fn position(&self, value: f64, change: f64) -> Pos2 {
        self.axes.position(value, change / self.largest)
    }

    /// Returns the part of a material that the plane shows.
    pub(super) fn rect(&self, material: &MaterialBox) -> Rect {
        let corner = |end: usize| self.position(material.values[end], material.changes[end]);
        Rect::from_two_pos(corner(0), corner(1))
    }

    /// Returns a material with its ends in the plane.
    pub(super) fn within(&self, material: MaterialBox) -> MaterialBox {
        let [values, changes] = self.spans();
        MaterialBox {
            values: material.values.map(|value| value.clamp(values.low, values.high)),
            changes: material.changes.map(|change| change.clamp(changes.low, changes.high)),
            ..material
        }
    }

    /// Shifts an interval into the plane, whose length stays.
    pub(super) fn shifted_within(&self, axis: usize, [low, high]: [f64; 2]) -> [f64; 2] {
        let span = self.spans()[axis];
        let by = (span.low - low).max(0.0) - (high - span.high).max(0.0);
        [low + by, high + by]
    }

    /// Extends ends that were dragged to a border of the plane beyond it, so that nothing there is left out.
    pub(super) fn opened_at_borders(&self, axis: usize, ends: [f64; 2]) -> [f64; 2] {
        let span = self.spans()[axis];
        let slack = 1e-3 * span.span();
        // The axis of changes ends where few voxels are left, and one over all values has none.
        let beyond = if axis == 0 { span.high } else { self.axes.range.span() };
        ends.map(|end| {
            if end <= span.low + slack {
                span.low
            } else if end >= span.high - slack {
                beyond
            } else {
                end
            }
        })
    }

    /// Paints a dot at a value and a change: of what is under the pointer in the picture.
    pub(super) fn paint_place(&self, ui: &Ui, [value, change]: [f64; 2]) {
        let at = self.position(value, change);
        ui.painter_at(self.axes.area).circle(at, DOT_RADIUS, theme::ACCENT, Stroke::new(1.5, theme::OUTLINE));
    }

    /// Paints the ground with the histogram, and the materials over it.
    pub(super) fn paint(
        &self,
        ui: &Ui,
        texture: Option<&egui::TextureHandle>,
        materials: &[MaterialBox],
        selected: usize,
    ) {
        let painter = ui.painter_at(self.axes.area);
        painter.rect_filled(self.axes.area, 0.0, self.axes.ink.checker[0]);
        let plane = Rect::from_two_pos(
            self.position(self.axes.range.low, 0.0),
            self.position(self.axes.range.high, self.largest),
        );
        if let Some(texture) = texture {
            let whole = Rect::from_min_max(Pos2::ZERO, egui::pos2(1.0, 1.0));
            let ink = if ui.visuals().dark_mode { Color32::WHITE } else { Color32::from_gray(40) };
            painter.image(texture.id(), plane, whole, ink);
        }
        for (index, material) in materials.iter().enumerate() {
            let [r, g, b, _] = theme::color(material.color).to_array();
            let opacity = (MIN_FILL + (FILL - MIN_FILL) * material.opacity) as u8;
            let area = self.rect(material);
            painter.rect_filled(area, 2.0, Color32::from_rgba_unmultiplied(r, g, b, opacity));
            let width = if index == selected { 2.5 } else { 1.0 };
            let stroke = Stroke::new(width, Color32::from_rgb(r, g, b));
            painter.rect_stroke(area, 2.0, stroke, StrokeKind::Inside);
            let number = text::materials::number(index);
            let font = FontId::proportional(theme::FONT_SIZE - 2.0);
            let ink = ui.visuals().strong_text_color();
            painter.text(area.left_top() + egui::vec2(5.0, 2.0), Align2::LEFT_TOP, number, font, ink);
        }
    }
}
