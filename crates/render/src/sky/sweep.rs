//! Sweep of light along the parallel rays of a batch of directions.

use glam::DVec3;

use super::direction_batches::{DirectionBatches, DirectionRays};
use super::sheets::RaySheets;
use crate::GpuError;
use crate::pipelines::binding::{NamedResource, bind_buffer, sampler};
use crate::pipelines::pipeline_variant::{ColorVariant, PipelineVariant, ShaderConstants, flag};
use crate::pipelines::uniforms;
use crate::plan::SweepFrame;
use crate::resources::pass;
use crate::volume::VolumeContext;

/// Pass that sweeps light through blocks in a batch of directions, with a shader that imports `sky/rays.wgsl`.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SweepPass<'a> {
    pub shader: &'static str,
    /// `true` if all light has the same colour (`scattered_light/sweep.wgsl`).
    pub one_color: bool,
    pub rays: &'a [DirectionRays],
    /// Number of blocks along x, y and z.
    pub dims: [usize; 3],
    /// Target: a layer for each slice of each direction, or one for each direction.
    pub sheets: &'a RaySheets,
    /// `true` for the first batch, before which the sums are undefined.
    pub is_first: bool,
    /// One over the number of directions, which turns sums into means.
    pub share: f32,
}

impl SweepPass<'_> {
    /// Records the pass; `entries` include the blocks that light passes through and the target sheets. `arriving` is
    /// the radiance that enters the grid from a direction. Returns the uniform, which the pass that gathers from the
    /// sheets also binds.
    pub(crate) fn record(
        &self,
        gpu: VolumeContext<'_>,
        entries: &[NamedResource<'_>],
        radiance: impl Fn(DVec3) -> DVec3,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<wgpu::Buffer, GpuError> {
        let Self { shader, one_color, rays, dims, sheets, is_first, share } = *self;
        let edge = gpu.volume.scene.smallest_edge();
        // Unused slots of the uniform have weight 0 and no rays.
        let mut packed = [bytemuck::Zeroable::zeroed(); uniforms::MAX_BATCH_DIRECTIONS];
        let mut layer = 0;
        let mut tiles: Vec<u32> = Vec::new();
        for (slot, DirectionRays { frame, tiles: own }) in packed.iter_mut().zip(rays) {
            *slot = pack_rays(frame, edge, layer, tiles.len(), radiance(frame.towards));
            layer += frame.slices();
            tiles.extend(&own.0);
        }
        let reciprocal = |size: [usize; 3]| size.map(|n| 1.0 / n as f32);
        let uniform = uniforms::SweepUniform {
            dims: dims.map(|n| n as u32),
            share,
            block_scale: reciprocal(dims.map(|n| n + 2)),
            has_sums: if is_first { 0.0 } else { 1.0 },
            sheet_scale: reciprocal(sheets.size),
            pad0: 0.0,
            rays: packed,
        };
        let uniform = gpu.uniform("Sweep::uniform", uniform);
        let tiles = gpu.storage("Sweep::tiles", &tiles);
        let pipeline = gpu.shaders.pipeline_into(&ColorVariant { shader, one_color }, sheets.format)?;
        let mut own = vec![
            bind_buffer("bound_sweep", &uniform),
            sampler("clamped", &gpu.volume.clamped),
            bind_buffer("tiles", &tiles),
        ];
        own.extend_from_slice(entries);
        let own = gpu.bind("Sweep::own", &pipeline, 0, &own);
        let [columns, rows, _] = sheets.size.map(|n| n.div_ceil(8) as u32);
        pass::dispatch(encoder, "Sweep::pass", &pipeline, &[&own], [columns, rows, rays.len() as u32]);
        Ok(uniform)
    }
}

/// Packs the rays of a direction for the shaders; `edge` is that of a voxel, and `layer` and `tile` are the first
/// ones of this direction.
fn pack_rays(
    frame: &SweepFrame,
    edge: f64,
    layer: usize,
    tile: usize,
    arriving: DVec3,
) -> uniforms::SweepRaysUniform {
    uniforms::SweepRaysUniform {
        direction_to_light: frame.towards.as_vec3().into(),
        step: (frame.step / edge) as f32,
        drift: frame.drift.as_vec2().into(),
        first: frame.first.map(|at| at as f32),
        size: frame.size,
        axis: frame.axis as u32,
        is_ascending: u32::from(frame.is_ascending),
        incoming_radiance: arriving.as_vec3().into(),
        layer: layer as u32,
        weight: 1.0,
        first_tile: tile as u32,
        pad0: 0.0,
        pad1: 0.0,
    }
}

/// Pipeline variant of a pass that gathers from swept sheets.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct SweepGatherVariant {
    pub shader: &'static str,
    /// Number of directions in a batch.
    directions: usize,
    /// `true` for the last batch, which stores the mean; `None` for shaders that store no mean.
    is_last: Option<bool>,
}

impl SweepGatherVariant {
    /// Creates the variant of a shader that stores no mean.
    pub(crate) fn new(shader: &'static str, batches: &DirectionBatches) -> Self {
        Self { shader, directions: batches.directions_per_batch(), is_last: None }
    }

    /// Creates the variant of a shader that stores the mean after the last batch.
    pub(crate) fn with_mean(shader: &'static str, batches: &DirectionBatches, batch: usize) -> Self {
        Self { is_last: Some(batch + 1 == batches.count()), ..Self::new(shader, batches) }
    }
}

impl PipelineVariant for SweepGatherVariant {
    fn shader(&self) -> &'static str {
        self.shader
    }

    fn constants(&self) -> ShaderConstants {
        let mut constants = vec![("DIRECTIONS", self.directions as f64)];
        constants.extend(self.is_last.map(|is_last| flag("IS_LAST", is_last)));
        constants
    }
}
