//! The letters at the edges of a picture that say which side of a body is where.

use eframe::egui::{Align2, Painter, Pos2, Rect, vec2};

use super::outlined::outlined;

/// Points from the edge of the picture.
pub(super) const MARGIN: f32 = 8.0;

/// What is written at an edge of a picture.
struct Letters {
    at: Pos2,
    /// Which part of the text is there.
    align: Align2,
    text: String,
}

/// Places of the letters at the right, the left, the top and the bottom of a picture.
fn letters(picture: Rect, [right, left, top, bottom]: [String; 4], margin: f32) -> [Letters; 4] {
    [
        (right, picture.right_center() - vec2(margin, 0.0), Align2::RIGHT_CENTER),
        (left, picture.left_center() + vec2(margin, 0.0), Align2::LEFT_CENTER),
        (top, picture.center_top() + vec2(0.0, margin), Align2::CENTER_TOP),
        (bottom, picture.center_bottom() - vec2(0.0, margin), Align2::CENTER_BOTTOM),
    ]
    .map(|(text, at, align)| Letters { at, align, text })
}

/// Writes the letters at the right, the left, the top and the bottom of a picture, so many points from its edges.
pub(in crate::app) fn write(painter: &Painter, picture: Rect, sides: [String; 4], margin: f32) {
    for Letters { at, align, text } in letters(picture, sides, margin) {
        outlined(painter, at, align, &text);
    }
}
