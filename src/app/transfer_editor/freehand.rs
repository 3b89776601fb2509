//! Freehand drawing of a transfer function curve.

use eframe::egui::{self, CursorIcon, Event, Key, Modifiers, Pos2, Response, Stroke, Ui};

use super::plot::{self, PlotAxes};
use super::theme;
use chiaroscuro_scene::TransferFunction;

/// State of freehand drawing between frames.
#[derive(Debug, Default)]
pub(super) struct FreehandDrawing {
    /// True while the pointer draws instead of moving points.
    pub is_active: bool,
    /// Values and opacities along the current stroke.
    stroke: Vec<[f64; 2]>,
    /// Curve before the current stroke.
    original: Option<TransferFunction>,
}

/// Positions of the pointer during this frame, in points of the window.
fn pointer_path(ui: &Ui) -> Vec<Pos2> {
    let to = |event: &Event| if let Event::PointerMoved(to) = event { Some(*to) } else { None };
    ui.input(|input| input.events.iter().filter_map(to).collect())
}

impl FreehandDrawing {
    /// Draws while the button is held; Escape reverts the current stroke, or else ends freehand drawing.
    pub(super) fn draw(
        &mut self,
        ui: &Ui,
        response: &Response,
        axes: &PlotAxes,
        function: &mut TransferFunction,
    ) {
        if response.hovered() {
            ui.ctx().set_cursor_icon(CursorIcon::Crosshair);
        }
        if !(response.dragged() || response.drag_started() || response.drag_stopped()) {
            // A stroke that was interrupted, because the editor was hidden, has ended.
            (self.original, self.stroke) = (None, Vec::new());
        }
        let painter = ui.painter_at(axes.area);
        for point in &function.points {
            let at = axes.position(point.value, point.opacity);
            let small = 0.7 * theme::POINT_RADIUS;
            plot::paint_point(&painter, &axes.ink, (at, small), theme::color(point.color), false);
        }
        let is_cancelled = (response.contains_pointer() || self.original.is_some())
            && ui.input_mut(|input| input.consume_key(Modifiers::NONE, Key::Escape));
        if is_cancelled {
            match self.original.take() {
                Some(before) => *function = before,
                None => self.is_active = false,
            }
            self.stroke.clear();
            return;
        }
        if response.drag_started_by(egui::PointerButton::Primary) {
            self.original = Some(function.clone());
            self.stroke.clear();
            // Position at which the button was pressed: a drag is reported only some points further on.
            let origin =
                ui.input(|input| input.pointer.press_origin()).map(|at| axes.value_and_opacity_at(at));
            self.stroke.extend(origin.map(|(value, opacity)| [value, opacity]));
        }
        if let (Some(before), Some(at)) = (&self.original, response.interact_pointer_pos()) {
            // All positions passed by the pointer; a slow frame has many.
            for at in pointer_path(ui).into_iter().chain([at]) {
                let (value, opacity) = axes.value_and_opacity_at(at);
                if self.stroke.last() != Some(&[value, opacity]) {
                    self.stroke.push([value, opacity]);
                }
            }
            *function = before.with_stroke(&self.stroke, axes.range.span());
            let stroke_line: Vec<_> =
                self.stroke.iter().map(|&[value, opacity]| axes.position(value, opacity)).collect();
            painter.line(stroke_line, Stroke::new(1.0, theme::ACCENT.gamma_multiply(0.6)));
        }
        if response.drag_stopped() {
            self.original = None;
        }
    }
}
