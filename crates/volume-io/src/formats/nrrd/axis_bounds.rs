//! Bounds of an axis, for headers that give `axis mins` and `axis maxs` instead of `spacings`.

/// Lower and upper bound of an axis in the file's unit; NaN if unknown.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct AxisBounds {
    pub(super) low: f64,
    pub(super) high: f64,
    /// True if the first and last sample lie at the bounds (nodes), false if half a spacing inside (cells).
    pub(super) is_node: bool,
}

impl AxisBounds {
    /// Returns the spacing of this many samples; NaN if the bounds do not determine it.
    ///
    /// Cells fill the axis, nodes lie at its ends (<https://teem.sourceforge.net/nrrd/format.html>, "axis mins").
    /// Without `centers` samples count as cells, as in Teem (`nrrdDefaultCenter`).
    pub(super) fn spacing(self, samples: u64) -> f64 {
        let steps = if self.is_node { samples.saturating_sub(1) } else { samples };
        if steps == 0 { f64::NAN } else { (self.high - self.low) / steps as f64 }
    }

    /// Returns the position of the first sample, given the spacing; 0 if unknown.
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
