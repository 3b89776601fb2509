//! Which values the plot shows: the wheel zooms to the pointer, a drag with the middle button moves.

use eframe::egui::{PointerButton, Rect, Response, Ui};

use super::super::text;
use crate::app::viewport::orbit::wheel_notches;
use crate::data::{ValueRange, ValueRanges};

/// A notch of the wheel shows this much less.
const ZOOM_PER_NOTCH: f64 = 1.2;
/// Least share of the values that is shown: the histogram has a thousand bars, of which these are twenty.
const LEAST_SHARE: f64 = 0.02;

/// A part of the values; nothing is all of them.
#[derive(Debug, Default, Clone, Copy, PartialEq)]
pub(super) struct Zoom {
    part: Option<ValueRange>,
}

/// The values that the plot shows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct ShownValues {
    /// The smallest.
    pub low: f64,
    /// The largest.
    pub high: f64,
    /// Whether these are all of the volume's values.
    pub is_whole: bool,
}

/// What the axis of values spans: what is shown of the volume, which control points widen, but for the time that a button
/// is held. Otherwise a point that is dragged would move the axis, and the axis the point.
#[derive(Debug, Default, Clone, Copy)]
pub(super) struct Span {
    /// The values of a volume, and what the axis has spanned since the button was pressed.
    held: Option<(ValueRanges, ValueRange)>,
}

impl Span {
    /// What it spans in this frame.
    pub(super) fn of(&mut self, is_held: bool, ranges: ValueRanges, shown: ValueRange) -> ValueRange {
        let held = self.held.filter(|(before, _)| is_held && *before == ranges);
        let span = held.map_or(shown, |(_, span)| span);
        self.held = is_held.then_some((ranges, span));
        span
    }
}

/// The values to which points can be moved: all that there are, and all that the axis spans.
pub(super) fn limits(ranges: ValueRanges, span: ValueRange) -> ValueRange {
    ValueRange::new(ranges.all.low.min(span.low), ranges.all.high.max(span.high))
}

impl Zoom {
    /// The values that are shown of a range.
    pub(super) fn shown(&self, range: ValueRange) -> ShownValues {
        // Another volume has other values.
        match self.part.filter(|part| part.low >= range.low && part.high <= range.high) {
            Some(ValueRange { low, high }) => ShownValues { low, high, is_whole: false },
            None => ShownValues { low: range.low, high: range.high, is_whole: true },
        }
    }

    /// How much wider the plot of all values would be.
    pub(super) fn factor(&self, range: ValueRange) -> f32 {
        let ShownValues { low, high, .. } = self.shown(range);
        ((range.high - range.low) / (high - low).max(1e-300)).clamp(1.0, 1.0 / LEAST_SHARE) as f32
    }

    /// Takes what the mouse does on the plot.
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

    /// Offers to show everything again, while it does not.
    pub(super) fn button(&mut self, ui: &mut Ui) {
        let all = text::transfer::SHOW_ALL;
        if self.part.is_some() && ui.button(all.name).on_hover_text(all.tip).clicked() {
            self.part = None;
        }
    }

    /// Shows a share of what is shown now, with the value at `share` where it is.
    fn by(&mut self, range: ValueRange, share: f64, factor: f64) {
        let ShownValues { low, high, .. } = self.shown(range);
        let all = range.high - range.low;
        let width = ((high - low) * factor).clamp(LEAST_SHARE * all, all);
        let low = low + share * (high - low - width);
        self.show(range, low, width);
    }

    /// Moves by a share of what is shown.
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
