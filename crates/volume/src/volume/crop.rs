//! Cropping of a volume to a region of its voxels.

use std::ops::Range;

use glam::{DAffine3, DVec3};

use super::{Samples, Volume, VolumeError};
use crate::values::samples::with_samples;

impl Volume {
    /// Crops the volume to a region, given as half-open ranges along x, y and z; voxels keep their positions in world
    /// space. Takes no extra memory unless the voxels are shared.
    ///
    /// # Errors
    /// Fails if the region is empty or reaches beyond the grid, or none of its voxels is finite.
    pub fn cropped(self, region: &[Range<usize>; 3]) -> Result<Self, VolumeError> {
        let dims = self.dims();
        if region.iter().zip(dims).any(|(range, count)| range.is_empty() || range.end > count) {
            return Err(VolumeError::Outside { dims });
        }
        let first = DVec3::from(region.clone().map(|range| range.start as f64));
        let world_from_index = self.world_from_index() * DAffine3::from_translation(first);
        let found = region.clone().map(|range| range.len());
        let mut whole = self;
        let mut samples = whole.voxels.take_samples();
        compact_box(&mut samples, dims, region);
        let cropped = Self::new(whole.name(), found, world_from_index, samples)?;
        // A region that consists only of padding is shown as it is.
        let cropped = match whole.padding_value() {
            Some(padding) => cropped.clone().with_padding(padding).unwrap_or(cropped),
            None => cropped,
        };
        let cropped = cropped.with_metadata_of(&whole);
        Ok(Self { grid: cropped.grid.with_file_dims(found), ..cropped })
    }
}

/// Compacts the values of a box of a grid to the front, and frees the rest.
fn compact_box(samples: &mut Samples, [nx, ny, _]: [usize; 3], [xs, ys, zs]: &[Range<usize>; 3]) {
    with_samples!(samples, values => {
        // Rows are moved towards the front in ascending order, so that no value is overwritten before it is moved.
        let mut to = 0;
        for z in zs.clone() {
            for y in ys.clone() {
                let row = (z * ny + y) * nx;
                values.copy_within(row + xs.start..row + xs.end, to);
                to += xs.len();
            }
        }
        values.truncate(to);
        values.shrink_to_fit();
    });
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{ValueMetadata, ValueRange};

    #[test]
    fn a_box_stays_where_it_was() {
        let values = (0..4 * 3 * 2).map(|value| value as i16).collect();
        let mut hints = ValueMetadata::default();
        hints.set_unit("HU");
        let volume = Volume::with_spacing("t", [4, 3, 2], DVec3::new(1.0, 2.0, 3.0), Samples::I16(values));
        let volume = volume.unwrap().with_metadata(hints).with_padding(7.0).unwrap();
        let part = volume.clone().cropped(&[1..4, 1..3, 1..2]).unwrap();
        assert_eq!((part.dims(), part.file_dims()), ([3, 2, 1], [3, 2, 1]));
        assert_eq!(part.samples(), &Samples::I16(vec![17, 18, 19, 21, 22, 23]));
        let place = |volume: &Volume, index| volume.world_from_index().transform_point3(index);
        assert_eq!(place(&part, DVec3::ZERO), place(&volume, DVec3::ONE));
        assert_eq!((part.metadata().unit(), part.padding_value()), (Some("HU"), Some(7.0)));
        let all = volume.clone().cropped(&[0..4, 0..3, 0..2]).unwrap();
        assert_eq!(all.content_id(), volume.content_id());
        let padding = volume.clone().cropped(&[3..4, 1..2, 0..1]).unwrap();
        assert_eq!(padding.value_range(), ValueRange::new(7.0, 7.0), "of padding alone");
        for region in [[0..0, 0..3, 0..2], [0..5, 0..3, 0..2], [0..4, 0..3, 2..3]] {
            assert!(matches!(volume.clone().cropped(&region), Err(VolumeError::Outside { .. })));
        }
    }
}
