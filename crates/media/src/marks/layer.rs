//! Layer of text and shapes that is composited over the rows of a picture, in any number format.

use std::sync::LazyLock;

use ab_glyph::{Font as _, FontRef, ScaleFont as _, point};

use crate::PixelRows;
use chiaroscuro_scene::{ImageSpec, PixelFormat, linear_from_srgb};

/// Font file; its licence is in the same folder.
static FONT: &[u8] = include_bytes!("../../../../assets/fonts/Ubuntu-Light.ttf");

/// Font of the window. `None` if the embedded file is not a valid font.
static TYPEFACE: LazyLock<Option<FontRef<'static>>> = LazyLock::new(|| FontRef::try_from_slice(FONT).ok());

/// Ink colour that is legible on dark pictures.
pub(super) const INK: [u8; 3] = [0xe8, 0xec, 0xf2];
/// Outline colour that keeps the ink legible on bright pictures.
pub(super) const OUTLINE_INK: [u8; 3] = [0x0c, 0x0d, 0x10];

/// Rectangle of one ink with a coverage mask.
#[derive(Debug, Clone, PartialEq)]
struct CoverageMask {
    left: i64,
    top: i64,
    width: usize,
    /// Coverage row by row, from 0 to 255 (opaque).
    coverage: Vec<u8>,
    ink: [u8; 3],
}

/// Shapes and text to be composited over a picture, in pixels from its top left corner.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct MarksLayer {
    dabs: Vec<CoverageMask>,
}

impl MarksLayer {
    /// Fills a rectangle with an ink, at least one pixel wide and high.
    pub(super) fn fill(&mut self, [left, top]: [f64; 2], [width, height]: [f64; 2], ink: [u8; 3], alpha: u8) {
        let (left, top) = (left.round() as i64, top.round() as i64);
        let (width, height) = (width.round().max(1.0) as usize, height.round().max(1.0) as usize);
        self.dabs.push(CoverageMask { left, top, width, coverage: vec![alpha; width * height], ink });
    }

    /// Returns the width of a line of text, in pixels.
    pub(super) fn width(words: &str, height: f64) -> f64 {
        let Some(font) = &*TYPEFACE else { return 0.0 };
        let font = font.as_scaled(height as f32);
        let mut last = None;
        let advances = words.chars().map(|letter| {
            let glyph = font.glyph_id(letter);
            let kern = last.replace(glyph).map_or(0.0, |last| font.kern(last, glyph));
            kern + font.h_advance(glyph)
        });
        f64::from(advances.sum::<f32>())
    }

    /// Writes a line of text `height` pixels high, with an outline that is legible on any picture. `share` selects
    /// the point of the text's box that lies at `at`: fractions from its left and its top, 0 to 1.
    pub(super) fn write(&mut self, words: &str, at: [f64; 2], share: [f64; 2], height: f64) {
        let Some(font) = &*TYPEFACE else { return };
        let left = at[0] - share[0] * Self::width(words, height);
        let top = at[1] - share[1] * height;
        let scaled = font.as_scaled(height as f32);
        let mut x = left as f32;
        let baseline = top as f32 + scaled.ascent();
        let mut letters = Vec::new();
        let mut last = None;
        for letter in words.chars() {
            let id = scaled.glyph_id(letter);
            x += last.replace(id).map_or(0.0, |last| scaled.kern(last, id));
            let glyph = id.with_scale_and_position(height as f32, point(x, baseline));
            x += scaled.h_advance(id);
            letters.extend(font.outline_glyph(glyph).map(|outline| {
                let bounds = outline.px_bounds();
                let (left, top) = (bounds.min.x as i64, bounds.min.y as i64);
                let (width, rows) = (bounds.width() as usize, bounds.height() as usize);
                let mut coverage = vec![0; width * rows];
                outline.draw(|x, y, share| {
                    if let Some(covered) = coverage.get_mut(y as usize * width + x as usize) {
                        *covered = (share.clamp(0.0, 1.0) * 255.0).round() as u8;
                    }
                });
                CoverageMask { left, top, width, coverage, ink: INK }
            }));
        }
        let edge = (height / 14.0).round().max(1.0) as i64;
        for (right, down) in [(-1, 0), (1, 0), (0, -1), (0, 1), (-1, -1), (1, 1), (-1, 1), (1, -1)] {
            let moved = |dab: &CoverageMask| CoverageMask {
                left: dab.left + right * edge,
                top: dab.top + down * edge,
                ink: OUTLINE_INK,
                ..dab.clone()
            };
            self.dabs.extend(letters.iter().map(moved));
        }
        self.dabs.extend(letters);
    }

    /// Composites the layer over rows of a picture, starting at row `first` of the picture.
    pub fn composite_over(&self, image_spec: &ImageSpec, first: usize, rows: &mut PixelRows) {
        let width = image_spec.size[0] as usize;
        for dab in &self.dabs {
            let ink = dab.ink.map(|c| f64::from(c) / 255.0);
            let linear = ink.map(linear_from_srgb);
            for (row, covered) in dab.coverage.chunks(dab.width.max(1)).enumerate() {
                let Ok(y) = usize::try_from(dab.top + row as i64 - first as i64) else { continue };
                for (column, &alpha) in covered.iter().enumerate().filter(|(_, alpha)| **alpha > 0) {
                    let Ok(x) = usize::try_from(dab.left + column as i64) else { continue };
                    if x >= width {
                        continue;
                    }
                    let (at, alpha) = ((y * width + x) * 4, f64::from(alpha) / 255.0);
                    match rows {
                        PixelRows::Bytes(shown) => {
                            if let Some(pixel) = shown.get_mut(at..at + 4) {
                                let before = [0, 1, 2, 3].map(|c| f64::from(pixel[c]) / 255.0);
                                let after = composite_straight(before, ink, alpha);
                                for (byte, value) in pixel.iter_mut().zip(after) {
                                    *byte = (value * 255.0).round() as u8;
                                }
                            }
                        }
                        PixelRows::Floats(shown) => {
                            if let Some(pixel) = shown.get_mut(at..at + 4) {
                                let before = [0, 1, 2, 3].map(|c| f64::from(pixel[c]));
                                let after = if image_spec.depth == PixelFormat::Linear {
                                    composite_premultiplied(before, linear, alpha)
                                } else {
                                    composite_straight(before, ink, alpha)
                                };
                                for (number, value) in pixel.iter_mut().zip(after) {
                                    *number = value as f32;
                                }
                            }
                        }
                    }
                }
            }
        }
    }
}

/// Composites an ink over a colour with straight alpha (Porter and Duff 1984).
fn composite_straight([r, g, b, below]: [f64; 4], ink: [f64; 3], alpha: f64) -> [f64; 4] {
    let left = below * (1.0 - alpha);
    let whole = alpha + left;
    if whole <= 0.0 {
        return [0.0; 4];
    }
    let mix = |before: f64, ink: f64| (ink * alpha + before * left) / whole;
    [mix(r, ink[0]), mix(g, ink[1]), mix(b, ink[2]), whole]
}

/// Composites an ink over a colour with premultiplied alpha.
fn composite_premultiplied([r, g, b, below]: [f64; 4], ink: [f64; 3], alpha: f64) -> [f64; 4] {
    let mix = |before: f64, ink: f64| ink * alpha + before * (1.0 - alpha);
    [mix(r, ink[0]), mix(g, ink[1]), mix(b, ink[2]), mix(below, 1.0)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shapes_cover_their_pixels_and_no_others_in_bands_too() {
        let mut layer = MarksLayer::default();
        layer.fill([1.0, 1.0], [2.0, 2.0], [255, 0, 0], 255);
        // Partly outside the picture.
        layer.fill([-3.0, 3.0], [4.0, 9.0], [0, 255, 0], 255);
        let image_spec = ImageSpec::new([4, 4]);
        let mut whole = PixelRows::Bytes(vec![0; 64]);
        layer.composite_over(&image_spec, 0, &mut whole);
        let mut bands = Vec::new();
        for first in [0, 2] {
            let mut band = PixelRows::Bytes(vec![0; 32]);
            layer.composite_over(&image_spec, first, &mut band);
            let PixelRows::Bytes(band) = band else { unreachable!() };
            bands.extend(band);
        }
        assert_eq!(whole, PixelRows::Bytes(bands.clone()));
        let pixel = |x: usize, y: usize| &bands[(y * 4 + x) * 4..][..4];
        assert_eq!((pixel(1, 1), pixel(2, 2)), (&[255, 0, 0, 255][..], &[255, 0, 0, 255][..]));
        assert_eq!((pixel(0, 3), pixel(3, 3)), (&[0, 255, 0, 255][..], &[0; 4][..]));
    }

    #[test]
    fn inks_lie_over_colors_of_every_kind() {
        assert_eq!(composite_straight([1.0, 1.0, 1.0, 1.0], [0.0; 3], 0.25), [0.75, 0.75, 0.75, 1.0]);
        assert_eq!(composite_straight([0.3, 0.3, 0.3, 0.0], [1.0, 0.5, 0.0], 0.5), [1.0, 0.5, 0.0, 0.5]);
        assert_eq!(composite_premultiplied([0.5, 0.5, 0.5, 0.5], [1.0; 3], 0.5), [0.75; 4]);
        let mut layer = MarksLayer::default();
        layer.fill([0.0, 0.0], [1.0, 1.0], [188, 188, 188], 255);
        let image_spec = ImageSpec { depth: PixelFormat::Linear, ..ImageSpec::new([1, 1]) };
        let mut rows = PixelRows::Floats(vec![4.0, 0.0, 0.0, 1.0]);
        layer.composite_over(&image_spec, 0, &mut rows);
        let PixelRows::Floats(light) = rows else { unreachable!() };
        assert!((light[0] - 0.503).abs() < 0.002 && light[0] == light[2], "{light:?}");
    }

    #[test]
    fn words_are_as_wide_as_they_are_written() {
        let height = 40.0;
        let mut layer = MarksLayer::default();
        layer.write("Skull 12", [100.0, 20.0], [0.5, 0.0], height);
        let ink = layer.dabs.iter().filter(|dab| dab.ink == INK);
        let left = ink.clone().map(|dab| dab.left).min().unwrap() as f64;
        let right = ink.map(|dab| dab.left + dab.width as i64).max().unwrap() as f64;
        let width = MarksLayer::width("Skull 12", height);
        assert!((right - left - width).abs() < 8.0, "{left} … {right}: {width}");
        assert!((f64::midpoint(left, right) - 100.0).abs() < 4.0);
        assert!(MarksLayer::width("WW", height) > MarksLayer::width("ii", height));
    }
}
