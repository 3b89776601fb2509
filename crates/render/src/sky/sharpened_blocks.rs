//! Extinction of blocks with sharp surfaces, through which sweeps follow the light of a sky.

use super::block_texture::BlockTexture;
use super::surfaces::SurfaceBlocks;
use crate::pipelines::binding::{bind_buffer, bind_view};
use crate::pipelines::pipeline_variant::SingleVariant;
use crate::plan::CellSet;
use crate::resources::pass;
use crate::volume::cell_list::CellList;
use crate::volume::{VolumeContext, texture_3d};
use crate::{GpuContext, GpuError};

/// Largest optical depth per shortest edge of a voxel that a sample point of a block counts for, if material has
/// surfaces. Rays start from where half of it is, at an opacity of 0.8. A block of one voxel lets 5 % of the light
/// pass.
pub(crate) const SOLID_DEPTH: f32 = 3.0;

/// Texture of extinction that falls through 0 at the surfaces of dense material, with a border of empty blocks.
#[derive(Debug)]
pub(crate) struct SharpenedBlocks {
    pub view: wgpu::TextureView,
    /// Cells of blocks that attenuate light or are beside such blocks.
    cells: CellList,
    bytes: u64,
}

impl SharpenedBlocks {
    /// Creates the texture for blocks of which `cells` attenuate light or are beside those that do.
    ///
    /// # Errors
    /// Returns an error if memory is exhausted.
    pub(crate) fn new(context: &GpuContext, dims: [usize; 3], cells: &CellSet) -> Result<Self, GpuError> {
        let usages = wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::STORAGE_BINDING;
        let (size, format) = (dims.map(|n| n + 2), context.storage_format);
        let texture = context.texture(&texture_3d("SharpenedBlocks::texture", size, format, usages))?;
        let cells = CellList::new(context, cells);
        let texel = u64::from(format.block_copy_size(None).unwrap_or(4));
        let bytes = texel * size.iter().map(|&n| n as u64).product::<u64>() + cells.bytes();
        Ok(Self { view: texture.create_view(&wgpu::TextureViewDescriptor::default()), cells, bytes })
    }

    /// Records the pass that sharpens the extinction of all blocks.
    pub(crate) fn fill(
        &self,
        gpu: VolumeContext<'_>,
        blocks: &BlockTexture,
        extinction: &wgpu::TextureView,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<(), GpuError> {
        let pipeline = gpu.shaders.pipeline(&SingleVariant("sky/sharpened_blocks.wgsl"))?;
        let geometry = SurfaceBlocks::geometry(gpu, blocks, 0, true);
        let entries = [
            bind_view("extinction", extinction),
            bind_view("sharpened", &self.view),
            self.cells.binding(),
            bind_buffer("bound_geometry", &geometry),
        ];
        let own = gpu.bind("SharpenedBlocks::fill", &pipeline, 0, &entries);
        pass::dispatch(encoder, "SharpenedBlocks::fill", &pipeline, &[&own], self.cells.workgroups());
        Ok(())
    }

    /// Returns the size of the texture and of the list of cells, in bytes.
    pub(crate) fn bytes(&self) -> u64 {
        self.bytes
    }
}
