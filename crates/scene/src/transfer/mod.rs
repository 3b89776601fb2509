//! Transfer functions: mapping from a value in data units to colour and opacity.
//!
//! Opacity is per opacity unit (a length in `Settings`): the extinction is μ = −ln(1 − opacity) / unit, so that the
//! look does not depend on the slab thickness (P eq. 6).

mod add_point;
pub(super) mod baked_transfer;
pub(super) mod color_map;
pub(super) mod colored_shadows;
mod crisp_ramp;
mod freehand;
pub(super) mod label_colors;
pub(super) mod oklab;
mod opacity_ramp;

use serde::{Deserialize, Serialize};

use super::{BakedTransfer, linear_from_oklab, oklab_from_linear};
use chiaroscuro_volume::ValueRange;
pub use chiaroscuro_volume::math::{linear_from_srgb, srgb_from_linear};

/// Number of entries of a baked table; values between them are interpolated.
pub const LUT_SIZE: usize = 1024;

/// Largest number of points of a function: that of the largest tables in exchange formats.
pub const MAX_POINTS: usize = 4096;

/// Largest opacity, so that extinction stays finite: 0.9999 per unit is e^−9.2, opaque within one unit for every
/// display.
pub const MAX_OPACITY: f64 = 0.9999;

/// Number of linear pieces that approximate a smooth segment.
pub const SMOOTH_SEGMENT_PIECES: u32 = 8;

/// Interpolation of opacity between two control points.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum OpacityInterpolation {
    /// Linear in opacity: as editors show it and users expect.
    #[default]
    Opacity,
    /// Linear in extinction −ln(1 − opacity): makes closed-form checks exact.
    Extinction,
}

/// Colour space in which colours between control points are interpolated.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ColorMixing {
    /// Linear RGB, as light mixes.
    #[default]
    Light,
    /// Oklab, perceptually: lightness is even, and mixtures stay saturated.
    Seen,
}

/// Shape of the segment from one control point to the next.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Easing {
    /// Linear interpolation to the next point.
    #[default]
    Linear,
    /// Smoothstep with level ends: 3t² − 2t³.
    Smooth,
    /// Constant until the next point.
    Step,
}

impl Easing {
    /// Returns the weight of the next point at a fraction of the segment.
    fn weight(self, t: f64) -> f64 {
        match self {
            Self::Linear => t,
            Self::Smooth => t * t * (3.0 - 2.0 * t),
            Self::Step => 0.0,
        }
    }
}

/// Control point of a transfer function.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ControlPoint {
    /// Position on the value axis, in data units.
    pub value: f64,
    /// Colour as sRGB, 0 … 1.
    #[serde(default = "white")]
    pub color: [f32; 3],
    /// Opacity per opacity unit, 0 … 1.
    pub opacity: f64,
    /// Shape of the segment to the next point.
    #[serde(default)]
    pub easing: Easing,
}

impl ControlPoint {
    /// Creates a point with a linear segment to the next.
    pub fn new(value: f64, color: [f32; 3], opacity: f64) -> Self {
        Self { value, color, opacity, easing: Easing::Linear }
    }
}

fn white() -> [f32; 3] {
    [1.0; 3]
}

/// Colour and opacity over the value axis; constant beyond the outermost points.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct TransferFunction {
    /// Control points in ascending order of value ([`Self::sort`] restores it).
    pub points: Vec<ControlPoint>,
    /// Interpolation of opacity between the points.
    #[serde(default)]
    pub interpolation: OpacityInterpolation,
    /// Colour space of the interpolation between the points.
    #[serde(default)]
    pub mixing: ColorMixing,
}

/// Returns −ln(1 − α) with α clamped to [`MAX_OPACITY`]: optical depth of one opacity unit.
fn optical_depth(opacity: f64) -> f64 {
    -(-opacity.clamp(0.0, MAX_OPACITY)).ln_1p()
}

/// Colour and opacity of a transfer function at a value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TransferSample {
    /// Colour in linear RGB, without opacity.
    pub color: [f64; 3],
    /// Optical depth per opacity unit.
    pub depth: f64,
}

impl TransferFunction {
    /// Sorts the points by value; points at the same value keep their order, which makes a jump.
    pub fn sort(&mut self) {
        self.points.sort_by(|a, b| a.value.total_cmp(&b.value));
    }

    /// Evaluates the function at a value.
    pub fn sample(&self, value: f64) -> TransferSample {
        let color = |point: &ControlPoint| point.color.map(|c| linear_from_srgb(f64::from(c)));
        let at_point = |point: &ControlPoint| TransferSample {
            color: color(point),
            depth: optical_depth(point.opacity),
        };
        let Some(first) = self.points.first() else {
            return TransferSample { color: [1.0; 3], depth: 0.0 };
        };
        let upper = self.points.partition_point(|point| point.value <= value);
        if upper == 0 {
            return at_point(first);
        }
        let a = &self.points[upper - 1];
        let Some(b) = self.points.get(upper) else { return at_point(a) };
        let t = a.easing.weight((value - a.value) / (b.value - a.value));
        let mix = |x: f64, y: f64| x + (y - x) * t;
        let depth = match self.interpolation {
            OpacityInterpolation::Opacity => optical_depth(mix(a.opacity, b.opacity)),
            OpacityInterpolation::Extinction => mix(optical_depth(a.opacity), optical_depth(b.opacity)),
        };
        let (ca, cb) = (color(a), color(b));
        let mixed = |ca: [f64; 3], cb: [f64; 3]| std::array::from_fn(|i| mix(ca[i], cb[i]));
        let rgb = match self.mixing {
            ColorMixing::Light => mixed(ca, cb),
            ColorMixing::Seen => linear_from_oklab(mixed(oklab_from_linear(ca), oklab_from_linear(cb))),
        };
        TransferSample { color: rgb, depth }
    }

    /// Returns a point on the curve at a value.
    pub fn point_at(&self, value: f64) -> ControlPoint {
        let color = self.sample(value).color.map(|c| srgb_from_linear(c) as f32);
        ControlPoint::new(value, color, self.opacity_at(value))
    }

    /// Returns the easing of the segment that contains a value.
    pub(crate) fn easing_at(&self, value: f64) -> Easing {
        let index = self.points.partition_point(|point| point.value <= value);
        index.checked_sub(1).map_or(Easing::Linear, |before| self.points[before].easing)
    }

    /// Replaces a non-linear segment by linear ones: a step by a jump, a smooth segment by [`SMOOTH_SEGMENT_PIECES`]
    /// pieces. Returns the number of added points.
    pub(crate) fn linearise_segment(&mut self, index: usize) -> usize {
        let (Some(&point), Some(&next)) = (self.points.get(index), self.points.get(index + 1)) else {
            return 0;
        };
        let between: Vec<ControlPoint> = match point.easing {
            Easing::Linear => Vec::new(),
            Easing::Smooth => {
                let share = |step: u32| f64::from(step) / f64::from(SMOOTH_SEGMENT_PIECES);
                (1..SMOOTH_SEGMENT_PIECES)
                    .map(|step| self.point_at(point.value + (next.value - point.value) * share(step)))
                    .collect()
            }
            Easing::Step => vec![ControlPoint { value: next.value, easing: Easing::Linear, ..point }],
        };
        let count = between.len();
        self.points[index].easing = Easing::Linear;
        self.points.splice(index + 1..=index, between);
        count
    }

    /// Adds a point on the curve without changing it (a smooth segment nearly so), and returns its index.
    pub fn split_at(&mut self, value: f64) -> usize {
        let upper = self.points.partition_point(|point| point.value <= value);
        if self.easing_at(value) == Easing::Smooth {
            self.linearise_segment(upper - 1);
        }
        self.insert_on_curve(value)
    }

    /// Adds a point on the curve, which inherits the segment's easing, and returns its index.
    pub fn insert_on_curve(&mut self, value: f64) -> usize {
        let point = self.point_at(value);
        let index = self.points.partition_point(|point| point.value <= value);
        let easing = self.easing_at(value);
        self.points.insert(index, ControlPoint { easing, ..point });
        index
    }

    /// Returns the opacity per opacity unit at a value, as an editor shows it.
    pub fn opacity_at(&self, value: f64) -> f64 {
        1.0 - (-self.sample(value).depth).exp()
    }

    /// Tabulates the function over a volume's value range. `unit` is the opacity unit in scene units, `scale` is a
    /// factor for the extinction.
    pub fn bake(&self, range: ValueRange, unit: f64, scale: f64) -> BakedTransfer {
        let value_at = |place: f64| range.low + range.span() * place / (LUT_SIZE - 1) as f64;
        let sample = |value: f64| {
            let TransferSample { color: [r, g, b], depth } = self.sample(value);
            [r, g, b, depth * scale / unit]
        };
        let entries = (0..LUT_SIZE).map(|i| sample(value_at(i as f64)).map(|number| number as f32)).collect();
        let means: Vec<_> = (0..LUT_SIZE - 1)
            .map(|i| self.mean_over(value_at(i as f64), value_at((i + 1) as f64), sample))
            .collect();
        BakedTransfer::with_means(entries, &means)
    }

    /// Returns the mean over the values from `low` to `high` of colour times extinction and of extinction, where
    /// `sample` returns colour and extinction: by two-point Gauss–Legendre quadrature between control points, which
    /// is exact where both change linearly.
    fn mean_over(&self, low: f64, high: f64, sample: impl Fn(f64) -> [f64; 4]) -> [f64; 4] {
        // ½ − 1/(2√3)
        const FIRST: f64 = 0.211_324_865_405_187_1;
        let mut sum = [0.0; 4];
        let mut from = low;
        let first = self.points.partition_point(|point| point.value <= low);
        let inner = self.points[first..].iter().map(|point| point.value).take_while(|&value| value < high);
        for to in inner.chain([high]) {
            for at in [FIRST, 1.0 - FIRST] {
                let [r, g, b, extinction] = sample(from + at * (to - from));
                let weight = 0.5 * extinction * (to - from) / (high - low);
                sum = [sum[0] + r * weight, sum[1] + g * weight, sum[2] + b * weight, sum[3] + weight];
            }
            from = to;
        }
        sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ramp(interpolation: OpacityInterpolation) -> TransferFunction {
        let point = |value, opacity| ControlPoint::new(value, [1.0; 3], opacity);
        TransferFunction {
            points: vec![point(10.0, 0.0), point(20.0, 0.8)],
            interpolation,
            ..TransferFunction::default()
        }
    }

    #[test]
    fn opacity_is_linear_or_extinction_is() {
        assert!((ramp(OpacityInterpolation::Opacity).opacity_at(15.0) - 0.4).abs() < 1e-12);
        let depth = ramp(OpacityInterpolation::Extinction).sample(15.0).depth;
        assert!((depth - -0.5 * 0.2f64.ln()).abs() < 1e-12);
        assert_eq!(ramp(OpacityInterpolation::Opacity).opacity_at(5.0), 0.0);
        assert!((ramp(OpacityInterpolation::Opacity).opacity_at(99.0) - 0.8).abs() < 1e-12);
    }

    #[test]
    fn ways_between_points_have_their_shapes() {
        let mut function = ramp(OpacityInterpolation::Opacity);
        for (easing, quarter, half) in
            [(Easing::Linear, 0.2, 0.4), (Easing::Smooth, 0.8 * 0.15625, 0.4), (Easing::Step, 0.0, 0.0)]
        {
            function.points[0].easing = easing;
            for (value, opacity) in [(10.0, 0.0), (12.5, quarter), (15.0, half), (20.0, 0.8)] {
                let found = function.opacity_at(value);
                assert!((found - opacity).abs() < 1e-12, "{easing:?} at {value}: {found}");
            }
        }
    }

    #[test]
    fn seen_mixtures_have_even_lightness() {
        let mut function = ramp(OpacityInterpolation::Opacity);
        (function.points[0].color, function.points[1].color) = ([0.0, 0.0, 1.0], [1.0, 1.0, 0.0]);
        let lightness =
            |function: &TransferFunction, value| oklab_from_linear(function.sample(value).color)[0];
        let even = |function: &TransferFunction| {
            let middle = f64::midpoint(lightness(function, 10.0), lightness(function, 20.0));
            (lightness(function, 15.0) - middle).abs() < 1e-3
        };
        assert!(!even(&function), "light mixes brighter than it looks");
        function.mixing = ColorMixing::Seen;
        assert!(even(&function));
        let ends = [function.sample(10.0).color, function.sample(20.0).color];
        assert!(ends.iter().flatten().zip([0.0, 0.0, 1.0, 1.0, 1.0, 0.0]).all(|(a, b)| (a - b).abs() < 1e-6));
    }

    #[test]
    fn points_on_the_curve_leave_it_as_it_is() {
        for mixing in [ColorMixing::Light, ColorMixing::Seen] {
            for easing in [Easing::Linear, Easing::Step] {
                let mut function = TransferFunction { mixing, ..ramp(OpacityInterpolation::Opacity) };
                function.points[0].easing = easing;
                let before = function.clone();
                assert_eq!(function.insert_on_curve(13.0), 1);
                for i in 0..40 {
                    let value = 9.0 + f64::from(i) * 0.3;
                    let (a, b) = (before.sample(value), function.sample(value));
                    assert!((a.depth - b.depth).abs() < 1e-9, "{mixing:?} {easing:?} {value}");
                    assert!(
                        a.color.iter().zip(b.color).all(|(a, b)| (a - b).abs() < 1e-6),
                        "{mixing:?} {easing:?} {value}"
                    );
                }
            }
        }
    }

    #[test]
    fn straight_ways_stand_for_others() {
        for (easing, more, apart) in
            [(Easing::Linear, 0, 1e-9), (Easing::Step, 1, 1e-9), (Easing::Smooth, 7, 0.01)]
        {
            let mut function = ramp(OpacityInterpolation::Opacity);
            function.points[0].easing = easing;
            let before = function.clone();
            assert_eq!(function.clone().linearise_segment(0), more, "{easing:?}");
            let index = function.split_at(13.0);
            assert_eq!(function.points[index].value, 13.0);
            for i in 0..100 {
                let value = 9.03 + f64::from(i) * 0.12;
                let found = (function.opacity_at(value) - before.opacity_at(value)).abs();
                assert!(found < apart, "{easing:?} at {value}: {found}");
            }
        }
        assert_eq!(ramp(OpacityInterpolation::Opacity).linearise_segment(1), 0, "nothing follows");
    }

    #[test]
    fn two_points_at_one_value_make_a_step() {
        let mut function = ramp(OpacityInterpolation::Opacity);
        function.points[1].value = 10.0;
        assert_eq!(function.opacity_at(9.999), 0.0);
        assert!((function.opacity_at(10.0) - 0.8).abs() < 1e-12);
    }

    #[test]
    fn visibility_never_hides_what_can_be_seen() {
        let baked = ramp(OpacityInterpolation::Opacity).bake(ValueRange::new(0.0, 100.0), 1.0, 1.0);
        let visible = baked.visibility_test();
        assert!(!visible(0.0, 0.09));
        for i in 0..=1000 {
            let density = i as f32 / 1000.0;
            assert!(visible(density, density) || baked.sample(f64::from(density))[3] == 0.0, "{density}");
        }
    }

    #[test]
    fn full_opacity_stays_finite() {
        let solid = TransferFunction {
            points: vec![ControlPoint::new(0.0, [1.0; 3], 1.0)],
            interpolation: OpacityInterpolation::Opacity,
            ..TransferFunction::default()
        };
        assert!(solid.bake(ValueRange::UNIT, 0.01, 1.0).entries.iter().all(|entry| entry[3].is_finite()));
    }
}
