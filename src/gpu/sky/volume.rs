//! The volume of the sky's visibility.

use std::sync::Arc;

use super::floor_map::FloorMap;
use crate::gpu::pipelines::binding::view_of;
use crate::gpu::pipelines::variant::Only;
use crate::gpu::resources::fill_time::FillTime;
use crate::gpu::resources::pass;
use crate::gpu::volume::listed_cells::ListedCells;
use crate::gpu::volume::{Gpu, texture_3d};
use crate::gpu::{Context, GpuError};
use crate::math::SceneSpace;
use crate::model::Resolution;
use crate::plan::{CellSet, FloorPlace};

/// Bytes of four sums of a block.
pub(crate) const SUM_BYTES: u64 = 16;

/// Most texels that the rays of one direction may take: 128 MiB of sheets.
pub(crate) const MOST_TEXELS: u64 = 1 << 26;

/// How open to the sky each block of voxels is.
#[derive(Debug)]
pub(crate) struct SkyVolume {
    /// Blocks along x, y and z.
    pub dims: [usize; 3],
    /// Voxels along the edge of a block.
    pub divisor: usize,
    /// V₁ in rgb, V₀ in a.
    pub view: wgpu::TextureView,
    /// What the floor sees of the sky, where there was one when it was filled.
    pub floor: Option<FloorMap>,
    /// Cells (of blocks) that hold, or will hold, values.
    pub filled: Arc<CellSet>,
    /// Cells around them, which only previews look up: nothing is in the way of the sky there.
    pub margin: CellSet,
    /// How long it took.
    pub fill: FillTime,
    /// Counts up with every use; the least recently used goes first.
    pub last_used: u64,
}

impl SkyVolume {
    /// Makes the texture, of blocks of `divisor`³ voxels; nothing is filled yet.
    ///
    /// # Errors
    /// When memory is out.
    pub(crate) fn new(
        context: &Context,
        scene: &SceneSpace,
        divisor: usize,
        (filled, margin): (Arc<CellSet>, CellSet),
        floor: Option<FloorPlace>,
    ) -> Result<Self, GpuError> {
        let dims = scene.dims.map(|n| n.div_ceil(divisor));
        let texture = context.texture(&texture_3d(
            "SkyVolume::texture",
            dims,
            wgpu::TextureFormat::Rgba16Float,
            wgpu::TextureUsages::TEXTURE_BINDING
                | wgpu::TextureUsages::STORAGE_BINDING
                | wgpu::TextureUsages::COPY_SRC,
        ))?;
        let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
        let block = scene.smallest_edge() * divisor as f64;
        let floor = floor.map(|place| FloorMap::new(context, place, block)).transpose()?;
        Ok(Self { dims, divisor, view, floor, filled, margin, fill: FillTime::default(), last_used: 0 })
    }

    /// Opens the margin to all of the sky.
    pub(crate) fn clear_margin(
        &self,
        gpu: Gpu<'_>,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<(), GpuError> {
        let cells = ListedCells::new(gpu.context, &self.margin);
        let pipeline = gpu.shaders.pipeline(&Only("sky/clear_margin.wgsl"))?;
        let own = gpu.bind(
            "SkyVolume::clear_margin",
            &pipeline,
            0,
            &[cells.entry(), view_of("moments", &self.view)],
        );
        pass::dispatch(encoder, "SkyVolume::clear_margin", &pipeline, &[&own], cells.workgroups());
        Ok(())
    }

    /// Index space to texture coordinates: (p + ½) × lookup.
    pub(crate) fn lookup(&self) -> [f32; 3] {
        self.dims.map(|n| 1.0 / (n * self.divisor) as f32)
    }

    /// Bytes of its texture.
    pub(crate) fn bytes(&self) -> u64 {
        self.floor.as_ref().map_or(0, FloorMap::bytes)
            + 8 * self.dims.iter().map(|&n| n as u64).product::<u64>()
    }
}

/// Voxels along the edge of a block at a resolution, on an adapter, where the rays of one direction may take so many texels: see
/// [`divisor_for`].
pub(crate) fn divisor_on(
    context: &Context,
    grid: [usize; 3],
    resolution: Resolution,
    most_texels: u64,
) -> usize {
    let most_sums = context.device.limits().max_storage_buffer_binding_size / SUM_BYTES;
    divisor_for(grid, resolution, (most_texels, most_sums))
}

/// Voxels along the edge of a block: those of a resolution, or more where the rays of one direction would take more texels
/// than they may, or there would be more blocks than the adapter's buffers hold sums for.
fn divisor_for(grid: [usize; 3], resolution: Resolution, (most_texels, most_sums): (u64, u64)) -> usize {
    let mut divisor = resolution.divisor();
    let texels = |divisor: usize| {
        let [x, y, z] = grid.map(|n| n.div_ceil(divisor) as u64);
        // Rays drift by a block per slice at most.
        [[x, y, z], [y, z, x], [z, x, y]].map(|[a, b, c]| a * (a + b) * (a + c)).into_iter().max()
    };
    let blocks = |divisor: usize| grid.map(|n| n.div_ceil(divisor) as u64).iter().product::<u64>();
    while texels(divisor) > Some(most_texels) || blocks(divisor) > most_sums {
        divisor *= 2;
    }
    divisor
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn large_volumes_are_followed_in_larger_blocks() {
        let of = |n: usize, resolution| divisor_for([n; 3], resolution, (MOST_TEXELS, u64::MAX));
        assert_eq!(of(256, Resolution::Full), 1);
        assert_eq!(of(257, Resolution::Full), 2);
        assert_eq!(of(512, Resolution::Half), 2);
        assert_eq!(of(1024, Resolution::Half), 4);
        assert_eq!(of(2048, Resolution::Quarter), 8);
        // Of a row of voxels 256 blocks fit: their rays drift as far as they go.
        assert_eq!(divisor_for([4096, 1, 1], Resolution::Full, (MOST_TEXELS, u64::MAX)), 16);
        // The least that adapters bind is 128 MiB.
        let least = (128 << 20) / SUM_BYTES;
        assert_eq!(divisor_for([256; 3], Resolution::Full, (MOST_TEXELS, least)), 2);
        assert_eq!(divisor_for([203; 3], Resolution::Full, (MOST_TEXELS, least)), 1);
    }
}
