//! Closed range of values in data units.

use serde::{Deserialize, Serialize};

/// Range of values in data units, both ends included; in JSON `[low, high]`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(from = "[f64; 2]", into = "[f64; 2]")]
pub struct ValueRange {
    /// Lowest value of the range.
    pub low: f64,
    /// Highest value of the range.
    pub high: f64,
}

impl ValueRange {
    /// Range from 0 to 1, as of densities and shares.
    pub const UNIT: Self = Self::new(0.0, 1.0);

    /// Creates the range from `low` to `high`.
    pub const fn new(low: f64, high: f64) -> Self {
        Self { low, high }
    }

    /// Returns the range with these ends; `None` if it is empty or a single value.
    pub fn non_degenerate(low: f64, high: f64) -> Option<Self> {
        (low < high).then_some(Self { low, high })
    }

    /// Returns the length of the range.
    pub fn span(self) -> f64 {
        self.high - self.low
    }

    /// Interpolates linearly between the lowest value (share 0) and the highest (share 1).
    pub fn value_at(self, share: f64) -> f64 {
        self.low + self.span() * share
    }

    /// Returns the share of the way from the lowest value to the highest; the inverse of [`Self::value_at`]. Nearly
    /// flat ranges give huge shares, but finite ones.
    pub fn share_of(self, value: f64) -> f64 {
        (value - self.low) / self.span().max(1e-300)
    }

    /// Returns true if a value is in the range.
    pub fn contains(self, value: f64) -> bool {
        (self.low..=self.high).contains(&value)
    }
}

impl From<[f64; 2]> for ValueRange {
    fn from([low, high]: [f64; 2]) -> Self {
        Self { low, high }
    }
}

impl From<ValueRange> for [f64; 2] {
    fn from(ValueRange { low, high }: ValueRange) -> Self {
        [low, high]
    }
}

impl From<(f64, f64)> for ValueRange {
    fn from((low, high): (f64, f64)) -> Self {
        Self { low, high }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_and_values_are_inverse() {
        let range = ValueRange::new(-1000.0, 3000.0);
        assert_eq!((range.span(), range.value_at(0.25), range.share_of(0.0)), (4000.0, 0.0, 0.25));
        assert!(range.contains(-1000.0) && range.contains(3000.0) && !range.contains(3000.1));
        assert!(ValueRange::new(5.0, 5.0).share_of(6.0).is_finite());
        assert_eq!(ValueRange::non_degenerate(5.0, 5.0), None);
        assert_eq!(ValueRange::non_degenerate(5.0, 6.0), Some(ValueRange::new(5.0, 6.0)));
    }
}
