//! The letters at the edges of the picture that say which side of a body is where.

use eframe::egui::{Align2, Pos2, Rect, vec2};

use crate::export::sides;
use crate::model::Camera;

/// Points from the edge of the picture.
const MARGIN: f32 = 8.0;

/// What is written at an edge of the picture.
pub(super) struct Letters {
    pub at: Pos2,
    /// Which part of the text is there.
    pub align: Align2,
    pub text: String,
}

/// Which sides of a body are where in a picture of it, or a part of one.
pub(super) fn letters(picture: Rect, camera: &Camera) -> [Letters; 4] {
    let [right, left, top, bottom] = sides(camera);
    [
        (right, picture.right_center() - vec2(MARGIN, 0.0), Align2::RIGHT_CENTER),
        (left, picture.left_center() + vec2(MARGIN, 0.0), Align2::LEFT_CENTER),
        (top, picture.center_top() + vec2(0.0, MARGIN), Align2::CENTER_TOP),
        (bottom, picture.center_bottom() - vec2(0.0, MARGIN), Align2::CENTER_BOTTOM),
    ]
    .map(|(text, at, align)| Letters { at, align, text })
}
