//! Where the picture is: a rectangle on the grid of the screen's pixels.

use eframe::egui::{Rect, pos2};

/// The picture's rectangle in points and its size in physical pixels, on the pixel grid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Canvas {
    /// In points; every edge is at a whole physical pixel.
    pub rect: Rect,
    /// In physical pixels.
    pub size: [u32; 2],
}

impl Canvas {
    /// The largest rectangle on the pixel grid within another.
    pub(crate) fn within(rect: Rect, pixels_per_point: f32) -> Self {
        // A hair of tolerance: 799.9999 is pixel 800.
        let up = |x: f32| (x * pixels_per_point - 0.01).ceil();
        let down = |x: f32| (x * pixels_per_point + 0.01).floor();
        let (left, top) = (up(rect.min.x), up(rect.min.y));
        let (right, bottom) = (down(rect.max.x).max(left), down(rect.max.y).max(top));
        Self {
            rect: Rect::from_min_max(
                pos2(left, top) / pixels_per_point,
                pos2(right, bottom) / pixels_per_point,
            ),
            size: [(right - left) as u32, (bottom - top) as u32],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_canvas_lies_on_the_pixel_grid() {
        for pixels_per_point in [1.0f32, 1.25, 1.5, 1.75, 2.0, 3.0] {
            let rect = Rect::from_min_max(pos2(0.3, 23.7), pos2(701.1, 555.5));
            let canvas = Canvas::within(rect, pixels_per_point);
            for edge in [canvas.rect.min.x, canvas.rect.min.y, canvas.rect.max.x, canvas.rect.max.y] {
                let pixel = edge * pixels_per_point;
                assert!((pixel - pixel.round()).abs() < 1e-3, "{pixel} at {pixels_per_point}");
            }
            let width = canvas.rect.width() * pixels_per_point;
            assert!((width - canvas.size[0] as f32).abs() < 1e-3);
        }
        assert_eq!(Canvas::within(Rect::from_min_max(pos2(5.0, 5.0), pos2(4.0, 5.0)), 1.0).size, [0, 0]);
    }
}
