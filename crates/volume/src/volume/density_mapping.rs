//! Mapping from voxel values or labels to densities.

use super::{LabelSet, Volume};
use crate::values::samples::with_samples;
use crate::{ValueRange, ValueRanges};

/// Quantity that densities from 0 to 1 represent.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum DensityMapping {
    /// Values of a range; values outside are clamped to it.
    Range(ValueRange),
    /// Classes of labels ([`LabelSet`]). If the values are no labels, the robust range is shown.
    Labels,
}

impl Volume {
    /// Returns a volume with the same voxels whose densities represent another quantity.
    #[must_use]
    pub fn with_density_mapping(&self, shown: impl Into<DensityMapping>) -> Self {
        let shown = shown.into();
        if shown == DensityMapping::Labels {
            // Counted here, so that all clones share the result.
            self.labels();
        }
        let mut volume = self.clone();
        volume.voxels.density_mapping = shown;
        volume
    }

    /// Returns a time step of the object that another volume shows, which looks as that one does: with the kind of data, the
    /// ranges of values and the quantity that densities represent there, whatever its own values are.
    #[must_use]
    pub(crate) fn with_look_of(mut self, shown: &Self) -> Self {
        self.voxels = self.voxels.with_look_of(&shown.voxels);
        self.with_density_mapping(shown.density_mapping())
    }

    /// Returns a volume with the same voxels that counts as having other ranges of values, as those of all time steps.
    #[must_use]
    pub fn with_ranges(mut self, ranges: ValueRanges) -> Self {
        self.voxels.statistics.ranges = ranges;
        self
    }

    /// Returns the quantity that densities represent: the robust range, unless changed by
    /// [`Self::with_density_mapping`].
    pub fn density_mapping(&self) -> DensityMapping {
        self.voxels.density_mapping()
    }

    /// Returns the labels whose classes densities represent; `None` if densities represent values.
    pub fn shown_labels(&self) -> Option<&LabelSet> {
        if self.density_mapping() == DensityMapping::Labels { self.labels() } else { None }
    }

    /// Returns the range of values with densities from 0 to 1, in data units; for labels the range of all values.
    pub fn shown_range(&self) -> ValueRange {
        match self.density_mapping() {
            DensityMapping::Range(range) => range,
            DensityMapping::Labels if self.labels().is_some() => self.ranges().all,
            DensityMapping::Labels => self.ranges().robust,
        }
    }

    /// Returns the domain of tables over densities: the shown values, or the class indices of labels.
    pub fn table_range(&self) -> ValueRange {
        self.shown_labels().map_or_else(|| self.shown_range(), LabelSet::class_range)
    }

    /// Converts a value in data units to a density in [0, 1]: 0 at the lowest shown value and below, 1 at the highest
    /// and above; for labels the density of their class. Values that are not finite have density 0.
    pub fn density_of(&self, value: f64) -> f64 {
        if let Some(labels) = self.shown_labels() {
            return labels.density_of(value);
        }
        relative_position(self.shown_range(), value)
    }

    /// Converts a density to a value, inverse to [`Self::density_of`] for shown values; for labels, to the first of a
    /// class.
    pub fn value_of(&self, density: f64) -> f64 {
        match self.shown_labels() {
            Some(labels) => labels.number_at(density) as f64,
            None => self.shown_range().value_at(density),
        }
    }

    /// Returns the densities in [0, 1] of the voxels of one z-slice, x fastest. Missing voxels get the mean of nearby
    /// ones; among labels, which have no mean, the density of a neighbour, or 0 if all neighbours are missing.
    #[expect(
        trivial_numeric_casts,
        clippy::unnecessary_cast,
        reason = "one of the eight types is f64 already"
    )]
    pub fn slice_densities(&self, z: usize) -> Vec<f32> {
        let [nx, ny, _] = self.dims();
        let count = nx * ny;
        let range = z * count..(z + 1) * count;
        if let Some(labels) = self.shown_labels() {
            return self.slice_classes(z, labels);
        }
        let shown = self.shown_range();
        let mut densities: Vec<f32> = with_samples!(self.samples(), values => values[range]
            .iter()
            .map(|&value| relative_position(shown, value as f64) as f32)
            .collect());
        for (at, value) in self.missing().iter().flat_map(|missing| missing.substitutes_in_slice(z)) {
            densities[at] = relative_position(shown, value) as f32;
        }
        densities
    }

    /// Computes [`Self::slice_densities`] for labels.
    fn slice_classes(&self, z: usize, labels: &LabelSet) -> Vec<f32> {
        let [nx, ny, nz] = self.dims();
        // The last result is reused, as neighbours are mostly equal.
        let mut last = (f64::NAN, 0.0);
        let mut density = |value: f64| {
            if value != last.0 {
                last = (value, labels.density_of(value) as f32);
            }
            last.1
        };
        let first = z * nx * ny;
        let mut densities: Vec<f32> =
            (first..first + nx * ny).map(|voxel| density(self.samples().value(voxel))).collect();
        let Some(missing) = self.missing() else { return densities };
        // Sorted by distance: faces, edges, corners.
        let mut beside: Vec<[isize; 3]> =
            (0..27).map(|at: isize| [at % 3 - 1, at / 3 % 3 - 1, at / 9 - 1]).collect();
        beside.sort_by_key(|offset| offset.map(isize::abs).iter().sum::<isize>());
        for at in (0..nx * ny).filter(|at| missing.contains(first + at)) {
            let place = [at % nx, at / nx, z];
            let neighbour = |offset: &[isize; 3]| {
                let [x, y, z] = [0, 1, 2].map(|axis| place[axis].checked_add_signed(offset[axis]));
                let (x, y, z) = (x.filter(|&x| x < nx)?, y.filter(|&y| y < ny)?, z.filter(|&z| z < nz)?);
                Some(x + nx * (y + ny * z)).filter(|&voxel| !missing.contains(voxel))
            };
            let near = beside.iter().find_map(neighbour);
            densities[at] = near.map_or(0.0, |voxel| density(self.samples().value(voxel)));
        }
        densities
    }
}

impl From<ValueRange> for DensityMapping {
    fn from(range: ValueRange) -> Self {
        Self::Range(range)
    }
}

/// Returns the relative position of a value in a range, as a density.
fn relative_position(range: ValueRange, value: f64) -> f64 {
    let span = range.span();
    if value.is_finite() && span > 0.0 { ((value - range.low) / span).clamp(0.0, 1.0) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Samples;
    use glam::DVec3;

    fn volume(values: Vec<i16>) -> Volume {
        Volume::with_spacing("t", [values.len(), 1, 1], DVec3::ONE, Samples::I16(values)).unwrap()
    }

    #[test]
    fn labels_have_densities_by_rank() {
        let labels = volume(vec![0, 40, 3, 3, 900]).with_density_mapping(DensityMapping::Labels);
        assert_eq!(labels.slice_densities(0), [0.0, 2.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0, 1.0]);
        assert_eq!((labels.density_of(40.0), labels.value_of(0.7)), (2.0 / 3.0, 40.0));
        assert_eq!(labels.table_range(), ValueRange::new(0.0, 3.0));
        assert_eq!(labels.shown_range(), labels.value_range());
        // The file's values are unchanged.
        assert_eq!((labels.value(1, 0, 0), labels.id()), (40.0, volume(vec![0, 40, 3, 3, 900]).id()));
        let values = labels.with_density_mapping(labels.value_range());
        assert_eq!(values.slice_densities(0)[4], 1.0);
        assert!((values.density_of(40.0) - 40.0 / 900.0).abs() < 1e-12 && values.shown_labels().is_none());
    }

    #[test]
    fn what_has_no_labels_shows_the_values_that_matter() {
        let samples = Samples::F32(vec![0.5, 1.5, 2.5]);
        let plain = Volume::with_spacing("t", [3, 1, 1], DVec3::ONE, samples).unwrap();
        let shown = plain.with_density_mapping(DensityMapping::Labels);
        assert_eq!((shown.slice_densities(0), shown.shown_labels()), (vec![0.0, 0.5, 1.0], None));
        assert_eq!(shown.table_range(), shown.ranges().robust);
    }

    #[test]
    fn among_labels_neighbours_stand_in_for_what_is_missing() {
        let padded = volume(vec![3, 255, 255, 255, 9, 9])
            .with_padding(255.0)
            .unwrap()
            .with_density_mapping(DensityMapping::Labels);
        // No label in between, although the mean of the two is one.
        assert_eq!(padded.slice_densities(0), [0.0, 0.0, 0.0, 1.0, 1.0, 1.0]);
    }
}
