//! Builders of a volume: each takes it and returns it with one fact set.

use std::sync::Arc;

use super::corrections::PatientTable;
use super::provenance::VolumeProvenance;
use super::{Volume, VolumeError};
use crate::load_context::{FileContents, ResolvedPortion};
use crate::{ValueMetadata, VoxelMask};

/// Difference of the content id of a volume whose table is hidden: the letters of "table".
const WITHOUT_TABLE: u64 = 0x0074_6162_6c65;

impl Volume {
    /// Sets the opacity unit in mm, so that the material looks the same at every resolution; built-in volumes have
    /// one.
    #[must_use]
    pub fn with_unit_mm(mut self, unit_mm: f64) -> Self {
        self.voxels.opacity_unit_mm = Some(unit_mm);
        self
    }

    /// Sets the metadata of the values.
    #[must_use]
    pub fn with_metadata(self, hints: ValueMetadata) -> Self {
        Self { voxels: self.voxels.with_metadata(hints), ..self }
    }

    /// Sets the padding value, as a file declares it. Voxels with this value are missing: they hold no material, and
    /// are excluded from the value range and from means. For 32-bit floats it is rounded to the nearest float, as
    /// files write decimals such as 0.1.
    ///
    /// # Errors
    /// Fails if no voxel has another value.
    pub fn with_padding(self, padding_value: f64) -> Result<Self, VolumeError> {
        let padding_value = self.voxels.as_stored(padding_value);
        let voxels = self.voxels.with_padding(self.grid.dims(), padding_value)?;
        // The padding value affects what is shown, like the values themselves.
        Ok(Self { voxels, content_id: self.content_id.rotate_left(9) ^ padding_value.to_bits(), ..self })
    }

    /// Hides the table under a body, whose voxels then count as missing; `threshold` is the value from which on voxels
    /// are material. Returns the volume as it is if there is no table.
    ///
    /// # Errors
    /// Fails if no voxel is left.
    pub fn without_table(self, threshold: f64) -> Result<Self, VolumeError> {
        match PatientTable::find(&self, threshold) {
            Some(table) => self.without_known_table(table),
            None => Ok(self),
        }
    }

    /// Hides a known table.
    pub(super) fn without_known_table(self, table: PatientTable) -> Result<Self, VolumeError> {
        let voxels = self.voxels.without_table(self.grid.dims(), Arc::new(table))?;
        // Hiding voxels changes the picture, as other values would.
        Ok(Self { voxels, content_id: self.content_id.rotate_left(13) ^ WITHOUT_TABLE, ..self })
    }

    /// Returns the table under a body that is hidden, if there is one.
    pub fn hidden_table(&self) -> Option<&PatientTable> {
        self.voxels.table()
    }

    /// Sets the mask, which has the dimensions of the grid.
    pub(crate) fn with_own_mask(mut self, mask: Option<Arc<VoxelMask>>) -> Self {
        self.voxels.mask = mask;
        self
    }

    /// Returns the mask that hides voxels, if there is one.
    pub fn mask(&self) -> Option<&Arc<VoxelMask>> {
        self.voxels.mask.as_ref()
    }

    /// Returns true if a table was to be hidden, and none was found.
    pub fn lacks_table(&self) -> bool {
        self.corrections().hidden_table.is_some() && self.hidden_table().is_none()
    }

    /// Sets whether world space is right-anterior-superior, as the file states of a body.
    #[must_use]
    pub fn with_anatomical_axes(self, is_anatomical: bool) -> Self {
        Self { grid: self.grid.with_anatomical_axes(is_anatomical), ..self }
    }

    /// Marks the size of voxels as unknown: lengths are then in voxels, not in millimetres.
    #[must_use]
    pub fn with_unknown_scale(self) -> Self {
        Self { grid: self.grid.with_unknown_scale(), ..self }
    }

    /// Sets the unit in which the file states lengths, given in mm; a length that is no known unit is ignored.
    #[must_use]
    pub fn with_length_unit(self, mm: f64) -> Self {
        Self { grid: self.grid.with_length_unit(mm), ..self }
    }

    /// Records the position of the voxels in the file's grid, of which only this portion was read.
    #[must_use]
    pub fn with_file_portion(self, read: &ResolvedPortion) -> Self {
        Self { grid: self.grid.with_file_portion(read), ..self }
    }

    /// Sets remarks for the user about how the file was read.
    #[must_use]
    pub fn with_remarks(self, remarks: Vec<String>) -> Self {
        self.with_changed_provenance(|provenance| provenance.remarks = remarks)
    }

    /// Takes the grid of another volume of the same dimensions, as it was opened; values stay as they are.
    #[must_use]
    pub(crate) fn with_opened_grid_of(self, other: &Self) -> Self {
        debug_assert_eq!(self.dims(), other.dims(), "one value for each voxel of the grid");
        Self { grid: other.as_opened().grid, correction: None, ..self }
    }

    /// Sets the inventory of the file.
    #[must_use]
    pub fn with_contents(self, held: FileContents) -> Self {
        self.with_changed_provenance(|provenance| provenance.contents = Arc::new(held))
    }

    /// Changes the provenance of this volume, without effect on others that share it.
    fn with_changed_provenance(mut self, change: impl FnOnce(&mut VolumeProvenance)) -> Self {
        change(Arc::make_mut(&mut self.provenance));
        self
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::{Corrections, Flips, Samples};

    #[test]
    fn changes_leave_the_volumes_that_share_a_provenance_alone() {
        let opened = Volume::with_spacing("t", [2, 2, 2], DVec3::ONE, Samples::U8((0..8).collect())).unwrap();
        let clone = opened.clone();
        assert!(Arc::ptr_eq(&clone.provenance, &opened.provenance));
        let told = clone.with_remarks(vec!["told".to_owned()]);
        assert_eq!((told.remarks().len(), opened.remarks().len()), (1, 0));
        let by = Corrections { flip: Flips { x: true, ..Flips::default() }, ..Corrections::default() };
        let corrected = told.corrected(&by).unwrap();
        assert_eq!((corrected.corrections(), told.corrections()), (&by, &Corrections::default()));
        // A part is a volume of its own, as if it had been opened.
        let part = corrected.cropped(&[0..1, 0..2, 0..2]).unwrap();
        assert_eq!((part.name(), part.remarks()), ("t", told.remarks()));
        assert!(part.corrections().is_none() && part.opened_id() == part.content_id());
    }
}
