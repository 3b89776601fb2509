//! Voxels of a grid that are kept by a portion: box, stride and block averages.

use super::portion::{LONGEST_STEP, Portion, Region, Thinning};

/// Portion resolved for a grid of known size.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::data) struct Kept {
    /// Number of voxels of the grid along x, y, z.
    pub(in crate::data) grid: [usize; 3],
    /// First voxel of the box along each axis.
    pub(in crate::data) low: [usize; 3],
    /// End of the box along each axis, exclusive.
    pub(in crate::data) high: [usize; 3],
    /// Stride, or edge of a block, in voxels along each axis; at most the edge of the box.
    pub(in crate::data) step: [usize; 3],
    /// True if each block is averaged; otherwise its first voxel is kept.
    pub(in crate::data) is_averaged: bool,
    /// True if voxels are labels, whose numbers have no mean.
    pub(in crate::data) are_labels: bool,
}

impl Kept {
    /// Returns the portion that keeps all voxels.
    pub(in crate::data) fn all(grid: [usize; 3]) -> Self {
        let (is_averaged, are_labels) = (false, false);
        Self { grid, low: [0; 3], high: grid, step: [1; 3], is_averaged, are_labels }
    }

    /// Resolves a portion for a grid; `None` if its box is empty or reaches beyond the grid.
    pub(in crate::data) fn of(portion: &Portion, grid: [usize; 3], are_labels: bool) -> Option<Self> {
        let ends = |Region(stretches): Region| {
            [0, 1, 2].map(|axis| (stretches[axis].first, stretches[axis].end.unwrap_or(grid[axis])))
        };
        let ends = portion.region.map_or(grid.map(|n| (0, n)), ends);
        let (low, high) = (ends.map(|(low, _)| low), ends.map(|(_, high)| high));
        if (0..3).any(|axis| low[axis] >= high[axis] || high[axis] > grid[axis]) {
            return None;
        }
        let step = portion.thinning.step().min(LONGEST_STEP);
        let step = [0, 1, 2].map(|axis| step.min(high[axis] - low[axis]));
        let is_averaged = matches!(portion.thinning, Thinning::Average(_)) && step != [1; 3];
        Some(Self { grid, low, high, step, is_averaged, are_labels })
    }

    /// Returns the box of this portion with all its voxels.
    pub(in crate::data) fn boxed(self) -> Self {
        Self { step: [1; 3], is_averaged: false, ..self }
    }

    /// Returns the voxels that must be read: the full box if blocks are averaged, otherwise only the kept voxels.
    pub(in crate::data) fn boxed_if_averaged(self) -> Self {
        if self.is_averaged { self.boxed() } else { self }
    }

    /// Returns true if no voxel is left out.
    pub(in crate::data) fn is_all(&self) -> bool {
        *self == Self { are_labels: self.are_labels, ..Self::all(self.grid) }
    }

    /// Returns the indices of the slices that must be read.
    pub(in crate::data) fn slices(&self) -> impl Iterator<Item = usize> + use<> {
        (self.low[2]..self.high[2]).step_by(if self.is_averaged { 1 } else { self.step[2] })
    }

    /// Returns this portion relative to a grid that consists only of [the slices read](Self::slices).
    pub(in crate::data) fn of_slices(self) -> Self {
        let count = self.slices().count();
        let step = if self.is_averaged { self.step[2] } else { 1 };
        let with = |of: [usize; 3], z: usize| [of[0], of[1], z];
        let (low, high) = (with(self.low, 0), with(self.high, count));
        Self { grid: with(self.grid, count), low, high, step: with(self.step, step), ..self }
    }

    /// Copies the kept voxels of one slice into `kept`.
    pub(in crate::data) fn pick_in_slice<T: Copy>(&self, slice: &[T], kept: &mut [T]) {
        let rows = (self.low[1]..self.high[1]).step_by(self.step[1]);
        for (row, kept) in rows.zip(kept.chunks_mut(self.dims()[0])) {
            let voxels = slice[row * self.grid[0]..][self.low[0]..self.high[0]].iter().step_by(self.step[0]);
            for (voxel, kept) in voxels.zip(kept) {
                *kept = *voxel;
            }
        }
    }

    /// Returns the number of voxels of the box along each axis.
    pub(in crate::data) fn edges(&self) -> [usize; 3] {
        [0, 1, 2].map(|axis| self.high[axis] - self.low[axis])
    }

    /// Returns the number of kept voxels along each axis.
    pub(in crate::data) fn dims(&self) -> [usize; 3] {
        let edges = self.edges();
        [0, 1, 2].map(|axis| edges[axis].div_ceil(self.step[axis]))
    }

    /// Returns the number of kept voxels, saturated at `usize::MAX`.
    pub(in crate::data) fn count(&self) -> usize {
        self.dims().into_iter().fold(1, usize::saturating_mul)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn portions_of_grids_have_sizes() {
        let kept = |portion: &Portion| Kept::of(portion, [10, 7, 1], false);
        assert_eq!(kept(&Portion::default()), Some(Kept::all([10, 7, 1])));
        let half = kept(&Portion::every(2)).unwrap();
        assert_eq!((half.dims(), half.step, half.count()), ([5, 4, 1], [2, 2, 1], 20));
        assert!(!half.is_all() && half.boxed().is_all());
        let region = |text: &str| Portion { region: text.parse().ok(), ..Portion::average(3) };
        let part = kept(&region("2:9,5:,:")).unwrap();
        assert_eq!((part.edges(), part.dims(), part.is_averaged), ([7, 2, 1], [3, 1, 1], true));
        for outside in ["0:11,:,:", "3:3,:,:", ":,:,1:", "9:2,:,:"] {
            assert_eq!(kept(&region(outside)), None, "{outside}");
        }
        let enormous = Kept::of(&Portion::every(usize::MAX), [usize::MAX; 3], false).unwrap();
        assert_eq!((enormous.step, enormous.count()), ([LONGEST_STEP; 3], usize::MAX));
    }
}
