//! Freehand drawing of a transfer function curve.

use eframe::egui::{self, CursorIcon, Event, Key, Modifiers, Pos2, Response, Stroke, Ui};

use super::plot::{self, Axes};
use super::theme;
use crate::model::TransferFunction;

/// State of freehand drawing between frames.
#[derive(Debug, Default)]
pub(super) struct Freehand {
    /// True while the pointer draws instead of moving points.
    pub on: bool,
    /// Values and opacities along the current stroke.
    stroke: Vec<[f64; 2]>,
    /// Curve before the current stroke.
    before: Option<TransferFunction>,
}

/// Positions of the pointer during this frame, in points of the window.
fn passed(ui: &Ui) -> Vec<Pos2> {
    let to = |event: &Event| if let Event::PointerMoved(to) = event { Some(*to) } else { None };
    ui.input(|input| input.events.iter().filter_map(to).collect())
}

impl Freehand {
    /// Draws while the button is held; Escape reverts the current stroke, or else ends freehand drawing.
    pub(super) fn draw(
        &mut self,
        ui: &Ui,
        response: &Response,
        axes: &Axes,
        function: &mut TransferFunction,
    ) {
        if response.hovered() {
            ui.ctx().set_cursor_icon(CursorIcon::Crosshair);
        }
        if !(response.dragged() || response.drag_started() || response.drag_stopped()) {
            // A stroke that was interrupted, because the editor was hidden, has ended.
            (self.before, self.stroke) = (None, Vec::new());
        }
        let painter = ui.painter_at(axes.area);
        for point in &function.points {
            let at = axes.position(point.value, point.opacity);
            let small = 0.7 * theme::POINT_RADIUS;
            plot::point(&painter, &axes.ink, (at, small), theme::color(point.color), false);
        }
        let is_left = (response.contains_pointer() || self.before.is_some())
            && ui.input_mut(|input| input.consume_key(Modifiers::NONE, Key::Escape));
        if is_left {
            match self.before.take() {
                Some(before) => *function = before,
                None => self.on = false,
            }
            self.stroke.clear();
            return;
        }
        if response.drag_started_by(egui::PointerButton::Primary) {
            self.before = Some(function.clone());
            self.stroke.clear();
            // Position at which the button was pressed: a drag is reported only some points further on.
            let origin = ui.input(|input| input.pointer.press_origin()).map(|at| axes.values(at));
            self.stroke.extend(origin.map(|(value, opacity)| [value, opacity]));
        }
        if let (Some(before), Some(at)) = (&self.before, response.interact_pointer_pos()) {
            // All positions passed by the pointer; a slow frame has many.
            for at in passed(ui).into_iter().chain([at]) {
                let (value, opacity) = axes.values(at);
                if self.stroke.last() != Some(&[value, opacity]) {
                    self.stroke.push([value, opacity]);
                }
            }
            *function = before.with_stroke(&self.stroke, axes.range.span());
            let way: Vec<_> =
                self.stroke.iter().map(|&[value, opacity]| axes.position(value, opacity)).collect();
            painter.line(way, Stroke::new(1.0, theme::ACCENT.gamma_multiply(0.6)));
        }
        if response.drag_stopped() {
            self.before = None;
        }
    }
}
