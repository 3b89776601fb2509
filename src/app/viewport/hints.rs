//! Three hints over the first picture that somebody sees; gone for good with the first drag or a click on them.

use eframe::egui::{self, Align2, Color32, Id, Rect, Response, Sense, Ui, WidgetInfo, vec2};

use crate::app::common::theme;
use crate::app::text;

/// Whether they are shown.
#[derive(Debug, Default)]
pub(crate) struct Hints {
    /// They have not been seen yet.
    pub on: bool,
}

impl Hints {
    /// Shows them until the picture is used.
    pub(crate) fn show(&mut self, ui: &Ui, picture: Rect, used: &Response) {
        if used.dragged() || used.clicked() || ui.input(|input| input.pointer.any_down()) {
            self.on = false;
        }
        let strength = ui.ctx().animate_bool_with_time(Id::unique("hints"), self.on, 4.0 * theme::FADE_S);
        if strength <= 0.0 || picture.height() < 260.0 {
            return;
        }
        let mut painter = ui.painter_at(picture);
        painter.multiply_opacity(strength);
        let font = egui::TextStyle::Body.resolve(ui.style());
        let width = 460.0_f32.min(picture.width() - 40.0);
        let size = vec2(width, 24.0 * text::help::HINTS.len() as f32 + 16.0);
        // In the corner that nothing else has: the object stands in the middle, the scale bar at the left.
        let area = Rect::from_min_size(picture.max - size - vec2(8.0, 8.0), size);
        painter.rect_filled(area, 8.0, theme::OUTLINE.gamma_multiply(0.78));
        for (row, (gesture, effect)) in (0..).zip(text::help::HINTS) {
            let left = area.left_top() + vec2(16.0, 20.0 + 24.0 * row as f32);
            let write = |at, ink: Color32, words: &str| {
                painter.text(at, Align2::LEFT_CENTER, words, font.clone(), ink)
            };
            let said = write(left, theme::ACCENT, gesture);
            write(said.right_center() + vec2(10.0, 0.0), theme::EYE_CURVE, effect);
        }
        let response = ui.interact(area, Id::unique("hints"), Sense::click());
        response.widget_info(|| WidgetInfo::labeled(egui::Role::Button, true, text::help::CLOSE_HINTS));
        if response.clicked() {
            self.on = false;
        }
    }
}
