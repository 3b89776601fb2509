//! Scalar volume on a regular grid, with its transform to world space and its values in data units.
//!
//! A [`Volume`] is composed of a `VoxelGrid`, the `VoxelData` at its voxels, and a `VolumeProvenance`. The grid
//! knows no values, the values know no positions, and neither knows the file. The methods of the volume combine them,
//! or hand on those of a part.

mod block_average;
mod builders;
mod corrections;
mod crop;
mod density_mapping;
mod error;
mod grid;
mod kind;
mod label_set;
mod missing;
mod provenance;
mod subsample;
mod voxel_data;
mod voxel_statistics;

pub use block_average::BlockPartition;
pub use block_average::block_counts;
pub use corrections::{
    AnatomicalAxes, AxisOrder, Corrections, Flips, Orientation, PaddingValue, PatientTable, SpacingUnit,
    ValueScale,
};
pub use density_mapping::DensityMapping;
pub use error::VolumeError;
pub use kind::{DataKind, DetectedKind, KindName};
pub use label_set::{CountedLabel, LabelSet, MAX_CLASSES};
pub use missing::MissingVoxels;

use std::sync::Arc;

use glam::{DAffine3, DMat3, DVec3};

use self::corrections::AppliedCorrections;
use self::grid::VoxelGrid;
use self::grid::face_voxels::face_voxels;
use self::provenance::VolumeProvenance;
use self::voxel_data::VoxelData;
use super::load_context::{FileContents, FileDimension, MAX_FIELDS};
use super::{Samples, ValueMetadata, ValueRange, ValueRanges};
use crate::math::SceneSpace;

/// Identity of the pages that a dataset has, by which pictures are cached; 0 where there are none.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct PagesId {
    /// Hash of the addresses of the pages.
    pub pages: u64,
    /// Hash of the addresses of the pages whose densities the bounds hold for.
    pub bounds: u64,
}

/// Identity of a volume together with its value ranges.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VolumeId {
    /// Content hash, see [`Volume::content_id`].
    pub content_id: u64,
    /// Value ranges, see [`Volume::ranges`].
    pub ranges: ValueRanges,
    /// Dimensions in voxels, see [`Volume::dims`].
    pub dims: [usize; 3],
    /// Value ranges of the further fields of a dataset.
    pub further_ranges: [Option<ValueRanges>; MAX_FIELDS - 1],
    /// Pages of finer levels that a dataset has.
    pub pages: PagesId,
}

/// Scalar volume. Invariants: at least one voxel, an invertible affine transform, a finite value range. Clones share
/// the voxels.
#[derive(Debug, Clone)]
pub struct Volume {
    grid: VoxelGrid,
    voxels: VoxelData,
    /// Source of the volume, which clones share.
    provenance: Arc<VolumeProvenance>,
    /// Hash of grid, samples, padding value and corrections: a fact of none of the parts alone.
    content_id: u64,
    /// Corrections of this volume, if there are any, with the volume as opened.
    correction: Option<Arc<AppliedCorrections>>,
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
        let grid = VoxelGrid::new(dims, world_from_index, samples.len())?;
        let voxels = VoxelData::new(samples, dims)?;
        let content_id = grid.combine_hash(voxels.samples().fingerprint());
        let provenance = Arc::new(VolumeProvenance::new(name));
        Ok(Self { grid, voxels, provenance, content_id, correction: None })
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

    /// Copies the metadata of the volume whose blocks this one's voxels represent.
    fn with_metadata_of(self, whole: &Self) -> Self {
        Self {
            grid: self.grid.with_file_facts_of(&whole.grid),
            voxels: self.voxels.with_metadata_of(&whole.voxels),
            provenance: Arc::clone(&whole.provenance),
            ..self
        }
    }

    /// Returns the name shown to the user: that of the file or the built-in volume.
    pub fn name(&self) -> &str {
        &self.provenance.name
    }

    /// Returns remarks for the user about how the file was read: impossible statements in it, and the values used
    /// instead.
    pub fn remarks(&self) -> &[String] {
        &self.provenance.remarks
    }

    /// Returns the inventory of the file: the other volumes that could be opened of it.
    pub fn contents(&self) -> &FileContents {
        &self.provenance.contents
    }

    /// Returns the number of voxels along x, y, z.
    pub fn dims(&self) -> [usize; 3] {
        self.grid.dims()
    }

    /// Returns the dimensions of the volume from which this one was made by block averages ([`Self::block_averaged`])
    /// or subsampling ([`Self::subsampled`]); [`Self::dims`] if it is neither.
    pub fn file_dims(&self) -> [usize; 3] {
        self.grid.file_dims()
    }

    /// Returns the dimensions of the finest resolution level of the file, if all of a coarser one was read; otherwise
    /// [`Self::file_dims`].
    pub fn finest_dims(&self) -> [usize; 3] {
        let contents = self.contents();
        let levels = contents.alternatives_in(FileDimension::Level).filter(|_| contents.portion.is_whole());
        let finest = levels.and_then(|levels| levels.offers[0].dims);
        finest.map_or_else(|| self.file_dims(), |dims| dims.map(|n| usize::try_from(n).unwrap_or(usize::MAX)))
    }

    /// Returns the spacings of the file's voxels in mm; a voxel of the volume may be the mean of several of them.
    pub fn file_spacing_mm(&self) -> DVec3 {
        self.grid.file_spacing_mm()
    }

    /// Returns the transform from voxel indices (centres at integers) to millimetres.
    pub fn world_from_index(&self) -> DAffine3 {
        self.grid.world_from_index()
    }

    /// Returns the distance in mm between voxel centres along the three index axes.
    pub fn spacing_mm(&self) -> DVec3 {
        self.grid.spacing_mm()
    }

    /// Returns the scene space of the grid.
    pub fn scene(&self) -> SceneSpace {
        self.grid.scene()
    }

    /// Returns true if +x, +y and +z are known to be a body's right, anterior and superior directions.
    pub fn is_anatomical(&self) -> bool {
        self.grid.is_anatomical()
    }

    /// Returns true if lengths are in voxels because the voxels' size is unknown.
    pub fn has_unknown_scale(&self) -> bool {
        self.grid.has_unknown_scale()
    }

    /// Returns the unit in which lengths of the object's size are shown: that of the file, if it suits them.
    pub fn length_unit(&self) -> SpacingUnit {
        self.grid.length_unit()
    }

    /// Returns the total number of voxels.
    pub fn voxel_count(&self) -> usize {
        self.samples().len()
    }

    /// Returns the stored values.
    pub fn samples(&self) -> &Samples {
        self.voxels.samples()
    }

    /// Returns the metadata of the values, as the file states it.
    pub fn metadata(&self) -> &ValueMetadata {
        self.voxels.metadata()
    }

    /// Returns the padding value set by [`Self::with_padding`].
    pub fn padding_value(&self) -> Option<f64> {
        self.voxels.padding_value()
    }

    /// Returns the opacity unit in mm, see [`Self::with_unit_mm`].
    pub fn opacity_unit_mm(&self) -> Option<f64> {
        self.voxels.opacity_unit_mm()
    }

    /// Returns the range of finite values in the file, in data units.
    pub fn value_range(&self) -> ValueRange {
        self.ranges().all
    }

    /// Returns the range of all values and the robust range.
    pub fn ranges(&self) -> ValueRanges {
        self.voxels.ranges()
    }

    /// Returns the value below which about this share of the voxels lies.
    pub fn quantile(&self, share: f64) -> f64 {
        self.voxels.quantile(share)
    }

    /// Returns the missing voxels, if there are any.
    pub fn missing(&self) -> Option<&MissingVoxels> {
        self.voxels.missing()
    }

    /// Returns the number of voxels that hold NaN or an infinity, and so are missing.
    pub fn non_finite_voxels(&self) -> usize {
        self.voxels.non_finite_voxels()
    }

    /// Returns the kind of data; the first call detects it and blocks meanwhile.
    pub fn kind(&self) -> &DetectedKind {
        self.voxels.statistics.kind.get_or_init(|| DetectedKind::detect(self))
    }

    /// Returns true if values are labels, whose numbers have no mean.
    pub fn is_label_map(&self) -> bool {
        matches!(self.kind().kind, DataKind::LabelMap { .. })
    }

    /// Returns the labels of the volume, if its values can be labels: see [`LabelSet`]. The first call blocks while
    /// they are counted: about a second for 512³ voxels.
    pub fn labels(&self) -> Option<&LabelSet> {
        self.voxels.statistics.labels.get_or_init(|| LabelSet::from_volume(self).map(Arc::new)).as_deref()
    }

    /// Returns a hash of values and geometry: equal volumes have equal ids.
    pub fn content_id(&self) -> u64 {
        self.content_id
    }

    /// Returns the identity by which pictures of the volume are cached.
    pub fn id(&self) -> VolumeId {
        VolumeId {
            content_id: self.content_id,
            ranges: self.ranges(),
            dims: self.dims(),
            further_ranges: [None; MAX_FIELDS - 1],
            pages: PagesId::default(),
        }
    }

    /// Returns the value of one voxel in data units, as stored in the file.
    pub fn value(&self, x: usize, y: usize, z: usize) -> f64 {
        self.samples().value(self.grid.voxel_index([x, y, z]))
    }

    /// Returns the indices of the voxels of one of the six faces: at the start and at the end of x, of y and of z. Of
    /// longer edges, `max_per_edge` voxels at most are evenly spread.
    pub fn face_voxels(&self, face: usize, max_per_edge: usize) -> impl Iterator<Item = usize> {
        face_voxels(self.dims(), face, max_per_edge)
    }

    /// Returns the density of a voxel; `None` if it is missing.
    pub fn density_at(&self, place: [usize; 3]) -> Option<f64> {
        let voxel = self.grid.voxel_index(place);
        let is_missing = self.missing().is_some_and(|missing| missing.contains(voxel));
        (!is_missing).then(|| self.density_of(self.samples().value(voxel)))
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
