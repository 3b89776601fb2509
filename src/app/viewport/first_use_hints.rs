//! Three hints for new users over the first picture; dismissed permanently by the first drag or a click on them.

use eframe::egui::{self, Id, Rect, Response, Sense, Ui, Vec2, WidgetInfo, vec2};

use crate::app::common::theme;
use crate::app::text;

/// Padding around the hints, and the gap between two of them, both in points.
const MARGIN: Vec2 = Vec2::new(14.0, 10.0);
const GAP: f32 = 6.0;

/// Visibility of the first-start hints.
#[derive(Debug, Default)]
pub(crate) struct FirstUseHints {
    /// True until the user has dismissed the hints.
    pub visible: bool,
}

impl FirstUseHints {
    /// Shows the hints until the user interacts with the picture.
    pub(crate) fn show(&mut self, ui: &Ui, picture: Rect, used: &Response) {
        if used.dragged() || used.clicked() || ui.input(|input| input.pointer.any_down()) {
            self.visible = false;
        }
        let strength =
            ui.ctx().animate_bool_with_time(Id::unique("hints"), self.visible, 4.0 * theme::FADE_S);
        if strength <= 0.0 || picture.height() < 260.0 {
            return;
        }
        let mut painter = ui.painter_at(picture);
        painter.multiply_opacity(strength);
        let font = egui::TextStyle::Body.resolve(ui.style());
        let lay = |words: &str, ink| painter.layout_no_wrap(words.to_owned(), font.clone(), ink);
        let rows = text::help::HINTS
            .map(|(gesture, effect)| [lay(gesture, theme::ACCENT), lay(effect, theme::PICTURE_TEXT)]);
        let row = rows[0][0].size().y;
        let width = rows.iter().flatten().map(|galley| galley.size().x).fold(0.0, f32::max);
        let size = vec2(width, (2.0 * row + GAP) * rows.len() as f32 - GAP) + 2.0 * MARGIN;
        // In the corner that is otherwise free, and no wider than necessary: the object is in the middle, the scale
        // bar at the left.
        let area = Rect::from_min_size(picture.max - size - vec2(8.0, 8.0), size);
        painter.rect_filled(area, 8.0, theme::OUTLINE.gamma_multiply(0.78));
        let mut at = area.min + MARGIN;
        for [gesture, effect] in rows {
            painter.galley(at, gesture, theme::ACCENT);
            painter.galley(at + vec2(0.0, row), effect, theme::PICTURE_TEXT);
            at.y += 2.0 * row + GAP;
        }
        let response = ui.interact(area, Id::unique("hints"), Sense::click());
        response.widget_info(|| WidgetInfo::labeled(egui::Role::Button, true, text::help::CLOSE_HINTS));
        if response.clicked() {
            self.visible = false;
        }
    }
}
