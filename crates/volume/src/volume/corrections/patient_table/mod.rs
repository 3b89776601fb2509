//! Patient table: finds the couch that a body lies on in a scan, so that it can be hidden.
//!
//! A table is a sheet, flat or curved, which is nearly the same in all slices along the scanner's axis, while a body is
//! not. Seen from outside, columns of voxels across it meet thin layers, the last of which before the body is its top.
//! In places where the body touches the top, the two look alike; there the top is that of a parabola or a circle, fitted
//! to the top beside the body. All that lies beyond the top is the table.

mod columns;
mod profile;
#[cfg(test)]
mod tests;

use self::columns::ThinLayers;
use self::profile::TableTop;
use crate::volume::Volume;

/// Share of the columns in which more than a thin layer lies beyond the top of a table: more belong to a body.
const MAX_CUT_SHARE: f64 = 0.03;

/// Orientation of a table in a grid.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct TableOrientation {
    /// Axis of the grid that leads through the table to the body.
    pub down: usize,
    /// `true` if the table lies at high indices.
    pub is_at_end: bool,
    /// Axis of the grid across the table.
    pub across: usize,
    /// Axis of the grid along the table, which is that of the scanner.
    pub along: usize,
}

impl TableOrientation {
    /// Returns the index along `down` at a depth, in voxels from the face beyond the table.
    fn index_at(self, depth: usize, dims: [usize; 3]) -> usize {
        if self.is_at_end { dims[self.down] - 1 - depth } else { depth }
    }

    /// Returns the orientations that a table may have in a volume, with the scanner's axis along that from feet to head,
    /// or along any axis of the grid if that is unknown.
    fn possible_in(volume: &Volume) -> impl Iterator<Item = Self> {
        let upwards = volume.world_from_index().matrix3.transpose().z_axis.abs();
        let is_known = volume.is_anatomical();
        let may_be_along = move |axis: &usize| !is_known || upwards[*axis] == upwards.max_element();
        (0..3).filter(may_be_along).flat_map(|along| {
            [(along + 1) % 3, (along + 2) % 3].into_iter().flat_map(move |down| {
                let across = 3 - along - down;
                [false, true].map(|is_at_end| Self { down, is_at_end, across, along })
            })
        })
    }
}

/// Table under a body, as the part of a grid that lies beyond its top.
#[derive(Debug, Clone, PartialEq)]
pub struct PatientTable {
    orientation: TableOrientation,
    dims: [usize; 3],
    /// Voxels of the grid in which the table was found, per voxel of this one.
    block: [usize; 3],
    top: TableTop,
}

impl PatientTable {
    /// Finds the table in a volume whose material has at least the value `threshold`; `None` if there is none.
    pub fn find(volume: &Volume, threshold: f64) -> Option<Self> {
        let dims = volume.dims();
        let found = TableOrientation::possible_in(volume).filter_map(|orientation| {
            let layers = ThinLayers::new(volume, threshold, orientation)?;
            let top = TableTop::fit(&layers)?;
            let is_clear = layers.cut_share(|u, v| top.depth(u, v)) <= MAX_CUT_SHARE;
            is_clear.then_some(Self { orientation, dims, block: [1; 3], top })
        });
        found.max_by(|a, b| a.top.score().total_cmp(&b.top.score()))
    }

    /// Returns the table in a grid whose voxels are blocks of those of this one.
    #[must_use]
    pub(crate) fn in_blocks(&self, block: [usize; 3]) -> Self {
        Self { block: [0, 1, 2].map(|axis| self.block[axis] * block[axis]), ..self.clone() }
    }

    /// Returns true if the middle of a voxel of the grid lies beyond the top of the table.
    pub fn contains(&self, voxel: [usize; 3]) -> bool {
        // The middle of the last block may lie outside the grid.
        let middle = |axis: usize| voxel[axis] * self.block[axis] + self.block[axis] / 2;
        let voxel = [0, 1, 2].map(|axis| middle(axis).min(self.dims[axis] - 1));
        let TableOrientation { down, across, along, .. } = self.orientation;
        // The mapping is its own inverse.
        let depth = self.orientation.index_at(voxel[down], self.dims) as f64;
        depth < self.top.limit()
            && self.top.depth(voxel[across] as f64, voxel[along] as f64).is_some_and(|top| depth < top)
    }
}
