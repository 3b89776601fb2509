//! Zoom of the plot along the value axis: the wheel zooms to the pointer, a drag with the middle button moves.

use eframe::egui::{PointerButton, Rect, Response, Ui};

use super::super::text;
use crate::app::viewport::mouse_navigation::wheel_notches;
use chiaroscuro_volume::{ValueRange, ValueRanges};

/// Factor by which a notch of the wheel narrows the shown range.
const ZOOM_PER_NOTCH: f64 = 1.2;
/// Smallest share of the values that is shown: the histogram has a thousand bars, and this is twenty of them.
const MIN_VISIBLE_SHARE: f64 = 0.02;

/// Part of the values that the plot shows; `None` is all of them.
#[derive(Debug, Default, Clone, Copy, PartialEq)]
pub(super) struct PlotZoom {
    visible_part: Option<ValueRange>,
}

/// Range of values that the plot shows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct ShownValues {
    /// Smallest value that is shown.
    pub low: f64,
    /// Largest value that is shown.
    pub high: f64,
    /// True if all of the volume's values are shown.
    pub is_whole: bool,
}

/// Range of the value axis: the shown range of the volume, widened by control points, but frozen while a button is
/// held. Otherwise a dragged point would move the axis, and the axis the point.
#[derive(Debug, Default, Clone, Copy)]
pub(super) struct AxisSpan {
    /// Value ranges of the volume, and the span frozen since the button was pressed.
    frozen: Option<(ValueRanges, ValueRange)>,
}

impl AxisSpan {
    /// Returns the span of this frame, frozen while `is_held`.
    pub(super) fn update(&mut self, is_held: bool, ranges: ValueRanges, shown: ValueRange) -> ValueRange {
        let held = self.frozen.filter(|(before, _)| is_held && *before == ranges);
        let span = held.map_or(shown, |(_, span)| span);
        self.frozen = is_held.then_some((ranges, span));
        span
    }
}

/// Values within which points can be moved: all values of the volume and all that the axis spans.
pub(super) fn point_limits(ranges: ValueRanges, span: ValueRange) -> ValueRange {
    ValueRange::new(ranges.all.low.min(span.low), ranges.all.high.max(span.high))
}

impl PlotZoom {
    /// Values of a range that are shown at the current zoom.
    pub(super) fn visible_range(&self, range: ValueRange) -> ShownValues {
        // Another volume has other values, so the zoom does not apply.
        match self.visible_part.filter(|part| part.low >= range.low && part.high <= range.high) {
            Some(ValueRange { low, high }) => ShownValues { low, high, is_whole: false },
            None => ShownValues { low: range.low, high: range.high, is_whole: true },
        }
    }

    /// Zoom factor: width of the range over the width that is shown.
    pub(super) fn zoom_factor(&self, range: ValueRange) -> f32 {
        let ShownValues { low, high, .. } = self.visible_range(range);
        ((range.high - range.low) / (high - low).max(1e-300)).clamp(1.0, 1.0 / MIN_VISIBLE_SHARE) as f32
    }

    /// Handles wheel and middle-button drags over the plot.
    pub(super) fn ui(&mut self, ui: &Ui, response: &Response, area: Rect, range: ValueRange) {
        let Some(pointer) = ui.ctx().pointer_hover_pos().filter(|at| area.contains(*at)) else { return };
        let share = f64::from(((pointer.x - area.min.x) / area.width().max(1.0)).clamp(0.0, 1.0));
        let notches = wheel_notches(ui);
        if notches != 0.0 && response.contains_pointer() {
            self.zoom_at(range, share, ZOOM_PER_NOTCH.powf(-notches));
        }
        let delta = ui.input(|input| input.pointer.delta().x);
        if ui.input(|input| input.pointer.button_down(PointerButton::Middle)) && delta != 0.0 {
            self.pan(range, -f64::from(delta / area.width().max(1.0)));
        }
    }

    /// Shows a button that resets the zoom, while it is zoomed in.
    pub(super) fn show_reset_button(&mut self, ui: &mut Ui) {
        let all = text::transfer::SHOW_ALL;
        if self.visible_part.is_some() && ui.button(all.name).on_hover_text(all.tooltip).clicked() {
            self.visible_part = None;
        }
    }

    /// Scales the shown range by a factor, with the value at `share` fixed.
    fn zoom_at(&mut self, range: ValueRange, share: f64, factor: f64) {
        let ShownValues { low, high, .. } = self.visible_range(range);
        let all = range.high - range.low;
        let width = ((high - low) * factor).clamp(MIN_VISIBLE_SHARE * all, all);
        let low = low + share * (high - low - width);
        self.set_range(range, low, width);
    }

    /// Moves the shown range by a share of its width.
    fn pan(&mut self, range: ValueRange, share: f64) {
        let ShownValues { low, high, is_whole } = self.visible_range(range);
        if !is_whole {
            self.set_range(range, low + share * (high - low), high - low);
        }
    }

    fn set_range(&mut self, range: ValueRange, low: f64, width: f64) {
        let low = low.clamp(range.low, (range.high - width).max(range.low));
        let whole = width >= (range.high - range.low) * (1.0 - 1e-9);
        self.visible_part = (!whole).then_some(ValueRange::new(low, (low + width).min(range.high)));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_axis_stays_while_a_button_is_held() {
        let ranges = ValueRanges { all: ValueRange::new(-50.0, 70.0), robust: ValueRange::new(0.0, 10.0) };
        let (narrow, wide) = (ranges.robust, ValueRange::new(0.0, 80.0));
        let mut span = AxisSpan::default();
        assert_eq!(span.update(false, ranges, narrow), narrow);
        assert_eq!(span.update(true, ranges, narrow), narrow);
        assert_eq!(span.update(true, ranges, wide), narrow, "a point was dragged beyond its end");
        let other = ValueRanges::without_outliers(wide);
        assert_eq!(span.update(true, other, wide), wide, "another volume has come meanwhile");
        assert_eq!(span.update(false, ranges, narrow), narrow);
        assert_eq!(span.update(true, ranges, wide), wide);
        assert_eq!(point_limits(ranges, wide), ValueRange::new(-50.0, 80.0));
    }

    #[test]
    fn the_value_under_the_pointer_stays() {
        let (mut zoom, range) = (PlotZoom::default(), ValueRange::new(-1000.0, 3000.0));
        zoom.zoom_at(range, 0.25, 0.5);
        let ShownValues { low, high, is_whole } = zoom.visible_range(range);
        assert!(!is_whole && (low + 0.25 * (high - low) - 0.0).abs() < 1e-9 && high - low == 2000.0);
        assert_eq!(zoom.zoom_factor(range), 2.0);
        zoom.pan(range, -9.0);
        let ends = ShownValues { low: -1000.0, high: 1000.0, is_whole: false };
        assert_eq!(zoom.visible_range(range), ends, "no further than the values");
        for _ in 0..60 {
            zoom.zoom_at(range, 0.5, 0.7);
        }
        assert!((zoom.zoom_factor(range) - 50.0).abs() < 0.1);
        for _ in 0..60 {
            zoom.zoom_at(range, 0.9, 1.5);
        }
        assert_eq!(zoom, PlotZoom::default());
        // Another volume.
        zoom.zoom_at(range, 0.0, 0.1);
        assert!(zoom.visible_range(ValueRange::new(0.0, 1.0)).is_whole);
    }
}
