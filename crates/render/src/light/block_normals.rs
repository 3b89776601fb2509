//! Normals of surfaces near blocks of voxels, by which the points of wide lights are weighted.

use super::light_volume::LightVolume;
use crate::pipelines::binding::{bind_buffer, bind_view, sampler};
use crate::pipelines::pipeline_variant::SingleVariant;
use crate::pipelines::uniforms;
use crate::plan::CellSet;
use crate::resources::pass;
use crate::sky::block_texture::BlockTexture;
use crate::sky::extinction_blocks::{BlocksPass, attenuating_cells, sample_offset};
use crate::volume::cell_list::CellList;
use crate::volume::transfer_tables::TransferTables;
use crate::volume::{GpuVolume, VolumeContext, brick_dims, texture_3d};
use crate::{GpuContext, GpuError, RenderOptions};
use chiaroscuro_scene::Settings;
use chiaroscuro_volume::CELL_EDGE;

/// Smallest edge of a block, in voxels. Normals are found up to two blocks from a surface: lights of more than 20° are
/// looked up at most 6 voxels from it, and narrower ones, whose weights hardly differ, at most 11.
const MIN_BLOCK_EDGE: usize = 4;

/// Normals of surfaces near the blocks that a light volume looks up, and temporary resources to find them.
#[derive(Debug)]
pub(crate) struct BlockNormals {
    pub normals: BlockTexture,
    /// Opacity of blocks, with a border of empty blocks around the grid.
    opacity: wgpu::TextureView,
    /// Blocks in which something may attenuate light.
    attenuating: CellList,
    /// Blocks that the light volume looks up.
    listed: CellList,
}

impl BlockNormals {
    /// Allocates normals for a light volume; nothing is filled yet.
    ///
    /// # Errors
    /// Returns an error if memory is exhausted.
    pub(crate) fn new(
        context: &GpuContext,
        volume: &GpuVolume,
        tables: &TransferTables,
        options: &RenderOptions,
        whole: &LightVolume,
    ) -> Result<Self, GpuError> {
        let divisor = (CELL_EDGE * whole.divisor).max(MIN_BLOCK_EDGE);
        let normals = BlockTexture::new(context, "BlockNormals::normals", volume.volume.dims(), divisor)?;
        let usages = wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::STORAGE_BINDING;
        let size = normals.dims.map(|n| n + 2);
        let opacity =
            context.texture(&texture_3d("BlockNormals::opacity", size, context.storage_format, usages))?;
        let attenuating = attenuating_cells(tables, options, normals.dims, divisor, 0);
        let listed =
            cells_around(&whole.filled_cells.cells, divisor / (CELL_EDGE * whole.divisor), normals.dims);
        Ok(Self {
            normals,
            opacity: opacity.create_view(&wgpu::TextureViewDescriptor::default()),
            attenuating: CellList::new(context, &attenuating),
            listed: CellList::new(context, &listed),
        })
    }

    /// Returns the size of all resources, in bytes.
    pub(crate) fn bytes(&self) -> u64 {
        let texel = u64::from(self.opacity.texture().format().block_copy_size(None).unwrap_or(4));
        let opacity = texel * self.normals.dims.iter().map(|&n| n as u64 + 2).product::<u64>();
        opacity + self.normals.bytes() + self.attenuating.bytes() + self.listed.bytes()
    }

    /// Records the passes that fill the normals, for a light with this factor of extinction.
    pub(crate) fn fill(
        &self,
        gpu: VolumeContext<'_>,
        tables: &TransferTables,
        settings: &Settings,
        density_scale: f64,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<(), GpuError> {
        let Self { normals, opacity, attenuating, listed } = self;
        let pass = BlocksPass {
            shader: "light/opacity_blocks.wgsl",
            dims: normals.dims,
            divisor: normals.divisor,
            sample_offset: sample_offset(normals.divisor, false),
            density_scale,
            albedo: 0.0,
            max_depth: f32::MAX,
            one_color: false,
            format: gpu.context.storage_format,
            cells: attenuating,
            tables,
            settings,
        };
        pass.record(gpu, &[bind_view("opacity", opacity)], encoder)?;
        let pipeline = gpu.shaders.pipeline(&SingleVariant("light/block_normals.wgsl"))?;
        let uniform = uniforms::BlockNormalsUniform {
            space: uniforms::SpaceUniform::new(&gpu.volume.scene),
            dims: normals.dims.map(|n| n as u32),
            pad0: 0,
            opacity_scale: normals.dims.map(|n| 1.0 / (n + 2) as f32),
            pad1: 0.0,
        };
        let uniform = gpu.uniform("BlockNormals::uniform", uniform);
        let entries = [
            bind_buffer("bound_near", &uniform),
            bind_view("opacity", opacity),
            sampler("clamped", &gpu.volume.clamped),
            listed.binding(),
            bind_view("normals", &normals.view),
        ];
        let own = gpu.bind("BlockNormals::bind_group", &pipeline, 0, &entries);
        pass::dispatch(encoder, "BlockNormals::pass", &pipeline, &[&own], listed.workgroups());
        Ok(())
    }
}

/// Returns the cells of blocks between which normals are interpolated in light cells: blocks have edges of `ratio`
/// light cells, and there are `dims` of them.
fn cells_around(filled: &CellSet, ratio: usize, dims: [usize; 3]) -> CellSet {
    let bricks = brick_dims(dims);
    let mut around = CellSet { dims: bricks, masks: vec![0; bricks.iter().product()] };
    for cell in filled.cubes_within(ratio) {
        // The block of the cells, and those beside it.
        let ends = cell.map(|at| [(at / ratio).saturating_sub(1), at / ratio + 1].map(|at| at / CELL_EDGE));
        for corner in 0..8 {
            around.insert([0, 1, 2].map(|axis| ends[axis][corner >> axis & 1]));
        }
    }
    around
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_beside_a_cell_are_listed() {
        let mut filled = CellSet { dims: [4; 3], masks: vec![0; 64] };
        filled.insert([0, 5, 8]);
        // Blocks 0 and 1, 4 to 6, and 7 to 9.
        let around = cells_around(&filled, 1, [16; 3]);
        let expected = [[0, 2, 3], [0, 3, 3], [0, 2, 4], [0, 3, 4]];
        assert!(around.count() == 4 && expected.iter().all(|&cell| around.contains(cell)), "{around:?}");
        // Blocks 0 and 1, 1 to 3, and 3 to 5.
        let around = cells_around(&filled, 2, [8; 3]);
        let expected = [[0, 0, 1], [0, 1, 1], [0, 0, 2], [0, 1, 2]];
        assert!(around.count() == 4 && expected.iter().all(|&cell| around.contains(cell)), "{around:?}");
    }
}
