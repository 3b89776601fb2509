//! A scalar volume on a regular grid, with its place in the world and its values in data units.

mod corrections;
mod error;
mod in_file;
mod kind;
mod label_set;
mod missing;
mod reduce;
mod region;
mod shown;
mod thinned;

pub use corrections::{
    AxisOrder, Corrections, Flips, Headings, Orientation, PaddingValue, SpacingUnit, ValueScale,
};
pub use error::VolumeError;
pub use kind::{DataKind, KindFound, KindName};
pub use label_set::{CountedLabel, LabelSet, MAX_CLASSES};
pub use missing::Missing;
pub(super) use reduce::Blocks;
pub use reduce::reduced_dims;
pub use shown::Shown;

use std::sync::{Arc, OnceLock};
use std::time::Duration;

use glam::{DAffine3, DMat3, DVec3};

use self::corrections::Corrected;
use self::in_file::InFile;
use super::attempt::Held;
use super::values::robust::quantile;
use super::{Hints, Samples, ValueRange, ValueRanges};
use crate::math::SceneSpace;

/// Identifies a volume, and says what its values are.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VolumeId {
    /// See [`Volume::content_id`].
    pub content_id: u64,
    /// See [`Volume::ranges`].
    pub ranges: ValueRanges,
    /// See [`Volume::dims`].
    pub dims: [usize; 3],
}

/// A scalar volume. Its invariants: at least one voxel, an invertible affine, a finite value range. Copies share the
/// voxels.
#[derive(Debug, Clone)]
pub struct Volume {
    name: String,
    dims: [usize; 3],
    file_dims: [usize; 3],
    /// How voxels lie among those of the file.
    block: InFile,
    world_from_index: DAffine3,
    samples: Arc<Samples>,
    ranges: ValueRanges,
    shown: Shown,
    missing: Option<Arc<Missing>>,
    non_finite_voxels: usize,
    padding_value: Option<f64>,
    unit_mm: Option<f64>,
    is_anatomical: bool,
    hints: Hints,
    length_unit: SpacingUnit,
    remarks: Vec<String>,
    held: Arc<Held>,
    looking_took: Duration,
    /// Found when it is first asked for.
    kind: OnceLock<KindFound>,
    /// Found when they are first asked for.
    labels: OnceLock<Option<Arc<LabelSet>>>,
    content_id: u64,
    /// What it was made from, if somebody knows better than the file.
    corrected: Option<Arc<Corrected>>,
}

impl Volume {
    /// Makes a volume. `world_from_index` maps voxel indices (centres at integers) to millimetres.
    ///
    /// # Errors
    /// When the count does not fit `dims`, a dimension is zero, the affine is not finite and
    /// invertible, no value is finite, or the values span more than a number can say.
    pub fn new(
        name: impl Into<String>,
        dims: [usize; 3],
        world_from_index: DAffine3,
        samples: Samples,
    ) -> Result<Self, VolumeError> {
        Self::sharing(name.into(), dims, world_from_index, Arc::new(samples))
    }

    /// As [`Self::new`], of voxels that others may have, too.
    fn sharing(
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
        // Relative to a box of the same edges: below a millionth it is flat, whatever the unit.
        let flatness = matrix.determinant().abs() / lengths.element_product();
        if !(world_from_index.is_finite() && lengths.min_element() > 0.0 && flatness > 1e-6) {
            return Err(VolumeError::BadGeometry { what: format!("axes {matrix:?}") });
        }
        let (value_range, non_finite_voxels) = samples.finite_range().ok_or(VolumeError::NothingFinite)?;
        if !value_range.span().is_finite() {
            let range = format!("from {:e} to {:e}", value_range.low, value_range.high);
            return Err(VolumeError::TooWide { range });
        }
        let ranges = ValueRanges::of(&samples, value_range);
        let geometry =
            dims.iter().map(|&n| n as u64).chain(world_from_index.to_cols_array().map(f64::to_bits));
        let content_id = geometry.fold(samples.fingerprint(), |hash, word| {
            hash.rotate_left(17) ^ word.wrapping_mul(0x9e37_79b9_7f4a_7c15)
        });
        let volume = Self {
            name,
            dims,
            file_dims: dims,
            block: InFile::default(),
            world_from_index,
            samples,
            ranges,
            shown: Shown::Range(ranges.robust),
            missing: None,
            non_finite_voxels,
            padding_value: None,
            unit_mm: None,
            is_anatomical: false,
            hints: Hints::default(),
            length_unit: SpacingUnit::Mm,
            remarks: Vec::new(),
            held: Arc::default(),
            looking_took: Duration::ZERO,
            kind: OnceLock::new(),
            labels: OnceLock::new(),
            content_id,
            corrected: None,
        };
        Ok(if non_finite_voxels > 0 { volume.with_missing() } else { volume })
    }

    /// States the length to which opacities of this material refer, so that it looks the same at
    /// every resolution; the built-in volumes have one.
    #[must_use]
    pub fn with_unit_mm(self, unit_mm: f64) -> Self {
        Self { unit_mm: Some(unit_mm), ..self }
    }

    /// See [`Self::with_unit_mm`].
    pub fn unit_mm(&self) -> Option<f64> {
        self.unit_mm
    }

    /// States that world space is right-anterior-superior, as the file says of a body.
    #[must_use]
    pub(crate) fn with_anatomy(self, is_anatomical: bool) -> Self {
        Self { is_anatomical, ..self }
    }

    /// Whether +x, +y and +z are known to be a body's right, front and head.
    pub fn is_anatomical(&self) -> bool {
        self.is_anatomical
    }

    /// States what the file says of the values.
    #[must_use]
    pub fn with_hints(self, hints: Hints) -> Self {
        Self { hints, kind: OnceLock::new(), ..self }
    }

    /// What the file says of the values.
    pub fn hints(&self) -> &Hints {
        &self.hints
    }

    /// States that nobody knows how large voxels are: lengths are in voxels then, not in millimetres.
    #[must_use]
    pub fn with_unknown_scale(self) -> Self {
        Self { length_unit: SpacingUnit::Voxels, ..self }
    }

    /// Whether lengths are in voxels because nobody knows how large these are.
    pub fn has_unknown_scale(&self) -> bool {
        self.length_unit == SpacingUnit::Voxels
    }

    /// States what a user should know of how the file was read.
    #[must_use]
    pub fn with_remarks(self, remarks: Vec<String>) -> Self {
        Self { remarks, ..self }
    }

    /// What a user should know of how the file was read: what it says that cannot be, and what was taken instead.
    pub fn remarks(&self) -> &[String] {
        &self.remarks
    }

    /// States what else the file holds.
    #[must_use]
    pub(super) fn with_held(self, held: Held) -> Self {
        Self { held: Arc::new(held), ..self }
    }

    /// What the file holds of which this volume is one: what else could be opened of it.
    pub fn held(&self) -> &Held {
        &self.held
    }

    /// States how long it took to look at the voxels of a file once they were there.
    #[must_use]
    pub(super) fn with_looking_took(self, looking_took: Duration) -> Self {
        Self { looking_took, ..self }
    }

    /// How long it took, when its file was read, to find what its values span and what identifies them: what of loading was
    /// neither reading nor decoding. Nothing for volumes that come from no file.
    pub fn looking_took(&self) -> Duration {
        self.looking_took
    }

    /// What kind of data it holds. The first to ask waits until that is found.
    pub fn kind(&self) -> &KindFound {
        self.kind.get_or_init(|| KindFound::of(self))
    }

    /// Whether its values are labels, whose numbers have no mean.
    pub(in crate::data) fn is_of_labels(&self) -> bool {
        matches!(self.kind().kind, DataKind::LabelMap { .. })
    }

    /// States what else is known of the volume whose blocks this one's voxels are.
    #[must_use]
    pub(super) fn standing_for(self, whole: &Self) -> Self {
        Self {
            file_dims: whole.file_dims,
            unit_mm: whole.unit_mm,
            is_anatomical: whole.is_anatomical,
            hints: whole.hints.clone(),
            length_unit: whole.length_unit,
            remarks: whole.remarks.clone(),
            held: Arc::clone(&whole.held),
            kind: whole.kind_of_parts(),
            ..self
        }
    }

    /// An axis-aligned volume: `spacing_mm` between voxel centres along x, y, z.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn with_spacing(
        name: impl Into<String>,
        dims: [usize; 3],
        spacing_mm: DVec3,
        samples: Samples,
    ) -> Result<Self, VolumeError> {
        let affine = DAffine3 { matrix3: DMat3::from_diagonal(spacing_mm), translation: DVec3::ZERO };
        Self::new(name, dims, affine, samples)
    }

    /// What the user calls it: the file's name or the built-in's.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Voxels along x, y, z.
    pub fn dims(&self) -> [usize; 3] {
        self.dims
    }

    /// Voxels along x, y, z of the volume whose blocks were averaged ([`Self::reduced`]), or of which every so manyth was
    /// kept ([`Self::thinned`]); [`Self::dims`] where that is all of them.
    pub fn file_dims(&self) -> [usize; 3] {
        self.file_dims
    }

    /// Number of voxels.
    pub fn voxel_count(&self) -> usize {
        self.samples.len()
    }

    /// Voxel indices (centres at integers) to millimetres.
    pub fn world_from_index(&self) -> DAffine3 {
        self.world_from_index
    }

    /// Distance between voxel centres along the three index axes.
    pub fn spacing_mm(&self) -> DVec3 {
        let axes = self.world_from_index.matrix3;
        DVec3::new(axes.x_axis.length(), axes.y_axis.length(), axes.z_axis.length())
    }

    /// How the grid lies in scene space.
    pub fn scene(&self) -> SceneSpace {
        SceneSpace::new(self.dims, self.world_from_index)
    }

    /// The stored values.
    pub fn samples(&self) -> &Samples {
        &self.samples
    }

    /// The smallest and the largest finite value of the file, in data units.
    pub fn value_range(&self) -> ValueRange {
        self.ranges.all
    }

    /// All values of the file, and those that matter.
    pub fn ranges(&self) -> ValueRanges {
        self.ranges
    }

    /// The value below which about that share of the voxels lies.
    pub fn quantile(&self, share: f64) -> f64 {
        quantile(&self.samples, self.padding_value.unwrap_or(f64::NAN), share)
    }

    /// How many voxels hold NaN or an infinity: nothing is there.
    pub fn non_finite_voxels(&self) -> usize {
        self.non_finite_voxels
    }

    /// Identifies values and geometry: equal volumes have equal ids.
    pub fn content_id(&self) -> u64 {
        self.content_id
    }

    /// What pictures are asked for by.
    pub fn id(&self) -> VolumeId {
        VolumeId { content_id: self.content_id, ranges: self.ranges, dims: self.dims }
    }

    /// One voxel in data units, as the file has it.
    pub fn value(&self, x: usize, y: usize, z: usize) -> f64 {
        self.samples.value(x + self.dims[0] * (y + self.dims[1] * z))
    }

    /// The density of a voxel; `None` where it holds nothing.
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
        // What is not there has the mean of what is beside it.
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
