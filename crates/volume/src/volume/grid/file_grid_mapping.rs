//! Mapping from the voxels of a volume to those of its file, where blocks were averaged or voxels skipped.

use glam::{DAffine3, DMat3, DVec3};

/// Position of a volume's voxels in the grid of its file: each may be the mean of several voxels, or one of them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct FileGridMapping {
    /// Voxels of the file per voxel of the volume, along each axis.
    step: [usize; 3],
    /// Centre of the first voxel, in index space of the file.
    first: DVec3,
}

impl Default for FileGridMapping {
    /// Returns the identity: each voxel stands for itself.
    fn default() -> Self {
        Self { step: [1; 3], first: DVec3::ZERO }
    }
}

impl FileGridMapping {
    /// Returns the mapping for blocks of this grid's voxels, given the position of the first block's voxel.
    pub(super) fn with_blocks(self, block: [usize; 3], first: DVec3) -> Self {
        let step = [0, 1, 2].map(|axis| self.step[axis] * block[axis]);
        Self { step, first: self.first + self.steps() * first }
    }

    /// Returns the number of the file's voxels per voxel, along each axis.
    pub(super) fn steps(self) -> DVec3 {
        DVec3::from(self.step.map(|n| n as f64))
    }

    /// Returns the transform from index space of the volume to that of the file; `None` for the identity.
    pub(super) fn file_from_index(self) -> Option<DAffine3> {
        let affine = DAffine3 { matrix3: DMat3::from_diagonal(self.steps()), translation: self.first };
        (self != Self::default()).then_some(affine)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_of_blocks_lie_where_their_voxels_do() {
        let half = FileGridMapping::default().with_blocks([2; 3], DVec3::splat(0.5));
        let quarter = half.with_blocks([2; 3], DVec3::splat(0.5));
        assert_eq!(quarter, FileGridMapping { step: [4; 3], first: DVec3::splat(1.5) });
        // Averages of two voxels after a stride of 2: the first is the mean of voxels 0 and 2.
        let thinned = FileGridMapping::default()
            .with_blocks([2; 3], DVec3::ZERO)
            .with_blocks([2; 3], DVec3::splat(0.5));
        assert_eq!(thinned.first, DVec3::ONE);
        assert!(FileGridMapping::default().file_from_index().is_none());
    }
}
