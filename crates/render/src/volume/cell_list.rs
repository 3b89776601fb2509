//! Dispatches over lists of cells, decoded by `shaders/common/listed_cells.wgsl`.

use super::brick_list::{one_workgroup_per_brick, pack_coordinates};
use crate::GpuContext;
use crate::pipelines::binding::{NamedResource, bind_buffer};
use crate::plan::CellSet;

/// Number of voxels in a cell.
const VOXELS_PER_CELL: u64 = 8;

/// Number of cells per workgroup.
const CELLS_PER_WORKGROUP: usize = 8;

/// List of cells of voxels or blocks, in the order of their bricks, in a storage buffer.
#[derive(Debug)]
pub(crate) struct CellList {
    buffer: wgpu::Buffer,
    count: usize,
}

impl CellList {
    /// Uploads the cells of a set.
    pub(crate) fn new(context: &GpuContext, set: &CellSet) -> Self {
        let cells: Vec<u32> = set.cells().map(pack_coordinates).collect();
        Self {
            buffer: context.buffer("ListedCells::buffer", &cells, wgpu::BufferUsages::STORAGE),
            count: cells.len(),
        }
    }

    /// Returns the number of voxels in all listed cells.
    pub(crate) fn voxel_count(&self) -> u64 {
        self.count as u64 * VOXELS_PER_CELL
    }

    /// Binds the list under the name that shaders use.
    pub(crate) fn binding(&self) -> NamedResource<'_> {
        bind_buffer("cells", &self.buffer)
    }

    /// Returns the dispatch size for all listed cells.
    pub(crate) fn workgroups(&self) -> [u32; 3] {
        one_workgroup_per_brick(self.count.div_ceil(CELLS_PER_WORKGROUP) as u32)
    }

    /// Returns the size of the list, in bytes.
    pub(crate) fn bytes(&self) -> u64 {
        self.buffer.size()
    }
}
