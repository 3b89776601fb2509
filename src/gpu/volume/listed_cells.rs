//! Dispatches over lists of cells, decoded by `shaders/common/listed_cells.wgsl`.

use super::listed_bricks::{packed, single_workgroups};
use crate::gpu::Context;
use crate::gpu::pipelines::binding::{Named, buffer};
use crate::plan::CellSet;

/// Number of voxels in a cell.
const VOXELS: u64 = 8;

/// Number of cells per workgroup.
const PER_WORKGROUP: usize = 8;

/// List of cells of voxels or blocks, in the order of their bricks, in a storage buffer.
#[derive(Debug)]
pub(crate) struct ListedCells {
    buffer: wgpu::Buffer,
    count: usize,
}

impl ListedCells {
    /// Uploads the cells of a set.
    pub(crate) fn new(context: &Context, set: &CellSet) -> Self {
        let cells: Vec<u32> = set.cells().map(packed).collect();
        Self {
            buffer: context.buffer("ListedCells::buffer", &cells, wgpu::BufferUsages::STORAGE),
            count: cells.len(),
        }
    }

    /// Returns the number of voxels in all listed cells.
    pub(crate) fn voxels(&self) -> u64 {
        self.count as u64 * VOXELS
    }

    /// Binds the list under the name that shaders use.
    pub(crate) fn entry(&self) -> Named<'_> {
        buffer("cells", &self.buffer)
    }

    /// Returns the dispatch size for all listed cells.
    pub(crate) fn workgroups(&self) -> [u32; 3] {
        single_workgroups(self.count.div_ceil(PER_WORKGROUP) as u32)
    }

    /// Returns the size of the list, in bytes.
    pub(crate) fn bytes(&self) -> u64 {
        self.buffer.size()
    }
}
