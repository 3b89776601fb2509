//! What the name of a file of bare voxels says of it.

use super::super::Endian;
use crate::data::VoxelType;

/// What the name of a file says of it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Said {
    /// Voxels along x, y and z.
    pub dims: Option<[usize; 3]>,
    /// The number type.
    pub voxel_type: Option<VoxelType>,
    /// The byte order.
    pub endian: Option<Endian>,
}
