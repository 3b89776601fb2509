//! Freehand drawing of opacity curves: a stroke is simplified to a few control points.

use super::{ControlPoint, Easing, TransferFunction};

/// Number of samples along a stroke: as many as pixels of a wide editor.
const STROKE_SAMPLES: usize = 1024;

/// Tolerance of the simplified curve, in opacity: the tremor of a hand.
const TOLERANCE: f64 = 0.012;

/// Largest number of points per stroke; a more detailed one is followed less closely.
const MAX_STROKE_POINTS: usize = 16;

/// Gap between the old curve and the drawn one, as a share of the shown values.
const EDGE_GAP: f64 = 1.0 / 2048.0;

impl TransferFunction {
    /// Returns the curve with the part under a stroke replaced: `stroke` has pairs of value and opacity in drawing
    /// order; if the hand went back, the later ones apply. Colours are kept at their values. `span`: range of the
    /// values that the editor shows.
    #[must_use]
    pub fn with_stroke(&self, stroke: &[[f64; 2]], span: f64) -> Self {
        let values = || stroke.iter().map(|[value, _]| *value);
        let (low, high) =
            (values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max));
        let is_usable =
            stroke.iter().flatten().all(|number| number.is_finite()) && high - low > span * EDGE_GAP;
        if !is_usable {
            return self.clone();
        }
        let drawn = simplify_polyline(&resample_stroke(stroke, low, high));
        let edge = span * EDGE_GAP;
        let point = |[value, opacity]: [f64; 2]| {
            ControlPoint::new(value, self.point_at(value).color, opacity.clamp(0.0, 1.0))
        };
        let mut curve = self.clone();
        // The curve stays unchanged on both sides of the stroke.
        if self.points.first().is_some_and(|point| point.value < low - edge) {
            curve.split_at(low - edge);
        }
        if self.points.last().is_some_and(|point| point.value > high + edge) {
            curve.split_at(high + edge);
        }
        curve.points.retain(|point| point.value <= low - edge || point.value >= high + edge);
        // The segment from the last point before the stroke loses its easing.
        if let Some(before) = curve.points.iter_mut().rfind(|point| point.value < low) {
            before.easing = Easing::Linear;
        }
        curve.points.extend(drawn.into_iter().map(point));
        curve.sort();
        curve
    }
}

/// Resamples the stroke at [`STROKE_SAMPLES`] evenly spaced values.
fn resample_stroke(stroke: &[[f64; 2]], low: f64, high: f64) -> Vec<[f64; 2]> {
    let place = |value: f64| ((value - low) / (high - low) * (STROKE_SAMPLES - 1) as f64).round() as usize;
    let mut opacities = vec![f64::NAN; STROKE_SAMPLES];
    for pair in stroke.windows(2) {
        let ([from, a], [to, b]) = (pair[0], pair[1]);
        let (first, last) = (place(from), place(to));
        let steps = first.abs_diff(last).max(1);
        for step in 0..=steps {
            let share = step as f64 / steps as f64;
            let at = (first as f64 + (last as f64 - first as f64) * share).round() as usize;
            opacities[at.min(STROKE_SAMPLES - 1)] = a + (b - a) * share;
        }
    }
    let value = |at: usize| low + (high - low) * at as f64 / (STROKE_SAMPLES - 1) as f64;
    opacities
        .into_iter()
        .enumerate()
        .filter(|(_, opacity)| opacity.is_finite())
        .map(|(at, opacity)| [value(at), opacity])
        .collect()
}

/// Simplifies a polyline by repeatedly adding the point with the largest error in opacity (Ramer 1972, Douglas and
/// Peucker 1973).
fn simplify_polyline(curve: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let (Some(last), true) = (curve.len().checked_sub(1), curve.len() > 2) else { return curve.to_vec() };
    let mut kept = vec![0, last];
    while kept.len() < MAX_STROKE_POINTS {
        let furthest = kept
            .windows(2)
            .filter_map(|pair| {
                let (from, to) = (pair[0], pair[1]);
                let off = |at: usize| {
                    let share = (curve[at][0] - curve[from][0]) / (curve[to][0] - curve[from][0]);
                    (curve[at][1] - curve[from][1] - share * (curve[to][1] - curve[from][1])).abs()
                };
                let at = (from + 1..to).max_by(|&a, &b| off(a).total_cmp(&off(b)))?;
                Some((at, off(at)))
            })
            .max_by(|a, b| a.1.total_cmp(&b.1));
        match furthest {
            Some((at, off)) if off > TOLERANCE => {
                let place = kept.partition_point(|&known| known < at);
                kept.insert(place, at);
            }
            _ => break,
        }
    }
    kept.into_iter().map(|at| curve[at]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ramp() -> TransferFunction {
        let points = vec![
            ControlPoint::new(0.0, [1.0, 0.0, 0.0], 0.0),
            ControlPoint::new(100.0, [0.0, 0.0, 1.0], 1.0),
        ];
        TransferFunction { points, ..TransferFunction::default() }
    }

    #[test]
    fn a_stroke_becomes_few_points_that_follow_it() {
        let hill = |value: f64| 0.5 + 0.4 * (value / 100.0 * std::f64::consts::TAU).sin();
        let stroke: Vec<_> = (200..=800).map(|at| [at as f64 / 10.0, hill(at as f64 / 10.0)]).collect();
        let curve = ramp().with_stroke(&stroke, 100.0);
        assert!(curve.points.len() <= MAX_STROKE_POINTS + 4, "{}", curve.points.len());
        for value in [21.0, 33.0, 50.0, 66.0, 79.0] {
            let off = curve.opacity_at(value) - hill(value);
            assert!(off.abs() < 2.0 * TOLERANCE, "{value}: {off}");
        }
        for value in [5.0, 19.0, 81.0, 99.0] {
            assert!((curve.opacity_at(value) - ramp().opacity_at(value)).abs() < 1e-6, "{value}");
        }
        let color = |curve: &TransferFunction| curve.point_at(50.0).color;
        let apart = color(&curve).iter().zip(color(&ramp())).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
        assert!(apart < 0.05, "colours stay: {apart}");
    }

    #[test]
    fn a_straight_line_is_two_points_and_the_later_way_counts() {
        let there_and_back = [[20.0, 0.1], [80.0, 0.1], [20.0, 0.7]];
        let curve = ramp().with_stroke(&there_and_back, 100.0);
        assert_eq!(curve.points.len(), 6, "two of the curve, two beside the stroke, two of it");
        assert!((curve.opacity_at(50.0) - 0.4).abs() < 1e-3);
    }

    #[test]
    fn what_is_no_stroke_changes_nothing() {
        for stroke in [&[][..], &[[1.0, 0.5]], &[[5.0, 0.1], [5.0, 0.9]], &[[1.0, f64::NAN], [9.0, 0.1]]] {
            assert_eq!(ramp().with_stroke(stroke, 100.0), ramp());
        }
    }
}
