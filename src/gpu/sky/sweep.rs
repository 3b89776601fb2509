//! The march of light along the rays of a batch of directions.

use glam::DVec3;

use super::batches::{Batches, Rays};
use super::sheets::RaySheets;
use crate::gpu::GpuError;
use crate::gpu::pipelines::binding::{Named, buffer, sampler};
use crate::gpu::pipelines::uniforms;
use crate::gpu::pipelines::variant::{ColorVariant, Constants, Variant, flag};
use crate::gpu::resources::pass;
use crate::gpu::volume::Gpu;
use crate::plan::SweepFrame;

/// A batch of directions in which light is followed through blocks, by a shader that imports `sky/rays.wgsl`.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SweepPass<'a> {
    pub shader: &'static str,
    /// Whether light has one colour all through (`bounces/sweep.wgsl`).
    pub one_color: bool,
    pub rays: &'a [Rays],
    /// Blocks along x, y and z.
    pub dims: [usize; 3],
    /// What is filled: a layer for each slice of each direction, or for each direction.
    pub sheets: &'a RaySheets,
    /// Whether nothing has been summed before.
    pub is_first: bool,
    /// One over all directions: what makes their sum a mean.
    pub share: f32,
}

impl SweepPass<'_> {
    /// Records it: light that arrives from directions goes through blocks into sheets, both of which are among the `entries`.
    /// Returns what the passes that gather from these need to know.
    pub(crate) fn record(
        &self,
        gpu: Gpu<'_>,
        entries: &[Named<'_>],
        arriving: impl Fn(DVec3) -> DVec3,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<wgpu::Buffer, GpuError> {
        let Self { shader, one_color, rays, dims, sheets, is_first, share } = *self;
        let edge = gpu.volume.scene.smallest_edge();
        // What is left over has no weight, and no rays.
        let mut packed = [bytemuck::Zeroable::zeroed(); uniforms::MAX_SKY_RAYS];
        let mut layer = 0;
        let mut tiles: Vec<u32> = Vec::new();
        for (slot, Rays { frame, tiles: own }) in packed.iter_mut().zip(rays) {
            *slot = pack(frame, edge, (layer, tiles.len()), arriving(frame.towards));
            layer += frame.slices();
            tiles.extend(&own.0);
        }
        let reciprocal = |size: [usize; 3]| size.map(|n| 1.0 / n as f32);
        let uniform = uniforms::Sweep {
            dims: dims.map(|n| n as u32),
            share,
            block_scale: reciprocal(dims.map(|n| n + 2)),
            has_sums: if is_first { 0.0 } else { 1.0 },
            sheet_scale: reciprocal(sheets.size),
            pad0: 0.0,
            rays: packed,
        };
        let uniform = gpu.uniform("Sweep::uniform", uniform);
        let tiles = gpu.list("Sweep::tiles", &tiles);
        let pipeline = gpu.shaders.pipeline_into(&ColorVariant { shader, one_color }, sheets.format)?;
        let mut own = vec![
            buffer("bound_sweep", &uniform),
            sampler("clamped", &gpu.volume.clamped),
            buffer("tiles", &tiles),
        ];
        own.extend_from_slice(entries);
        let own = gpu.bind("Sweep::own", &pipeline, 0, &own);
        let [columns, rows, _] = sheets.size.map(|n| n.div_ceil(8) as u32);
        pass::dispatch(encoder, "Sweep::pass", &pipeline, &[&own], [columns, rows, rays.len() as u32]);
        Ok(uniform)
    }
}

/// The rays of a direction for the shaders, from which so much light arrives; `edge` is that of a voxel, and layer and tile are
/// the first among all.
fn pack(frame: &SweepFrame, edge: f64, (layer, tile): (usize, usize), arriving: DVec3) -> uniforms::SkyRays {
    uniforms::SkyRays {
        towards: frame.towards.as_vec3().into(),
        step: (frame.step / edge) as f32,
        drift: frame.drift.as_vec2().into(),
        first: frame.first.map(|at| at as f32),
        size: frame.size,
        axis: frame.axis as u32,
        rises: u32::from(frame.rises),
        arriving: arriving.as_vec3().into(),
        layer: layer as u32,
        weight: 1.0,
        first_tile: tile as u32,
        pad0: 0.0,
        pad1: 0.0,
    }
}

/// What tells one pipeline that gathers from a sweep from another.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct GatherVariant {
    pub shader: &'static str,
    /// Directions of a batch.
    directions: usize,
    /// Whether none comes after it, of a shader that stores the mean then.
    is_last: Option<bool>,
}

impl GatherVariant {
    /// That of a shader which stores no mean.
    pub(crate) fn of(shader: &'static str, batches: &Batches) -> Self {
        Self { shader, directions: batches.each(), is_last: None }
    }

    /// That of a shader which stores the mean when a batch is the last.
    pub(crate) fn with_mean(shader: &'static str, batches: &Batches, batch: usize) -> Self {
        Self { is_last: Some(batch + 1 == batches.count()), ..Self::of(shader, batches) }
    }
}

impl Variant for GatherVariant {
    fn shader(&self) -> &'static str {
        self.shader
    }

    fn constants(&self) -> Constants {
        let mut constants = vec![("DIRECTIONS", self.directions as f64)];
        constants.extend(self.is_last.map(|is_last| flag("IS_LAST", is_last)));
        constants
    }
}
