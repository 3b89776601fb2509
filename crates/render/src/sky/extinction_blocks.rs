//! Downsampled extinction: mean over blocks of voxels, for sweeps of light.

use std::sync::Arc;

use crate::pipelines::binding::{NamedResource, bind_buffer};
use crate::pipelines::pipeline_variant::{GridBoundaries, PipelineVariant, ShaderConstants, flag, is_cut};
use crate::pipelines::uniforms;
use crate::plan::{CellSet, stretch_reach};
use crate::resources::pass;
use crate::volume::cell_list::CellList;
use crate::volume::transfer_tables::TransferTables;
use crate::volume::{VolumeContext, brick_dims};
use crate::{GpuError, RenderOptions};
use chiaroscuro_scene::Settings;
use chiaroscuro_volume::CELL_EDGE;

/// Pass that fills blocks of extinction, with a shader that imports `sky/places.wgsl`.
#[derive(Debug, Clone, Copy)]
pub(crate) struct BlocksPass<'a> {
    pub shader: &'static str,
    /// Number of blocks along x, y and z.
    pub dims: [usize; 3],
    /// Number of voxels along the edge of a block.
    pub divisor: usize,
    /// Distance of the eight sample points from a block's centre along each axis, in voxels.
    pub sample_offset: f64,
    /// Factor applied to extinction.
    pub density_scale: f64,
    /// Fraction of attenuated light that is scattered rather than absorbed.
    pub albedo: f64,
    /// Largest optical depth per shortest edge of a voxel that a sample point counts for; only the sky has one.
    pub max_depth: f32,
    /// `true` if all light has the same colour.
    pub one_color: bool,
    /// Format of the texture that is filled.
    pub format: wgpu::TextureFormat,
    /// Cells of blocks in which something may attenuate light ([`attenuating_cells`]).
    pub cells: &'a CellList,
    pub tables: &'a TransferTables,
    pub settings: &'a Settings,
}

/// Returns the pyramid level with texels as large as an eighth of a block of `divisor`³ voxels; level 0 for single
/// voxels.
fn pyramid_level(divisor: usize) -> f64 {
    (divisor as f64 / 2.0).max(1.0).log2()
}

/// Returns the distance of sample points from the centre of a block along each axis, in voxels: for the mean over a
/// block, but for what single voxels hold unless they are smoothed.
///
/// A quarter of a voxel amid linearly interpolated texels spreads single voxels by a variance of 1/4, beside the 1/6 of
/// the prefiltered volume: 5/12, as the B-spline's 1/3 and the 1/12 of a mean over a voxel.
pub(crate) fn sample_offset(divisor: usize, is_smoothed: bool) -> f64 {
    if divisor == 1 && !is_smoothed { 0.0 } else { divisor as f64 / 4.0 }
}

/// Returns the cells of blocks of `divisor`³ voxels in which something may attenuate light, and those within `margin`
/// blocks of them; `dims` is the number of blocks.
pub(crate) fn attenuating_cells(
    tables: &TransferTables,
    options: &RenderOptions,
    dims: [usize; 3],
    divisor: usize,
    margin: usize,
) -> Arc<CellSet> {
    let bricks = brick_dims(dims);
    if !options.switches.empty_space_skipping {
        return Arc::new(CellSet::full(bricks));
    }
    // The sample points of a block are at most as many cells from its centre as half its edge has voxels.
    let around = divisor / 2 + (margin * divisor).div_ceil(CELL_EDGE);
    let reach = stretch_reach(pyramid_level(divisor)).saturating_add(around as u8);
    tables.attenuating_cells(reach, divisor, bricks)
}

impl BlocksPass<'_> {
    /// Records the pass; `entries` are the target and the additional bindings of the shader.
    pub(crate) fn record(
        &self,
        gpu: VolumeContext<'_>,
        entries: &[NamedResource<'_>],
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<(), GpuError> {
        let Self { shader, dims, divisor, cells, tables, settings, .. } = *self;
        let scene = &gpu.volume.scene;
        let shading = settings.cuts.shadowing_part();
        let variant = BlocksVariant {
            shader,
            one_color: self.one_color,
            ends: gpu.volume.possible_boundaries(),
            is_cut: is_cut(shading),
            is_preclassified: settings.classification().is_pre(),
            is_tinted: settings.has_tints(),
        };
        let pipeline = gpu.shaders.pipeline_into(&variant, self.format)?;
        let uniform = uniforms::BlocksUniform {
            dims: dims.map(|n| n as u32),
            voxel_step: divisor as f32,
            level: pyramid_level(divisor) as f32,
            offset: self.sample_offset as f32,
            edge: (scene.smallest_edge() * self.density_scale) as f32,
            albedo: self.albedo as f32,
            max_depth: self.max_depth,
            pad0: 0.0,
            pad1: 0.0,
            pad2: 0.0,
            shading_cut: uniforms::CutUniform::new(&shading.region(scene)),
        };
        let uniform = gpu.uniform("Blocks::uniform", uniform);
        let mut own = vec![
            bind_buffer("bound_blocks", &uniform),
            bind_buffer("table", tables.lighting.lookup_buffer()),
            cells.binding(),
        ];
        own.extend_from_slice(entries);
        let own = gpu.bind("Blocks::own", &pipeline, 0, &own);
        let of_volume = gpu.bind_pyramid(&pipeline, tables.lighting_pyramids(gpu.volume).primary);
        pass::dispatch(encoder, "Blocks::pass", &pipeline, &[&own, &of_volume], cells.workgroups());
        Ok(())
    }
}

/// Pipeline variant of the pass that fills blocks.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
struct BlocksVariant {
    shader: &'static str,
    one_color: bool,
    ends: GridBoundaries,
    is_cut: bool,
    is_preclassified: bool,
    is_tinted: bool,
}

impl PipelineVariant for BlocksVariant {
    fn shader(&self) -> &'static str {
        self.shader
    }

    fn constants(&self) -> ShaderConstants {
        let mut constants = self.ends.constants().to_vec();
        constants.push(flag("ONE_COLOR", self.one_color));
        constants.push(flag("CUT", self.is_cut));
        constants.push(flag("PRECLASSIFY", self.is_preclassified));
        constants.push(flag("TINTED", self.is_tinted));
        // Sample points are fetched from the pyramid: the prefiltered kernel, with stretch.
        constants.extend([("KERNEL", 2.0), ("STRETCH", 1.0)]);
        constants
    }
}
