//! Resampling of a volume to the grid of another one, so that both can be shown together.

use glam::{DAffine3, DVec3};
use rayon::prelude::*;

use super::{Samples, Volume};

/// Largest difference, in voxels of the target, at which corners of two grids count as the same: a tenth of what is
/// seen of a shift.
const SAME_CORNER_VOXELS: f64 = 0.01;

/// Label of voxels outside the grid of a label map: that of the background.
const OUTSIDE_LABEL: i32 = 0;

impl Volume {
    /// Returns true if both volumes have the same number of voxels at the same places, or at places of which one file
    /// says nothing.
    pub fn has_grid_of(&self, other: &Self) -> bool {
        if self.dims() != other.dims() {
            return false;
        }
        // Without a scale, a grid of the same size is taken for the same grid.
        if self.has_unknown_scale() || other.has_unknown_scale() {
            return true;
        }
        let index_from_other = self.world_from_index().inverse() * other.world_from_index();
        let last = self.dims().map(|n| (n - 1) as f64);
        (0..8).all(|corner| {
            let at = DVec3::from([0, 1, 2].map(|axis| last[axis] * f64::from(corner >> axis & 1)));
            index_from_other.transform_point3(at).distance(at) <= SAME_CORNER_VOXELS
        })
    }

    /// Returns the volume on another one's grid, with the same corrections of positions, so that both move together:
    /// [resampled](Self::resampled_to) where its own grid is another. `None` if they do not meet.
    pub(crate) fn on_grid_of(&self, target: &Self) -> Option<Self> {
        let found = if self.has_grid_of(target) { self.clone() } else { self.resampled_to(target)? };
        found.with_opened_grid_of(target).corrected(&target.corrections().of_grid()).ok()
    }

    /// Returns the values at the voxels of another grid: interpolated linearly, or for labels those of the nearest
    /// voxel. Voxels outside this volume's grid are missing; of labels they have that of the background. `None` if all
    /// are outside.
    pub fn resampled_to(&self, target: &Self) -> Option<Self> {
        let index_from_target = self.world_from_index().inverse() * target.world_from_index();
        let samples = if self.is_label_map() {
            Samples::I32(self.nearest_labels(target.dims(), index_from_target)?)
        } else {
            Samples::F32(self.interpolated(target.dims(), index_from_target)?)
        };
        let resampled = Self::new(self.name(), target.dims(), target.world_from_index(), samples).ok()?;
        Some(resampled.with_metadata(self.metadata().clone()))
    }

    /// Returns the label at each voxel of a grid; `None` if it is nowhere inside this one.
    fn nearest_labels(&self, dims: [usize; 3], index_from_target: DAffine3) -> Option<Vec<i32>> {
        let label = |place: DVec3| {
            let voxel = self.voxel_inside(place.round())?;
            Some(self.samples().value(voxel) as i32)
        };
        let labels = at_voxels(dims, index_from_target, label);
        labels
            .par_iter()
            .any(Option::is_some)
            .then(|| labels.into_par_iter().map(|label| label.unwrap_or(OUTSIDE_LABEL)).collect())
    }

    /// Returns the interpolated value at each voxel of a grid, NaN outside this one; `None` if it is nowhere inside.
    fn interpolated(&self, dims: [usize; 3], index_from_target: DAffine3) -> Option<Vec<f32>> {
        let value = |place: DVec3| {
            // Values of the outermost voxels hold up to their faces.
            let inside = place.clamp(DVec3::ZERO, DVec3::from(self.dims().map(|n| (n - 1) as f64)));
            if place.distance(inside) > 0.5 + SAME_CORNER_VOXELS {
                return f32::NAN;
            }
            let low = inside.floor();
            let share = inside - low;
            let mut sum = 0.0;
            for corner in 0..8 {
                let side = DVec3::from([0, 1, 2].map(|axis| f64::from(corner >> axis & 1)));
                let weight = (DVec3::ONE - side - share).abs();
                let weight = weight.x * weight.y * weight.z;
                if weight == 0.0 {
                    continue;
                }
                let found = self.voxel_inside(low + side).map(|voxel| self.samples().value(voxel));
                sum += weight * found.unwrap_or(f64::NAN);
            }
            sum as f32
        };
        let values = at_voxels(dims, index_from_target, value);
        values.par_iter().any(|value| value.is_finite()).then_some(values)
    }

    /// Returns the index of the present voxel at integer coordinates; `None` outside the grid and where it is missing.
    fn voxel_inside(&self, place: DVec3) -> Option<usize> {
        let [nx, ny, nz] = self.dims();
        let is_inside =
            place.cmpge(DVec3::ZERO).all() && place.cmplt(DVec3::new(nx as f64, ny as f64, nz as f64)).all();
        let voxel = is_inside.then(|| place.x as usize + nx * (place.y as usize + ny * place.z as usize))?;
        (!self.missing().is_some_and(|missing| missing.contains(voxel))).then_some(voxel)
    }
}

/// Returns what `value` finds at the place of each voxel of a grid in another index space, x fastest.
fn at_voxels<T: Send>(
    [nx, ny, nz]: [usize; 3],
    index_from_target: DAffine3,
    value: impl Fn(DVec3) -> T + Sync,
) -> Vec<T> {
    let value = &value;
    let row = |at: usize| {
        let (y, z) = ((at % ny) as f64, (at / ny) as f64);
        (0..nx).map(move |x| value(index_from_target.transform_point3(DVec3::new(x as f64, y, z))))
    };
    (0..ny * nz).into_par_iter().flat_map_iter(row).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{AddFieldError, Dataset, MAX_FIELDS};
    use glam::DMat3;

    fn ramp(dims: [usize; 3], spacing: f64, origin: f64) -> Volume {
        let world_from_index = DAffine3 {
            matrix3: DMat3::from_diagonal(DVec3::splat(spacing)),
            translation: DVec3::splat(origin),
        };
        let value = |at: usize| {
            let place = [at % dims[0], at / dims[0] % dims[1], at / (dims[0] * dims[1])].map(|c| c as f64);
            let world = world_from_index.transform_point3(place.into());
            (world.x + 10.0 * world.y + 100.0 * world.z) as f32
        };
        let values = (0..dims.iter().product()).map(value).collect();
        Volume::new("ramp", dims, world_from_index, Samples::F32(values)).unwrap()
    }

    #[test]
    fn a_ramp_keeps_its_values_in_world_space() {
        let (coarse, fine) = (ramp([5, 6, 7], 2.0, 0.0), ramp([9, 8, 7], 1.0, 1.5));
        let found = coarse.resampled_to(&fine).unwrap();
        assert!(found.has_grid_of(&fine) && !coarse.has_grid_of(&fine));
        for (x, y, z) in [(0, 0, 0), (3, 4, 5), (6, 7, 6)] {
            assert!((found.value(x, y, z) - fine.value(x, y, z)).abs() < 1e-3, "{x} {y} {z}");
        }
        // The coarse grid ends at 8 mm along x, its faces at 9 mm; the last voxel lies at 9.5 mm.
        assert!(found.value(7, 0, 0).is_finite() && found.value(8, 0, 0).is_nan());
    }

    #[test]
    fn labels_are_not_mixed() {
        let numbers = (0..16_usize.pow(3)).map(|at| [0, 7, 200][(at % 16 / 4 + at / 1024) % 3]).collect();
        let labels = Volume::with_spacing("l", [16; 3], DVec3::splat(2.0), Samples::U8(numbers)).unwrap();
        assert!(labels.is_label_map());
        let found = labels.resampled_to(&ramp([34; 3], 1.0, -0.2)).unwrap();
        assert_eq!([0, 8, 16].map(|x| found.value(x, 0, 0)), [0.0, 7.0, 200.0]);
        for at in 0..found.voxel_count() {
            assert!([0.0, 7.0, 200.0].contains(&found.samples().value(at)));
        }
        assert_eq!(found.value(33, 8, 8), 0.0, "outside");
    }

    #[test]
    fn volumes_that_do_not_meet_and_too_many_are_refused() {
        let dataset = Dataset::new(ramp([5, 6, 7], 1.0, 0.0));
        let far = ramp([5, 6, 7], 1.0, 100.0);
        assert_eq!(dataset.with_field(&far, "far").unwrap_err(), AddFieldError::Apart);
        let mut several = dataset.clone();
        for _ in 1..MAX_FIELDS {
            several = several.with_field(&ramp([5, 6, 7], 1.0, 0.25), "near").unwrap();
        }
        let another = ramp([5, 6, 7], 1.0, 0.0);
        assert_eq!(several.with_field(&another, "another").unwrap_err(), AddFieldError::TooMany);
        assert_eq!(several.fields()[1].origin().unwrap().source, std::path::Path::new("near"));
        assert_eq!(dataset.id(), dataset.volume().id());
        assert_ne!(several.id(), dataset.id());
        assert_eq!(several.with_fields_where(|_| false).id(), dataset.id());
    }
}
