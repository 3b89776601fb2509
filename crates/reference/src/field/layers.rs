//! Layers: matter of voxels from several fields, by the definition: one voxel and one layer after another.

use super::classified::unassociated;
use super::integrated_table::IntegratedTable;
use chiaroscuro_scene::{BakedTransfer, LayerBlend, Settings, VolumeLayer};
use chiaroscuro_volume::{Dataset, Volume, math::SceneSpace};

/// Field with its layer and the layer's transfer function of a side.
struct LayeredField<'a> {
    volume: &'a Volume,
    densities: Vec<f64>,
    layer: &'a VolumeLayer,
    table: IntegratedTable,
    scene: SceneSpace,
}

impl LayeredField<'_> {
    /// Returns the density of a voxel; `None` if it is missing or outside the grid.
    fn density(&self, place: [i64; 3]) -> Option<f64> {
        let dims = self.volume.dims().map(|n| n as i64);
        if (0..3).any(|axis| !(0..dims[axis]).contains(&place[axis])) {
            return None;
        }
        let voxel = (place[0] + dims[0] * (place[1] + dims[1] * place[2])) as usize;
        let is_missing = self.volume.missing().is_some_and(|missing| missing.contains(voxel));
        (!is_missing).then(|| self.densities[voxel])
    }

    /// Returns colour times extinction, and extinction, of a voxel: the mean over the densities in it.
    fn matter(&self, place: [i64; 3]) -> [f64; 4] {
        let Some(own) = self.density(place) else { return [0.0; 4] };
        let beside = |axis: usize, step: i64| {
            let mut other = place;
            other[axis] += step;
            self.density(other).unwrap_or(own)
        };
        let pairs = [0, 1, 2].map(|axis| [beside(axis, -1), beside(axis, 1)]);
        let slope = pairs.iter().map(|[a, b]| (0.5 * (b - a)).powi(2)).sum::<f64>().sqrt();
        let lowest = pairs.iter().flatten().copied().fold(own, f64::min);
        let highest = pairs.iter().flatten().copied().fold(own, f64::max);
        let width = if self.volume.shown_labels().is_some() { 0.0 } else { slope };
        let (low, high) = ((own - 0.5 * width).max(lowest), (own + 0.5 * width).min(highest));
        let matter = self.table.mean_between(low, high);
        let edges = self.layer.edges;
        if edges <= 0.0 {
            return matter;
        }
        let t = ((slope / edges - 0.5) / 0.5).clamp(0.0, 1.0);
        matter.map(|number| number * t * t * (3.0 - 2.0 * t))
    }
}

/// Returns colour times extinction, and extinction, of every voxel of a dataset with layers. `has_effect` tells if a
/// layer counts, and `bake` makes its table over the values of its field.
pub(crate) fn composed_voxels(
    dataset: &Dataset,
    settings: &Settings,
    has_effect: impl Fn(&VolumeLayer) -> bool,
    bake: impl Fn(&VolumeLayer, &Volume) -> BakedTransfer,
) -> Vec<[f64; 4]> {
    let fields: Vec<_> = settings
        .layers
        .iter()
        .zip(dataset.fields().iter())
        .filter(|(layer, _)| has_effect(layer))
        .map(|(layer, field)| {
            let volume = &**field.volume();
            let [.., slices] = volume.dims();
            LayeredField {
                volume,
                densities: (0..slices).flat_map(|z| volume.slice_densities(z)).map(f64::from).collect(),
                layer,
                table: IntegratedTable::new(bake(layer, volume), true),
                scene: dataset.volume().scene(),
            }
        })
        .collect();
    let [nx, ny, nz] = dataset.volume().dims();
    let places =
        (0..nz).flat_map(|z| (0..ny).flat_map(move |y| (0..nx).map(move |x| [x, y, z].map(|c| c as i64))));
    places.map(|place| fields.iter().fold([0.0; 4], |sum, field| composed(sum, field, place))).collect()
}

/// Returns the matter of a voxel with that of one more layer.
fn composed(sum: [f64; 4], field: &LayeredField<'_>, place: [i64; 3]) -> [f64; 4] {
    let matter = field.matter(place);
    let unit = field.layer.opacity_unit.scene_units(&field.scene);
    let opacity = 1.0 - (-matter[3] * unit).exp();
    match field.layer.blend {
        LayerBlend::Add => std::array::from_fn(|i| sum[i] + matter[i]),
        LayerBlend::Gate => sum.map(|number| number * opacity),
        LayerBlend::Tint => {
            let [r, g, b, _] = unassociated(matter);
            let tinted = [r, g, b].map(|color| color * sum[3]);
            let mixed = |i: usize| sum[i] + (tinted[i] - sum[i]) * opacity;
            [mixed(0), mixed(1), mixed(2), sum[3]]
        }
    }
}
