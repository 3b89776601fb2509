//! Zoom of the plot along the value axis: the wheel zooms to the pointer, a drag with the middle button moves.

use eframe::egui::{PointerButton, Rect, Response, Ui};

use super::super::text;
use crate::app::viewport::orbit::wheel_notches;
use crate::data::{ValueRange, ValueRanges};

/// Factor by which a notch of the wheel narrows the shown range.
const ZOOM_PER_NOTCH: f64 = 1.2;
/// Smallest share of the values that is shown: the histogram has a thousand bars, and this is twenty of them.
const LEAST_SHARE: f64 = 0.02;

/// Part of the values that the plot shows; `None` is all of them.
#[derive(Debug, Default, Clone, Copy, PartialEq)]
pub(super) struct Zoom {
    part: Option<ValueRange>,
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
pub(super) struct Span {
    /// Value ranges of the volume, and the span frozen since the button was pressed.
    held: Option<(ValueRanges, ValueRange)>,
}

impl Span {
    /// Returns the span of this frame, frozen while `is_held`.
    pub(super) fn of(&mut self, is_held: bool, ranges: ValueRanges, shown: ValueRange) -> ValueRange {
        let held = self.held.filter(|(before, _)| is_held && *before == ranges);
        let span = held.map_or(shown, |(_, span)| span);
        self.held = is_held.then_some((ranges, span));
        span
    }
}

/// Values within which points can be moved: all values of the volume and all that the axis spans.
pub(super) fn limits(ranges: ValueRanges, span: ValueRange) -> ValueRange {
    ValueRange::new(ranges.all.low.min(span.low), ranges.all.high.max(span.high))
}

impl Zoom {
    /// Values of a range that are shown at the current zoom.
    pub(super) fn shown(&self, range: ValueRange) -> ShownValues {
        // Another volume has other values, so the zoom does not apply.
        match self.part.filter(|part| part.low >= range.low && part.high <= range.high) {
            Some(ValueRange { low, high }) => ShownValues { low, high, is_whole: false },
            None => ShownValues { low: range.low, high: range.high, is_whole: true },
        }
    }

    /// Zoom factor: width of the range over the width that is shown.
    pub(super) fn factor(&self, range: ValueRange) -> f32 {
        let ShownValues { low, high, .. } = self.shown(range);
        ((range.high - range.low) / (high - low).max(1e-300)).clamp(1.0, 1.0 / LEAST_SHARE) as f32
    }

    /// Handles wheel and middle-button drags over the plot.
    pub(super) fn ui(&mut self, ui: &Ui, response: &Response, area: Rect, range: ValueRange) {
        let Some(pointer) = ui.ctx().pointer_hover_pos().filter(|at| area.contains(*at)) else { return };
        let share = f64::from(((pointer.x - area.min.x) / area.width().max(1.0)).clamp(0.0, 1.0));
        let notches = wheel_notches(ui);
        if notches != 0.0 && response.contains_pointer() {
            self.by(range, share, ZOOM_PER_NOTCH.powf(-notches));
        }
        let delta = ui.input(|input| input.pointer.delta().x);
        if ui.input(|input| input.pointer.button_down(PointerButton::Middle)) && delta != 0.0 {
            self.along(range, -f64::from(delta / area.width().max(1.0)));
        }
    }

    /// Shows a button that resets the zoom, while it is zoomed in.
    pub(super) fn button(&mut self, ui: &mut Ui) {
        let all = text::transfer::SHOW_ALL;
        if self.part.is_some() && ui.button(all.name).on_hover_text(all.tip).clicked() {
            self.part = None;
        }
    }

    /// Scales the shown range by a factor, with the value at `share` fixed.
    fn by(&mut self, range: ValueRange, share: f64, factor: f64) {
        let ShownValues { low, high, .. } = self.shown(range);
        let all = range.high - range.low;
        let width = ((high - low) * factor).clamp(LEAST_SHARE * all, all);
        let low = low + share * (high - low - width);
        self.show(range, low, width);
    }

    /// Moves the shown range by a share of its width.
    fn along(&mut self, range: ValueRange, share: f64) {
        let ShownValues { low, high, is_whole } = self.shown(range);
        if !is_whole {
            self.show(range, low + share * (high - low), high - low);
        }
    }

    fn show(&mut self, range: ValueRange, low: f64, width: f64) {
        let low = low.clamp(range.low, (range.high - width).max(range.low));
        let whole = width >= (range.high - range.low) * (1.0 - 1e-9);
        self.part = (!whole).then_some(ValueRange::new(low, (low + width).min(range.high)));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_axis_stays_while_a_button_is_held() {
        let ranges = ValueRanges { all: ValueRange::new(-50.0, 70.0), robust: ValueRange::new(0.0, 10.0) };
        let (narrow, wide) = (ranges.robust, ValueRange::new(0.0, 80.0));
        let mut span = Span::default();
        assert_eq!(span.of(false, ranges, narrow), narrow);
        assert_eq!(span.of(true, ranges, narrow), narrow);
        assert_eq!(span.of(true, ranges, wide), narrow, "a point was dragged beyond its end");
        let other = ValueRanges::same(wide);
        assert_eq!(span.of(true, other, wide), wide, "another volume has come meanwhile");
        assert_eq!(span.of(false, ranges, narrow), narrow);
        assert_eq!(span.of(true, ranges, wide), wide);
        assert_eq!(limits(ranges, wide), ValueRange::new(-50.0, 80.0));
    }

    #[test]
    fn the_value_under_the_pointer_stays() {
        let (mut zoom, range) = (Zoom::default(), ValueRange::new(-1000.0, 3000.0));
        zoom.by(range, 0.25, 0.5);
        let ShownValues { low, high, is_whole } = zoom.shown(range);
        assert!(!is_whole && (low + 0.25 * (high - low) - 0.0).abs() < 1e-9 && high - low == 2000.0);
        assert_eq!(zoom.factor(range), 2.0);
        zoom.along(range, -9.0);
        let ends = ShownValues { low: -1000.0, high: 1000.0, is_whole: false };
        assert_eq!(zoom.shown(range), ends, "no further than the values");
        for _ in 0..60 {
            zoom.by(range, 0.5, 0.7);
        }
        assert!((zoom.factor(range) - 50.0).abs() < 0.1);
        for _ in 0..60 {
            zoom.by(range, 0.9, 1.5);
        }
        assert_eq!(zoom, Zoom::default());
        // Another volume.
        zoom.by(range, 0.0, 0.1);
        assert!(zoom.shown(ValueRange::new(0.0, 1.0)).is_whole);
    }
}
