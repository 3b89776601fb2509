//! Voxels of a grid that are kept by a portion: box, stride and block averages.

use super::portion::{Downsampling, MAX_STRIDE, Portion, VoxelRegion};

/// Portion resolved for a grid of known size.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ResolvedPortion {
    /// Number of voxels of the grid along x, y, z.
    pub grid: [usize; 3],
    /// First voxel of the box along each axis.
    pub low: [usize; 3],
    /// End of the box along each axis, exclusive.
    pub high: [usize; 3],
    /// Stride, or edge of a block, in voxels along each axis; at most the edge of the box.
    pub stride: [usize; 3],
    /// True if each block is averaged; otherwise its first voxel is kept.
    pub is_averaged: bool,
    /// True if voxels are labels, whose numbers have no mean.
    pub are_labels: bool,
}

impl ResolvedPortion {
    /// Returns the portion that keeps all voxels.
    pub fn whole_grid(grid: [usize; 3]) -> Self {
        let (is_averaged, are_labels) = (false, false);
        Self { grid, low: [0; 3], high: grid, stride: [1; 3], is_averaged, are_labels }
    }

    /// Resolves a portion for a grid; `None` if its box is empty or reaches beyond the grid.
    pub fn resolve(portion: &Portion, grid: [usize; 3], are_labels: bool) -> Option<Self> {
        let ends = |VoxelRegion(stretches): VoxelRegion| {
            [0, 1, 2].map(|axis| (stretches[axis].first, stretches[axis].end.unwrap_or(grid[axis])))
        };
        let ends = portion.region.map_or(grid.map(|n| (0, n)), ends);
        let (low, high) = (ends.map(|(low, _)| low), ends.map(|(_, high)| high));
        if (0..3).any(|axis| low[axis] >= high[axis] || high[axis] > grid[axis]) {
            return None;
        }
        let step = portion.thinning.stride().min(MAX_STRIDE);
        let step = [0, 1, 2].map(|axis| step.min(high[axis] - low[axis]));
        let is_averaged = matches!(portion.thinning, Downsampling::Average(_)) && step != [1; 3];
        Some(Self { grid, low, high, stride: step, is_averaged, are_labels })
    }

    /// Returns the box of this portion with all its voxels.
    pub(crate) fn full_box(self) -> Self {
        Self { stride: [1; 3], is_averaged: false, ..self }
    }

    /// Returns the voxels that must be read: the full box if blocks are averaged, otherwise only the kept voxels.
    pub fn voxels_to_read(self) -> Self {
        if self.is_averaged { self.full_box() } else { self }
    }

    /// Returns true if no voxel is left out.
    pub fn is_whole_grid(&self) -> bool {
        *self == Self { are_labels: self.are_labels, ..Self::whole_grid(self.grid) }
    }

    /// Returns the indices of the slices that must be read.
    pub fn slices(&self) -> impl Iterator<Item = usize> + use<> {
        (self.low[2]..self.high[2]).step_by(if self.is_averaged { 1 } else { self.stride[2] })
    }

    /// Returns this portion relative to a grid that consists only of [the slices read](Self::slices).
    pub(crate) fn relative_to_slices(self) -> Self {
        let count = self.slices().count();
        let step = if self.is_averaged { self.stride[2] } else { 1 };
        let with = |of: [usize; 3], z: usize| [of[0], of[1], z];
        let (low, high) = (with(self.low, 0), with(self.high, count));
        Self { grid: with(self.grid, count), low, high, stride: with(self.stride, step), ..self }
    }

    /// Returns this portion relative to a grid that consists only of its box.
    pub(crate) fn relative_to_box(self) -> Self {
        let edges = self.box_dims();
        Self { grid: edges, low: [0; 3], high: edges, ..self }
    }

    /// Copies the kept voxels of one slice into `kept`.
    pub fn copy_from_slice<T: Copy>(&self, slice: &[T], kept: &mut [T]) {
        let rows = (self.low[1]..self.high[1]).step_by(self.stride[1]);
        for (row, kept) in rows.zip(kept.chunks_mut(self.dims()[0])) {
            let voxels =
                slice[row * self.grid[0]..][self.low[0]..self.high[0]].iter().step_by(self.stride[0]);
            for (voxel, kept) in voxels.zip(kept) {
                *kept = *voxel;
            }
        }
    }

    /// Returns the number of voxels of the box along each axis.
    pub fn box_dims(&self) -> [usize; 3] {
        [0, 1, 2].map(|axis| self.high[axis] - self.low[axis])
    }

    /// Returns the number of kept voxels along each axis.
    pub fn dims(&self) -> [usize; 3] {
        let edges = self.box_dims();
        [0, 1, 2].map(|axis| edges[axis].div_ceil(self.stride[axis]))
    }

    /// Returns the number of kept voxels, saturated at `usize::MAX`.
    pub fn count(&self) -> usize {
        self.dims().into_iter().fold(1, usize::saturating_mul)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn portions_of_grids_have_sizes() {
        let kept = |portion: &Portion| ResolvedPortion::resolve(portion, [10, 7, 1], false);
        assert_eq!(kept(&Portion::default()), Some(ResolvedPortion::whole_grid([10, 7, 1])));
        let half = kept(&Portion::with_stride(2)).unwrap();
        assert_eq!((half.dims(), half.stride, half.count()), ([5, 4, 1], [2, 2, 1], 20));
        assert!(!half.is_whole_grid() && half.full_box().is_whole_grid());
        let region = |text: &str| Portion { region: text.parse().ok(), ..Portion::with_block_average(3) };
        let part = kept(&region("2:9,5:,:")).unwrap();
        assert_eq!((part.box_dims(), part.dims(), part.is_averaged), ([7, 2, 1], [3, 1, 1], true));
        for outside in ["0:11,:,:", "3:3,:,:", ":,:,1:", "9:2,:,:"] {
            assert_eq!(kept(&region(outside)), None, "{outside}");
        }
        let enormous =
            ResolvedPortion::resolve(&Portion::with_stride(usize::MAX), [usize::MAX; 3], false).unwrap();
        assert_eq!((enormous.stride, enormous.count()), ([MAX_STRIDE; 3], usize::MAX));
    }
}
