//! Comparison of pictures and volumes by their largest error and RMSE. Tests below show that each comparison can
//! fail.

/// Upper limits for a comparison's errors.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ErrorLimit {
    /// Largest absolute difference that is allowed.
    pub(crate) max: f64,
    /// Largest root mean square of the differences that is allowed.
    pub(crate) rmse: f64,
}

/// Result of a comparison of two lists.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ErrorMeasure {
    /// Largest absolute difference of two values.
    pub(crate) max: f64,
    /// Index of the largest difference.
    pub(crate) max_at: usize,
    /// Root mean square of the differences.
    pub(crate) rmse: f64,
}

/// Difference of two lists of the same length; a value that is NaN counts as an infinite difference.
pub(crate) fn difference(actual: &[f64], expected: &[f64]) -> ErrorMeasure {
    assert_eq!(actual.len(), expected.len(), "lists of different lengths cannot be compared");
    assert!(!actual.is_empty(), "nothing to compare");
    let mut found = ErrorMeasure { max: 0.0, max_at: 0, rmse: 0.0 };
    let mut squares = 0.0;
    for (at, (a, b)) in actual.iter().zip(expected).enumerate() {
        let d = (a - b).abs();
        let d = if d.is_nan() { f64::INFINITY } else { d };
        squares += d * d;
        if d > found.max {
            (found.max, found.max_at) = (d, at);
        }
    }
    found.rmse = (squares / actual.len() as f64).sqrt();
    found
}

/// Compares two lists with a limit; an error says where they differ and by how much.
pub(crate) fn compare(
    what: &str,
    actual: &[f64],
    expected: &[f64],
    limit: ErrorLimit,
) -> Result<ErrorMeasure, String> {
    let found = difference(actual, expected);
    println!("{what}: max {:.2e} at {}, rmse {:.2e}", found.max, found.max_at, found.rmse);
    if found.max <= limit.max && found.rmse <= limit.rmse {
        return Ok(found);
    }
    let at = found.max_at;
    Err(format!(
        "{what}: max {:.3e} (limit {:.3e}) at {at}: {} instead of {}; rmse {:.3e} (limit {:.3e})",
        found.max, limit.max, actual[at], expected[at], found.rmse, limit.rmse
    ))
}

/// Flattens f32 texels into a list of channels in f64.
pub(crate) fn channels_f32(texels: &[[f32; 4]]) -> Vec<f64> {
    texels.iter().flatten().map(|&c| f64::from(c)).collect()
}

/// Flattens f64 texels into a list of channels.
pub(crate) fn channels_f64(texels: &[[f64; 4]]) -> Vec<f64> {
    texels.iter().flatten().copied().collect()
}

/// Converts a list of f32 values to f64.
pub(crate) fn to_f64(values: &[f32]) -> Vec<f64> {
    values.iter().map(|&v| f64::from(v)).collect()
}

mod can_fail {
    use super::{ErrorLimit, compare};
    use crate::thresholds::{LITERAL, SAME_WEIGHTS};

    /// Smooth list, and a copy with some values spoiled.
    fn lists(spoil: impl Fn(usize, f64) -> f64) -> (Vec<f64>, Vec<f64>) {
        let good: Vec<f64> = (0..1000).map(|i| (f64::from(i) / 100.0).sin().abs()).collect();
        let bad = good.iter().enumerate().map(|(i, &v)| spoil(i, v)).collect();
        (good, bad)
    }

    fn fails(limit: ErrorLimit, spoil: impl Fn(usize, f64) -> f64) -> bool {
        let (good, bad) = lists(spoil);
        compare("spoiled", &bad, &good, limit).is_err()
    }

    #[test]
    fn comparators_notice_wrong_pictures() {
        assert!(!fails(SAME_WEIGHTS, |_, v| v), "equal lists pass");
        assert!(fails(SAME_WEIGHTS, |i, v| if i == 500 { v + 0.01 } else { v }), "one wrong value");
        assert!(fails(SAME_WEIGHTS, |_, v| v + 0.0011), "all a little too bright");
        assert!(fails(SAME_WEIGHTS, |i, v| if i == 3 { f64::NAN } else { v }), "not a number");
        assert!(fails(LITERAL, |_, v| v * 1.01), "one percent too bright");
        assert!(fails(LITERAL, |_, _| 0.0), "black");
    }

    #[test]
    #[should_panic(expected = "different lengths")]
    fn lists_of_different_lengths_are_no_match() {
        drop(compare("lengths", &[1.0], &[1.0, 2.0], SAME_WEIGHTS));
    }
}
