//! Backdrop of the plot, behind its curves: a checkerboard, the histogram, and the colours under the eye's curve.
//!
//! It is composed into one picture whenever one of its inputs changes: painted as shapes, three layers over an eighth
//! of the window, it took a software driver longer than the rest of the window.

use eframe::egui::{Color32, Rgba, Shape, pos2};

use super::plot::PlotAxes;
use super::theme;
use crate::app::viewport::canvas::Canvas;
use crate::app::viewport::paint_callback;
use chiaroscuro_render::{WindowPainter, WindowPicture};
use chiaroscuro_scene::TransferFunction;
use chiaroscuro_volume::ValueRange;

/// Smallest opacity of the fill under the curve, so that its colour is seen even where it is nearly transparent.
const MIN_FILL_OPACITY: f32 = 0.25;

/// Bars of the histogram, with equal widths.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct HistogramBars {
    /// Values that the bars cover.
    pub range: ValueRange,
    /// Number of voxels in each bar.
    pub counts: Vec<u64>,
    /// True for logarithmic heights, so that rare values are visible.
    pub log: bool,
}

impl HistogramBars {
    /// Heights of the bars, as shares of the plot's height.
    fn heights(&self) -> Vec<f32> {
        let height = |count: u64| if self.log { (count as f64).ln_1p() } else { count as f64 };
        // The bin of the background would dwarf all others on a linear scale.
        let mut sorted = self.counts.clone();
        sorted.sort_unstable();
        let columns = sorted.len();
        let top = if self.log { columns - 1 } else { (columns * 99 / 100).min(columns - 1) };
        let full = height(sorted[top]).max(1e-9);
        self.counts.iter().map(|&count| (height(count) / full).min(1.0) as f32).collect()
    }

    /// Index of the bar that contains a value.
    fn bar_of(&self, value: f64) -> Option<usize> {
        let span = if self.range.high > self.range.low { self.range.high - self.range.low } else { 1.0 };
        let place = ((value - self.range.low) / span * self.counts.len() as f64).floor();
        (place >= 0.0 && place < self.counts.len() as f64).then_some(place as usize)
    }
}

/// Inputs of the composed picture, compared to detect changes.
#[derive(Debug, Clone, PartialEq)]
struct BackdropKey {
    canvas: Canvas,
    axes: PlotAxes,
    bars: HistogramBars,
    function: TransferFunction,
}

/// Cached picture of the backdrop, with the inputs that it was composed from.
#[derive(Debug)]
pub(super) struct PlotBackdrop {
    window: WindowPainter,
    cached_picture: Option<(BackdropKey, WindowPicture)>,
}

impl PlotBackdrop {
    /// Creates an empty backdrop for a window.
    pub(super) fn new(window: WindowPainter) -> Self {
        Self { window, cached_picture: None }
    }

    /// Returns the shape to paint first, below the curves; recomposes the picture if its inputs have changed.
    pub(super) fn shape(
        &mut self,
        axes: &PlotAxes,
        pixels_per_point: f32,
        bars: HistogramBars,
        function: &TransferFunction,
    ) -> Shape {
        let canvas = Canvas::inscribed(axes.area, pixels_per_point);
        if canvas.size.contains(&0) || bars.counts.is_empty() {
            return Shape::Noop;
        }
        let key = BackdropKey { canvas, axes: *axes, bars, function: function.clone() };
        if self.cached_picture.as_ref().is_none_or(|(before, _)| *before != key) {
            let before = self.cached_picture.take().map(|(_, picture)| picture);
            let bytes = compose(&key, pixels_per_point);
            self.cached_picture = Some((key, self.window.upload(before, canvas.size, &bytes, true)));
        }
        let picture = |(_, picture): &(BackdropKey, WindowPicture)| {
            paint_callback::picture_shape(canvas.rect, picture, u8::MAX)
        };
        self.cached_picture.as_ref().map_or(Shape::Noop, picture)
    }
}

/// Composes the backdrop: pixels from the upper left, row by row; sRGB, four bytes each.
fn compose(key: &BackdropKey, pixels_per_point: f32) -> Vec<u8> {
    let BackdropKey { canvas, axes, bars, function } = key;
    let [width, height] = canvas.size.map(|n| n as usize);
    let heights = bars.heights();
    // Centres of pixels, in points.
    let point = |pixel: usize| (pixel as f32 + 0.5) / pixels_per_point;
    let floor = axes.position(axes.range.low, 0.0).y;
    let tall = floor - axes.position(axes.range.low, 1.0).y;
    let mut pixels = vec![Color32::BLACK; width * height];
    for column in 0..width {
        let x = canvas.rect.min.x + point(column);
        let value = axes.contains_x(x).then(|| axes.value_and_opacity_at(pos2(x, floor)).0);
        let bar = value.and_then(|value| bars.bar_of(value)).map_or(0.0, |bar| heights[bar] * tall);
        let (curve, fill) = value.map_or((0.0, Color32::TRANSPARENT), |value| {
            let opacity = function.opacity_at(value) as f32;
            let [r, g, b] = function.sample(value).color.map(|c| c as f32);
            let share = MIN_FILL_OPACITY + (1.0 - MIN_FILL_OPACITY) * opacity;
            (opacity * tall, Color32::from(Rgba::from_rgb(r, g, b)).gamma_multiply(share))
        });
        for row in 0..height {
            let above_floor = floor - canvas.rect.min.y - point(row);
            let field =
                (point(column) / theme::CHECKER_EDGE) as usize + (point(row) / theme::CHECKER_EDGE) as usize;
            let mut color = axes.ink.checker[1 - field % 2];
            if (0.0..bar).contains(&above_floor) {
                color = axes.ink.histogram;
            }
            if (0.0..curve).contains(&above_floor) {
                color = color.blend(fill);
            }
            pixels[row * width + column] = color;
        }
    }
    pixels.iter().flat_map(Color32::to_array).collect()
}

#[cfg(test)]
mod tests {
    use eframe::egui::{Rect, vec2};

    use super::super::zoom::ShownValues;
    use super::*;
    use chiaroscuro_scene::ControlPoint;

    #[test]
    fn bars_and_colours_stand_on_the_floor() {
        let area = Rect::from_min_size(pos2(3.0, 400.0), vec2(116.0, 64.0));
        let axes = PlotAxes::new(
            area,
            ShownValues { low: 0.0, high: 10.0, is_whole: true },
            theme::PlotColors::DARK,
        );
        let bars = HistogramBars {
            range: ValueRange::new(0.0, 10.0),
            counts: vec![0, 8, 4, 0, 0, 0, 0, 0, 0, 0],
            log: false,
        };
        // Opaque white from 6 on, nothing before.
        let points = [(0.0, 0.0), (6.0, 0.0), (6.0, 1.0), (10.0, 1.0)];
        let points = points.map(|(value, opacity)| ControlPoint::new(value, [1.0; 3], opacity)).to_vec();
        let function = TransferFunction { points, ..TransferFunction::default() };
        let key = BackdropKey { canvas: Canvas::inscribed(area, 1.0), axes, bars, function };
        let picture = compose(&key, 1.0);
        let at = |value: f64, share: f64| {
            let place = axes.position(value, share) - key.canvas.rect.min;
            let pixel = place.y as usize * 116 + place.x as usize;
            Color32::from_rgb(picture[4 * pixel], picture[4 * pixel + 1], picture[4 * pixel + 2])
        };
        let is_checker = |color| theme::PlotColors::DARK.checker.contains(&color);
        assert_eq!(at(1.5, 0.9), theme::PlotColors::DARK.histogram);
        assert_eq!(at(2.5, 0.4), theme::PlotColors::DARK.histogram);
        assert!(is_checker(at(2.5, 0.6)), "the bar is half as tall");
        assert!(is_checker(at(0.5, 0.9)) && is_checker(at(5.5, 0.1)), "nothing is there");
        assert_eq!(at(7.5, 0.1), Color32::WHITE);
        assert_eq!(at(7.5, 0.9), Color32::WHITE);
        // The margin shows neither.
        assert!(is_checker(Color32::from_rgb(picture[0], picture[1], picture[2])));
    }
}
