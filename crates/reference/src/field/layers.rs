//! Layers: matter of voxels from several fields, by the definition: one voxel and one layer after another.

use super::classified::unassociated;
use super::integrated_table::IntegratedTable;
use super::material_regions::{MaterialRegion, material_regions};
use super::pyramid::Pyramid;
use chiaroscuro_scene::{BakedTransfer, LayerBlend, Settings, VolumeLayer, linear_from_srgb};
use chiaroscuro_volume::{Dataset, Volume, math::SceneSpace};
use glam::DVec3;

/// Field with its layer and the layer's transfer function of a side.
struct LayeredField<'a> {
    volume: &'a Volume,
    densities: Vec<f64>,
    layer: &'a VolumeLayer,
    /// Table over densities, of opacities if there is a length to which they refer.
    table: IntegratedTable,
    opacity_length: Option<f64>,
    /// Materials that take the place of the table.
    materials: Vec<MaterialRegion>,
    scene: SceneSpace,
    /// Presence that the matter is multiplied by, if the mask is not of the sum of all layers.
    presence: Option<&'a Pyramid>,
}

impl LayeredField<'_> {
    /// Returns the density of a voxel, even if a mask hides it; `None` if it is missing or outside the grid.
    fn density(&self, place: [i64; 3]) -> Option<f64> {
        let dims = self.volume.dims().map(|n| n as i64);
        if (0..3).any(|axis| !(0..dims[axis]).contains(&place[axis])) {
            return None;
        }
        let voxel = (place[0] + dims[0] * (place[1] + dims[1] * place[2])) as usize;
        let is_missing = self.volume.missing().is_some_and(|missing| missing.contains(voxel));
        (!is_missing).then(|| self.densities[voxel])
    }

    /// Returns the opacity of matter over the length to which opacities refer.
    fn opacity(&self, matter: [f64; 4]) -> f64 {
        -(-matter[3] * self.layer.opacity_unit.scene_units(&self.scene)).exp_m1()
    }

    /// Returns the matter whose opacity over a voxel, or extinction, is a mean.
    fn matter_of_mean(&self, mean: [f64; 4]) -> [f64; 4] {
        let Some(length) = self.opacity_length else { return mean };
        let opacity = mean[3].clamp(1e-12, 1.0 - 1e-6);
        let extinction = -(-opacity).ln_1p() / length;
        mean.map(|number| number.max(0.0) * extinction / opacity)
    }

    /// Returns colour times extinction, and extinction, of a voxel, as far as no mask of the layer hides it.
    fn visible_matter(&self, place: [i64; 3]) -> [f64; 4] {
        let matter = self.matter(place);
        let Some(presence) = self.presence else { return matter };
        let left = presence.fetch(DVec3::from(place.map(|at| at as f64)), 0.0);
        matter.map(|number| number * left)
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
        let matter = if self.materials.is_empty() {
            self.matter_of_mean(self.table.mean_between(low, high))
        } else {
            let parts =
                self.materials.iter().map(|region| self.matter_of_mean(region.mean(low, high, slope)));
            parts.fold([0.0; 4], |sum, part| std::array::from_fn(|i| sum[i] + part[i]))
        };
        let edges = self.layer.edges;
        if edges <= 0.0 {
            return matter;
        }
        if self.volume.shown_labels().is_some() {
            let is_outline = pairs.iter().flatten().any(|other| *other != own);
            return if is_outline { matter } else { [0.0; 4] };
        }
        let t = ((slope / edges - 0.5) / 0.5).clamp(0.0, 1.0);
        matter.map(|number| number * t * t * (3.0 - 2.0 * t))
    }
}

/// Returns colour times extinction, and extinction, of every voxel of a dataset with layers. `has_effect` tells if a
/// layer counts, and `bake` makes its table over the values of its field. Opacities over a length are composed, or
/// extinctions if there is none. If some layers are never cut, `presence` is that of the others.
pub(crate) fn composed_voxels(
    dataset: &Dataset,
    settings: &Settings,
    has_effect: impl Fn(&VolumeLayer) -> bool,
    bake: impl Fn(&VolumeLayer, &Volume) -> BakedTransfer,
    opacity_length: Option<f64>,
    presence: Option<&Pyramid>,
) -> Vec<[f64; 4]> {
    let mut fields = layered_fields(dataset, settings, has_effect, bake, opacity_length);
    for field in &mut fields {
        field.presence = presence.filter(|_| !field.layer.ignores_cuts);
    }
    let places = voxel_places(dataset.volume().dims());
    places.map(|place| fields.iter().fold([0.0; 4], |sum, field| composed(sum, field, place))).collect()
}

/// Lists the places of all voxels, x fastest.
fn voxel_places([nx, ny, nz]: [usize; 3]) -> impl Iterator<Item = [i64; 3]> {
    (0..nz).flat_map(move |z| (0..ny).flat_map(move |y| (0..nx).map(move |x| [x, y, z].map(|c| c as i64))))
}

/// Returns the fields whose layers have an effect, with their tables.
fn layered_fields<'a>(
    dataset: &'a Dataset,
    settings: &'a Settings,
    has_effect: impl Fn(&VolumeLayer) -> bool,
    bake: impl Fn(&VolumeLayer, &Volume) -> BakedTransfer,
    opacity_length: Option<f64>,
) -> Vec<LayeredField<'a>> {
    settings
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
                table: IntegratedTable::new(
                    match (bake(layer, volume), opacity_length) {
                        (table, None) => table,
                        (table, Some(length)) => table.with_opacities(length),
                    },
                    true,
                ),
                opacity_length,
                materials: material_regions(layer, volume, &bake, opacity_length),
                scene: dataset.volume().scene(),
                presence: None,
            }
        })
        .collect()
}

/// Returns colour times opacity, and opacity, of the tint of every voxel by the seen layers that tint.
pub(crate) fn tint_voxels(
    dataset: &Dataset,
    settings: &Settings,
    bake: impl Fn(&VolumeLayer, &Volume) -> BakedTransfer,
) -> Vec<[f64; 4]> {
    let tints = |layer: &VolumeLayer| layer.is_seen() && layer.blend.changes_color_alone();
    let fields = layered_fields(dataset, settings, tints, bake, Some(dataset.volume().scene().mean_edge()));
    let tint = |place: [i64; 3]| {
        fields.iter().fold([0.0; 4], |[r, g, b, covered], field| {
            if let Some(channel) = field.layer.blend.channel() {
                let mut tint = [r, g, b, covered];
                if let Some(density) = field.density(place) {
                    tint[channel] = linear_from_srgb(density);
                    tint[3] = 1.0;
                }
                return tint;
            }
            let mut matter = field.matter(place);
            let is_without =
                field.density(place).is_none_or(|own| field.table.mean_between(own, own)[3] <= 0.0);
            if field.volume.shown_labels().is_some() && is_without {
                // Labels tint one voxel further, since their surfaces lie between voxels.
                let steps = [0, 1, 2].into_iter().flat_map(|axis| [(axis, -1), (axis, 1)]);
                matter = steps.fold([0.0; 4], |densest: [f64; 4], (axis, step)| {
                    let mut beside = place;
                    beside[axis] += step;
                    let matter = field.matter(beside);
                    if matter[3] > densest[3] { matter } else { densest }
                });
            }
            let opacity = field.opacity(matter);
            let [red, green, blue, _] = unassociated(matter);
            let over = |below: f64, color: f64| below * (1.0 - opacity) + color * opacity;
            [over(r, red), over(g, green), over(b, blue), over(covered, 1.0)]
        })
    };
    voxel_places(dataset.volume().dims()).map(tint).collect()
}

/// Returns the matter of a voxel with that of one more layer.
fn composed(sum: [f64; 4], field: &LayeredField<'_>, place: [i64; 3]) -> [f64; 4] {
    let matter = field.visible_matter(place);
    let opacity = field.opacity(matter);
    match field.layer.blend {
        LayerBlend::Add => std::array::from_fn(|i| sum[i] + matter[i]),
        LayerBlend::Gate => sum.map(|number| number * opacity),
        LayerBlend::Red | LayerBlend::Green | LayerBlend::Blue => {
            let mut replaced = sum;
            if let (Some(channel), Some(density)) = (field.layer.blend.channel(), field.density(place)) {
                replaced[channel] = linear_from_srgb(density) * sum[3];
            }
            replaced
        }
        LayerBlend::Tint => {
            let [r, g, b, _] = unassociated(matter);
            let tinted = [r, g, b].map(|color| color * sum[3]);
            let mixed = |i: usize| sum[i] + (tinted[i] - sum[i]) * opacity;
            [mixed(0), mixed(1), mixed(2), sum[3]]
        }
    }
}
