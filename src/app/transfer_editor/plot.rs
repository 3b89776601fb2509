//! Painting of the transfer function plot: axes, curves, control points, labels and readout.

use eframe::egui::{
    self, Align2, Color32, FontId, Painter, Pos2, Rect, Response, Shape, Stroke, Ui, Vec2, pos2,
};

use super::text;
use super::theme::{self, PlotColors};
use super::zoom::ShownValues;
use crate::app::common::volume_facts::range_decimals;
use chiaroscuro_scene::{TransferFunction, VolumeLayer};
use chiaroscuro_volume::{Histogram, ValueRange};

/// Distance between two samples of a curve, in points.
const SAMPLE_STEP: f32 = 2.0;
/// Margin around the plot, in points, so that control points at its borders can be grabbed.
const MARGIN: Vec2 = Vec2::new(8.0, 7.0);

/// Values of the first volume that are marked elsewhere in the window.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct PlotMarks {
    /// Value that the probe reads, or at which a surface lies.
    pub value: Option<f64>,
    /// Value under the pointer in the picture, and its change over a voxel.
    pub hovered: Option<[f64; 2]>,
}

/// Mapping from value and opacity to positions in the window.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct PlotAxes {
    /// Whole area, including the margin.
    pub area: Rect,
    /// Values at the left and right end.
    pub range: ValueRange,
    /// True if all of the volume's values are shown.
    is_whole: bool,
    plot: Rect,
    /// Colours of lines, texts and grounds.
    pub ink: PlotColors,
}

impl PlotAxes {
    /// Creates axes over an area, for the values that are shown.
    pub(super) fn new(area: Rect, shown: ShownValues, ink: PlotColors) -> Self {
        let ShownValues { low, high, is_whole } = shown;
        // A volume of a single value still needs an axis.
        let range = ValueRange::new(low, if high > low { high } else { low + 1.0 });
        Self { area, range, is_whole, plot: area.shrink2(MARGIN), ink }
    }

    /// Position of a value and an opacity in the window, clamped to the plot.
    pub(super) fn position(&self, value: f64, opacity: f64) -> Pos2 {
        let x = ((value - self.range.low) / (self.range.high - self.range.low)).clamp(0.0, 1.0) as f32;
        pos2(
            self.plot.min.x + x * self.plot.width(),
            self.plot.max.y - opacity.clamp(0.0, 1.0) as f32 * self.plot.height(),
        )
    }

    /// Value and opacity at a position, clamped to the axes.
    pub(super) fn value_and_opacity_at(&self, at: Pos2) -> (f64, f64) {
        let x = f64::from(((at.x - self.plot.min.x) / self.plot.width()).clamp(0.0, 1.0));
        let y = f64::from(((self.plot.max.y - at.y) / self.plot.height()).clamp(0.0, 1.0));
        (self.range.low + x * (self.range.high - self.range.low), y)
    }

    /// Returns true if a value lies within the shown range.
    pub(super) fn contains_value(&self, value: f64) -> bool {
        // With all values shown, points beyond them are drawn at the border.
        let slack = 1e-9 * (self.range.high - self.range.low);
        (self.range.low - slack..=self.range.high + slack).contains(&value) || self.is_whole
    }

    /// Returns true if a horizontal position is over the plot.
    pub(super) fn contains_x(&self, x: f32) -> bool {
        self.plot.x_range().contains(x)
    }

    /// Horizontal position of a value, also beyond the plot.
    fn x_of(&self, value: f64) -> f32 {
        self.plot.min.x
            + ((value - self.range.low) / (self.range.high - self.range.low)) as f32 * self.plot.width()
    }

    /// Horizontal positions at which curves are sampled, with their values.
    fn samples(&self) -> impl Iterator<Item = (f32, f64)> + use<> {
        let Self { plot, range, .. } = *self;
        let count = (plot.width() / SAMPLE_STEP).ceil().max(1.0) as usize;
        (0..=count).map(move |i| {
            let share = i as f64 / count as f64;
            (plot.min.x + share as f32 * plot.width(), range.low + share * (range.high - range.low))
        })
    }

    /// Width of the plot, in points.
    pub(super) fn width(&self) -> f32 {
        self.plot.width()
    }

    fn y_of(&self, opacity: f64) -> f32 {
        self.plot.max.y - opacity.clamp(0.0, 1.0) as f32 * self.plot.height()
    }
}

/// Number of voxels per bar: at most one bar per point of width, or one per distinct value if there are fewer.
pub(super) fn histogram_bars(histogram: &Histogram, levels: Option<usize>, width: f32) -> Vec<u64> {
    let bins = histogram.counts.len();
    if let Some(levels) = levels.filter(|&levels| levels <= bins && levels <= width as usize) {
        // Each value has a bin of its own; the bins between are empty.
        let bin = |level: usize| (level * bins / (levels - 1).max(1)).min(bins - 1);
        return (0..levels).map(|level| histogram.counts[bin(level)]).collect();
    }
    let columns = (width as usize).clamp(1, bins);
    let first = |column: usize| column * bins / columns;
    (0..columns).map(|column| histogram.counts[first(column)..first(column + 1)].iter().sum()).collect()
}

/// Paints the eye's curve, dimmed if it is not edited.
pub(super) fn paint_eye_curve(painter: &Painter, axes: &PlotAxes, function: &TransferFunction, edited: bool) {
    let line = axes.samples().map(|(x, value)| pos2(x, axes.y_of(function.opacity_at(value)))).collect();
    let strength = if edited { 1.0 } else { 0.5 };
    painter.add(Shape::line(line, Stroke::new(1.5, axes.ink.eye.gamma_multiply(strength))));
}

/// Paints the lighting curve, dashed while it is linked to the eye's.
pub(super) fn paint_light_curve(painter: &Painter, axes: &PlotAxes, layer: &VolumeLayer, edited: bool) {
    let VolumeLayer { transfer, lighting, .. } = layer;
    let (linked, scale) = (lighting.linked, lighting.scale);
    let function = if linked { transfer } else { &lighting.curve };
    // The scale multiplies the extinction, not the opacity.
    let scaled = |value: f64| 1.0 - (-function.sample(value).depth * scale).exp();
    let line: Vec<Pos2> = axes.samples().map(|(x, value)| pos2(x, axes.y_of(scaled(value)))).collect();
    let stroke = Stroke::new(if edited { 2.0 } else { 1.2 }, axes.ink.light);
    if linked {
        painter.extend(Shape::dashed_line(&line, stroke, 5.0, 5.0));
    } else {
        painter.add(Shape::line(line, stroke));
    }
}

/// Paints the labels at the ends of the axes.
pub(super) fn paint_axis_labels(painter: &Painter, axes: &PlotAxes, upper: &str) {
    let ink = axes.ink.eye.gamma_multiply(0.75);
    let plot = axes.plot;
    let write = |at: Pos2, align: Align2, text: String| {
        paint_text_on_ground(painter, axes, (at, align), text, ink);
    };
    write(plot.left_bottom(), Align2::LEFT_BOTTOM, format_value(axes.range.low, axes.range));
    write(plot.right_bottom(), Align2::RIGHT_BOTTOM, format_value(axes.range.high, axes.range));
    write(plot.left_top(), Align2::LEFT_TOP, upper.to_owned());
}

/// Formats a value with as many digits as the range needs.
pub(super) fn format_value(value: f64, range: ValueRange) -> String {
    let decimals = range_decimals(range);
    format!("{value:.decimals$}")
}

/// Paints a control point: a disc of its colour in a ring.
pub(super) fn paint_point(
    painter: &Painter,
    ink: &PlotColors,
    (at, radius): (Pos2, f32),
    color: Color32,
    selected: bool,
) {
    painter.circle_filled(at, radius + 1.5, ink.background);
    let ring = if selected { theme::ACCENT } else { ink.eye };
    painter.circle(at, radius, color, Stroke::new(if selected { 2.0 } else { 1.5 }, ring));
}

/// Paints value and opacity under the pointer.
pub(super) fn paint_readout(ui: &Ui, axes: &PlotAxes, response: &Response, function: &TransferFunction) {
    let Some(at) = response.hover_pos() else { return };
    let (value, _) = axes.value_and_opacity_at(at);
    let painter = ui.painter_at(axes.area);
    let line = Stroke::new(1.0, axes.ink.eye.gamma_multiply(0.35));
    painter.vline(at.x, egui::Rangef::new(axes.plot.min.y, axes.plot.max.y), line);
    let opacity = function.opacity_at(value);
    let words = text::transfer::pointer_readout(&format_value(value, axes.range), opacity);
    paint_readout_text(ui, axes, at, words);
}

/// Paints what is at the pointer beside it, on the side with more room.
pub(super) fn paint_readout_text(ui: &Ui, axes: &PlotAxes, at: Pos2, words: String) {
    let right = at.x < axes.area.center().x;
    let (align, dx) = if right { (Align2::LEFT_TOP, 6.0) } else { (Align2::RIGHT_TOP, -6.0) };
    let place = pos2(at.x + dx, axes.plot.min.y + 14.0);
    paint_text_on_ground(&ui.painter_at(axes.area), axes, (place, align), words, axes.ink.eye);
}

/// Paints text on a ground of its own, legible over curves and fills of any colour.
fn paint_text_on_ground(
    painter: &Painter,
    axes: &PlotAxes,
    (at, align): (Pos2, Align2),
    text: String,
    ink: Color32,
) {
    let galley = painter.layout_no_wrap(text, FontId::proportional(11.0), ink);
    let area = align.anchor_size(at, galley.size());
    painter.rect_filled(area.expand2(Vec2::new(3.0, 1.0)), 3.0, axes.ink.background.gamma_multiply(0.75));
    painter.galley(area.min, galley, ink);
}

/// Marks the value that the light probe reads in another view, or at which a surface lies.
pub(super) fn paint_value_mark(ui: &Ui, axes: &PlotAxes, marked_value: Option<f64>) {
    let Some(value) = marked_value.filter(|&value| axes.contains_value(value)) else { return };
    let x = axes.x_of(value);
    let painter = ui.painter_at(axes.area);
    painter.vline(x, egui::Rangef::new(axes.plot.min.y, axes.plot.max.y), Stroke::new(1.5, theme::ACCENT));
    let head =
        [pos2(x - 4.0, axes.plot.min.y), pos2(x + 4.0, axes.plot.min.y), pos2(x, axes.plot.min.y + 6.0)];
    painter.add(Shape::convex_polygon(head.to_vec(), theme::ACCENT, Stroke::NONE));
}

#[cfg(test)]
mod tests {
    use super::*;
    use eframe::egui::vec2;

    #[test]
    fn places_and_values_agree() {
        let axes = PlotAxes::new(
            Rect::from_min_size(pos2(7.0, 400.0), vec2(900.0, 120.0)),
            ShownValues { low: -1000.0, high: 3000.0, is_whole: true },
            PlotColors::DARK,
        );
        let at = axes.position(250.0, 0.37);
        let (value, opacity) = axes.value_and_opacity_at(at);
        assert!((value - 250.0).abs() < 0.5 && (opacity - 0.37).abs() < 1e-3, "{value} {opacity}");
        assert_eq!(axes.value_and_opacity_at(pos2(-50.0, 9000.0)), (-1000.0, 0.0));
        assert!(
            PlotAxes::new(axes.area, ShownValues { low: 5.0, high: 5.0, is_whole: true }, PlotColors::DARK)
                .position(5.0, 0.0)
                .x
                .is_finite()
        );
    }

    #[test]
    fn every_voxel_is_in_a_bar() {
        use chiaroscuro_volume::{Samples, Volume};
        let values = Samples::U8((0..=199).chain(0..=55).collect());
        let volume = Volume::with_spacing("ramp", [16, 4, 4], glam::DVec3::ONE, values).unwrap();
        let histogram = Histogram::from_volume(&volume);
        let per_value = histogram_bars(&histogram, Some(200), 900.0);
        assert_eq!(per_value.len(), 200);
        assert!(per_value.iter().enumerate().all(|(value, &count)| count == if value <= 55 { 2 } else { 1 }));
        for width in [0.0, 150.0, 900.0, 5000.0] {
            assert_eq!(histogram_bars(&histogram, None, width).iter().sum::<u64>(), 256);
        }
    }

    #[test]
    fn numbers_have_sensible_digits() {
        assert_eq!(format_value(1024.0, ValueRange::new(0.0, 4095.0)), "1024");
        assert_eq!(format_value(0.5, ValueRange::new(0.0, 1.0)), "0.50");
        assert_eq!(format_value(0.00125, ValueRange::new(0.0, 0.004)), "0.00125");
    }
}
