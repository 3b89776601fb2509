//! Dispatches over the cells of a set, as `shaders/common/listed_cells.wgsl` takes them apart.

use super::listed_bricks::{packed, single_workgroups};
use crate::gpu::Context;
use crate::gpu::pipelines::binding::{Named, buffer};
use crate::plan::CellSet;

/// Voxels of a cell.
const VOXELS: u64 = 8;

/// Cells of a workgroup.
const PER_WORKGROUP: usize = 8;

/// Cells of voxels or blocks, brick by brick.
#[derive(Debug)]
pub(crate) struct ListedCells {
    buffer: wgpu::Buffer,
    count: usize,
}

impl ListedCells {
    /// Those of a set.
    pub(crate) fn new(context: &Context, set: &CellSet) -> Self {
        let cells: Vec<u32> = set.cells().map(packed).collect();
        Self {
            buffer: context.buffer("ListedCells::buffer", &cells, wgpu::BufferUsages::STORAGE),
            count: cells.len(),
        }
    }

    /// Voxels of all of them.
    pub(crate) fn voxels(&self) -> u64 {
        self.count as u64 * VOXELS
    }

    /// As what shaders know them by.
    pub(crate) fn entry(&self) -> Named<'_> {
        buffer("cells", &self.buffer)
    }

    /// Workgroups over all of them.
    pub(crate) fn workgroups(&self) -> [u32; 3] {
        single_workgroups(self.count.div_ceil(PER_WORKGROUP) as u32)
    }

    /// Bytes of the list.
    pub(crate) fn bytes(&self) -> u64 {
        self.buffer.size()
    }
}
