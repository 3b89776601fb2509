//! What attenuates light, as mean extinctions of blocks of voxels.

use crate::gpu::pipelines::binding::{Named, buffer};
use crate::gpu::pipelines::uniforms;
use crate::gpu::pipelines::variant::{Constants, Ends, Variant, flag, is_cut};
use crate::gpu::resources::pass;
use crate::gpu::volume::listed_cells::ListedCells;
use crate::gpu::volume::transfer_tables::Tables;
use crate::gpu::volume::{Gpu, brick_dims};
use crate::gpu::{GpuError, RenderOptions};
use crate::model::{Classification, Settings};
use crate::plan::{CellSet, stretch_reach};

/// The filling of blocks, by a shader that imports `sky/places.wgsl`.
#[derive(Debug, Clone, Copy)]
pub(crate) struct BlocksPass<'a> {
    pub shader: &'static str,
    /// Blocks along x, y and z.
    pub dims: [usize; 3],
    /// Voxels along the edge of a block.
    pub divisor: usize,
    /// Multiplies the extinction.
    pub density_scale: f64,
    /// What of light that is met is scattered.
    pub albedo: f64,
    /// Whether what is filled is for light that has one colour all through.
    pub one_color: bool,
    /// Of the texture that is filled.
    pub format: wgpu::TextureFormat,
    /// Blocks in which anything may attenuate light ([`met`]).
    pub cells: &'a ListedCells,
    pub tables: &'a Tables,
    pub settings: &'a Settings,
}

/// The level of the pyramid whose texels are as large as an eighth of a block of `divisor`³ voxels; of one voxel, that.
fn level_of(divisor: usize) -> f64 {
    (divisor as f64 / 2.0).max(1.0).log2()
}

/// Cells of blocks of `divisor`³ voxels in which anything may attenuate light, of a grid of so many blocks.
pub(crate) fn met(tables: &Tables, options: &RenderOptions, dims: [usize; 3], divisor: usize) -> CellSet {
    let bricks = brick_dims(dims);
    if !options.empty_space_skipping {
        return CellSet::full(bricks);
    }
    // Places of a block lie at most as many cells from that of its middle as it has voxels in half its edge.
    let reach = stretch_reach(level_of(divisor)).saturating_add((divisor / 2) as u8);
    tables.lighting.around(reach, divisor, bricks)
}

impl BlocksPass<'_> {
    /// Records it; what is filled and what more the shader reads is among the `entries`.
    pub(crate) fn record(
        &self,
        gpu: Gpu<'_>,
        entries: &[Named<'_>],
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<(), GpuError> {
        let Self { shader, dims, divisor, density_scale, albedo, cells, tables, settings, .. } = *self;
        let scene = &gpu.volume.scene;
        let shading = settings.cuts.shading();
        let variant = BlocksVariant {
            shader,
            one_color: self.one_color,
            ends: gpu.volume.ends_of_all(),
            is_cut: is_cut(shading),
            classification: settings.sampling.classification,
        };
        let pipeline = gpu.shaders.pipeline_into(&variant, self.format)?;
        let uniform = uniforms::Blocks {
            dims: dims.map(|n| n as u32),
            voxel_step: divisor as f32,
            level: level_of(divisor) as f32,
            // Eight places; a voxel is one.
            offset: if divisor == 1 { 0.0 } else { divisor as f32 / 4.0 },
            edge: (scene.smallest_edge() * density_scale) as f32,
            albedo: albedo as f32,
            shading_cut: uniforms::Cut::new(&shading.region(scene)),
        };
        let uniform = gpu.uniform("Blocks::uniform", uniform);
        let mut own = vec![
            buffer("bound_blocks", &uniform),
            buffer("table", tables.lighting.gathered()),
            cells.entry(),
        ];
        own.extend_from_slice(entries);
        let own = gpu.bind("Blocks::own", &pipeline, 0, &own);
        let of_volume = gpu.bind_pyramid_alone(&pipeline, tables.lighting_pyramids(gpu.volume).own);
        pass::dispatch(encoder, "Blocks::pass", &pipeline, &[&own, &of_volume], cells.workgroups());
        Ok(())
    }
}

/// What tells one pipeline that fills blocks from another.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
struct BlocksVariant {
    shader: &'static str,
    one_color: bool,
    ends: Ends,
    is_cut: bool,
    classification: Classification,
}

impl Variant for BlocksVariant {
    fn shader(&self) -> &'static str {
        self.shader
    }

    fn constants(&self) -> Constants {
        let mut constants = self.ends.constants().to_vec();
        constants.push(flag("ONE_COLOR", self.one_color));
        constants.push(flag("CUT", self.is_cut));
        constants.push(flag("PRECLASSIFY", self.classification == Classification::Pre));
        // What places are fetched from is the pyramid.
        constants.extend([("KERNEL", 2.0), ("STRETCH", 1.0)]);
        constants
    }
}
