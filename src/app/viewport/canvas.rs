//! Canvas: the rectangle of the picture in the window, aligned to the grid of physical pixels.

use eframe::egui::{Rect, pos2, vec2};

/// Rectangle of the picture in points, and its size in physical pixels; the edges lie on the pixel grid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Canvas {
    /// Rectangle in points; every edge lies on a whole physical pixel.
    pub rect: Rect,
    /// Width and height in physical pixels.
    pub size: [u32; 2],
    /// Size, in physical pixels, of the area that the picture could fill if its aspect ratio were free.
    pub available_size: [u32; 2],
}

/// Relative difference of two aspect ratios below which they count as equal.
const ASPECT_TOLERANCE: f64 = 0.01;

impl Canvas {
    /// Returns the largest pixel-aligned canvas inside `rect`, which is in points.
    pub(crate) fn inscribed(rect: Rect, pixels_per_point: f32) -> Self {
        // Tolerance of 0.01 pixels against rounding errors: 799.9999 is pixel 800.
        let up = |x: f32| (x * pixels_per_point - 0.01).ceil();
        let down = |x: f32| (x * pixels_per_point + 0.01).floor();
        let (left, top) = (up(rect.min.x), up(rect.min.y));
        let (right, bottom) = (down(rect.max.x).max(left), down(rect.max.y).max(top));
        let size = [(right - left) as u32, (bottom - top) as u32];
        Self {
            rect: Rect::from_min_max(
                pos2(left, top) / pixels_per_point,
                pos2(right, bottom) / pixels_per_point,
            ),
            size,
            available_size: size,
        }
    }

    /// Returns the largest canvas centred in this one with `shape` as its aspect ratio (width over height).
    pub(crate) fn with_aspect_ratio(self, shape: f64, pixels_per_point: f32) -> Self {
        let here = f64::from(self.rect.width()) / f64::from(self.rect.height().max(1.0));
        if (here / shape - 1.0).abs() < ASPECT_TOLERANCE {
            return self;
        }
        let size = if here > shape {
            vec2((f64::from(self.rect.height()) * shape) as f32, self.rect.height())
        } else {
            vec2(self.rect.width(), (f64::from(self.rect.width()) / shape) as f32)
        };
        let centred = Rect::from_center_size(self.rect.center(), size);
        Self { available_size: self.available_size, ..Self::inscribed(centred, pixels_per_point) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_canvas_lies_on_the_pixel_grid() {
        for pixels_per_point in [1.0f32, 1.25, 1.5, 1.75, 2.0, 3.0] {
            let rect = Rect::from_min_max(pos2(0.3, 23.7), pos2(701.1, 555.5));
            let canvas = Canvas::inscribed(rect, pixels_per_point);
            for edge in [canvas.rect.min.x, canvas.rect.min.y, canvas.rect.max.x, canvas.rect.max.y] {
                let pixel = edge * pixels_per_point;
                assert!((pixel - pixel.round()).abs() < 1e-3, "{pixel} at {pixels_per_point}");
            }
            let width = canvas.rect.width() * pixels_per_point;
            assert!((width - canvas.size[0] as f32).abs() < 1e-3);
        }
        let whole = Canvas::inscribed(Rect::from_min_size(pos2(10.0, 20.0), vec2(800.0, 400.0)), 2.0);
        for (shape, size) in [(2.001, [1600, 800]), (1.0, [800, 800]), (4.0, [1600, 400])] {
            let part = whole.with_aspect_ratio(shape, 2.0);
            assert_eq!((part.size, part.available_size), (size, [1600, 800]));
            assert_eq!(part.rect.center(), whole.rect.center());
        }
        assert_eq!(Canvas::inscribed(Rect::from_min_max(pos2(5.0, 5.0), pos2(4.0, 5.0)), 1.0).size, [0, 0]);
    }
}
