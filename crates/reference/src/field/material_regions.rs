//! Materials by value and change, by the definition: a region's weight at a density, averaged piece by piece.

use chiaroscuro_scene::{BakedTransfer, LUT_SIZE, MaterialBox, VolumeLayer};
use chiaroscuro_volume::Volume;

/// Interval that fades at its limits over a length.
#[derive(Clone, Copy)]
struct FadingInterval {
    from: f64,
    to: f64,
    fade: f64,
}

/// Material with its region of densities and of their changes over a voxel.
pub(super) struct MaterialRegion {
    densities: FadingInterval,
    changes: FadingInterval,
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
        let least = 2.0 / (LUT_SIZE - 1) as f64;
        let [from, to] = material.values.map(|value| (value - range.low) / range.span());
        let extent = to.clamp(0.0, 1.0) - from.clamp(0.0, 1.0);
        let densities = FadingInterval { from, to, fade: least.max(material.softness * extent) };
        let [from, to] = material.changes.map(|change| change / range.span());
        let extent = if to < 1.0 { to - from.max(0.0) } else { from };
        let changes = FadingInterval { from, to, fade: least.max(material.softness * extent) };
        MaterialRegion { densities, changes, matter: [r * amount, g * amount, b * amount, amount] }
    };
    layer.materials.iter().filter(|_| layer.has_materials()).map(region).collect()
}

impl FadingInterval {
    /// Returns the weight at a position: ½ at the limits, between which it rises and falls linearly; limits beyond 0
    /// and 1 exclude nothing.
    fn weight(&self, at: f64) -> f64 {
        let Self { from, to, fade } = *self;
        let above = if from <= 0.0 { 1.0 } else { ((at - from) / fade + 0.5).clamp(0.0, 1.0) };
        let below = if to >= 1.0 { 1.0 } else { ((to - at) / fade + 0.5).clamp(0.0, 1.0) };
        above + below - 1.0
    }
}

impl MaterialRegion {
    /// Returns the mean matter for densities from `low` to `high` and their change.
    pub(super) fn mean(&self, low: f64, high: f64, change: f64) -> [f64; 4] {
        let FadingInterval { from, to, fade } = self.densities;
        let at = |density: f64| self.densities.weight(density);
        let half = 0.5 * fade;
        let mut places = vec![low, high];
        for limit in [from, to] {
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
        let share = mean * self.changes.weight(change);
        self.matter.map(|number| number * share)
    }
}
