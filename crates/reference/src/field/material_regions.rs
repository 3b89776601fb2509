//! Materials by value and change, by the definition: a region's weight at a density, averaged piece by piece.

use chiaroscuro_scene::{BakedTransfer, LUT_SIZE, MaterialBox, VolumeLayer};
use chiaroscuro_volume::Volume;

/// Material with its region of densities and of their changes over a voxel.
pub(super) struct MaterialRegion {
    densities: [f64; 2],
    changes: [f64; 2],
    softness: f64,
    /// Colour times opacity or extinction, and opacity or extinction.
    matter: [f64; 4],
}

/// Returns the materials that take the place of a layer's table, over whose opacity length they have opacities.
pub(super) fn material_regions(
    layer: &VolumeLayer,
    volume: &Volume,
    bake: impl Fn(&VolumeLayer, &Volume) -> BakedTransfer,
    opacity_length: Option<f64>,
) -> Vec<MaterialRegion> {
    let range = volume.table_range();
    let region = |material: &MaterialBox| {
        let constant = VolumeLayer { transfer: material.constant_transfer(), ..layer.clone() };
        let table = bake(&constant, volume);
        let table = opacity_length.map_or(table.clone(), |length| table.with_opacities(length));
        let [r, g, b, amount] = table.sample(0.5);
        MaterialRegion {
            densities: material.values.map(|value| (value - range.low) / range.span()),
            changes: material.changes.map(|change| change / range.span()),
            softness: material.softness,
            matter: [r * amount, g * amount, b * amount, amount],
        }
    };
    layer.materials.iter().filter(|_| layer.has_materials()).map(region).collect()
}

/// Returns the length of a region's ends, at least two entries of a table.
fn end_length([low, high]: [f64; 2], softness: f64) -> f64 {
    f64::max(softness * (high - low), 2.0 / (LUT_SIZE - 1) as f64)
}

/// Returns the weight of a region: ½ at its limits, between which it rises and falls linearly; limits beyond 0 and 1
/// exclude nothing.
fn weight(region: [f64; 2], softness: f64, at: f64) -> f64 {
    let [low, high] = region;
    let length = end_length(region, softness);
    let above = if low <= 0.0 { 1.0 } else { ((at - low) / length + 0.5).clamp(0.0, 1.0) };
    let below = if high >= 1.0 { 1.0 } else { ((high - at) / length + 0.5).clamp(0.0, 1.0) };
    above + below - 1.0
}

impl MaterialRegion {
    /// Returns the mean matter for densities from `low` to `high` and their change.
    pub(super) fn mean(&self, low: f64, high: f64, change: f64) -> [f64; 4] {
        let at = |density: f64| weight(self.densities, self.softness, density);
        let half = 0.5 * end_length(self.densities, self.softness);
        let mut places = vec![low, high];
        for limit in self.densities {
            places
                .extend([limit - half, limit + half].into_iter().filter(|place| (low..high).contains(place)));
        }
        places.sort_by(f64::total_cmp);
        // Between these places weights are linear.
        let mean = if high > low {
            let pieces =
                places.windows(2).map(|ends| 0.5 * (at(ends[0]) + at(ends[1])) * (ends[1] - ends[0]));
            pieces.sum::<f64>() / (high - low)
        } else {
            at(low)
        };
        let share = mean * weight(self.changes, self.softness, change);
        self.matter.map(|number| number * share)
    }
}
