//! Layout hints in the name of a raw file.

use super::super::Endian;
use chiaroscuro_volume::VoxelType;

/// Properties of a raw file that its name gives.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct RawNameHints {
    /// Voxels along x, y and z.
    pub dims: Option<[usize; 3]>,
    /// Number type of the voxels.
    pub voxel_type: Option<VoxelType>,
    /// Byte order of the voxels.
    pub endian: Option<Endian>,
}
