//! How the voxels of a volume lie among those of its file.

use glam::{DAffine3, DMat3, DVec3};

/// A volume may have one voxel for several of the file: their mean, or one of them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct InFile {
    /// Voxels of the file along each axis for which one stands.
    step: [usize; 3],
    /// Where the first voxel lies, in indices of the file.
    first: DVec3,
}

impl Default for InFile {
    /// Each stands for itself.
    fn default() -> Self {
        Self { step: [1; 3], first: DVec3::ZERO }
    }
}

impl InFile {
    /// That of voxels that stand for blocks of these, the first of which lies so far into its block.
    pub(super) fn of_blocks(self, block: [usize; 3], first: DVec3) -> Self {
        let step = [0, 1, 2].map(|axis| self.step[axis] * block[axis]);
        Self { step, first: self.first + self.steps() * first }
    }

    /// Voxels of the file for which one stands, along each axis.
    pub(super) fn steps(self) -> DVec3 {
        DVec3::from(self.step.map(|n| n as f64))
    }

    /// Indices of voxels to those of the file; nothing where they are the same.
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
        let half = InFile::default().of_blocks([2; 3], DVec3::splat(0.5));
        let quarter = half.of_blocks([2; 3], DVec3::splat(0.5));
        assert_eq!(quarter, InFile { step: [4; 3], first: DVec3::splat(1.5) });
        // Every second voxel, of which two are averaged: the mean of voxels 0 and 2.
        let thinned = InFile::default().of_blocks([2; 3], DVec3::ZERO).of_blocks([2; 3], DVec3::splat(0.5));
        assert_eq!(thinned.first, DVec3::ONE);
        assert!(InFile::default().file_from_index().is_none());
    }
}
