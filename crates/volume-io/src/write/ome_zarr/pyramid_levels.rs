//! Grids of the resolution levels of a pyramid.

/// Longest edge of the coarsest level, in voxels.
const COARSEST_EDGE: usize = 128;

/// Ratio to the shortest spacing up to which an axis is halved with it, so that voxels become more like cubes.
const MAX_HALVED_RATIO: f64 = 1.5;

/// Grid of a resolution level.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct LevelGrid {
    /// Voxels along x, y, z.
    pub(super) dims: [usize; 3],
    /// Voxels of the finer level that make one, along x, y, z; 1 for the finest level.
    pub(super) block: [usize; 3],
    /// Distances between voxels along x, y, z.
    pub(super) spacing: [f64; 3],
    /// Place of the centre of the first voxel.
    pub(super) translation: [f64; 3],
}

impl LevelGrid {
    /// Returns the next coarser level, in which axes are halved; `None` for the coarsest.
    fn coarser(&self) -> Option<Self> {
        let Self { dims, spacing, translation, .. } = *self;
        if dims.into_iter().all(|n| n <= COARSEST_EDGE) {
            return None;
        }
        let lengths = [0, 1, 2].map(|axis| if dims[axis] < 2 { f64::INFINITY } else { spacing[axis] });
        let shortest = lengths.into_iter().fold(f64::INFINITY, f64::min);
        let block = lengths
            .map(|length| if length.is_finite() && length <= MAX_HALVED_RATIO * shortest { 2 } else { 1 });
        Some(Self {
            dims: [0, 1, 2].map(|axis| dims[axis].div_ceil(block[axis])),
            block,
            spacing: [0, 1, 2].map(|axis| spacing[axis] * block[axis] as f64),
            // The centre of two voxels lies half a voxel after that of the first.
            translation: [0, 1, 2]
                .map(|axis| 0.5 * (block[axis] - 1) as f64 * spacing[axis] + translation[axis]),
        })
    }
}

/// Returns the levels of a pyramid, the finest first.
pub(super) fn plan_levels(dims: [usize; 3], spacing: [f64; 3], translation: [f64; 3]) -> Vec<LevelGrid> {
    let finest = LevelGrid { dims, block: [1; 3], spacing, translation };
    std::iter::successors(Some(finest), LevelGrid::coarser).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_are_halved_until_voxels_are_cubes() {
        let dims = |dims, spacing| -> Vec<[usize; 3]> {
            plan_levels(dims, spacing, [0.0; 3]).iter().map(|level| level.dims).collect()
        };
        assert_eq!(dims([128, 5, 128], [1.0; 3]), [[128, 5, 128]]);
        assert_eq!(dims([129, 1, 300], [1.0; 3]), [[129, 1, 300], [65, 1, 150], [33, 1, 75]]);
        let stack = dims([1000, 800, 60], [0.5, 0.5, 2.0]);
        assert_eq!(stack, [[1000, 800, 60], [500, 400, 60], [250, 200, 60], [125, 100, 30]]);
        // A long axis of long voxels is halved when the others are as long, or cannot be halved any more.
        assert_eq!(dims([2, 1, 200], [1.0, 1.0, 9.0]), [[2, 1, 200], [1, 1, 200], [1, 1, 100]]);
        let levels = plan_levels([300, 300, 300], [1.0, 1.25, 2.0], [10.0, 0.0, -1.0]);
        assert_eq!((levels[1].block, levels[1].spacing), ([2, 2, 1], [2.0, 2.5, 2.0]));
        assert_eq!(levels[1].translation, [10.5, 0.625, -1.0]);
        assert_eq!((levels[2].block, levels[2].translation), ([2, 2, 2], [11.5, 1.875, 0.0]));
    }
}
