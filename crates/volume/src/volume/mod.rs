//! Scalar volume on a regular grid, with its transform to world space and its values in data units.

mod block_average;
mod corrections;
mod crop;
mod density_mapping;
mod error;
mod file_grid;
mod kind;
mod label_set;
mod missing;
mod subsample;

pub use block_average::BlockPartition;
pub use block_average::block_counts;
pub use corrections::{
    AnatomicalAxes, AxisOrder, Corrections, Flips, Orientation, PaddingValue, SpacingUnit, ValueScale,
};
pub use density_mapping::DensityMapping;
pub use error::VolumeError;
pub use kind::{DataKind, DetectedKind, KindName};
pub use label_set::{CountedLabel, LabelSet, MAX_CLASSES};
pub use missing::MissingVoxels;

use std::sync::{Arc, OnceLock};
use std::time::Duration;

use glam::{DAffine3, DMat3, DVec3};

use self::corrections::AppliedCorrections;
use self::file_grid::FileGridMapping;
use super::load_context::FileContents;
use super::values::robust::quantile;
use super::{Samples, ValueMetadata, ValueRange, ValueRanges};
use crate::math::SceneSpace;

/// Identity of a volume together with its value ranges.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VolumeId {
    /// Content hash, see [`Volume::content_id`].
    pub content_id: u64,
    /// Value ranges, see [`Volume::ranges`].
    pub ranges: ValueRanges,
    /// Dimensions in voxels, see [`Volume::dims`].
    pub dims: [usize; 3],
}

/// Scalar volume. Invariants: at least one voxel, an invertible affine transform, a finite value range. Clones share
/// the voxels.
#[derive(Debug, Clone)]
pub struct Volume {
    name: String,
    dims: [usize; 3],
    file_dims: [usize; 3],
    /// Position of the voxels in the grid of the file.
    file_grid: FileGridMapping,
    world_from_index: DAffine3,
    samples: Arc<Samples>,
    ranges: ValueRanges,
    density_mapping: DensityMapping,
    missing: Option<Arc<MissingVoxels>>,
    non_finite_voxels: usize,
    padding_value: Option<f64>,
    opacity_unit_mm: Option<f64>,
    is_anatomical: bool,
    hints: ValueMetadata,
    length_unit: SpacingUnit,
    remarks: Vec<String>,
    contents: Arc<FileContents>,
    analysis_time: Duration,
    /// Kind of data, detected on first use.
    kind: OnceLock<DetectedKind>,
    /// Labels of the volume, counted on first use.
    labels: OnceLock<Option<Arc<LabelSet>>>,
    content_id: u64,
    /// Corrections by the user and the opened volume, if there are any.
    corrected: Option<Arc<AppliedCorrections>>,
}

impl Volume {
    /// Creates a volume. `world_from_index` maps voxel indices (centres at integers) to millimetres.
    ///
    /// # Errors
    /// Fails if the count does not match `dims`, a dimension is zero, the transform is not finite and invertible, no
    /// value is finite, or the span of the values exceeds the range of numbers.
    pub fn new(
        name: impl Into<String>,
        dims: [usize; 3],
        world_from_index: DAffine3,
        samples: Samples,
    ) -> Result<Self, VolumeError> {
        Self::from_shared_samples(name.into(), dims, world_from_index, Arc::new(samples))
    }

    /// Creates a volume as [`Self::new`] does, from voxels that other volumes may share.
    fn from_shared_samples(
        name: String,
        dims: [usize; 3],
        world_from_index: DAffine3,
        samples: Arc<Samples>,
    ) -> Result<Self, VolumeError> {
        if dims.contains(&0) {
            return Err(VolumeError::Empty { dims });
        }
        let expected = dims.iter().try_fold(1usize, |product, &n| product.checked_mul(n));
        if expected != Some(samples.len()) {
            return Err(VolumeError::WrongCount { dims, found: samples.len() });
        }
        let matrix = world_from_index.matrix3;
        let lengths = DVec3::new(matrix.x_axis.length(), matrix.y_axis.length(), matrix.z_axis.length());
        // Relative to a box with the same edges: below a millionth it is flat, whatever the unit.
        let flatness = matrix.determinant().abs() / lengths.element_product();
        if !(world_from_index.is_finite() && lengths.min_element() > 0.0 && flatness > 1e-6) {
            return Err(VolumeError::BadGeometry { what: format!("axes {matrix:?}") });
        }
        let (value_range, non_finite_voxels) = samples.finite_range().ok_or(VolumeError::NothingFinite)?;
        if !value_range.span().is_finite() {
            let range = format!("from {:e} to {:e}", value_range.low, value_range.high);
            return Err(VolumeError::TooWide { range });
        }
        let ranges = ValueRanges::from_samples(&samples, value_range);
        let geometry =
            dims.iter().map(|&n| n as u64).chain(world_from_index.to_cols_array().map(f64::to_bits));
        let content_id = geometry.fold(samples.fingerprint(), |hash, word| {
            hash.rotate_left(17) ^ word.wrapping_mul(0x9e37_79b9_7f4a_7c15)
        });
        let volume = Self {
            name,
            dims,
            file_dims: dims,
            file_grid: FileGridMapping::default(),
            world_from_index,
            samples,
            ranges,
            density_mapping: DensityMapping::Range(ranges.robust),
            missing: None,
            non_finite_voxels,
            padding_value: None,
            opacity_unit_mm: None,
            is_anatomical: false,
            hints: ValueMetadata::default(),
            length_unit: SpacingUnit::Mm,
            remarks: Vec::new(),
            contents: Arc::default(),
            analysis_time: Duration::ZERO,
            kind: OnceLock::new(),
            labels: OnceLock::new(),
            content_id,
            corrected: None,
        };
        Ok(if non_finite_voxels > 0 { volume.with_missing() } else { volume })
    }

    /// Sets the opacity unit in mm, so that the material looks the same at every resolution; built-in volumes have
    /// one.
    #[must_use]
    pub fn with_unit_mm(self, unit_mm: f64) -> Self {
        Self { opacity_unit_mm: Some(unit_mm), ..self }
    }

    /// Returns the opacity unit in mm, see [`Self::with_unit_mm`].
    pub fn opacity_unit_mm(&self) -> Option<f64> {
        self.opacity_unit_mm
    }

    /// Sets whether world space is right-anterior-superior, as the file states of a body.
    #[must_use]
    pub fn with_anatomical_axes(self, is_anatomical: bool) -> Self {
        Self { is_anatomical, ..self }
    }

    /// Returns true if +x, +y and +z are known to be a body's right, anterior and superior directions.
    pub fn is_anatomical(&self) -> bool {
        self.is_anatomical
    }

    /// Sets the metadata of the values.
    #[must_use]
    pub fn with_metadata(self, hints: ValueMetadata) -> Self {
        Self { hints, kind: OnceLock::new(), ..self }
    }

    /// Returns the metadata of the values, as the file states it.
    pub fn metadata(&self) -> &ValueMetadata {
        &self.hints
    }

    /// Marks the size of voxels as unknown: lengths are then in voxels, not in millimetres.
    #[must_use]
    pub fn with_unknown_scale(self) -> Self {
        Self { length_unit: SpacingUnit::Voxels, ..self }
    }

    /// Returns true if lengths are in voxels because the voxels' size is unknown.
    pub fn has_unknown_scale(&self) -> bool {
        self.length_unit == SpacingUnit::Voxels
    }

    /// Sets remarks for the user about how the file was read.
    #[must_use]
    pub fn with_remarks(self, remarks: Vec<String>) -> Self {
        Self { remarks, ..self }
    }

    /// Returns remarks for the user about how the file was read: impossible statements in it, and the values used
    /// instead.
    pub fn remarks(&self) -> &[String] {
        &self.remarks
    }

    /// Sets the inventory of the file.
    #[must_use]
    pub fn with_contents(self, held: FileContents) -> Self {
        Self { contents: Arc::new(held), ..self }
    }

    /// Returns the inventory of the file: the other volumes that could be opened of it.
    pub fn contents(&self) -> &FileContents {
        &self.contents
    }

    /// Sets the time taken to analyse the voxels after reading.
    #[must_use]
    pub fn with_analysis_time(self, looking_took: Duration) -> Self {
        Self { analysis_time: looking_took, ..self }
    }

    /// Returns the time taken, when the file was read, for the voxels' ranges and hash: the part of loading that was
    /// neither reading nor decoding. Zero for volumes that come from no file.
    pub fn analysis_time(&self) -> Duration {
        self.analysis_time
    }

    /// Returns the kind of data; the first call detects it and blocks meanwhile.
    pub fn kind(&self) -> &DetectedKind {
        self.kind.get_or_init(|| DetectedKind::detect(self))
    }

    /// Returns true if values are labels, whose numbers have no mean.
    pub fn is_label_map(&self) -> bool {
        matches!(self.kind().kind, DataKind::LabelMap { .. })
    }

    /// Copies the metadata of the volume whose blocks this one's voxels represent.
    #[must_use]
    pub(super) fn with_metadata_of(self, whole: &Self) -> Self {
        Self {
            file_dims: whole.file_dims,
            opacity_unit_mm: whole.opacity_unit_mm,
            is_anatomical: whole.is_anatomical,
            hints: whole.hints.clone(),
            length_unit: whole.length_unit,
            remarks: whole.remarks.clone(),
            contents: Arc::clone(&whole.contents),
            kind: whole.inherited_kind(),
            ..self
        }
    }

    /// Creates an axis-aligned volume with `spacing_mm` between voxel centres along x, y, z.
    ///
    /// # Errors
    /// Fails like [`Self::new`].
    pub fn with_spacing(
        name: impl Into<String>,
        dims: [usize; 3],
        spacing_mm: DVec3,
        samples: Samples,
    ) -> Result<Self, VolumeError> {
        let affine = DAffine3 { matrix3: DMat3::from_diagonal(spacing_mm), translation: DVec3::ZERO };
        Self::new(name, dims, affine, samples)
    }

    /// Returns the name shown to the user: that of the file or the built-in volume.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Returns the number of voxels along x, y, z.
    pub fn dims(&self) -> [usize; 3] {
        self.dims
    }

    /// Returns the dimensions of the volume from which this one was made by block averages ([`Self::block_averaged`])
    /// or subsampling ([`Self::subsampled`]); [`Self::dims`] if it is neither.
    pub fn file_dims(&self) -> [usize; 3] {
        self.file_dims
    }

    /// Returns the total number of voxels.
    pub fn voxel_count(&self) -> usize {
        self.samples.len()
    }

    /// Returns the transform from voxel indices (centres at integers) to millimetres.
    pub fn world_from_index(&self) -> DAffine3 {
        self.world_from_index
    }

    /// Returns the distance in mm between voxel centres along the three index axes.
    pub fn spacing_mm(&self) -> DVec3 {
        let axes = self.world_from_index.matrix3;
        DVec3::new(axes.x_axis.length(), axes.y_axis.length(), axes.z_axis.length())
    }

    /// Returns the scene space of the grid.
    pub fn scene(&self) -> SceneSpace {
        SceneSpace::new(self.dims, self.world_from_index)
    }

    /// Returns the stored values.
    pub fn samples(&self) -> &Samples {
        &self.samples
    }

    /// Returns the range of finite values in the file, in data units.
    pub fn value_range(&self) -> ValueRange {
        self.ranges.all
    }

    /// Returns the range of all values and the robust range.
    pub fn ranges(&self) -> ValueRanges {
        self.ranges
    }

    /// Returns the value below which about this share of the voxels lies.
    pub fn quantile(&self, share: f64) -> f64 {
        quantile(&self.samples, self.padding_value.unwrap_or(f64::NAN), share)
    }

    /// Returns the number of voxels that hold NaN or an infinity, and so are missing.
    pub fn non_finite_voxels(&self) -> usize {
        self.non_finite_voxels
    }

    /// Returns a hash of values and geometry: equal volumes have equal ids.
    pub fn content_id(&self) -> u64 {
        self.content_id
    }

    /// Returns the identity by which pictures of the volume are cached.
    pub fn id(&self) -> VolumeId {
        VolumeId { content_id: self.content_id, ranges: self.ranges, dims: self.dims }
    }

    /// Returns the value of one voxel in data units, as stored in the file.
    pub fn value(&self, x: usize, y: usize, z: usize) -> f64 {
        self.samples.value(x + self.dims[0] * (y + self.dims[1] * z))
    }

    /// Returns the density of a voxel; `None` if it is missing.
    pub fn density_at(&self, [x, y, z]: [usize; 3]) -> Option<f64> {
        let voxel = x + self.dims[0] * (y + self.dims[1] * z);
        let is_missing = self.missing().is_some_and(|missing| missing.contains(voxel));
        (!is_missing).then(|| self.density_of(self.samples.value(voxel)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn density_spans_the_finite_range() {
        let samples = Samples::F32(vec![f32::NAN, -1000.0, 0.0, 1000.0]);
        let volume = Volume::with_spacing("t", [4, 1, 1], DVec3::ONE, samples).unwrap();
        assert_eq!(volume.value_range(), ValueRange::new(-1000.0, 1000.0));
        assert_eq!(volume.non_finite_voxels(), 1);
        // The missing voxel gets the mean of its neighbours.
        assert_eq!(volume.slice_densities(0), [0.0, 0.0, 0.5, 1.0]);
        assert!(volume.missing().is_some_and(|missing| missing.count() == 1 && missing.contains(0)));
        assert_eq!(volume.value_of(0.5), 0.0);
        assert_eq!([0, 1, 2].map(|x| volume.density_at([x, 0, 0])), [None, Some(0.0), Some(0.5)]);
    }

    #[test]
    fn what_is_not_a_volume_is_refused() {
        let make = |dims, spacing: DVec3, n| {
            Volume::with_spacing("t", dims, spacing, Samples::U8(vec![0; n])).map(|_| ())
        };
        assert!(matches!(make([0, 1, 1], DVec3::ONE, 0), Err(VolumeError::Empty { .. })));
        assert!(matches!(make([2, 2, 2], DVec3::ONE, 7), Err(VolumeError::WrongCount { .. })));
        assert!(matches!(
            make([2, 1, 1], DVec3::new(1.0, f64::NAN, 1.0), 2),
            Err(VolumeError::BadGeometry { .. })
        ));
        let nan = Volume::with_spacing("t", [1, 1, 1], DVec3::ONE, Samples::F64(vec![f64::NAN]));
        assert!(matches!(nan, Err(VolumeError::NothingFinite)));
        let far = Volume::with_spacing("t", [2, 1, 1], DVec3::ONE, Samples::F64(vec![-1.5e308, 1.5e308]));
        let said = far.map(|_| ()).unwrap_err().to_string();
        assert!(said.contains("from -1.5e308 to 1.5e308"), "{said}");
    }

    #[test]
    fn content_decides_the_identity() {
        let make = |v: Vec<u8>| Volume::with_spacing("t", [2, 2, 1], DVec3::ONE, Samples::U8(v)).unwrap();
        assert_eq!(make(vec![1, 2, 3, 4]).content_id(), make(vec![1, 2, 3, 4]).content_id());
        assert_ne!(make(vec![1, 2, 3, 4]).content_id(), make(vec![1, 2, 4, 3]).content_id());
    }
}
