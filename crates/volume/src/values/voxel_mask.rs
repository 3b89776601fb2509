//! Mask over the voxels of a grid: the part of each that is hidden, for eye and light alike.

/// Number of steps from a visible voxel to a hidden one.
const SHARE_STEPS: f32 = 255.0;

/// Mask over the voxels of a grid. A voxel that is hidden in part is one at the edge of a cut.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct VoxelMask {
    /// Number of voxels along x, y, z.
    dims: [usize; 3],
    /// Hidden share of each voxel, x fastest, from 0 to 255.
    hidden: Vec<u8>,
}

impl VoxelMask {
    /// Creates a mask from the hidden share of each voxel, x fastest, from 0 for visible to 255 for hidden; `None` if
    /// no voxel is hidden, or there is not one share for each voxel.
    pub fn from_hidden_shares(dims: [usize; 3], hidden: Vec<u8>) -> Option<Self> {
        let is_whole = hidden.len() == dims.iter().product::<usize>();
        (is_whole && hidden.iter().any(|&share| share > 0)).then_some(Self { dims, hidden })
    }

    /// Returns the number of voxels along x, y, z.
    pub fn dims(&self) -> [usize; 3] {
        self.dims
    }

    /// Returns the hidden share of the voxel at an index, x fastest, from 0 to 255.
    pub fn hidden(&self, voxel: usize) -> u8 {
        self.hidden[voxel]
    }

    /// Returns the hidden shares of all voxels, x fastest, from 0 to 255.
    pub fn hidden_shares(&self) -> &[u8] {
        &self.hidden
    }

    /// Returns the visible share of the voxel at an index, x fastest, from 0 to 1.
    pub fn visible_share(&self, voxel: usize) -> f32 {
        1.0 - f32::from(self.hidden[voxel]) / SHARE_STEPS
    }
}
