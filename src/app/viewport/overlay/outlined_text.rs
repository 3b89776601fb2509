//! Outlined text that is legible on any picture.

use eframe::egui::{Align2, FontId, Painter, Pos2, vec2};

use crate::app::common::theme;

/// Paints text with an outline that makes it legible on any picture.
pub(crate) fn paint_outlined_text(painter: &Painter, at: Pos2, align: Align2, text: &str) {
    let font = FontId::proportional(12.0);
    for offset in [vec2(1.0, 0.0), vec2(-1.0, 0.0), vec2(0.0, 1.0), vec2(0.0, -1.0)] {
        painter.text(at + offset, align, text, font.clone(), theme::OUTLINE);
    }
    painter.text(at, align, text, font, theme::PICTURE_TEXT);
}
