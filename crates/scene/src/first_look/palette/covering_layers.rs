//! Thinning of layers that cover others: the nucleus of a cell is seen through its membrane, and vessels through a head.

use crate::{BakedTransfer, LayerBlend, Settings, VolumeLayer};
use chiaroscuro_volume::{Dataset, DatasetField, math::SceneSpace};

/// Largest number of cells along an axis: the mean over thousands of cells changes little with finer ones.
const MAX_CELLS: usize = 48;

/// Share of the light from a layer that is to pass another one in front of it, on average over its material and over
/// directions: half, so that both are seen.
const PASSING_SHARE: f64 = 0.5;

/// Smallest factor of a layer's density; with less it would not be seen itself.
const MIN_FACTOR: f64 = 0.02;

/// Number of halvings of the range of factors: its logarithm is then known to 4/2¹².
const HALVINGS: u32 = 12;

/// Extinction of a layer in cells of a grid, each sampled at one voxel.
struct ExtinctionCells {
    /// Number of cells along x, y and z.
    cells: [usize; 3],
    /// Edges of a cell in scene units.
    edges: [f64; 3],
    /// Extinction per scene unit, x fastest.
    extinctions: Vec<f64>,
}

/// Thins layers that hide others, by the length to which their opacities refer.
pub(super) fn thin_covering_layers(settings: &mut Settings, dataset: &Dataset) {
    let scene = dataset.volume().scene();
    let shown = settings.layers.iter().zip(dataset.fields().iter()).enumerate();
    let adds = |index: usize, layer: &VolumeLayer| {
        layer.is_seen() && layer.labels.is_empty() && (index == 0 || layer.blend == LayerBlend::Add)
    };
    let layers: Vec<_> = shown
        .filter(|(index, (layer, _))| adds(*index, layer))
        .map(|(index, (layer, field))| (index, ExtinctionCells::new(layer, field, &scene)))
        .collect();
    for (index, cover) in &layers {
        let depths = cover.depths_to_outside();
        let covered = layers.iter().filter(|(other, _)| other != index);
        let factors = covered.map(|(_, covered)| covered.factor_of_cover(&depths));
        let factor = factors.fold(1.0, f64::min);
        if factor < 1.0 {
            let layer = settings.layer_at_mut(*index);
            layer.opacity_unit = layer.opacity_unit.scaled(1.0 / factor);
        }
    }
}

impl ExtinctionCells {
    fn new(layer: &VolumeLayer, field: &DatasetField, scene: &SceneSpace) -> Self {
        let volume = field.volume();
        let volume = &volume.with_density_mapping(layer.density_mapping(&volume.ranges()));
        let table = layer.bake_eye(volume.table_range(), scene);
        let dims = volume.dims();
        let strides = dims.map(|n| n.div_ceil(MAX_CELLS));
        let cells = [0, 1, 2].map(|axis| dims[axis].div_ceil(strides[axis]));
        let spacing = volume.spacing_mm() / scene.mm_per_unit;
        let edges = [0, 1, 2].map(|axis| spacing[axis] * strides[axis] as f64);
        let mut extinctions = Vec::with_capacity(cells.iter().product());
        for z in (0..dims[2]).step_by(strides[2]) {
            let slice = volume.slice_densities(z);
            for y in (0..dims[1]).step_by(strides[1]) {
                for x in (0..dims[0]).step_by(strides[0]) {
                    let at = x + dims[0] * y;
                    let voxel = at + dims[0] * dims[1] * z;
                    let is_missing = volume.missing().is_some_and(|missing| missing.contains(voxel));
                    extinctions.push(if is_missing { 0.0 } else { extinction(&table, slice[at]) });
                }
            }
        }
        Self { cells, edges, extinctions }
    }

    /// Returns the optical depths from each cell to either end of the grid along each axis.
    fn depths_to_outside(&self) -> Vec<[f64; 6]> {
        let mut depths = vec![[0.0; 6]; self.extinctions.len()];
        let [nx, ny, nz] = self.cells;
        for (axis, step) in [1, nx, nx * ny].into_iter().enumerate() {
            let count = self.cells[axis];
            for first in 0..nx * ny * nz {
                if first / step % count != 0 {
                    continue;
                }
                let line = || (0..count).map(|at| first + at * step);
                let mut sum = 0.0;
                for cell in line() {
                    depths[cell][2 * axis] = sum;
                    sum += self.extinctions[cell] * self.edges[axis];
                }
                for cell in line() {
                    depths[cell][2 * axis + 1] =
                        (sum - depths[cell][2 * axis] - self.extinctions[cell] * self.edges[axis]).max(0.0);
                }
            }
        }
        depths
    }

    /// Returns the factor of a cover's density with which enough light from this material passes it, if the optical
    /// depths to the outside are those of the cover; 1 if enough passes already.
    fn factor_of_cover(&self, depths: &[[f64; 6]]) -> f64 {
        let edge = self.edges.iter().product::<f64>().cbrt();
        let passing = |factor: f64| {
            let mut sums = [0.0; 2];
            for (extinction, depths) in self.extinctions.iter().zip(depths).filter(|(e, _)| **e > 0.0) {
                let weight = -(-extinction * edge).exp_m1();
                sums[0] += weight * depths.iter().map(|depth| (-factor * depth).exp()).sum::<f64>() / 6.0;
                sums[1] += weight;
            }
            if sums[1] > 0.0 { sums[0] / sums[1] } else { 1.0 }
        };
        if passing(1.0) >= PASSING_SHARE {
            return 1.0;
        }
        let (mut low, mut high) = (MIN_FACTOR.ln(), 0.0);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            if passing(middle.exp()) < PASSING_SHARE { high = middle } else { low = middle }
        }
        low.exp()
    }
}

fn extinction(table: &BakedTransfer, density: f32) -> f64 {
    let [.., extinction] = table.sample(f64::from(density));
    extinction
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::first_look::first_settings;
    use chiaroscuro_volume::{Samples, Volume};
    use glam::DVec3;

    const EDGE: usize = 24;

    fn shells(from: f64, to: f64) -> Volume {
        let value = |at: usize| {
            let place = DVec3::new((at % EDGE) as f64, (at / EDGE % EDGE) as f64, (at / EDGE / EDGE) as f64);
            let radius = place.distance(DVec3::splat(11.5));
            if (from..to).contains(&radius) { 200 } else { 0 }
        };
        let values = (0..EDGE.pow(3)).map(value).collect();
        Volume::with_spacing("v", [EDGE; 3], DVec3::ONE, Samples::U8(values)).unwrap()
    }

    fn unit(settings: &Settings, index: usize) -> f64 {
        settings.layer_at(index).opacity_unit.number()
    }

    #[test]
    fn a_shell_is_thinned_until_half_of_the_light_passes_and_its_core_is_not() {
        let core = Dataset::new(shells(0.0, 4.0));
        let mut settings = first_settings(core.volume(), core.histogram());
        let dataset = core.with_field(&shells(7.0, 9.0), "shell").unwrap();
        settings.layers.push(settings.layer().clone());
        let before = settings.clone();
        thin_covering_layers(&mut settings, &dataset);
        assert_eq!(settings.layer(), before.layer());
        assert!(unit(&settings, 1) > 1.5 * unit(&before, 1));
        let scene = dataset.volume().scene();
        let [core, shell] =
            [0, 1].map(|at| ExtinctionCells::new(settings.layer_at(at), &dataset.fields()[at], &scene));
        assert!((core.factor_of_cover(&shell.depths_to_outside()) - 1.0).abs() < 0.01);
        // Apart, nothing covers.
        let mut apart = before.clone();
        let dataset = Dataset::new(shells(0.0, 4.0)).with_field(&shells(30.0, 40.0), "empty").unwrap();
        thin_covering_layers(&mut apart, &dataset);
        assert_eq!(apart, before);
    }
}
