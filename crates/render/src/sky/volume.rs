//! Sky-visibility volume: moments of transmittance over directions for blocks of voxels.

use std::sync::Arc;

use super::floor_map::FloorSkyMap;
use crate::pipelines::binding::bind_view;
use crate::pipelines::pipeline_variant::SingleVariant;
use crate::plan::{CellSet, FloorPlane};
use crate::resources::fill_time::FillStopwatch;
use crate::resources::pass;
use crate::volume::cell_list::CellList;
use crate::volume::{VolumeContext, texture_3d};
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
    /// Number of blocks along x, y and z.
    pub dims: [usize; 3],
    /// Number of voxels along the edge of a block.
    pub divisor: usize,
    /// View of the moments: V₁ in rgb, V₀ in a.
    pub view: wgpu::TextureView,
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
        let floor = floor.map(|place| FloorSkyMap::new(context, place, block)).transpose()?;
        Ok(Self {
            dims,
            divisor,
            view,
            floor,
            filled_cells: filled,
            margin,
            fill_time: FillStopwatch::default(),
        })
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
            &[cells.binding(), bind_view("moments", &self.view)],
        );
        pass::dispatch(encoder, "SkyVolume::clear_margin", &pipeline, &[&own], cells.workgroups());
        Ok(())
    }

    /// Returns the scale from index space to texture coordinates: (p + ½) × lookup.
    pub(crate) fn lookup(&self) -> [f32; 3] {
        self.dims.map(|n| 1.0 / (n * self.divisor) as f32)
    }

    /// Returns the size of the textures, in bytes.
    pub(crate) fn bytes(&self) -> u64 {
        self.floor.as_ref().map_or(0, FloorSkyMap::bytes)
            + 8 * self.dims.iter().map(|&n| n as u64).product::<u64>()
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
