//! How far two pictures are apart, as displayed.

/// The distance between two pictures, in steps of 8 bits.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Distance {
    /// Root of the mean square over pixels and colours.
    pub rmse: f64,
    /// The largest of any colour.
    pub largest: u8,
}

impl Distance {
    /// Between two pictures of one size: sRGB bytes, RGBA; alpha does not count.
    pub fn between(left: &[u8], right: &[u8]) -> Self {
        let (mut squares, mut largest) = (0u64, 0u8);
        for (a, b) in left.chunks_exact(4).zip(right.chunks_exact(4)) {
            for (a, b) in a[..3].iter().zip(&b[..3]) {
                let step = a.abs_diff(*b);
                squares += u64::from(step) * u64::from(step);
                largest = largest.max(step);
            }
        }
        let colors = (left.len() / 4 * 3).max(1);
        Self { rmse: (squares as f64 / colors as f64).sqrt(), largest }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_count_colors_and_no_alpha() {
        let (left, right) = ([10, 20, 30, 255, 0, 0, 0, 255], [10, 20, 33, 255, 0, 0, 0, 0]);
        let found = Distance::between(&left, &right);
        assert!((found.rmse - (9.0f64 / 6.0).sqrt()).abs() < 1e-12, "{}", found.rmse);
        assert_eq!(found.largest, 3);
        assert_eq!(Distance::between(&[], &[]), Distance { rmse: 0.0, largest: 0 });
    }
}
