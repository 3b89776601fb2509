//! Ends of an axis, as headers say them that have `axis mins` and `axis maxs` in place of `spacings`.

/// Begin and end of an axis in the file's unit; NaN where they are not known.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct AxisBounds {
    pub(super) low: f64,
    pub(super) high: f64,
    /// True where the first and last sample lie at the bounds, and not half a distance within.
    pub(super) is_node: bool,
}

impl AxisBounds {
    /// Distance of so many samples; NaN where the bounds do not say it.
    ///
    /// Cells fill the axis, nodes lie at its ends (<https://teem.sourceforge.net/nrrd/format.html>, "axis mins"). Without
    /// a word samples are cells, as Teem takes them (`nrrdDefaultCenter`).
    pub(super) fn spacing(self, samples: u64) -> f64 {
        let steps = if self.is_node { samples.saturating_sub(1) } else { samples };
        if steps == 0 { f64::NAN } else { (self.high - self.low) / steps as f64 }
    }

    /// Place of the first of samples that are so far apart; 0 where it is not known.
    pub(super) fn first_sample(self, spacing: f64) -> f64 {
        let first = if self.is_node { self.low } else { self.low + 0.5 * spacing };
        if first.is_finite() { first } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nodes_lie_at_the_ends_and_cells_within_them() {
        let bounds = |is_node| AxisBounds { low: 2.0, high: 12.0, is_node };
        assert_eq!((bounds(true).spacing(6), bounds(true).first_sample(2.0)), (2.0, 2.0));
        assert_eq!((bounds(false).spacing(5), bounds(false).first_sample(2.0)), (2.0, 3.0));
        assert!(bounds(true).spacing(1).is_nan() && bounds(false).spacing(0).is_nan());
        let unknown = AxisBounds { low: f64::NAN, high: 1.0, is_node: false };
        assert!(unknown.spacing(3).is_nan() && unknown.first_sample(1.0) == 0.0);
    }
}
