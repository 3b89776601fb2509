//! Density range: the range of data values that is mapped to densities of 0 … 1.

use serde::{Deserialize, Serialize};

use crate::{Settings, VolumeLayer};
use chiaroscuro_volume::{ValueRange, ValueRanges};

/// Number of steps per span in which the range is widened: dragging a control point changes it only occasionally,
/// since each change costs an upload.
const STEPS_PER_SPAN: f64 = 8.0;

/// Share of the span by which points may lie beyond an end without widening the range: within rounding, they are at
/// the end.
const END_TOLERANCE: f64 = 0.005;

/// Choice of the values with densities 0 … 1; values outside are clamped.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum DensityRange {
    /// Robust range: all values without padding and outliers.
    #[default]
    Robust,
    /// Full range of the file's values.
    Full,
    /// Range between two typed values, in data units.
    Typed(ValueRange),
}

impl DensityRange {
    /// Returns the chosen range, for a volume with these value ranges.
    pub fn resolve(self, ranges: &ValueRanges) -> ValueRange {
        match self {
            Self::Robust => ranges.robust,
            Self::Full => ranges.all,
            Self::Typed(range) => range,
        }
    }

    /// Returns a usable range: with its ends in order and apart.
    #[must_use]
    pub(crate) fn sanitised(self) -> Self {
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
    /// Returns the values with densities 0 and 1 in images of a volume with these value ranges: the chosen range,
    /// widened by control points outside it, but not beyond the values of the volume.
    pub fn shown_range(&self, ranges: &ValueRanges) -> ValueRange {
        self.layer().shown_range(ranges, self.shown_isovalue())
    }
}

impl VolumeLayer {
    /// Moves the curves, so that they show of the values of one range what they have shown of another; the looks of labels
    /// and of materials stay.
    pub fn map_range(&mut self, from: ValueRange, to: ValueRange) {
        self.transfer.map_range(from, to);
        self.lighting.curve.map_range(from, to);
    }

    /// Returns the values with densities 0 and 1 of a field with these value ranges, in which a surface may be shown
    /// at an isovalue.
    pub fn shown_range(&self, ranges: &ValueRanges, isovalue: Option<f64>) -> ValueRange {
        let chosen = self.range.resolve(ranges);
        let span = chosen.span();
        if span <= 0.0 {
            return chosen;
        }
        // Light meets a surface as the eye does, wherever it lies.
        let is_linked = self.lighting.linked || isovalue.is_some();
        let light = (!is_linked).then_some(&self.lighting.curve);
        let curves = std::iter::once(&self.transfer).chain(light);
        let values = curves.flat_map(|curve| &curve.points).map(|point| point.value).chain(isovalue);
        let (lowest, highest) =
            values.fold((chosen.low, chosen.high), |(low, high), value| (low.min(value), high.max(value)));
        let by = |beyond: f64| {
            let step = span / STEPS_PER_SPAN;
            if beyond > END_TOLERANCE * span { (beyond / step).ceil() * step } else { 0.0 }
        };
        ValueRange {
            low: (chosen.low - by(chosen.low - lowest)).max(ranges.all.low.min(chosen.low)),
            high: (chosen.high + by(highest - chosen.high)).min(ranges.all.high.max(chosen.high)),
        }
    }
}

impl Settings {
    /// Returns settings for the same image of a volume with these value ranges, with densities over a range that
    /// contains this look's range. No effect on looks of labels.
    #[must_use]
    pub fn with_density_range(&self, range: ValueRange, ranges: &ValueRanges) -> Self {
        let own = self.shown_range(ranges);
        if own == range || !self.layer().labels.is_empty() {
            return self.clone();
        }
        let mut wider = self.clone().with_range(DensityRange::Typed(range));
        // Density gradients shrink in proportion to the widened range.
        wider.shading.surface_gradient *= own.span() / range.span();
        wider
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{ControlPoint, TransferFunction};

    const RANGES: ValueRanges =
        ValueRanges { all: ValueRange::new(-32_768.0, 30_000.0), robust: ValueRange::new(-1000.0, 3000.0) };

    fn shown(range: DensityRange, values: &[f64]) -> ValueRange {
        let points = values.iter().map(|&value| ControlPoint::new(value, [1.0; 3], 0.5)).collect();
        let transfer = TransferFunction { points, ..TransferFunction::default() };
        Settings::default().with_range(range).with_transfer(transfer).shown_range(&RANGES)
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
        settings.layer_mut().transfer.points = vec![ControlPoint::new(0.0, [1.0; 3], 0.5)];
        settings.layer_mut().lighting.curve.points = vec![ControlPoint::new(3400.0, [1.0; 3], 0.5)];
        assert_eq!(settings.shown_range(&RANGES), RANGES.robust);
        settings.layer_mut().lighting.linked = false;
        assert_eq!(settings.shown_range(&RANGES).high, 3500.0);
    }

    #[test]
    fn a_wider_range_is_shown_as_it_is() {
        let mut settings = Settings::default();
        settings.layer_mut().transfer.points = vec![ControlPoint::new(0.0, [1.0; 3], 0.5)];
        assert_eq!(settings.with_density_range(RANGES.robust, &RANGES), settings);
        let range = ValueRange::new(-2000.0, 6000.0);
        let wider = settings.with_density_range(range, &RANGES);
        assert_eq!(wider.shown_range(&RANGES), range);
        let per_value =
            |settings: &Settings| settings.shading.surface_gradient * settings.shown_range(&RANGES).span();
        assert!((per_value(&wider) / per_value(&settings) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn typed_ranges_have_two_ends() {
        let typed = |low: f64, high: f64| DensityRange::Typed(ValueRange::new(low, high));
        assert_eq!(typed(3.0, 1.0).sanitised(), typed(1.0, 3.0));
        for (low, high) in [(2.0, 2.0), (f64::NAN, 1.0), (0.0, f64::INFINITY), (-1.5e308, 1.5e308)] {
            assert_eq!(typed(low, high).sanitised(), DensityRange::Robust);
        }
        assert_eq!(typed(-1.0, 1.0).resolve(&RANGES), ValueRange::new(-1.0, 1.0));
    }
}
