//! Distance between two pictures, as displayed.

/// Difference between two pictures, in steps of 8 bits (1/255).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PictureDistance {
    /// Root mean square over pixels and colour channels.
    pub rmse: f64,
    /// Maximum over pixels and colour channels.
    pub max: f64,
}

impl PictureDistance {
    /// Compares two pictures of equal size: RGBA in sRGB bytes, alpha ignored.
    pub fn between_bytes(left: &[u8], right: &[u8]) -> Self {
        Self::compute(left, right, f64::from)
    }

    /// Compares two RGBA pictures of equal size with floating-point channels, in which 1 is white.
    pub fn between_values(left: &[f32], right: &[f32]) -> Self {
        Self::compute(left, right, |value| 255.0 * f64::from(value))
    }

    fn compute<T: Copy>(left: &[T], right: &[T], value: impl Fn(T) -> f64) -> Self {
        let (mut squares, mut largest) = (0.0, 0.0f64);
        for (a, b) in left.chunks_exact(4).zip(right.chunks_exact(4)) {
            for (&a, &b) in a[..3].iter().zip(&b[..3]) {
                let step = (value(a) - value(b)).abs();
                squares += step * step;
                largest = largest.max(step);
            }
        }
        let colors = (left.len() / 4 * 3).max(1);
        Self { rmse: (squares / colors as f64).sqrt(), max: largest }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_count_colors_and_no_alpha() {
        let (left, right) = ([10, 20, 30, 255, 0, 0, 0, 255], [10, 20, 33, 255, 0, 0, 0, 0]);
        let found = PictureDistance::between_bytes(&left, &right);
        assert!((found.rmse - (9.0f64 / 6.0).sqrt()).abs() < 1e-12, "{}", found.rmse);
        assert_eq!(found.max, 3.0);
        assert_eq!(PictureDistance::between_bytes(&[], &[]), PictureDistance { rmse: 0.0, max: 0.0 });
        let fine = PictureDistance::between_values(&[0.5, 0.25, 1.0, 1.0], &[0.5, 0.251, 1.0, 0.0]);
        assert!((fine.max - 0.255).abs() < 1e-4, "{fine:?}");
    }
}
