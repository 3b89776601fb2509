//! Materials by value and change: regions of the plane of values and of their changes, each with its own colour and
//! opacity (two-dimensional transfer functions: Kniss, Kindlmann and Hansen, 2002).

use std::borrow::Cow;

use serde::{Deserialize, Serialize};

use super::VolumeLayer;
use crate::{ControlPoint, OpacityInterpolation, Settings, TransferFunction};
use chiaroscuro_volume::{ValueRange, Volume};

/// Largest number of materials of a layer.
pub const MAX_MATERIAL_BOXES: usize = 8;

/// Colours of materials that are added, told apart by those who see few colours (Okabe and Ito, 2008).
pub const MATERIAL_COLORS: [[f32; 3]; MAX_MATERIAL_BOXES] = [
    [0.90, 0.62, 0.0],
    [0.34, 0.71, 0.91],
    [0.0, 0.62, 0.45],
    [0.80, 0.47, 0.65],
    [0.94, 0.89, 0.26],
    [0.84, 0.37, 0.0],
    [0.0, 0.45, 0.70],
    [0.95, 0.95, 0.95],
];

/// Region of values and of their changes from voxel to voxel that is drawn as one material.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct MaterialBox {
    /// Lowest and highest value, in data units.
    pub values: [f64; 2],
    /// Least and largest change of the value over a voxel, in data units: the length of the gradient in units of
    /// voxels.
    pub changes: [f64; 2],
    /// Share of the region's extent over which it fades at each end, 0 … 1, half of it outside. A region of all large
    /// changes has no extent: it fades over that share of its smallest one.
    pub softness: f64,
    /// Colour as sRGB, 0 … 1.
    pub color: [f32; 3],
    /// Opacity per opacity unit, 0 … 1.
    pub opacity: f64,
}

impl Default for MaterialBox {
    fn default() -> Self {
        Self { values: [0.0; 2], changes: [0.0; 2], softness: 0.25, color: [1.0; 3], opacity: 0.5 }
    }
}

/// Interval with linear ends: its weight rises over the first pair of positions from 0 to 1, and falls over the second.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SoftInterval {
    /// Positions at which the weight begins to rise, and is 1.
    pub rise: [f64; 2],
    /// Positions at which the weight begins to fall, and is 0.
    pub fall: [f64; 2],
}

/// Least length of an end, in densities: two entries of a table, so that no table misses a narrow interval.
const MIN_END: f64 = 2.0 / (crate::LUT_SIZE - 1) as f64;

/// Distance by which ends that do not fade lie beyond 0 and 1, as densities do.
const BEYOND: f64 = 0.25;

impl SoftInterval {
    /// Creates an interval of densities, or of their changes. It does not fade where it includes all that is below 0 or
    /// above 1.
    fn new([low, high]: [f64; 2], fade: f64) -> Self {
        let half = 0.5 * fade.max(MIN_END);
        let rise = if low <= 0.0 { [-2.0 * BEYOND, -BEYOND] } else { [low - half, low + half] };
        let fall = if high >= 1.0 { [1.0 + BEYOND, 1.0 + 2.0 * BEYOND] } else { [high - half, high + half] };
        Self { rise, fall }
    }

    /// Returns the weight of a position, 0 … 1.
    pub fn weight(&self, at: f64) -> f64 {
        let ramp = |[from, to]: [f64; 2]| ((at - from) / (to - from)).clamp(0.0, 1.0);
        ramp(self.rise) - ramp(self.fall)
    }

    /// Returns the positions at which the slope of the weight changes, in ascending order unless the ends overlap.
    pub fn corners(&self) -> [f64; 4] {
        [self.rise[0], self.rise[1], self.fall[0], self.fall[1]]
    }
}

impl MaterialBox {
    /// Returns the intervals of densities and of their changes over a voxel, for a range of values that is mapped to
    /// densities.
    pub fn intervals(&self, range: ValueRange) -> [SoftInterval; 2] {
        let span = range.span().max(f64::MIN_POSITIVE);
        let densities = self.values.map(|value| (value - range.low) / span);
        let changes = self.changes.map(|change| change / span);
        let shown = |[low, high]: [f64; 2]| high.min(1.0) - low.max(0.0);
        let extent = if changes[1] >= 1.0 { changes[0] } else { shown(changes) };
        [
            SoftInterval::new(densities, self.softness * shown(densities)),
            SoftInterval::new(changes, self.softness * extent),
        ]
    }

    /// Returns a transfer function that has the colour and the opacity of the material at all values.
    pub fn constant_transfer(&self) -> TransferFunction {
        let points = vec![ControlPoint::new(0.0, self.color, self.opacity)];
        TransferFunction { points, ..TransferFunction::default() }
    }
}

/// Share of white in the colour of a highlighted material, and of its own colour in that of others.
const HIGHLIGHT: f32 = 0.5;
const DIMMED: f32 = 0.15;

impl Settings {
    /// Returns the settings with one material of a layer in a bright colour, and all others in dark greys. Opacities
    /// stay, and with them light.
    #[must_use]
    pub fn with_material_highlighted(&self, layer: usize, material: usize) -> Self {
        let mut settings = self.clone();
        for (at, shown) in settings.layers.iter_mut().enumerate() {
            for (index, shown) in shown.materials.iter_mut().enumerate() {
                shown.color = if (at, index) == (layer, material) {
                    shown.color.map(|c| c + (1.0 - c) * HIGHLIGHT)
                } else {
                    [DIMMED * shown.color.iter().sum::<f32>() / 3.0; 3]
                };
            }
        }
        settings
    }
}

/// Returns the optical depth of an opacity.
fn depth(opacity: f64) -> f64 {
    -(-opacity.clamp(0.0, crate::MAX_OPACITY)).ln_1p()
}

/// Returns the transfer function of materials at any change: at every value the sum of their extinctions, so that it has
/// matter wherever they have, in the mean of their colours.
pub(crate) fn transfer_at_any_change(materials: &[MaterialBox], range: ValueRange) -> TransferFunction {
    let intervals: Vec<SoftInterval> =
        materials.iter().map(|material| material.intervals(range)[0]).collect();
    let mut corners: Vec<f64> = intervals.iter().flat_map(SoftInterval::corners).collect();
    corners.retain(|corner| (0.0..=1.0).contains(corner));
    corners.extend([0.0, 1.0]);
    corners.sort_by(f64::total_cmp);
    corners.dedup();
    let point = |at: f64| {
        let mut sum = 0.0;
        let mut color = [0.0_f64; 3];
        let mut weights = 0.0;
        for (material, interval) in materials.iter().zip(&intervals) {
            let extinction = depth(material.opacity) * interval.weight(at);
            // Ends without matter have the colours of the materials that begin or end there.
            let weight = extinction + 1e-6 * f64::from(u8::from(interval.corners().contains(&at)));
            sum += extinction;
            weights += weight;
            (0..3).for_each(|c| color[c] += weight * f64::from(material.color[c]));
        }
        let color = color.map(|c| if weights > 0.0 { (c / weights) as f32 } else { 1.0 });
        ControlPoint::new(range.value_at(at), color, -(-sum).exp_m1())
    };
    TransferFunction {
        points: corners.into_iter().map(point).collect(),
        interpolation: OpacityInterpolation::Extinction,
        ..TransferFunction::default()
    }
}

impl VolumeLayer {
    /// Returns true if the layer is drawn by its materials: labels come first.
    pub fn has_materials(&self) -> bool {
        !self.materials.is_empty() && self.labels.is_empty()
    }

    /// Replaces the curves of a layer that is drawn by its materials by the function that has matter wherever these
    /// have, for a field.
    pub(super) fn resolve_materials(&mut self, field: &Volume) {
        if self.has_materials() {
            let range = self.shown_range(&field.ranges(), None);
            self.transfer = transfer_at_any_change(&self.materials, range);
            self.lighting.linked = true;
        } else {
            self.materials.clear();
        }
    }
}

impl Settings {
    /// Returns the settings of their [mode](Self::resolved_mode), with the transfer function of materials at any change
    /// if a volume is drawn by materials.
    pub(super) fn resolved_mode_and_materials(&self, volume: &Volume) -> Cow<'_, Self> {
        let mut drawn = self.resolved_mode();
        if drawn.shows_matter() && drawn.layer().has_materials() {
            drawn.to_mut().layer_mut().resolve_materials(volume);
        }
        drawn
    }
}

#[cfg(test)]
mod tests {
    use super::{MaterialBox, transfer_at_any_change};
    use crate::Settings;
    use chiaroscuro_volume::ValueRange;

    const RANGE: ValueRange = ValueRange::new(-100.0, 300.0);

    fn material(values: [f64; 2], opacity: f64) -> MaterialBox {
        MaterialBox { values, changes: [0.0, 1e3], opacity, ..MaterialBox::default() }
    }

    #[test]
    fn a_highlight_changes_colors_alone() {
        let material = |color| MaterialBox { color, opacity: 0.3, ..MaterialBox::default() };
        let mut settings = Settings::default();
        settings.layer_mut().materials = vec![material([0.2, 0.4, 0.6]), material([0.9, 0.0, 0.0])];
        let shown = settings.with_material_highlighted(0, 0);
        let [bright, dark] = shown.layer().materials[..] else { panic!("two materials") };
        assert!((0..3).all(|c| bright.color[c] > settings.layer().materials[0].color[c]), "{bright:?}");
        assert!(dark.color[0] == dark.color[2] && dark.color[0] < 0.1, "{dark:?}");
        let mut again = shown.clone();
        for (material, own) in again.layer_mut().materials.iter_mut().zip(&settings.layer().materials) {
            material.color = own.color;
        }
        assert_eq!(again, settings);
    }

    #[test]
    fn ends_fade_by_half_outside_and_open_ends_do_not() {
        let [values, changes] =
            MaterialBox { softness: 0.5, changes: [40.0, 1e3], ..material([0.0, 200.0], 0.5) }
                .intervals(RANGE);
        let near =
            |found: f64, expected: f64| assert!((found - expected).abs() < 1e-12, "{found} {expected}");
        for (value, weight) in
            [(-50.0, 0.0), (0.0, 0.5), (50.0, 1.0), (100.0, 1.0), (175.0, 0.75), (260.0, 0.0)]
        {
            near(values.weight((value - RANGE.low) / RANGE.span()), weight);
        }
        assert_eq!(changes.weight(0.9), 1.0, "any large change");
        assert_eq!(changes.weight(0.0), 0.0);
        let [all, still] =
            MaterialBox { changes: [0.0, 20.0], ..material([-1e3, 1e3], 0.5) }.intervals(RANGE);
        assert_eq!(
            [all.weight(0.0), all.weight(1.0), still.weight(0.0), still.weight(0.1)],
            [1.0, 1.0, 1.0, 0.0]
        );
    }

    #[test]
    fn the_function_of_all_changes_is_the_sum_of_extinctions() {
        let materials =
            [material([0.0, 100.0], 0.6), material([50.0, 50.0], 0.9), material([80.0, 500.0], 0.3)];
        let function = transfer_at_any_change(&materials, RANGE);
        for step in 0..400 {
            let value = RANGE.value_at(f64::from(step) / 399.0);
            let sum: f64 = materials
                .iter()
                .map(|m| {
                    m.intervals(RANGE)[0].weight((value - RANGE.low) / RANGE.span()) * -(1.0 - m.opacity).ln()
                })
                .sum();
            let found = function.sample(value).depth;
            assert!((found - sum).abs() < 1e-9, "{value}: {found} {sum}");
        }
    }
}
