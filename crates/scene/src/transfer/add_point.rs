//! Adding points to a transfer function in the editor. Values are in data units, opacities per opacity unit.

use super::{ControlPoint, TransferFunction};
use chiaroscuro_volume::ValueRange;

/// Width of the flank between a point beyond the ends of the curve and the point that holds the values behind it, as
/// a share of the values that the editor shows: 12 pixels in an editor of 1200, so that both can be grabbed.
const FLANK_SHARE: f64 = 0.01;

impl TransferFunction {
    /// Adds a point and returns its index. Left of the first point and right of the last one, a second point is added
    /// if the values beyond would become more opaque: it holds them at their current opacity. `shown`: the values
    /// that the editor shows; the second point lies within them.
    pub fn add_point(&mut self, value: f64, opacity: f64, shown: ValueRange) -> usize {
        let (Some(first), Some(last)) = (self.points.first().copied(), self.points.last().copied()) else {
            self.points.push(ControlPoint { opacity, ..self.point_at(value) });
            return 0;
        };
        let flank = FLANK_SHARE * shown.span();
        if value < first.value && opacity > first.opacity {
            let holding_value = (value - flank).max(shown.low);
            // At the border of the editor the point itself is moved.
            let value = value.max((holding_value + flank).min(first.value));
            let holding_point = ControlPoint::new(holding_value.min(value), first.color, first.opacity);
            self.points.splice(0..0, [holding_point, ControlPoint::new(value, first.color, opacity)]);
            return 1;
        }
        if value > last.value && opacity > last.opacity {
            let beyond = (value + flank).min(shown.high);
            let value = value.min((beyond - flank).max(last.value));
            let index = self.points.len();
            let held = ControlPoint::new(beyond.max(value), last.color, last.opacity);
            self.points.extend([ControlPoint::new(value, last.color, opacity), held]);
            return index;
        }
        let index = self.insert_on_curve(value);
        self.points[index].opacity = opacity;
        index
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Easing;

    const SHOWN: ValueRange = ValueRange { low: 0.0, high: 200.0 };

    /// Returns a curve over the values 100 … 150 with the given opacities at its ends.
    fn curve(first: f64, last: f64) -> TransferFunction {
        let point = |value, opacity| ControlPoint::new(value, [0.5; 3], opacity);
        TransferFunction {
            points: vec![point(100.0, first), point(120.0, 0.6), point(150.0, last)],
            ..TransferFunction::default()
        }
    }

    #[test]
    fn values_beyond_an_added_point_stay_as_clear_as_they_were() {
        for (value, far) in [(40.0, [0.0, 20.0, 37.9]), (180.0, [182.1, 190.0, 200.0])] {
            let mut function = curve(0.0, 0.0);
            let index = function.add_point(value, 0.8, SHOWN);
            assert_eq!((function.points[index].value, function.points[index].opacity), (value, 0.8));
            assert_eq!(function.points.len(), 5);
            assert!(function.points.is_sorted_by(|a, b| a.value <= b.value));
            for far in far {
                assert!(function.opacity_at(far).abs() < 1e-12, "{value}: {far}");
            }
        }
        // Values beyond keep their opacity.
        let mut function = curve(0.3, 0.2);
        function.add_point(40.0, 0.8, SHOWN);
        function.add_point(180.0, 0.8, SHOWN);
        assert!((function.opacity_at(10.0) - 0.3).abs() < 1e-12);
        assert!((function.opacity_at(195.0) - 0.2).abs() < 1e-12);
    }

    #[test]
    fn a_point_that_makes_nothing_more_opaque_comes_alone() {
        for (first, last, value, opacity) in
            [(0.5, 0.5, 40.0, 0.0), (0.5, 0.5, 180.0, 0.5), (0.0, 0.0, 130.0, 0.9), (0.0, 0.0, 40.0, 0.0)]
        {
            let mut function = curve(first, last);
            let index = function.add_point(value, opacity, SHOWN);
            assert_eq!(function.points.len(), 4, "{value} at {opacity}");
            assert_eq!((function.points[index].value, function.points[index].opacity), (value, opacity));
        }
        let mut nothing = TransferFunction::default();
        assert_eq!(nothing.add_point(3.0, 0.4, SHOWN), 0);
        assert_eq!((nothing.points[0].value, nothing.points[0].opacity), (3.0, 0.4));
    }

    #[test]
    fn points_at_the_border_of_the_editor_keep_the_outermost_value_clear() {
        for (value, outermost) in [(0.0, 0.0), (1.0, 0.0), (200.0, 200.0), (199.5, 200.0)] {
            let mut function = curve(0.0, 0.0);
            // A step after the last point has no effect on added points.
            function.points[2].easing = Easing::Step;
            let index = function.add_point(value, 0.8, SHOWN);
            assert!(function.points.is_sorted_by(|a, b| a.value <= b.value));
            assert!(function.opacity_at(outermost).abs() < 1e-12, "{value}");
            assert!((function.points[index].value - value).abs() <= 2.0, "{value}");
        }
    }
}
