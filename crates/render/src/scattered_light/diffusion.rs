//! Diffusion of scattered light, solved on coarser and coarser grids of blocks: what all later bounces make of the
//! change that the last sweep brought (diffusion synthetic acceleration: Alcouffe 1977, Larsen 1984).

use crate::pipelines::binding::{NamedResource, bind_buffer};
use crate::pipelines::pipeline_variant::{PipelineVariant, ShaderConstants, SingleVariant, flag};
use crate::pipelines::uniforms::DiffusionLevelUniform;
use crate::resources::pass;
use crate::sky::volume::SUM_BYTES;
use crate::volume::VolumeContext;
use crate::{GpuContext, GpuError};

/// Maximum number of blocks along each axis of the coarsest level: those of a workgroup of `diffusion/coarsest.wgsl`.
const COARSEST_EDGE: u32 = 4;

/// Number of last bounces before the visible one whose changes diffuse, beside the light before the first: with four
/// hardly anything is left, and cycles cost as much as sweeps in few directions.
const DIFFUSED_BOUNCES: u32 = 4;

/// Returns true if the light of later bounces is found before this one, of so many.
pub(super) fn diffuses(bounces: u32, bounce: u32) -> bool {
    bounces > 1 && (bounce == 0 || bounces - bounce <= DIFFUSED_BOUNCES)
}

/// Level of the grid, and its place in the lists.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct DiffusionLevel {
    dims: [u32; 3],
    first: u32,
}

impl DiffusionLevel {
    /// Returns the number of blocks.
    fn count(&self) -> u32 {
        self.dims.iter().product()
    }

    /// Returns the levels of a grid, from the finest to the coarsest; each has half of the blocks along each axis.
    fn all(finest: [u32; 3]) -> Vec<Self> {
        let mut level = Self { dims: finest, first: 0 };
        let mut levels = vec![level];
        while level.dims.iter().any(|&n| n > COARSEST_EDGE) {
            level = Self { dims: level.dims.map(|n| n.div_ceil(2)), first: level.first + level.count() };
            levels.push(level);
        }
        levels
    }
}

/// Buffers of a fill that the diffusion equation refers to.
#[derive(Debug, Clone, Copy)]
pub(super) struct DiffusionInputs<'a> {
    pub(super) scattering: &'a wgpu::Buffer,
    pub(super) received: &'a wgpu::Buffer,
    pub(super) single_scattering: &'a wgpu::Buffer,
    pub(super) previous: &'a wgpu::Buffer,
}

/// Buffers of the diffusion equation, with all levels in each.
#[derive(Debug)]
pub(super) struct DiffusionSolver {
    levels: Vec<DiffusionLevel>,
    /// Edges of the finest blocks, in shortest edges of a voxel.
    edges: [f32; 3],
    stencils: wgpu::Buffer,
    right_sides: wgpu::Buffer,
    /// Light of all later bounces, the finest level first.
    pub(super) solution: wgpu::Buffer,
    pub(super) bytes: u64,
}

impl DiffusionSolver {
    /// Allocates the buffers for a grid of blocks with these edges, in shortest edges of a voxel.
    pub(super) fn new(context: &GpuContext, dims: [usize; 3], edges: [f32; 3]) -> Self {
        let levels = DiffusionLevel::all(dims.map(|n| n as u32));
        let blocks: u64 = levels.iter().map(|level| u64::from(level.count())).sum();
        let list = |label| {
            context.uninitialised_buffer(&wgpu::BufferDescriptor {
                label: Some(label),
                size: SUM_BYTES * blocks,
                usage: wgpu::BufferUsages::STORAGE,
                mapped_at_creation: false,
            })
        };
        Self {
            levels,
            edges,
            stencils: list("Diffusion::stencils"),
            right_sides: list("Diffusion::right_sides"),
            solution: list("Diffusion::solution"),
            bytes: 3 * SUM_BYTES * blocks,
        }
    }

    /// Records the conductances of all levels, which follow from the scattering of the blocks.
    pub(super) fn record_stencils(
        &self,
        gpu: VolumeContext<'_>,
        scattering: &wgpu::Buffer,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<(), GpuError> {
        let entries = [bind_buffer("scattering", scattering), bind_buffer("stencils", &self.stencils)];
        let finest = self.levels[0].dims;
        self.record(gpu, 0, &SingleVariant("diffusion/stencil.wgsl"), &entries, finest, encoder)?;
        for at in 1..self.levels.len() {
            let entries = [bind_buffer("stencils", &self.stencils)];
            let dims = self.levels[at].dims;
            let variant = SingleVariant("diffusion/coarser_stencil.wgsl");
            self.record(gpu, at - 1, &variant, &entries, dims, encoder)?;
        }
        Ok(())
    }

    /// Records one cycle through all levels: its solution is the light of all later bounces, from what the last sweep
    /// changed or, before the first, from all that blocks scatter.
    pub(super) fn record_cycle(
        &self,
        gpu: VolumeContext<'_>,
        has_bounced: bool,
        inputs: DiffusionInputs<'_>,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<(), GpuError> {
        let [stencils, right_sides, solution] = self.entries();
        let entries = [
            stencils,
            right_sides,
            solution,
            bind_buffer("scattering", inputs.scattering),
            bind_buffer("received", inputs.received),
            bind_buffer("first", inputs.single_scattering),
            bind_buffer("last", inputs.previous),
        ];
        self.record(gpu, 0, &RightSideVariant { has_bounced }, &entries, self.levels[0].dims, encoder)?;
        let coarsest = self.levels.len() - 1;
        for at in 0..coarsest {
            // Even blocks are balanced where their right side is found.
            self.relax(gpu, at, RelaxVariant { parity: 1, corrects: false }, encoder)?;
            let variant = SingleVariant("diffusion/restrict.wgsl");
            self.record(gpu, at, &variant, &self.entries(), self.levels[at + 1].dims, encoder)?;
        }
        let variant = SingleVariant("diffusion/coarsest.wgsl");
        self.record(gpu, coarsest, &variant, &self.entries(), [1; 3], encoder)?;
        for at in (0..coarsest).rev() {
            // The correction is of even blocks, from which odd ones follow.
            self.relax(gpu, at, RelaxVariant { parity: 1, corrects: true }, encoder)?;
            self.relax(gpu, at, RelaxVariant { parity: 0, corrects: false }, encoder)?;
            self.relax(gpu, at, RelaxVariant { parity: 1, corrects: false }, encoder)?;
            self.relax(gpu, at, RelaxVariant { parity: 0, corrects: false }, encoder)?;
        }
        Ok(())
    }

    /// Returns the bindings of passes that balance blocks.
    fn entries(&self) -> [NamedResource<'_>; 3] {
        [
            bind_buffer("stencils", &self.stencils),
            bind_buffer("right_sides", &self.right_sides),
            bind_buffer("solution", &self.solution),
        ]
    }

    /// Records the relaxation of half of the blocks of a level.
    fn relax(
        &self,
        gpu: VolumeContext<'_>,
        level: usize,
        variant: RelaxVariant,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<(), GpuError> {
        let [x, y, z] = self.levels[level].dims;
        self.record(gpu, level, &variant, &self.entries(), [x.div_ceil(2), y, z], encoder)
    }

    /// Records a pass over a level with this number of threads along each axis.
    fn record(
        &self,
        gpu: VolumeContext<'_>,
        level: usize,
        variant: &impl PipelineVariant,
        entries: &[NamedResource<'_>],
        threads: [u32; 3],
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<(), GpuError> {
        let own = self.levels[level];
        let coarser = self.levels.get(level + 1).copied().unwrap_or(own);
        let uniform = DiffusionLevelUniform {
            dims: own.dims,
            first: own.first,
            coarser_dims: coarser.dims,
            coarser_first: coarser.first,
            edges: self.edges,
            pad0: 0.0,
        };
        let uniform = gpu.uniform("Diffusion::level", uniform);
        let mut all = vec![bind_buffer("bound_level", &uniform)];
        all.extend_from_slice(entries);
        let pipeline = gpu.shaders.pipeline(variant)?;
        let group = gpu.bind("Diffusion::level", &pipeline, 0, &all);
        pass::dispatch(encoder, "Diffusion::level", &pipeline, &[&group], threads.map(|n| n.div_ceil(4)));
        Ok(())
    }
}

/// Pipeline variant of the right side of the finest level.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
struct RightSideVariant {
    /// True if there was a sweep before.
    has_bounced: bool,
}

impl PipelineVariant for RightSideVariant {
    fn shader(&self) -> &'static str {
        "diffusion/right_side.wgsl"
    }

    fn constants(&self) -> ShaderConstants {
        vec![flag("HAS_BOUNCED", self.has_bounced)]
    }
}

/// Pipeline variant of the relaxation of half of the blocks.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
struct RelaxVariant {
    /// Parity of the sum of their coordinates.
    parity: u8,
    /// True if the coarser level corrects the solution of the other half.
    corrects: bool,
}

impl PipelineVariant for RelaxVariant {
    fn shader(&self) -> &'static str {
        "diffusion/relax.wgsl"
    }

    fn constants(&self) -> ShaderConstants {
        vec![("PARITY", f64::from(self.parity)), flag("CORRECTS", self.corrects)]
    }
}
