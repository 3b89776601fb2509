//! Selection of control points: by click, by rubber band, and moving the selected points together.

use std::collections::BTreeSet;

use eframe::egui::{Key, Modifiers, Painter, PointerButton, Pos2, Rect, Response, Stroke, Ui};

use super::plot::PlotAxes;
use super::theme;
use chiaroscuro_scene::TransferFunction;
use chiaroscuro_volume::ValueRange;

/// Indices of the selected points, and the rubber band that selects more of them.
#[derive(Debug, Default, Clone, PartialEq)]
pub(super) struct PointSelection {
    points: BTreeSet<usize>,
    /// True if the first selected point is to take the keyboard focus.
    pub wants_focus: bool,
    /// Corner at which the rubber band began.
    rubber_band_start: Option<Pos2>,
}

/// Distance by which points are moved, along both axes.
#[derive(Debug, Clone, Copy)]
pub(super) struct PointShift {
    /// Distance along the value axis, in data units.
    pub value: f64,
    /// Distance along the opacity axis, positive towards opaque.
    pub opacity: f64,
}

impl PointSelection {
    /// With the pointer over the plot, Ctrl+A selects all points, and Escape clears the selection.
    pub(super) fn select_by_keys(&mut self, ui: &Ui, response: &Response, count: usize) {
        if !response.contains_pointer() || ui.ctx().text_edit_focused() {
            return;
        }
        if ui.input_mut(|input| input.consume_key(Modifiers::COMMAND, Key::A)) {
            self.select_all(count);
        } else if ui.input(|input| input.key_pressed(Key::Escape)) {
            self.clear();
        }
    }

    /// Selects one point and no other.
    pub(super) fn select_only(&mut self, index: usize) {
        self.points = [index].into();
    }

    /// Adds a point to the selection, or removes it.
    pub(super) fn toggle(&mut self, index: usize) {
        if !self.points.remove(&index) {
            self.points.insert(index);
        }
    }

    /// Selects all of `count` points.
    fn select_all(&mut self, count: usize) {
        self.points = (0..count).collect();
        self.wants_focus = true;
    }

    /// Clears the selection of points.
    pub(super) fn clear(&mut self) {
        self.points.clear();
    }

    /// Returns true if a point is selected.
    pub(super) fn contains(&self, index: usize) -> bool {
        self.points.contains(&index)
    }

    /// Returns the selected indices below `count` in ascending order, and drops the others.
    pub(super) fn retained_indices(&mut self, count: usize) -> Vec<usize> {
        self.points.retain(|&index| index < count);
        self.points.iter().copied().collect()
    }

    /// Selects the points inside a rubber band drawn with the mouse; with Shift, the previous selection is kept.
    pub(super) fn rubber_band(
        &mut self,
        ui: &Ui,
        response: &Response,
        axes: &PlotAxes,
        function: &TransferFunction,
    ) {
        let primary = PointerButton::Primary;
        if response.drag_started_by(primary) {
            self.rubber_band_start = ui.input(|input| input.pointer.press_origin());
        }
        let Some((start, now)) = self.rubber_band_start.zip(ui.ctx().pointer_latest_pos()) else { return };
        let frame = Rect::from_two_pos(start, now);
        if response.dragged_by(primary) {
            paint_rubber_band(&ui.painter_at(axes.area), frame);
        } else {
            self.rubber_band_start = None;
        }
        if response.dragged_by(primary) || response.drag_stopped_by(primary) {
            if !ui.input(|input| input.modifiers.shift) {
                self.points.clear();
            }
            let inside = |point: &chiaroscuro_scene::ControlPoint| {
                axes.contains_value(point.value) && frame.contains(axes.position(point.value, point.opacity))
            };
            let found = function.points.iter().enumerate().filter(|(_, point)| inside(point));
            self.points.extend(found.map(|(index, _)| index));
            self.wants_focus = response.drag_stopped_by(primary);
        }
    }

    /// Removes the selected points, but always leaves one: a function without points could never be seen again.
    pub(super) fn remove_points(&mut self, function: &mut TransferFunction) {
        for index in self.retained_indices(function.points.len()).into_iter().rev() {
            if function.points.len() > 1 {
                function.points.remove(index);
            }
        }
        self.points.clear();
    }

    /// Moves the selected points together, by at most the distance at which none of them passes an unselected
    /// neighbour, leaves the values, or leaves the opacities 0 to 1.
    pub(super) fn move_points(&mut self, function: &mut TransferFunction, range: ValueRange, by: PointShift) {
        let PointShift { value, opacity } = by;
        let selected = self.retained_indices(function.points.len());
        let points = &function.points;
        let (mut left, mut right, mut down, mut up) =
            (f64::NEG_INFINITY, f64::INFINITY, f64::NEG_INFINITY, f64::INFINITY);
        let mut bounds = Vec::with_capacity(selected.len());
        for &index in &selected {
            let point = points[index];
            // Points from a preset may lie beyond this volume's values, and may stay there.
            let (mut low, mut high) = (range.low.min(point.value), range.high.max(point.value));
            if let Some(before) = index.checked_sub(1).filter(|&before| !self.contains(before)) {
                low = points[before].value;
            }
            if let Some(after) = points.get(index + 1).filter(|_| !self.contains(index + 1)) {
                high = after.value;
            }
            (left, right) = (left.max(low - point.value), right.min(high - point.value));
            (down, up) = (down.max(-point.opacity), up.min(1.0 - point.opacity));
            bounds.push((index, low.min(point.value), high.max(point.value)));
        }
        for (index, low, high) in bounds {
            let point = &mut function.points[index];
            // Rounding must not carry a point past its neighbour.
            point.value = (point.value + value.max(left).min(right)).clamp(low, high);
            point.opacity = (point.opacity + opacity.max(down).min(up)).clamp(0.0, 1.0);
        }
    }
}

fn paint_rubber_band(painter: &Painter, frame: Rect) {
    painter.rect_filled(frame, 0.0, theme::ACCENT.gamma_multiply(0.12));
    painter.rect_stroke(frame, 0.0, Stroke::new(1.0, theme::ACCENT), eframe::egui::StrokeKind::Inside);
}

#[cfg(test)]
mod tests {
    use super::*;
    use chiaroscuro_scene::ControlPoint;

    fn function() -> TransferFunction {
        let point = |value, opacity| ControlPoint::new(value, [1.0; 3], opacity);
        TransferFunction {
            points: vec![point(0.0, 0.0), point(20.0, 0.3), point(40.0, 0.8), point(90.0, 1.0)],
            ..TransferFunction::default()
        }
    }

    fn points_after_shift(selected: &[usize], value: f64, opacity: f64) -> Vec<(f64, f64)> {
        let (mut function, mut selection) = (function(), PointSelection::default());
        for &index in selected {
            selection.toggle(index);
        }
        selection.move_points(&mut function, ValueRange::new(0.0, 100.0), PointShift { value, opacity });
        function.points.iter().map(|point| (point.value, (point.opacity * 1e6).round() / 1e6)).collect()
    }

    #[test]
    fn points_move_together_and_pass_none() {
        assert_eq!(
            points_after_shift(&[1, 2], 10.0, 0.1),
            [(0.0, 0.0), (30.0, 0.4), (50.0, 0.9), (90.0, 1.0)]
        );
        assert_eq!(
            points_after_shift(&[1, 2], 70.0, 0.9)[1..3],
            [(70.0, 0.5), (90.0, 1.0)],
            "up to what stays"
        );
        assert_eq!(points_after_shift(&[1], -50.0, -0.9)[1], (0.0, 0.0));
        assert_eq!(points_after_shift(&[3], 50.0, 0.0)[3], (100.0, 1.0), "up to the values' end");
        assert_eq!(points_after_shift(&[], 5.0, 0.5), points_after_shift(&[1], 0.0, 0.0));
        assert_eq!(
            points_after_shift(&[7], 5.0, 0.5),
            points_after_shift(&[], 0.0, 0.0),
            "points that are gone"
        );
    }

    #[test]
    fn rounding_carries_no_point_past_another() {
        let mut function = function();
        let mut selection = PointSelection::default();
        selection.select_only(1);
        for i in 1..2000 {
            let low = 12.3 + f64::from(i) * 0.001_7;
            function.points[0].value = low;
            function.points[1].value = 20.0 + f64::from(i) * 0.009;
            selection.move_points(
                &mut function,
                ValueRange::new(0.0, 100.0),
                PointShift { value: -1e3, opacity: 0.0 },
            );
            let found = function.points[1].value;
            assert!(found >= low && found - low < 1e-9, "{found} at {low}");
        }
    }

    #[test]
    fn one_point_always_stays() {
        let (mut function, mut selection) = (function(), PointSelection::default());
        selection.select_all(4);
        selection.remove_points(&mut function);
        assert_eq!(function.points.len(), 1);
        assert!(!selection.contains(0));
    }
}
