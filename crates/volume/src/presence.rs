//! Presence of voxels: 0 where they are missing or hidden by a mask, 1 elsewhere, and the cells where some are left.

use std::ops::Range;
use std::sync::Arc;

use rayon::prelude::*;

use super::{Observer, Volume, VoxelMask};
use crate::occupancy::cells::{BRICK_EDGE, CELL_EDGE};

/// Number of cells along the edge of a brick.
const CELLS_PER_BRICK_EDGE: usize = BRICK_EDGE / CELL_EDGE;

impl Volume {
    /// Hides voxels by a mask, in place of an earlier one; `None` shows all. Values, ranges and kind stay, and so does
    /// [`Self::missing`]. A mask of other dimensions is ignored.
    #[must_use]
    pub fn with_mask(&self, mask: Option<Arc<VoxelMask>>) -> Self {
        let dims = self.dims();
        self.clone().with_own_mask(mask.filter(|mask| mask.dims() == dims))
    }

    /// Returns true if voxels are missing, or are hidden by a mask as a whole or in part.
    pub fn has_absent_voxels(&self) -> bool {
        self.missing().is_some() || self.mask().is_some()
    }

    /// Returns the presence of the voxel at an index, x fastest: 0 if it is missing, else the share of it that a mask
    /// leaves to the eye, or to light if that is more.
    pub fn presence(&self, voxel: usize) -> f32 {
        if self.is_missing(voxel) { 0.0 } else { self.mask().map_or(1.0, |mask| mask.visible_to_any(voxel)) }
    }

    /// Returns the presence of the voxel at an index, x fastest, for an observer: 0 if it is missing, else the share of
    /// it that no mask hides from the observer.
    pub fn presence_for(&self, observer: Observer, voxel: usize) -> f32 {
        if self.is_missing(voxel) { 0.0 } else { self.unmasked_share(observer, voxel) }
    }

    /// Returns the share of the voxel at an index, x fastest, that no mask hides from an observer, even if the voxel is
    /// missing.
    pub fn unmasked_share(&self, observer: Observer, voxel: usize) -> f32 {
        self.mask().map_or(1.0, |mask| mask.visible_to(voxel, observer))
    }

    fn is_missing(&self, voxel: usize) -> bool {
        self.missing().is_some_and(|missing| missing.contains(voxel))
    }

    /// Returns true if all voxels in a range of indices are known to be present as a whole, to eye and light.
    fn is_present(&self, voxels: Range<usize>) -> bool {
        self.missing().is_none() && self.mask().is_none_or(|mask| mask.hides_none_of(voxels))
    }

    /// Returns the minimum of `number` over all voxels that are missing or hidden, at least in part and from one
    /// observer; `u8::MAX` if there are none.
    pub fn min_over_absent(&self, number: impl Fn([usize; 3]) -> u8 + Sync) -> u8 {
        if !self.has_absent_voxels() {
            return u8::MAX;
        }
        let [nx, ny, nz] = self.dims();
        let least_of_row = |row: usize| {
            let (y, z) = (row % ny, row / ny);
            if self.is_present(row * nx..(row + 1) * nx) {
                return u8::MAX;
            }
            let is_absent = |voxel: usize| Observer::ALL.iter().any(|by| self.presence_for(*by, voxel) < 1.0);
            let absent = (0..nx).filter(|x| is_absent(x + nx * row));
            absent.map(|x| number([x, y, z])).min().unwrap_or(u8::MAX)
        };
        (0..ny * nz).into_par_iter().map(least_of_row).min().unwrap_or(u8::MAX)
    }

    /// Returns for each brick of 4³ cells of 2³ voxels the bit mask, x fastest, of the cells in which an unstretched
    /// kernel reaches a voxel that is present at least in part: one in the cell itself or in a neighbouring cell.
    /// `None` if all voxels are present.
    pub(crate) fn present_cells(&self, bricks: [usize; 3]) -> Option<Vec<u64>> {
        if !self.has_absent_voxels() {
            return None;
        }
        let [width, height, depth] = bricks.map(|n| n * CELLS_PER_BRICK_EDGE);
        let [nx, ny, nz] = self.dims();
        let holds = |cell: usize| {
            let low = [cell % width, cell / width % height, cell / (width * height)].map(|c| CELL_EDGE * c);
            let place = |corner: usize| [0, 1, 2].map(|axis| low[axis] + (corner >> axis & 1));
            let is_there = |[x, y, z]: [usize; 3]| {
                x < nx && y < ny && z < nz && self.presence(x + nx * (y + ny * z)) > 0.0
            };
            (0..8).any(|corner| is_there(place(corner)))
        };
        // Most rows of cells are present as a whole.
        let row_of_cells = |row: usize| {
            let [y, z] = [row % height, row / height].map(|c| CELL_EDGE * c);
            let is_whole = width * CELL_EDGE == nx && y + CELL_EDGE <= ny && z + CELL_EDGE <= nz;
            let rows = (z..z + CELL_EDGE).flat_map(|z| (y..y + CELL_EDGE).map(move |y| y + ny * z));
            let is_present =
                is_whole && rows.into_iter().all(|row| self.is_present(row * nx..(row + 1) * nx));
            (0..width).map(move |x| is_present || holds(x + width * row))
        };
        let mut cells: Vec<bool> = (0..height * depth)
            .into_par_iter()
            .flat_map_iter(|row| row_of_cells(row).collect::<Vec<_>>())
            .collect();
        for (stride, count) in [(1, width), (width, height), (width * height, depth)] {
            let beside = |at: usize| {
                let place = at / stride % count;
                cells[at] || place > 0 && cells[at - stride] || place + 1 < count && cells[at + stride]
            };
            cells = (0..cells.len()).into_par_iter().map(beside).collect();
        }
        let mask = |brick: usize| {
            let first = [brick % bricks[0], brick / bricks[0] % bricks[1], brick / (bricks[0] * bricks[1])];
            let bit = |cell: usize| {
                let [x, y, z] = [cell % 4, cell / 4 % 4, cell / 16];
                let at = 4 * first[0] + x + width * (4 * first[1] + y + height * (4 * first[2] + z));
                u64::from(cells[at]) << cell
            };
            (0..64).map(bit).sum()
        };
        Some((0..bricks.iter().product()).into_par_iter().map(mask).collect())
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::{BrickBounds, Corrections, Dataset, Flips, Samples};

    #[test]
    fn voxels_are_absent_where_missing_or_hidden() {
        let values = vec![f32::NAN, 1.0, 2.0, 3.0];
        let volume = Volume::with_spacing("t", [4, 1, 1], DVec3::ONE, Samples::F32(values)).unwrap();
        let mask = VoxelMask::from_hidden_shares([4, 1, 1], vec![0, 0, 51, 255]).map(Arc::new);
        let masked = volume.with_mask(mask.clone());
        assert_eq!([0, 1, 2, 3].map(|voxel| masked.presence(voxel)), [0.0, 1.0, 0.8, 0.0]);
        assert_eq!(masked.min_over_absent(|[x, ..]| 10 - x as u8), 7);
        assert_eq!(volume.min_over_absent(|[x, ..]| 10 - x as u8), 10);
        assert_eq!((masked.ranges(), masked.content_id()), (volume.ranges(), volume.content_id()));
        // Masks are replaced and removed, and fit one grid.
        assert!(masked.with_mask(None).mask().is_none());
        let other = VoxelMask::from_hidden_shares([2, 1, 1], vec![0, 9]).map(Arc::new);
        assert!(other.is_some() && masked.with_mask(other).mask().is_none());
        assert_eq!(VoxelMask::from_hidden_shares([2, 1, 1], vec![0; 2]), None);
        assert_eq!(VoxelMask::from_hidden_shares([2, 1, 1], vec![9; 3]), None);
    }

    #[test]
    fn eye_and_light_may_see_different_voxels() {
        let samples = Samples::U8(vec![0, 1, 2, 3]);
        let volume = Volume::with_spacing("t", [4, 1, 1], DVec3::ONE, samples).unwrap();
        let mask = VoxelMask::from_shares_by_observer([4, 1, 1], vec![0, 255, 0, 51], vec![0, 0, 255, 51]);
        let mask = mask.map(Arc::new);
        assert!(mask.as_ref().is_some_and(|mask| mask.differs_by_observer()));
        let masked = volume.with_mask(mask);
        let for_observer = |observer| [0, 1, 2, 3].map(|voxel| masked.presence_for(observer, voxel));
        assert_eq!(for_observer(Observer::Eye), [1.0, 0.0, 1.0, 0.8]);
        assert_eq!(for_observer(Observer::Light), [1.0, 1.0, 0.0, 0.8]);
        assert_eq!([0, 1, 2, 3].map(|voxel| masked.presence(voxel)), [1.0, 1.0, 1.0, 0.8]);
        // A voxel that is hidden from one observer counts as absent.
        assert_eq!(masked.min_over_absent(|[x, ..]| x as u8), 1);
        let alike = VoxelMask::from_shares_by_observer([4, 1, 1], vec![0, 9, 0, 0], vec![0, 9, 0, 0]);
        assert!(alike.is_some_and(|mask| !mask.differs_by_observer()));
        assert_eq!(VoxelMask::from_shares_by_observer([4, 1, 1], vec![0; 4], vec![0; 4]), None);
        assert_eq!(VoxelMask::from_shares_by_observer([4, 1, 1], vec![0; 4], vec![9; 3]), None);
    }

    #[test]
    fn cells_count_that_a_kernel_finds_something_from() {
        // Voxels 13 … 15 of 20 along x are present, so that cells 5 … 8 are reached.
        let values = (0..1280).map(|at| if (13..16).contains(&(at % 20)) { at as f32 } else { f32::NAN });
        let samples = Samples::F32(values.collect());
        let volume = Volume::with_spacing("t", [20, 8, 8], DVec3::ONE, samples).unwrap();
        let masks = volume.present_cells([3, 1, 1]).unwrap();
        let row = |mask: u64| (0..4).map(|x| mask >> x & 1 == 1).collect::<Vec<_>>();
        assert_eq!(row(masks[0]), [false; 4]);
        assert_eq!(row(masks[1]), [false, true, true, true]);
        assert_eq!(row(masks[2]), [true, false, false, false]);
    }

    #[test]
    fn corrections_show_all_voxels_until_they_are_hidden_again() {
        let dims = [32, 8, 8];
        let samples = Samples::U8((0..2048).map(|at| at as u8).collect());
        let dataset = Dataset::new(Volume::with_spacing("t", dims, DVec3::ONE, samples).unwrap());
        let shares = (0..2048).map(|at| if at % 32 < 20 { 255 } else { 0 }).collect();
        let mask = VoxelMask::from_hidden_shares(dims, shares).map(Arc::new);
        let masked = dataset.with_mask(mask.as_ref());
        let occupancy = |dataset: &Dataset| dataset.bricks().occupancy(|_, _| true);
        assert_eq!(occupancy(&masked), [false, false, true, true]);
        for by in [
            Corrections { spacing: Some([2.0; 3]), ..Corrections::NONE },
            Corrections { flip: Flips { x: true, ..Flips::default() }, ..Corrections::NONE },
        ] {
            let corrected = masked.corrected(&by).unwrap();
            assert!(corrected.volume().mask().is_none());
            assert_eq!(occupancy(&corrected), [true; 4]);
        }
        assert_eq!(occupancy(&masked.with_mask(None)), [true; 4]);
    }

    #[test]
    fn hidden_cells_are_skipped() {
        let dims = [32, 8, 8];
        let volume =
            Volume::with_spacing("t", dims, DVec3::ONE, Samples::U8((0..2048).map(|at| at as u8).collect()));
        let shares = (0..2048).map(|at| if at % 32 < 20 { 255 } else { 0 }).collect();
        let mask = VoxelMask::from_hidden_shares(dims, shares).map(Arc::new);
        let masked = volume.unwrap().with_mask(mask);
        let bounds = BrickBounds::from_volume(&masked);
        assert_eq!(bounds.occupancy(|_, _| true), [false, false, true, true]);
        // Voxels from 20 on are left: cells from 10 on, and the one before.
        let row = |brick: usize| bounds.cell_masks(|_, _| true)[brick] & 0b1111;
        assert_eq!([0, 1, 2, 3].map(row), [0, 0, 0b1110, 0b1111]);
    }
}
