//! From the smallest value to the largest.

use serde::{Deserialize, Serialize};

/// Values in data units from a lowest to a highest, both included; in JSON `[low, high]`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(from = "[f64; 2]", into = "[f64; 2]")]
pub struct ValueRange {
    /// The lowest value.
    pub low: f64,
    /// The highest value.
    pub high: f64,
}

impl ValueRange {
    /// From 0 to 1: the range of densities, and of values that are shares of a whole.
    pub const UNIT: Self = Self::new(0.0, 1.0);

    /// Values from `low` to `high`.
    pub const fn new(low: f64, high: f64) -> Self {
        Self { low, high }
    }

    /// The range with these ends if it has a length, so that values can be told apart in it.
    pub fn spread(low: f64, high: f64) -> Option<Self> {
        (low < high).then_some(Self { low, high })
    }

    /// How far the highest value is above the lowest.
    pub fn span(self) -> f64 {
        self.high - self.low
    }

    /// The value at a share of the way from the lowest (0) to the highest (1).
    pub fn at(self, share: f64) -> f64 {
        self.low + self.span() * share
    }

    /// The share of the way to the highest at which a value lies; the inverse of [`Self::at`]. Nearly flat ranges
    /// have huge shares, but finite ones.
    pub fn share_of(self, value: f64) -> f64 {
        (value - self.low) / self.span().max(1e-300)
    }

    /// Whether a value is in the range.
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
        assert_eq!((range.span(), range.at(0.25), range.share_of(0.0)), (4000.0, 0.0, 0.25));
        assert!(range.contains(-1000.0) && range.contains(3000.0) && !range.contains(3000.1));
        assert!(ValueRange::new(5.0, 5.0).share_of(6.0).is_finite());
        assert_eq!(ValueRange::spread(5.0, 5.0), None);
        assert_eq!(ValueRange::spread(5.0, 6.0), Some(ValueRange::new(5.0, 6.0)));
    }
}
