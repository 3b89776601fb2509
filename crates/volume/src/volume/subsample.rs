//! Subsampling of a volume with a stride, and extraction of a portion of a file's grid.

use glam::{DAffine3, DMat3, DVec3};

use super::{Samples, Volume, VolumeError};
use crate::load_context::ResolvedPortion;
use crate::values::samples::with_samples;

impl Volume {
    /// Keeps the first voxel along each axis and every `step`-th one after it; voxels keep their positions in world
    /// space. Takes no extra memory unless the voxels are shared.
    ///
    /// # Errors
    /// Fails if none of the kept voxels is finite.
    pub fn subsampled(self, step: [usize; 3]) -> Result<Self, VolumeError> {
        let dims = self.dims();
        let step = [0, 1, 2].map(|axis| step[axis].clamp(1, dims[axis]));
        if step == [1; 3] {
            return Ok(self);
        }
        let found = [0, 1, 2].map(|axis| dims[axis].div_ceil(step[axis]));
        let mut whole = self;
        let mut samples = whole.voxels.take_samples();
        compact_stride(&mut samples, dims, step);
        let world_from_index = whole.world_from_index() * stride_transform(step);
        let thinned = Self::new(whole.name(), found, world_from_index, samples)?;
        let thinned = match whole.padding_value() {
            Some(padding) => thinned.clone().with_padding(padding).unwrap_or(thinned),
            None => thinned,
        };
        let thinned = thinned.with_metadata_of(&whole);
        Ok(Self { grid: thinned.grid.with_blocks_of(&whole.grid, step, DVec3::ZERO), ..thinned })
    }

    /// Extracts the wanted portion of a grid from a volume that holds the portion that was read: the whole grid, its
    /// box, or the wanted portion itself.
    ///
    /// # Errors
    /// Fails like [`Volume::new`].
    pub fn extract_portion(
        self,
        read: &ResolvedPortion,
        wanted: &ResolvedPortion,
    ) -> Result<Self, VolumeError> {
        if read == wanted {
            return Ok(self);
        }
        let within = [0, 1, 2].map(|axis| {
            let first = wanted.low[axis] - read.low[axis];
            first..first + wanted.high[axis] - wanted.low[axis]
        });
        let boxed = if read.full_box() == wanted.full_box() { self } else { self.cropped(&within)? };
        if wanted.is_averaged { boxed.block_averaged(wanted.stride) } else { boxed.subsampled(wanted.stride) }
    }
}

impl ResolvedPortion {
    /// Returns the transform from indices of kept voxels to world space, computed in the order of [`Volume::cropped`]
    /// and [`Volume::block_averaged`], so that the results are bit-identical.
    pub fn world_from_kept(&self, world_from_index: DAffine3) -> DAffine3 {
        if self.is_whole_grid() {
            return world_from_index;
        }
        let low = DVec3::from(self.low.map(|n| n as f64));
        let of_box = if self.full_box().is_whole_grid() {
            world_from_index
        } else {
            world_from_index * DAffine3::from_translation(low)
        };
        if self.stride == [1; 3] {
            return of_box;
        }
        let mut index_from_kept = stride_transform(self.stride);
        if self.is_averaged {
            index_from_kept.translation = 0.5 * (DVec3::from(self.stride.map(|n| n as f64)) - 1.0);
        }
        of_box * index_from_kept
    }
}

/// Returns the transform from indices after subsampling to indices before it.
fn stride_transform(step: [usize; 3]) -> DAffine3 {
    DAffine3::from_mat3(DMat3::from_diagonal(DVec3::from(step.map(|n| n as f64))))
}

/// Compacts the voxels at a stride to the front, and frees the rest.
fn compact_stride(samples: &mut Samples, [nx, ny, nz]: [usize; 3], [sx, sy, sz]: [usize; 3]) {
    with_samples!(samples, values => {
        // Values are moved towards the front in ascending order, so that none is overwritten before it is moved.
        let mut to = 0;
        for z in (0..nz).step_by(sz) {
            for y in (0..ny).step_by(sy) {
                let row = (z * ny + y) * nx;
                for x in (row..row + nx).step_by(sx) {
                    values[to] = values[x];
                    to += 1;
                }
            }
        }
        values.truncate(to);
        values.shrink_to_fit();
    });
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::load_context::Portion;

    fn volume() -> Volume {
        let values = (0..5 * 4 * 3).map(|value| value as u8).collect();
        Volume::with_spacing("t", [5, 4, 3], DVec3::new(1.0, 2.0, 3.0), Samples::U8(values)).unwrap()
    }

    #[test]
    fn every_second_voxel_stays_where_it_was() {
        let half = volume().subsampled([2, 2, 2]).unwrap();
        assert_eq!((half.dims(), half.file_dims()), ([3, 2, 2], [5, 4, 3]));
        let kept = [0, 2, 4, 10, 12, 14, 40, 42, 44, 50, 52, 54];
        assert_eq!(half.samples(), &Samples::U8(kept.to_vec()));
        assert_eq!(half.spacing_mm(), DVec3::new(2.0, 4.0, 6.0));
        let place = |volume: &Volume, index| volume.world_from_index().transform_point3(index);
        assert_eq!(place(&half, DVec3::ONE), place(&volume(), DVec3::splat(2.0)));
        assert_eq!(volume().subsampled([1; 3]).unwrap().content_id(), volume().content_id());
        let slice = volume().subsampled([2, 2, 9]).unwrap();
        assert_eq!((slice.dims(), slice.spacing_mm().z), ([3, 2, 1], 9.0), "no step is longer than the axis");
    }

    #[test]
    fn corrections_of_thinned_voxels_are_those_of_the_files() {
        use crate::{Corrections, Flips};
        let by = Corrections { flip: Flips { x: true, ..Flips::default() }, ..Corrections::default() };
        let first = volume().corrected(&by).unwrap().subsampled([2; 3]).unwrap();
        let last = volume().subsampled([2; 3]).unwrap().corrected(&by).unwrap();
        assert!(first.world_from_index().abs_diff_eq(last.world_from_index(), 1e-9));
    }

    #[test]
    fn a_portion_of_what_was_read_lies_where_it_would_be_read() {
        let region = "1:5,0:4,1:".parse().ok();
        for thinning in [Portion::default(), Portion::with_stride(2), Portion::with_block_average(2)]
            .map(|it| it.thinning)
        {
            let wanted = ResolvedPortion::resolve(&Portion { region, thinning }, [5, 4, 3], false).unwrap();
            let part = volume().extract_portion(&ResolvedPortion::whole_grid([5, 4, 3]), &wanted).unwrap();
            assert_eq!((part.dims(), part.file_dims()), (wanted.dims(), wanted.box_dims()));
            assert_eq!(
                part.world_from_index(),
                wanted.world_from_kept(volume().world_from_index()),
                "{thinning:?}"
            );
        }
    }
}
