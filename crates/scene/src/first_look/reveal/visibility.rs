//! Visibility histogram: the share of each density in what the camera sees. Each cell counts with the light that it
//! absorbs, attenuated by the cells in front of it (Correa & Ma 2011): the light volume of a headlight, in cells.

use glam::DAffine3;

use crate::{Camera, OpacityLength, TransferFunction};
use chiaroscuro_volume::Volume;

/// Largest number of cells along an axis.
const MAX_CELLS: usize = 64;

/// Number of bins of densities.
const BINS: usize = 256;

/// Volume averaged into cells of a few voxels.
pub(super) struct AveragedCells {
    dims: [usize; 3],
    /// Bin of each cell's mean density, x fastest; `None` where voxels are missing.
    bins: Vec<Option<u8>>,
    scene_from_index: DAffine3,
    /// Number of opacity units per scene unit.
    units_per_scene: f64,
    /// Value of each bin in data units.
    values: Vec<f64>,
}

impl AveragedCells {
    /// Averages a volume into cells; `opacity_unit` is the length to which opacities refer.
    pub(super) fn average(volume: &Volume, opacity_unit: OpacityLength) -> Option<Self> {
        let units_per_scene = 1.0 / opacity_unit.scene_units(&volume.scene()).max(1e-9);
        let range = volume.density_mapping();
        let averaged = volume
            .to_block_averaged(volume.dims().map(|n| n.div_ceil(MAX_CELLS)))
            .ok()?
            .with_density_mapping(range);
        let dims = averaged.dims();
        let bin = |at: usize| {
            let place = [at % dims[0], at / dims[0] % dims[1], at / dims[0] / dims[1]];
            averaged.density_at(place).map(|density| ((density * BINS as f64) as usize).min(BINS - 1) as u8)
        };
        let values = (0..BINS).map(|bin| averaged.value_of((bin as f64 + 0.5) / BINS as f64)).collect();
        Some(Self {
            dims,
            bins: (0..dims.iter().product()).map(bin).collect(),
            scene_from_index: averaged.scene().scene_from_index,
            units_per_scene,
            values,
        })
    }

    /// Returns the visibility of each density bin from a distant camera.
    pub(super) fn visibility_by_bin(&self, function: &TransferFunction, camera: &Camera) -> Vec<f64> {
        let index_from_scene = self.scene_from_index.matrix3.inverse();
        let view_direction = index_from_scene * -camera.scene_from_view().z_axis;
        // Slices perpendicular to the dominant axis of the view direction; the cell in front is looked up in the
        // previous slice.
        let axis =
            (0..3).max_by(|&a, &b| view_direction[a].abs().total_cmp(&view_direction[b].abs())).unwrap_or(2);
        let [u, v] = [(axis + 1) % 3, (axis + 2) % 3];
        let step = view_direction / view_direction[axis].abs().max(1e-9);
        let length = (self.scene_from_index.matrix3 * step).length() * self.units_per_scene;
        let transmittance: Vec<f64> = self
            .values
            .iter()
            .map(|&value| (1.0 - function.opacity_at(value)).max(0.0).powf(length))
            .collect();
        let [nu, nv] = [self.dims[u], self.dims[v]];
        let mut light = vec![1.0; nu * nv];
        let mut next = light.clone();
        let mut seen = vec![0.0; BINS];
        for slice in 0..self.dims[axis] {
            let at = if step[axis] > 0.0 { slice } else { self.dims[axis] - 1 - slice };
            for j in 0..nv {
                for i in 0..nu {
                    let incoming = if slice == 0 {
                        1.0
                    } else {
                        interpolate_light(&light, [nu, nv], [i as f64 - step[u], j as f64 - step[v]])
                    };
                    let mut place = [0; 3];
                    (place[axis], place[u], place[v]) = (at, i, j);
                    let cell = place[0] + self.dims[0] * (place[1] + self.dims[1] * place[2]);
                    let transmittance = self.bins[cell].map_or(1.0, |bin| {
                        let left = transmittance[usize::from(bin)];
                        seen[usize::from(bin)] += incoming * (1.0 - left);
                        left
                    });
                    next[j * nu + i] = incoming * transmittance;
                }
            }
            std::mem::swap(&mut light, &mut next);
        }
        seen
    }

    /// Returns the bin of a value.
    pub(super) fn value_bin(&self, value: f64) -> usize {
        self.values.partition_point(|&of_bin| of_bin < value)
    }
}

/// Interpolates light between the cells of a slice; 1 outside.
fn interpolate_light(light: &[f64], [nu, nv]: [usize; 2], [x, y]: [f64; 2]) -> f64 {
    let at = |i: f64, j: f64| {
        let is_inside = i >= 0.0 && j >= 0.0 && i < nu as f64 && j < nv as f64;
        if is_inside { light[j as usize * nu + i as usize] } else { 1.0 }
    };
    let (i, j) = (x.floor(), y.floor());
    let (s, t) = (x - i, y - j);
    (at(i, j) * (1.0 - s) + at(i + 1.0, j) * s) * (1.0 - t)
        + (at(i, j + 1.0) * (1.0 - s) + at(i + 1.0, j + 1.0) * s) * t
}
