//! Orientation letters at the edges of a picture, which name the sides of a body.

use eframe::egui::{Align2, Painter, Pos2, Rect, vec2};

use super::outlined_text::paint_outlined_text;

/// Distance of the letters from the edge of the picture, in points.
pub(super) const MARGIN: f32 = 8.0;

/// Text at one edge of a picture, with its placement.
struct PlacedLetters {
    at: Pos2,
    /// Point of the text's box that lies at `at`.
    align: Align2,
    text: String,
}

/// Places the letters at the right, left, top and bottom of a picture.
fn place_letters(picture: Rect, [right, left, top, bottom]: [String; 4], margin: f32) -> [PlacedLetters; 4] {
    [
        (right, picture.right_center() - vec2(margin, 0.0), Align2::RIGHT_CENTER),
        (left, picture.left_center() + vec2(margin, 0.0), Align2::LEFT_CENTER),
        (top, picture.center_top() + vec2(0.0, margin), Align2::CENTER_TOP),
        (bottom, picture.center_bottom() - vec2(0.0, margin), Align2::CENTER_BOTTOM),
    ]
    .map(|(text, at, align)| PlacedLetters { at, align, text })
}

/// Paints the letters at the right, left, top and bottom of a picture, `margin` points from its edges.
pub(crate) fn paint_orientation_letters(painter: &Painter, picture: Rect, sides: [String; 4], margin: f32) {
    for PlacedLetters { at, align, text } in place_letters(picture, sides, margin) {
        paint_outlined_text(painter, at, align, &text);
    }
}
