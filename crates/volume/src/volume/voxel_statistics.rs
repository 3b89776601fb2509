//! Statistics of voxels' values: ranges, missing voxels, kind of data and labels.

use std::sync::{Arc, OnceLock};

use super::corrections::PatientTable;
use super::error::VolumeError;
use super::kind::{DataKind, DetectedKind};
use super::label_set::LabelSet;
use super::missing::MissingVoxels;
use crate::{FiniteRange, Samples, ValueRanges};

/// Facts that follow from samples, padding value, metadata and the dimensions of the grid: ranges and missing voxels at
/// once, kind and labels when they are first asked for.
///
/// They are one struct so that none can remain from other values: a new padding value replaces them all, and new
/// metadata the kind, the only one that depends on them.
#[derive(Debug, Clone)]
pub(super) struct VoxelStatistics {
    /// Range of all values and robust range, without padding, in data units.
    pub(super) ranges: ValueRanges,
    /// Number of voxels that hold NaN or an infinity.
    pub(super) non_finite_voxels: usize,
    /// Voxels that are not finite or padding, if there are any.
    pub(super) missing: Option<Arc<MissingVoxels>>,
    /// Kind of data, detected on first use.
    pub(super) kind: OnceLock<DetectedKind>,
    /// Labels of the volume, counted on first use; `None` if values are no labels.
    pub(super) labels: OnceLock<Option<Arc<LabelSet>>>,
}

impl VoxelStatistics {
    /// Scans the samples of a grid; voxels with the padding value are missing.
    ///
    /// # Errors
    /// Fails if no value is finite and present, or the span of the values exceeds the range of numbers.
    pub(super) fn from_samples(
        samples: &Samples,
        dims: [usize; 3],
        padding: Option<f64>,
    ) -> Result<Self, VolumeError> {
        // No value equals NaN, so that none is left out.
        let excluded = padding.unwrap_or(f64::NAN);
        let FiniteRange { range: value_range, non_finite_voxels } =
            samples.finite_range_except(excluded).ok_or(VolumeError::NothingFinite)?;
        if !value_range.span().is_finite() {
            let range = format!("from {:e} to {:e}", value_range.low, value_range.high);
            return Err(VolumeError::TooWide { range });
        }
        let ranges = ValueRanges::from_samples_except(samples, value_range, excluded);
        let missing = if non_finite_voxels > 0 || padding.is_some() {
            find_missing(samples, dims, padding, |_| false)
        } else {
            None
        };
        Ok(Self { ranges, non_finite_voxels, missing, kind: OnceLock::new(), labels: OnceLock::new() })
    }

    /// Returns the statistics of the same voxels without a table, whose voxels count as missing. Ranges and kind stay
    /// those of the whole volume, so that its look stays, too.
    ///
    /// # Errors
    /// Fails if no voxel is left.
    pub(super) fn without_table(
        &self,
        samples: &Samples,
        dims: [usize; 3],
        padding: Option<f64>,
        table: &PatientTable,
    ) -> Result<Self, VolumeError> {
        let is_hidden =
            |at: usize| table.contains([at % dims[0], at / dims[0] % dims[1], at / (dims[0] * dims[1])]);
        let missing = find_missing(samples, dims, padding, is_hidden);
        if missing.as_ref().is_some_and(|missing| missing.count() == samples.len()) {
            return Err(VolumeError::NothingFinite);
        }
        Ok(Self { missing, labels: OnceLock::new(), ..self.clone() })
    }

    /// Forgets the kind, as metadata have changed.
    pub(super) fn without_kind(self) -> Self {
        Self { kind: OnceLock::new(), ..self }
    }

    /// Takes over the known kind of a volume whose blocks these voxels represent: a part of a label map is a label
    /// map, whatever its detection would say.
    pub(super) fn with_kind_of(self, whole: &Self) -> Self {
        let kind = match whole.kind.get() {
            Some(found) if matches!(found.kind, DataKind::LabelMap { .. }) => OnceLock::from(found.clone()),
            _ => OnceLock::new(),
        };
        Self { kind, ..self }
    }
}

/// Finds the voxels that are not finite, padding or hidden.
fn find_missing(
    samples: &Samples,
    dims: [usize; 3],
    padding: Option<f64>,
    is_hidden: impl Fn(usize) -> bool + Sync,
) -> Option<Arc<MissingVoxels>> {
    let is_present = |value: &f64| value.is_finite() && Some(*value) != padding;
    let value = |at: usize| Some(samples.value(at)).filter(is_present).filter(|_| !is_hidden(at));
    MissingVoxels::find(dims, value).map(Arc::new)
}
