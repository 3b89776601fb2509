//! Which values of a volume a look spends its densities on.

use serde::{Deserialize, Serialize};

use crate::data::{ValueRange, ValueRanges};
use crate::model::Settings;

/// A range is widened in steps of this many to its span: dragging a control point changes it now and then only, which
/// costs an upload.
const STEPS: f64 = 8.0;

/// Points that are no further than this share of the span beyond an end do not widen the range: they are at it, but for
/// rounding.
const AT_THE_END: f64 = 0.005;

/// The values that have densities from 0 to 1; what lies outside counts as the nearest of them.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum DensityRange {
    /// The values that matter, without padding and outliers.
    #[default]
    Robust,
    /// All values of the file.
    Full,
    /// Those between two values, in data units.
    Typed(ValueRange),
}

impl DensityRange {
    /// The range that is chosen, for a volume with these values.
    pub fn of(self, ranges: &ValueRanges) -> ValueRange {
        match self {
            Self::Robust => ranges.robust,
            Self::Full => ranges.all,
            Self::Typed(range) => range,
        }
    }

    /// The range as it can be used: ends in order, and apart.
    #[must_use]
    pub(super) fn sane(self) -> Self {
        match self {
            Self::Typed(range) if !range.span().is_finite() || range.span() == 0.0 => Self::Robust,
            Self::Typed(ValueRange { low, high }) => {
                Self::Typed(ValueRange::new(low.min(high), low.max(high)))
            }
            chosen => chosen,
        }
    }
}

impl Settings {
    /// The values that have densities from 0 to 1 in pictures of a volume with these values: the chosen range, widened by
    /// control points that lie beyond it, but not beyond the values that there are.
    pub fn shown_range(&self, ranges: &ValueRanges) -> ValueRange {
        let chosen = self.range.of(ranges);
        let span = chosen.span();
        if span <= 0.0 {
            return chosen;
        }
        let light = (!self.lighting.linked).then_some(&self.lighting.curve);
        let curves = std::iter::once(&self.transfer).chain(light);
        let values = curves.flat_map(|curve| &curve.points).map(|point| point.value);
        let (lowest, highest) =
            values.fold((chosen.low, chosen.high), |(low, high), value| (low.min(value), high.max(value)));
        let by = |beyond: f64| {
            let step = span / STEPS;
            if beyond > AT_THE_END * span { (beyond / step).ceil() * step } else { 0.0 }
        };
        ValueRange {
            low: (chosen.low - by(chosen.low - lowest)).max(ranges.all.low.min(chosen.low)),
            high: (chosen.high + by(highest - chosen.high)).min(ranges.all.high.max(chosen.high)),
        }
    }
}

impl Settings {
    /// The same picture of a volume with these values, with densities for a range that holds those of the look. Labels have
    /// none.
    #[must_use]
    pub fn over(&self, range: ValueRange, ranges: &ValueRanges) -> Self {
        let own = self.shown_range(ranges);
        if own == range || !self.labels.is_empty() {
            return self.clone();
        }
        let mut wider = Self { range: DensityRange::Typed(range), ..self.clone() };
        // Densities change more slowly by as much as there are more values.
        wider.shading.surface_gradient *= own.span() / range.span();
        wider
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{ControlPoint, TransferFunction};

    const RANGES: ValueRanges =
        ValueRanges { all: ValueRange::new(-32_768.0, 30_000.0), robust: ValueRange::new(-1000.0, 3000.0) };

    fn shown(range: DensityRange, values: &[f64]) -> ValueRange {
        let points = values.iter().map(|&value| ControlPoint::new(value, [1.0; 3], 0.5)).collect();
        let transfer = TransferFunction { points, ..TransferFunction::default() };
        Settings { range, transfer, ..Settings::default() }.shown_range(&RANGES)
    }

    #[test]
    fn points_beyond_the_range_widen_it_in_steps() {
        let robust = |values: &[f64]| shown(DensityRange::Robust, values);
        assert_eq!(robust(&[-1000.0, 3000.0]), RANGES.robust);
        assert_eq!(robust(&[-1020.0, 3020.0]), RANGES.robust, "half a per cent");
        assert_eq!(robust(&[-1021.0, 3000.0]), ValueRange::new(-1500.0, 3000.0));
        assert_eq!(robust(&[-1500.0, 3400.0]), robust(&[-1400.0, 3500.0]), "the same until the next step");
        assert_eq!(robust(&[-1e30, 1e30]), RANGES.all, "beyond it there is nothing");
        assert_eq!(shown(DensityRange::Full, &[-1e30, 1e30]), RANGES.all);
        let typed = DensityRange::Typed(ValueRange::new(-100.0, 300.0));
        assert_eq!(shown(typed, &[0.0, 310.0]), ValueRange::new(-100.0, 350.0));
        let beyond = DensityRange::Typed(ValueRange::new(-40_000.0, 40_000.0));
        assert_eq!(shown(beyond, &[-1e30, 1e30]), ValueRange::new(-40_000.0, 40_000.0));
    }

    #[test]
    fn the_lighting_curve_widens_it_where_it_is_used() {
        let mut settings = Settings::default();
        settings.transfer.points = vec![ControlPoint::new(0.0, [1.0; 3], 0.5)];
        settings.lighting.curve.points = vec![ControlPoint::new(3400.0, [1.0; 3], 0.5)];
        assert_eq!(settings.shown_range(&RANGES), RANGES.robust);
        settings.lighting.linked = false;
        assert_eq!(settings.shown_range(&RANGES).high, 3500.0);
    }

    #[test]
    fn a_wider_range_is_shown_as_it_is() {
        let mut settings = Settings::default();
        settings.transfer.points = vec![ControlPoint::new(0.0, [1.0; 3], 0.5)];
        assert_eq!(settings.over(RANGES.robust, &RANGES), settings);
        let range = ValueRange::new(-2000.0, 6000.0);
        let wider = settings.over(range, &RANGES);
        assert_eq!(wider.shown_range(&RANGES), range);
        let per_value =
            |settings: &Settings| settings.shading.surface_gradient * settings.shown_range(&RANGES).span();
        assert!((per_value(&wider) / per_value(&settings) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn typed_ranges_have_two_ends() {
        let typed = |low: f64, high: f64| DensityRange::Typed(ValueRange::new(low, high));
        assert_eq!(typed(3.0, 1.0).sane(), typed(1.0, 3.0));
        for (low, high) in [(2.0, 2.0), (f64::NAN, 1.0), (0.0, f64::INFINITY), (-1.5e308, 1.5e308)] {
            assert_eq!(typed(low, high).sane(), DensityRange::Robust);
        }
        assert_eq!(typed(-1.0, 1.0).of(&RANGES), ValueRange::new(-1.0, 1.0));
    }
}
