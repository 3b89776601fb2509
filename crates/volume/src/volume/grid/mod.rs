//! Grid of a volume: its size in voxels, and its position in world space (millimetres) and in the grid of its file.

mod correct;
pub(super) mod face_voxels;
mod file_grid_mapping;

use glam::{DAffine3, DVec3};

use self::file_grid_mapping::FileGridMapping;
use super::corrections::SpacingUnit;
use super::error::VolumeError;
use crate::load_context::ResolvedPortion;
use crate::math::SceneSpace;

/// Maximum number of units for the object's size at which the file's unit is used; larger numbers have too many
/// digits.
const MAX_UNITS_SHOWN: f64 = 1e4;

/// Minimum volume of a voxel, relative to a box with the same edges: below a millionth it is flat, whatever the unit.
const MIN_RELATIVE_VOLUME: f64 = 1e-6;

/// Regular grid of voxels, without their values. Invariants: at least one voxel, an invertible affine transform.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct VoxelGrid {
    /// Number of voxels along x, y, z.
    dims: [usize; 3],
    /// Transform from index space (voxel centres at integers) to world space in mm.
    world_from_index: DAffine3,
    /// True if +x, +y and +z of world space are a body's right, anterior and superior directions.
    is_anatomical: bool,
    /// Unit in which the file states lengths; voxels if their size is unknown.
    length_unit: SpacingUnit,
    /// Dimensions of the grid that was reduced to this one, see [`Self::file_dims`].
    file_dims: [usize; 3],
    /// Position of the voxels in the grid of the file.
    file_grid: FileGridMapping,
}

impl VoxelGrid {
    /// Creates the grid of as many voxels as there are samples. `world_from_index` maps voxel indices (centres at
    /// integers) to millimetres.
    ///
    /// # Errors
    /// Fails if a dimension is zero, their product is another number, or the transform is not finite and invertible.
    pub(super) fn new(
        dims: [usize; 3],
        world_from_index: DAffine3,
        sample_count: usize,
    ) -> Result<Self, VolumeError> {
        if dims.contains(&0) {
            return Err(VolumeError::Empty { dims });
        }
        let expected = dims.iter().try_fold(1usize, |product, &n| product.checked_mul(n));
        if expected != Some(sample_count) {
            return Err(VolumeError::WrongCount { dims, found: sample_count });
        }
        let matrix = world_from_index.matrix3;
        let lengths = DVec3::new(matrix.x_axis.length(), matrix.y_axis.length(), matrix.z_axis.length());
        let relative_volume = matrix.determinant().abs() / lengths.element_product();
        if !(world_from_index.is_finite()
            && lengths.min_element() > 0.0
            && relative_volume > MIN_RELATIVE_VOLUME)
        {
            return Err(VolumeError::BadGeometry { what: format!("axes {matrix:?}") });
        }
        Ok(Self {
            dims,
            world_from_index,
            is_anatomical: false,
            length_unit: SpacingUnit::Mm,
            file_dims: dims,
            file_grid: FileGridMapping::default(),
        })
    }

    /// Returns the number of voxels along x, y, z.
    pub(super) fn dims(&self) -> [usize; 3] {
        self.dims
    }

    /// Returns the index of a voxel among all samples, x fastest.
    pub(super) fn voxel_index(&self, [x, y, z]: [usize; 3]) -> usize {
        x + self.dims[0] * (y + self.dims[1] * z)
    }

    /// Returns the transform from voxel indices (centres at integers) to millimetres.
    pub(super) fn world_from_index(&self) -> DAffine3 {
        self.world_from_index
    }

    /// Returns the distance in mm between voxel centres along the three index axes.
    pub(super) fn spacing_mm(&self) -> DVec3 {
        let axes = self.world_from_index.matrix3;
        DVec3::new(axes.x_axis.length(), axes.y_axis.length(), axes.z_axis.length())
    }

    /// Returns the scene space of the grid.
    pub(super) fn scene(&self) -> SceneSpace {
        SceneSpace::new(self.dims, self.world_from_index)
    }

    /// Returns true if +x, +y and +z are known to be a body's right, anterior and superior directions.
    pub(super) fn is_anatomical(&self) -> bool {
        self.is_anatomical
    }

    /// Returns true if lengths are in voxels because the voxels' size is unknown.
    pub(super) fn has_unknown_scale(&self) -> bool {
        self.length_unit == SpacingUnit::Voxels
    }

    /// Returns the unit in which lengths of the object's size are shown: that of the file, if it suits them.
    pub(super) fn length_unit(&self) -> SpacingUnit {
        let length_mm = self.scene().mm_per_unit;
        match self.length_unit {
            SpacingUnit::Voxels => SpacingUnit::Voxels,
            unit if (1.0..=MAX_UNITS_SHOWN).contains(&(length_mm / unit.mm())) => unit,
            _ => SpacingUnit::suiting_length(length_mm),
        }
    }

    /// Returns the dimensions of the grid that was reduced to this one by block averages or subsampling;
    /// [`Self::dims`] if it was not reduced.
    pub(super) fn file_dims(&self) -> [usize; 3] {
        self.file_dims
    }

    /// Returns the spacings of the file's voxels in mm; a voxel of the grid may be the mean of several of them.
    pub(super) fn file_spacing_mm(&self) -> DVec3 {
        self.spacing_mm() / self.file_grid.steps()
    }

    /// Combines the hash of all samples with size and position, so that equal volumes have equal hashes.
    pub(super) fn combine_hash(&self, samples_hash: u64) -> u64 {
        let sizes = self.dims.iter().map(|&n| n as u64);
        let geometry = sizes.chain(self.world_from_index.to_cols_array().map(f64::to_bits));
        geometry
            .fold(samples_hash, |hash, word| hash.rotate_left(17) ^ word.wrapping_mul(0x9e37_79b9_7f4a_7c15))
    }

    /// Sets whether world space is right-anterior-superior, as the file states of a body.
    pub(super) fn with_anatomical_axes(self, is_anatomical: bool) -> Self {
        Self { is_anatomical, ..self }
    }

    /// Marks the size of voxels as unknown: lengths are then in voxels, not in millimetres.
    pub(super) fn with_unknown_scale(self) -> Self {
        Self { length_unit: SpacingUnit::Voxels, ..self }
    }

    /// Sets the unit in which the file states lengths, given in mm; a length that is no known unit is ignored.
    pub(super) fn with_length_unit(self, mm: f64) -> Self {
        Self { length_unit: SpacingUnit::from_mm(mm).unwrap_or(self.length_unit), ..self }
    }

    /// Sets the dimensions of the grid that this one comes from.
    pub(super) fn with_file_dims(self, file_dims: [usize; 3]) -> Self {
        Self { file_dims, ..self }
    }

    /// Copies the facts that the file states of the grid, of which this one is a part or a reduction.
    pub(super) fn with_file_facts_of(self, whole: &Self) -> Self {
        Self {
            is_anatomical: whole.is_anatomical,
            length_unit: whole.length_unit,
            file_dims: whole.file_dims,
            ..self
        }
    }

    /// Records that each voxel stands for a block of voxels of another grid; `first` is the position of the first
    /// block's voxel in index space of that grid.
    pub(super) fn with_blocks_of(self, whole: &Self, block: [usize; 3], first: DVec3) -> Self {
        Self { file_grid: whole.file_grid.with_blocks(block, first), ..self }
    }

    /// Records the position of the voxels in the file's grid, of which only this portion was read.
    pub(super) fn with_file_portion(self, read: &ResolvedPortion) -> Self {
        let edges = DVec3::from(read.stride.map(|n| n as f64));
        let first = if read.is_averaged { 0.5 * (edges - 1.0) } else { DVec3::ZERO };
        self.with_blocks_of(&self, read.stride, first).with_file_dims(read.box_dims())
    }
}
