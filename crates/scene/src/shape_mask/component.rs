//! Connected components of voxels around a seed, with the faint skin around them.

use super::is_visible;
use crate::{ComponentCut, Settings};
use chiaroscuro_volume::{ValueRange, Volume};
use glam::DVec3;
use rayon::prelude::*;

/// Distance in voxels within which the first voxel of a component is looked for around its seed.
const SEED_REACH: i64 = 3;

/// Number of layers of voxels around a component that belong to it: values fall off over the width of a kernel, and
/// what is left of them would be seen as a shell.
const SKIN_VOXELS: usize = 2;

/// Share of the opacity of the picked value down to which values belong to a component.
const MIN_OPACITY_SHARE: f64 = 0.5;

/// Number of steps in which the range of densities is searched for opaque values.
const DENSITY_STEPS: usize = 1024;

impl ComponentCut {
    /// Creates the cut of the part with a value at a point of the scene: of what is at least half as opaque, without a
    /// gap in between, by the curve of a look. For labels, of the label.
    pub fn from_picked(settings: &Settings, volume: &Volume, point: DVec3, value: f64) -> Self {
        let seed = point.into();
        let settings = settings.resolved_for(volume);
        let volume = volume.with_density_mapping(settings.shown_content(&volume.ranges()));
        if volume.shown_labels().is_some() {
            return Self { seed, values: ValueRange::new(value, value) };
        }
        let shown = volume.shown_range();
        let table = settings.bake_eye(shown, &volume.scene());
        let density = |step: usize| step as f64 / DENSITY_STEPS as f64;
        let picked = (volume.density_of(value) * DENSITY_STEPS as f64).round() as usize;
        let least = MIN_OPACITY_SHARE * table.sample(density(picked))[3];
        let is_opaque = |step: &usize| table.sample(density(*step))[3] >= least;
        let low = (0..=picked).rev().take_while(is_opaque).last().unwrap_or(picked);
        let high = (picked..=DENSITY_STEPS).take_while(is_opaque).last().unwrap_or(picked);
        // Values beyond the shown range have the opacity of its ends.
        let all = volume.ranges().all;
        let low = if low == 0 { all.low.min(shown.low) } else { shown.value_at(density(low)) };
        let high =
            if high == DENSITY_STEPS { all.high.max(shown.high) } else { shown.value_at(density(high)) };
        Self { seed, values: ValueRange::new(low, high) }
    }
}

/// Grid with the voxels that have values of a component.
struct Candidates<'a> {
    dims: [usize; 3],
    is_candidate: &'a [bool],
}

/// Returns for each voxel whether it belongs to a component or to the skin around it, among voxels that are visible so
/// far; `None` if there is no voxel with its values near the seed.
pub(super) fn component_with_skin(volume: &Volume, hidden: &[u8], cut: &ComponentCut) -> Option<Vec<bool>> {
    component_voxels(volume, hidden, cut, SKIN_VOXELS)
}

/// Returns for each voxel whether it belongs to a component, with so many layers of voxels around it.
pub(super) fn component_voxels(
    volume: &Volume,
    hidden: &[u8],
    cut: &ComponentCut,
    layers: usize,
) -> Option<Vec<bool>> {
    let ComponentCut { seed, values } = cut;
    let samples = volume.samples();
    let has_value = |voxel: usize| {
        let value = samples.value(voxel);
        value >= values.low && value <= values.high
    };
    let is_candidate: Vec<bool> = (0..hidden.len())
        .into_par_iter()
        .map(|voxel| has_value(voxel) && is_visible(volume, hidden, voxel))
        .collect();
    let candidates = Candidates { dims: volume.dims(), is_candidate: &is_candidate };
    let index = volume.scene().index_from_scene.transform_point3((*seed).into()).round();
    let first = candidates.nearest(index.to_array().map(|at| at as i64))?;
    let mut inside = candidates.connected(first);
    // The skin does not reach into other components.
    for _ in 0..layers {
        let grown = candidates.grown(&inside);
        inside = inside
            .par_iter()
            .zip(&is_candidate)
            .zip(grown)
            .map(|((&inside, &is_other), grown)| inside || grown && !is_other)
            .collect();
    }
    Some(inside)
}

impl Candidates<'_> {
    fn voxel(&self, place: [i64; 3]) -> Option<usize> {
        let is_inside = (0..3).all(|axis| (0..self.dims[axis] as i64).contains(&place[axis]));
        let [x, y, z] = place.map(|at| at.max(0) as usize);
        is_inside.then(|| x + self.dims[0] * (y + self.dims[1] * z))
    }

    /// Returns the candidate nearest to a place.
    fn nearest(&self, place: [i64; 3]) -> Option<usize> {
        let reach = -SEED_REACH..=SEED_REACH;
        let offsets = reach.clone().flat_map(|x| {
            let reach = reach.clone();
            reach.clone().flat_map(move |y| reach.clone().map(move |z| [x, y, z]))
        });
        let near = offsets.filter_map(|offset| {
            let voxel = self.voxel([0, 1, 2].map(|axis| place[axis] + offset[axis]))?;
            self.is_candidate[voxel].then(|| (offset.iter().map(|at| at * at).sum::<i64>(), voxel))
        });
        near.min().map(|(_, voxel)| voxel)
    }

    /// Returns the candidates that are connected through faces with one of them: runs along x are filled at once.
    fn connected(&self, first: usize) -> Vec<bool> {
        let [nx, ny, nz] = self.dims;
        let mut inside = vec![false; self.is_candidate.len()];
        let mut stack = vec![first];
        while let Some(voxel) = stack.pop() {
            if inside[voxel] {
                continue;
            }
            let row = voxel / nx * nx;
            let is_open = |inside: &[bool], at: usize| self.is_candidate[at] && !inside[at];
            let mut low = voxel;
            while low > row && is_open(&inside, low - 1) {
                low -= 1;
            }
            let mut end = voxel + 1;
            while end < row + nx && is_open(&inside, end) {
                end += 1;
            }
            inside[low..end].fill(true);
            let (y, z) = (row / nx % ny, row / nx / ny);
            let beside = [
                (y > 0).then(|| low.wrapping_sub(nx)),
                (y + 1 < ny).then(|| low + nx),
                (z > 0).then(|| low.wrapping_sub(nx * ny)),
                (z + 1 < nz).then(|| low + nx * ny),
            ];
            for start in beside.into_iter().flatten() {
                let mut was_open = false;
                for at in start..start + (end - low) {
                    let open = is_open(&inside, at);
                    if open && !was_open {
                        stack.push(at);
                    }
                    was_open = open;
                }
            }
        }
        inside
    }

    /// Returns the voxels of a set and those beside them, also across edges and corners.
    fn grown(&self, inside: &[bool]) -> Vec<bool> {
        let [nx, ny, nz] = self.dims;
        let mut grown = inside.to_vec();
        for (stride, count) in [(1, nx), (nx, ny), (nx * ny, nz)] {
            let beside = |at: usize| {
                let place = at / stride % count;
                grown[at] || place > 0 && grown[at - stride] || place + 1 < count && grown[at + stride]
            };
            grown = (0..grown.len()).into_par_iter().map(beside).collect();
        }
        grown
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{ControlPoint, LabelLook, LabelTable, TransferFunction};
    use chiaroscuro_volume::Samples;

    #[test]
    fn picked_parts_have_values_at_least_half_as_opaque() {
        let volume =
            Volume::with_spacing("t", [8; 3], DVec3::ONE, Samples::U8((0..512).map(|at| at as u8).collect()));
        let volume = volume.unwrap();
        let point = |value, opacity| ControlPoint::new(value, [1.0; 3], opacity);
        let points =
            vec![point(0.0, 0.0), point(50.0, 0.1), point(100.0, 0.1), point(120.0, 0.0), point(200.0, 0.8)];
        let settings = Settings::default().with_transfer(TransferFunction { points, ..Default::default() });
        let picked = |value: f64| {
            ComponentCut::from_picked(&settings, &volume, DVec3::new(0.1, 0.2, 0.3), value).values
        };
        let soft = picked(75.0);
        assert!(soft.low > 20.0 && soft.low < 40.0 && soft.high > 100.0 && soft.high < 120.0, "{soft:?}");
        let hard = picked(200.0);
        assert!(hard.low > 140.0 && hard.low < 190.0 && hard.high == 255.0, "{hard:?}");
        let labels: LabelTable = [(7, LabelLook::default_for(7))].into_iter().collect();
        let labelled = Settings::default().with_labels(labels);
        let cut = ComponentCut::from_picked(&labelled, &volume, DVec3::ZERO, 7.0);
        assert_eq!(cut.values, ValueRange::new(7.0, 7.0));
    }
}
