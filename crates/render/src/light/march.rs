//! Light march, the first half of the light pass: fills sheets with the transmittance that they deposit.

use std::ops::Range;

use super::fill_inputs::{LightTables, LightWithSettings};
use crate::pipelines::binding::{NamedResource, bind_buffer, bind_view};
use crate::pipelines::pipeline_variant::{
    GridBoundaries, PipelineVariant, ReconstructionVariant, ShaderConstants, deposit_constant, flag, is_cut,
};
use crate::pipelines::uniforms;
use crate::plan::{LightView, sample_reach};
use crate::resources::gpu_tools::GpuTools;
use crate::resources::pass;
use crate::resources::sheet_ring::SheetRing;
use crate::volume::brick_list::one_workgroup_per_brick;
use crate::volume::transfer_tables::UNLIMITED_REACH;
use crate::volume::{PyramidLevels, VolumeContext};
use crate::{GpuError, TestSwitches};
use chiaroscuro_scene::{DepositMode, SceneLight, Settings};
use chiaroscuro_volume::math::ClipRegion;

/// Number of slabs that share a texel of the ring.
pub(crate) const SLABS_PER_TEXEL: u32 = 4;

/// Minimum size of the tile list, in bytes: for sheets of 1024 × 1024 pixels, so that few lights need another buffer.
const MIN_TILE_LIST_BYTES: u64 = 64 << 10;

/// Granularity of the ring's columns and rows, because sheets change their size as the light moves.
const RING_GRANULARITY: u32 = 32;

/// Sheets of one view of a light: a ring of layers through which the slabs stream.
#[derive(Debug)]
pub(crate) struct LightSheets {
    /// Number of layers in the ring, with [`SLABS_PER_TEXEL`] slabs each.
    pub layers: u32,
    /// Number of slabs marched at a time.
    pub chunk: u32,
    /// Transmittance at which light is no longer followed.
    pub min_transmittance: f32,
    /// `true` for previews, which may omit the tails of stretched kernels.
    pub is_preview: bool,
    pub ring: SheetRing,
    /// Number of cells beyond the visible ones in which sheets are read.
    pub reach: i32,
}

impl LightSheets {
    /// Creates the sheets, with a ring that holds `chunk` slabs and those before them that the reverse kernel still
    /// reads; reuses the pool's ring if that is suitable.
    ///
    /// Sheets are read up to `reach` cells from cells that are occupied in either transfer function.
    pub(crate) fn new(tools: &GpuTools, view: &LightView, chunk: u32, reach: i32) -> Result<Self, GpuError> {
        let pool = &tools.pool;
        let frame = &view.frame;
        // Radius 2 on both sides of a voxel, rounded up, and one for the quadrature points; the first slab may be the
        // last of its texel.
        let layers_kept = ((4.0 * view.kernel_slabs()).ceil() as u32 + 2).div_ceil(SLABS_PER_TEXEL) + 1;
        let chunk = chunk.min(frame.slab_count).next_multiple_of(SLABS_PER_TEXEL).max(SLABS_PER_TEXEL);
        let layers = chunk / SLABS_PER_TEXEL + layers_kept;
        let needed = [
            frame.size[0].next_multiple_of(RING_GRANULARITY),
            frame.size[1].next_multiple_of(RING_GRANULARITY),
            layers,
        ];
        let ring = match pool.take_ring().map(|known| known.reuse_or_new_size(needed)) {
            Some(Ok(known)) => known,
            Some(Err(larger)) => Self::make_ring(tools, larger)?,
            None => Self::make_ring(tools, needed)?,
        };
        let layers = ring.texture.depth_or_array_layers();
        let min_transmittance = TestSwitches::default().min_transmittance;
        Ok(Self { layers, chunk, min_transmittance, is_preview: false, ring, reach })
    }

    fn make_ring(GpuTools { context, pool, .. }: &GpuTools, size: [u32; 3]) -> Result<SheetRing, GpuError> {
        pool.record_new_ring();
        SheetRing::new(context, size)
    }

    /// Returns the bindings of group 0 for passes that march.
    pub(crate) fn march_entries<'a>(
        &'a self,
        uniform: &'a wgpu::Buffer,
        table: &'a wgpu::Buffer,
        distances: &'a wgpu::TextureView,
    ) -> [NamedResource<'a>; 5] {
        [
            bind_buffer("bound_march", uniform),
            bind_buffer("table", table),
            bind_view("distances", distances),
            bind_buffer("transmittance", &self.ring.transmittance),
            bind_view("ring", &self.ring.view),
        ]
    }
}

/// Pipeline variant of the march.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct MarchVariant {
    reconstruction: ReconstructionVariant,
    /// `true` if pixels are wider than voxels somewhere.
    is_stretched: bool,
    is_cut: bool,
    deposit: DepositMode,
    /// Channel of the gathered values that holds extinction.
    component: u32,
}

impl MarchVariant {
    /// Creates the variant; `is_stretched` tells if pixels are wider than voxels somewhere.
    pub(crate) fn from_settings(settings: &Settings, is_stretched: bool) -> Self {
        let shadows = &settings.shadows;
        Self {
            reconstruction: ReconstructionVariant::new(settings.light_kernel(), shadows.quadrature),
            is_stretched,
            is_cut: is_cut(settings.cuts.shadowing_part()),
            deposit: shadows.deposit,
            component: 0,
        }
    }

    /// Sets the grid boundaries that samples may meet, and the channel that holds extinction.
    fn with_boundaries(mut self, ends: GridBoundaries, component: u32) -> Self {
        self.reconstruction = self.reconstruction.with_boundaries(ends);
        self.component = component;
        self
    }
}

impl PipelineVariant for MarchVariant {
    fn shader(&self) -> &'static str {
        "light/march.wgsl"
    }

    fn constants(&self) -> ShaderConstants {
        let mut constants = self.reconstruction.constants();
        constants.extend([
            flag("STRETCH", self.is_stretched),
            flag("CUT", self.is_cut),
            deposit_constant(self.deposit),
            ("EXTINCTION_CHANNEL", f64::from(self.component)),
        ]);
        constants
    }
}

/// Builds the uniform for some slabs of a view: light, cut and sheets.
pub(crate) fn march_uniform(
    light: &SceneLight,
    shading_cut: &ClipRegion,
    view: &LightView,
    sheets: &LightSheets,
    slabs: Range<u32>,
) -> uniforms::MarchUniform {
    let cone = light.cone();
    uniforms::MarchUniform {
        frame: uniforms::SheetFrameUniform::new(&view.frame),
        begin: slabs.start,
        end: slabs.end,
        layers: sheets.layers,
        tiles: 0,
        extinction_scale: light.density_scale as f32,
        cone_cos_inner: cone.cos_inner as f32,
        cone_cos_outer: cone.cos_outer as f32,
        cone_axis: (view.axes.transpose() * cone.axis).as_vec3().into(),
        min_transmittance: sheets.min_transmittance,
        reach: sheets.reach,
        shading_cut: uniforms::CutUniform::new(shading_cut),
    }
}

/// Marches the listed tiles through some slabs of a view, for white light or one of its colours.
#[expect(clippy::too_many_arguments, reason = "each is another thing: who, what, how, where from, where to")]
pub(crate) fn march(
    gpu: VolumeContext<'_>,
    LightTables { tables, color }: LightTables<'_>,
    LightWithSettings { light, settings }: LightWithSettings<'_>,
    view: &LightView,
    sheets: &LightSheets,
    slabs: Range<u32>,
    tiles: &[u32],
    encoder: &mut wgpu::CommandEncoder,
) -> Result<(), GpuError> {
    let VolumeContext { context, shaders, volume, .. } = gpu;
    if tiles.is_empty() {
        return Ok(());
    }
    // Slabs near a perspective light have narrower pixels than those further away.
    let is_stretched = view.frame.max_stretch_level_of(slabs.clone()) > 0.0;
    let empty_space_skipping = sheets.reach != UNLIMITED_REACH;
    let seen = sample_reach(&view.frame, &volume.scene, settings.shadows.quadrature, sheets.is_preview);
    let dilation = if empty_space_skipping { i32::from(seen) } else { UNLIMITED_REACH };
    let lighting_table = tables.lighting_of_color(color);
    let ends = lighting_table.boundaries(volume, dilation, view.frame.max_stretch_level_of(slabs.clone()));
    let variant = MarchVariant::from_settings(settings, is_stretched)
        .with_boundaries(ends, lighting_table.extinction_channel);
    let pipeline = shaders.pipeline(&variant)?;
    let cut = settings.cuts.shadowing_part().region(&volume.scene);
    let count = tiles.len() as u32;
    let uniform = uniforms::MarchUniform { tiles: count, ..march_uniform(light, &cut, view, sheets, slabs) };
    let uniform = gpu.uniform("March::uniform", uniform);
    let list = gpu.storage_of_at_least(
        "March::tiles",
        &interleave_tiles(tiles, pass::driver_threads(context)),
        MIN_TILE_LIST_BYTES,
    );
    let mut entries =
        sheets.march_entries(&uniform, lighting_table.lookup_buffer(), &tables.light_distances).to_vec();
    entries.push(bind_buffer("tiles", &list));
    let own = gpu.bind("March::bind_group", &pipeline, 0, &entries);
    let levels = PyramidLevels::for_stretch(is_stretched);
    let of_volume = gpu.bind_volume(&pipeline, dilation, levels, tables.lighting_pyramids(volume));
    pass::dispatch(encoder, "March::pass", &pipeline, &[&own, &of_volume], one_workgroup_per_brick(count));
    Ok(())
}

/// Interleaves the tiles for the threads of a software driver, each of which processes a contiguous run of
/// workgroups.
///
/// All threads then work on neighbouring tiles at any time, and share expensive ones evenly.
fn interleave_tiles(tiles: &[u32], threads: u32) -> Vec<u32> {
    let threads = threads as usize;
    (0..threads).flat_map(|thread| tiles.iter().skip(thread).step_by(threads).copied()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_tile_is_interleaved_once() {
        assert_eq!(interleave_tiles(&[1, 2, 3, 4, 5], 2), [1, 3, 5, 2, 4]);
        assert_eq!(interleave_tiles(&[1, 2, 3], 1), [1, 2, 3]);
        assert_eq!(interleave_tiles(&[1, 2], 3), [1, 2]);
    }
}
