//! What of the picture would be exported, while its shape is another.

use eframe::egui::{Color32, Rect, Stroke, StrokeKind, Ui, vec2};

use crate::app::common::theme;
use crate::model::Camera;

/// Shapes that differ by less look the same.
const ALIKE: f64 = 0.01;

/// The part of the window's picture that an exported one of a shape (width over height) shows; it may reach beyond.
fn seen(picture: Rect, camera: &Camera, shape: f64) -> Rect {
    let here = f64::from(picture.width()) / f64::from(picture.height().max(1.0));
    let height = f64::from(picture.height()) * camera.half_height_at_target(shape)
        / camera.half_height_at_target(here);
    Rect::from_center_size(picture.center(), vec2((height * shape) as f32, height as f32))
}

/// Darkens what would not be exported.
pub(crate) fn show(ui: &Ui, picture: Rect, camera: &Camera, shape: f64) {
    let here = f64::from(picture.width()) / f64::from(picture.height().max(1.0));
    if (here / shape - 1.0).abs() < ALIKE {
        return;
    }
    let frame = seen(picture, camera, shape);
    let painter = ui.painter_at(picture);
    let shade = Color32::from_black_alpha(120);
    for part in [
        Rect::from_x_y_ranges(picture.left()..=frame.left(), picture.y_range()),
        Rect::from_x_y_ranges(frame.right()..=picture.right(), picture.y_range()),
        Rect::from_x_y_ranges(frame.x_range(), picture.top()..=frame.top()),
        Rect::from_x_y_ranges(frame.x_range(), frame.bottom()..=picture.bottom()),
    ] {
        if part.is_positive() {
            painter.rect_filled(part, 0.0, shade);
        }
    }
    painter.rect_stroke(frame, 0.0, Stroke::new(1.0, theme::GUIDE), StrokeKind::Inside);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::Fit;
    use eframe::egui::pos2;

    #[test]
    fn frames_show_what_is_exported() {
        let picture = Rect::from_min_size(pos2(10.0, 20.0), vec2(800.0, 400.0));
        let mut camera = Camera { fit: Fit::Height, ..Camera::default() };
        // As high, and narrower.
        let square = seen(picture, &camera, 1.0);
        assert!((square.width() - 400.0).abs() < 0.1 && (square.height() - 400.0).abs() < 0.1);
        assert_eq!(square.center(), picture.center());
        // A frame of 4:3 lies in both.
        camera.fit = Fit::Frame;
        let tall = seen(picture, &camera, 0.5);
        assert!((tall.width() - 400.0 * 4.0 / 3.0).abs() < 0.5, "{tall}");
        assert!(tall.height() > picture.height());
    }
}
