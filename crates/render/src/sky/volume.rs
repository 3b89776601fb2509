//! Sky-visibility volume: moments of transmittance over directions for blocks of voxels.

use std::sync::Arc;

use super::block_texture::BlockTexture;
use super::floor_map::FloorSkyMap;
use crate::pipelines::binding::bind_view;
use crate::pipelines::pipeline_variant::SingleVariant;
use crate::plan::{CellSet, FloorPlane};
use crate::resources::fill_time::FillStopwatch;
use crate::resources::pass;
use crate::volume::VolumeContext;
use crate::volume::cell_list::CellList;
use crate::{GpuContext, GpuError};
use chiaroscuro_scene::LightVolumeResolution;
use chiaroscuro_volume::math::SceneSpace;

/// Size of a block's four sums, in bytes.
pub(crate) const SUM_BYTES: u64 = 16;

/// Maximum number of texels for the rays of one direction: 128 MiB of sheets.
pub(crate) const MAX_DIRECTION_TEXELS: u64 = 1 << 26;

/// Sky visibility of blocks of voxels.
#[derive(Debug)]
pub(crate) struct SkyVolume {
    /// Moments of each block: V₁ in rgb, V₀ in a.
    pub blocks: BlockTexture,
    /// Sky-visibility map of the floor, if there was a floor when the volume was filled.
    pub floor: Option<FloorSkyMap>,
    /// Cells (of blocks) that hold values, or will when the volume is complete.
    pub filled_cells: Arc<CellSet>,
    /// Cells around the filled ones, which only previews look up and which see the whole sky.
    pub margin: CellSet,
    /// Stopwatch for the filling of the volume.
    pub fill_time: FillStopwatch,
}

/// Extent of a sky-visibility volume that is to be filled.
#[derive(Debug)]
pub(crate) struct SkyVolumeExtent {
    /// Cells (of blocks) to be filled.
    pub filled: Arc<CellSet>,
    /// Cells around the filled ones, to be cleared.
    pub margin: CellSet,
    /// Extent of the floor, if there is one.
    pub floor: Option<FloorPlane>,
}

impl SkyVolume {
    /// Creates the texture, for blocks of `divisor`³ voxels; nothing is filled yet.
    ///
    /// # Errors
    /// Returns an error if memory is exhausted.
    pub(crate) fn new(
        context: &GpuContext,
        scene: &SceneSpace,
        divisor: usize,
        SkyVolumeExtent { filled, margin, floor }: SkyVolumeExtent,
    ) -> Result<Self, GpuError> {
        let blocks = BlockTexture::new(context, "SkyVolume::texture", scene.dims, divisor)?;
        let block = scene.smallest_edge() * divisor as f64;
        let floor = floor.map(|place| FloorSkyMap::new(context, place, block)).transpose()?;
        Ok(Self { blocks, floor, filled_cells: filled, margin, fill_time: FillStopwatch::default() })
    }

    /// Sets the cells of the margin to an unoccluded sky.
    pub(crate) fn clear_margin(
        &self,
        gpu: VolumeContext<'_>,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<(), GpuError> {
        let cells = CellList::new(gpu.context, &self.margin);
        let pipeline = gpu.shaders.pipeline(&SingleVariant("sky/clear_margin.wgsl"))?;
        let own = gpu.bind(
            "SkyVolume::clear_margin",
            &pipeline,
            0,
            &[cells.binding(), bind_view("moments", &self.blocks.view)],
        );
        pass::dispatch(encoder, "SkyVolume::clear_margin", &pipeline, &[&own], cells.workgroups());
        Ok(())
    }

    /// Returns the size of the textures, in bytes.
    pub(crate) fn bytes(&self) -> u64 {
        self.floor.as_ref().map_or(0, FloorSkyMap::bytes) + self.blocks.bytes()
    }
}

/// Returns the number of voxels along the edge of a block for an adapter, at a resolution, with at most `most_texels`
/// for the rays of one direction; see [`divisor_for`].
pub(crate) fn divisor_for_adapter(
    context: &GpuContext,
    grid: [usize; 3],
    resolution: LightVolumeResolution,
    most_texels: u64,
) -> usize {
    let most_sums = context.device.limits().max_storage_buffer_binding_size / SUM_BYTES;
    divisor_for(grid, resolution, most_texels, most_sums)
}

/// Returns the number of voxels along the edge of a block.
///
/// It is that of the resolution, doubled until the rays of one direction are within `most_texels`, and the blocks
/// within the number of sums that a buffer of the adapter holds.
fn divisor_for(
    grid: [usize; 3],
    resolution: LightVolumeResolution,
    most_texels: u64,
    most_sums: u64,
) -> usize {
    let mut divisor = resolution.divisor();
    let texels = |divisor: usize| {
        let [x, y, z] = grid.map(|n| n.div_ceil(divisor) as u64);
        // Rays drift by at most one block per slice.
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
        let of = |n: usize, resolution| divisor_for([n; 3], resolution, MAX_DIRECTION_TEXELS, u64::MAX);
        assert_eq!(of(256, LightVolumeResolution::Full), 1);
        assert_eq!(of(257, LightVolumeResolution::Full), 2);
        assert_eq!(of(512, LightVolumeResolution::Half), 2);
        assert_eq!(of(1024, LightVolumeResolution::Half), 4);
        assert_eq!(of(2048, LightVolumeResolution::Quarter), 8);
        // In a single row of voxels the rays drift as far as they advance, so only 256 blocks are possible.
        assert_eq!(
            divisor_for([4096, 1, 1], LightVolumeResolution::Full, MAX_DIRECTION_TEXELS, u64::MAX),
            16
        );
        // The smallest limit on bindings of all adapters is 128 MiB.
        let least = (128 << 20) / SUM_BYTES;
        assert_eq!(divisor_for([256; 3], LightVolumeResolution::Full, MAX_DIRECTION_TEXELS, least), 2);
        assert_eq!(divisor_for([203; 3], LightVolumeResolution::Full, MAX_DIRECTION_TEXELS, least), 1);
    }
}
