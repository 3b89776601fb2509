//! Values of one quantity at the voxels of a grid, with metadata and statistics, but without the grid.

use std::sync::Arc;

use super::corrections::PatientTable;
use super::density_mapping::DensityMapping;
use super::error::VolumeError;
use super::missing::MissingVoxels;
use super::voxel_statistics::VoxelStatistics;
use crate::values::robust::quantile;
use crate::{Samples, ValueMetadata, ValueRanges, VoxelMask};

/// Values of one scalar field, one per voxel of a grid, x fastest, in data units. At least one of them is finite and
/// present. Clones share the samples.
#[derive(Debug, Clone)]
pub(super) struct VoxelData {
    samples: Arc<Samples>,
    /// Value of missing voxels, besides those that are not finite.
    padding_value: Option<f64>,
    /// Table under a body, whose voxels count as missing.
    table: Option<Arc<PatientTable>>,
    /// Mask that hides voxels of the picture.
    pub(super) mask: Option<Arc<VoxelMask>>,
    /// Metadata of the values, as the file states it.
    metadata: ValueMetadata,
    /// Length in mm to which opacities refer, if the values have one.
    pub(super) opacity_unit_mm: Option<f64>,
    /// Quantity that densities represent.
    pub(super) density_mapping: DensityMapping,
    /// Facts that follow from samples, padding value, metadata and the dimensions of the grid.
    pub(super) statistics: VoxelStatistics,
}

impl VoxelData {
    /// Scans the samples of a grid, which other volumes may share; densities represent their robust range.
    ///
    /// # Errors
    /// Fails if no value is finite, or the span of the values exceeds the range of numbers.
    pub(super) fn new(samples: Arc<Samples>, dims: [usize; 3]) -> Result<Self, VolumeError> {
        let statistics = VoxelStatistics::from_samples(&samples, dims, None)?;
        Ok(Self {
            samples,
            padding_value: None,
            table: None,
            mask: None,
            metadata: ValueMetadata::default(),
            opacity_unit_mm: None,
            density_mapping: DensityMapping::Range(statistics.ranges.robust),
            statistics,
        })
    }

    /// Rounds a value to the nearest float where the samples are 32-bit floats.
    pub(super) fn as_stored(&self, value: f64) -> f64 {
        match &*self.samples {
            Samples::F32(_) => f64::from(value as f32),
            _ => value,
        }
    }

    /// Sets the padding value, which is [as stored](Self::as_stored).
    pub(super) fn with_padding(self, dims: [usize; 3], padding_value: f64) -> Result<Self, VolumeError> {
        let statistics = VoxelStatistics::from_samples(&self.samples, dims, Some(padding_value))?;
        Ok(Self {
            padding_value: Some(padding_value),
            table: None,
            density_mapping: DensityMapping::Range(statistics.ranges.robust),
            statistics,
            ..self
        })
    }

    /// Hides a table: its voxels count as missing.
    ///
    /// # Errors
    /// Fails if no voxel is left.
    pub(super) fn without_table(
        self,
        dims: [usize; 3],
        table: Arc<PatientTable>,
    ) -> Result<Self, VolumeError> {
        let statistics = self.statistics.without_table(&self.samples, dims, self.padding_value, &table)?;
        Ok(Self { table: Some(table), statistics, ..self })
    }

    /// Returns the table that is hidden, if there is one.
    pub(super) fn table(&self) -> Option<&PatientTable> {
        self.table.as_deref()
    }

    /// Sets the metadata of the values.
    pub(super) fn with_metadata(self, metadata: ValueMetadata) -> Self {
        Self { metadata, statistics: self.statistics.without_kind(), ..self }
    }

    /// Copies the metadata of the values of which these are a part or means.
    pub(super) fn with_metadata_of(self, whole: &Self) -> Self {
        Self {
            metadata: whole.metadata.clone(),
            opacity_unit_mm: whole.opacity_unit_mm,
            statistics: self.statistics.with_kind_of(&whole.statistics),
            ..self
        }
    }

    /// Takes the kind of data and the ranges of other values, of which these are another time step.
    pub(super) fn with_look_of(self, shown: &Self) -> Self {
        let VoxelStatistics { ranges, kind, .. } = shown.statistics.clone();
        Self { statistics: VoxelStatistics { ranges, kind, ..self.statistics }, ..self }
    }

    /// Takes the samples out, without a copy unless other volumes share them.
    pub(super) fn take_samples(&mut self) -> Samples {
        Arc::unwrap_or_clone(std::mem::replace(&mut self.samples, Arc::new(Samples::U8(Vec::new()))))
    }

    /// Returns the stored values.
    pub(super) fn samples(&self) -> &Samples {
        &self.samples
    }

    /// Returns the stored values for sharing with another volume.
    pub(super) fn shared_samples(&self) -> Arc<Samples> {
        Arc::clone(&self.samples)
    }

    /// Returns true if both have the same samples in memory and treat the same ones as missing.
    pub(super) fn shares_samples(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.samples, &other.samples)
            && self.padding_value == other.padding_value
            && self.table == other.table
    }

    /// Returns the value of missing voxels, besides those that are not finite.
    pub(super) fn padding_value(&self) -> Option<f64> {
        self.padding_value
    }

    /// Returns the metadata of the values, as the file states it.
    pub(super) fn metadata(&self) -> &ValueMetadata {
        &self.metadata
    }

    /// Returns the length in mm to which opacities refer, so that the material looks the same at every resolution.
    pub(super) fn opacity_unit_mm(&self) -> Option<f64> {
        self.opacity_unit_mm
    }

    /// Returns the quantity that densities represent.
    pub(super) fn density_mapping(&self) -> DensityMapping {
        self.density_mapping
    }

    /// Returns the range of all values and the robust range.
    pub(super) fn ranges(&self) -> ValueRanges {
        self.statistics.ranges
    }

    /// Returns the value below which about this share of the voxels lies.
    pub(super) fn quantile(&self, share: f64) -> f64 {
        quantile(&self.samples, self.padding_value.unwrap_or(f64::NAN), share)
    }

    /// Returns the missing voxels, if there are any.
    pub(super) fn missing(&self) -> Option<&MissingVoxels> {
        self.statistics.missing.as_deref()
    }

    /// Returns the number of voxels that hold NaN or an infinity, and so are missing.
    pub(super) fn non_finite_voxels(&self) -> usize {
        self.statistics.non_finite_voxels
    }
}
