//! Compositing of every footprint separately: the voxels of a slice are drawn in phases, so that no two footprints of
//! a dispatch share a pixel.

use super::splat::{ScatterVariant, SheetScatterer};
use super::voxels::ScatterState;
use crate::GpuError;
use crate::eye::eye_pass::EyePass;
use crate::eye::light_lookup::{LightLookup, light_bind_group};
use crate::pipelines::binding::{bind_buffer, bind_view, sampler};
use crate::pipelines::pipeline_variant::{PipelineVariant, ShaderConstants, ShadingVariant};
use crate::pipelines::uniforms;
use crate::pipelines::uniforms::FootprintPhaseUniform;
use crate::resources::pass;
use crate::volume::{PyramidLevels, VolumeContext};
use chiaroscuro_volume::BRICK_EDGE;

/// Pipeline variant of the pass that composites footprints.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
struct FootprintsVariant {
    shading: ShadingVariant,
    footprints: ScatterVariant,
}

impl PipelineVariant for FootprintsVariant {
    fn shader(&self) -> &'static str {
        "scatter/footprints.wgsl"
    }

    fn constants(&self) -> ShaderConstants {
        let mut constants = self.shading.constants();
        constants.extend(self.footprints.constants());
        constants
    }
}

/// Inputs and target of compositing a slice.
#[derive(Clone, Copy)]
pub(crate) struct FootprintInputs<'a> {
    pub scattering: &'a ScatterState,
    pub eye: &'a EyePass,
    /// Uniform buffer of the eye.
    pub eye_uniform: &'a wgpu::Buffer,
    /// Transfer function of the eye.
    pub table: &'a wgpu::Buffer,
    /// Light volumes in the order of the lights.
    pub looked_up: LightLookup<'a>,
    /// Accumulated colour and opacity of each ray.
    pub rays: &'a wgpu::Buffer,
    pub clamped: &'a wgpu::Sampler,
}

/// Phases of a slice, each with footprints that do not overlap.
#[derive(Debug)]
pub(crate) struct FootprintPhases {
    phases: Vec<wgpu::Buffer>,
}

impl FootprintPhases {
    /// Creates the phases.
    ///
    /// Footprints of radius 2s (in voxels, s the stretch) do not overlap if their voxels are 4s · √3 apart in a
    /// slice: the line of sight deviates from its axis at most as far as a cube's diagonal.
    pub(crate) fn new(gpu: VolumeContext<'_>, scatterer: &SheetScatterer) -> Result<Self, GpuError> {
        let apart = 4.0 * 3f64.sqrt() * scatterer.max_stretch();
        let stride = (apart / BRICK_EDGE as f64).ceil() as u32;
        // Pictures with pixels this wide are smaller than thumbnails.
        if stride > 4 {
            return Err(GpuError::OverLimit {
                what: "the width of footprints, in bricks,".to_owned(),
                size: u64::from(stride),
                limit: 4,
                help: "choose a larger picture or another order of sheets",
            });
        }
        let edge = BRICK_EDGE as u32;
        let phases = (0..stride * stride * edge * edge)
            .map(|at| {
                let (within, brick) = (at % (edge * edge), at / (edge * edge));
                let phase = FootprintPhaseUniform {
                    u: within % edge,
                    v: within / edge,
                    brick_u: brick % stride,
                    brick_v: brick / stride,
                    stride,
                    pad0: 0,
                    pad1: 0,
                    pad2: 0,
                };
                gpu.context.buffer("Footprints::phase", &[phase], wgpu::BufferUsages::UNIFORM)
            })
            .collect();
        Ok(Self { phases })
    }

    /// Composites slice `k` into the rays.
    pub(crate) fn draw(
        &self,
        gpu: VolumeContext<'_>,
        scatterer: &SheetScatterer,
        FootprintInputs { scattering, eye, eye_uniform, table, looked_up, rays, clamped }: FootprintInputs<
            '_,
        >,
        k: u32,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<(), GpuError> {
        if !scatterer.is_filled(k) {
            return Ok(());
        }
        let VolumeContext { context, shaders, .. } = gpu;
        // Footprints carry the densities of voxels, which are classified one by one.
        let shading = ShadingVariant { is_preclassified: false, ..eye.shading_variant() };
        let variant = FootprintsVariant { shading, footprints: scatterer.variant() };
        let pipeline = shaders.pipeline(&variant)?;
        let own = pass::bind(
            context,
            "Footprints::bind_group",
            &pipeline,
            0,
            &[
                bind_buffer("bound_eye", eye_uniform),
                bind_buffer("table", table),
                bind_buffer("first_words", &scattering.voxels.first_words),
                bind_buffer("bricks", scatterer.bricks()),
                bind_buffer("splats", &scattering.counter),
                bind_buffer("voxels", &scattering.voxels.buffer),
            ],
        );
        let uniform: uniforms::ScatterSlabUniform = scatterer.uniform(k, 1.0);
        let slab = context.buffer("Footprints::slice", &[uniform], wgpu::BufferUsages::UNIFORM);
        let grid = gpu.uniform("Volume::grid", gpu.volume.grid(0));
        let shared = pass::bind(
            context,
            "Footprints::rays",
            &pipeline,
            1,
            &[
                bind_buffer("bound_grid", &grid),
                bind_view("presence_texture", gpu.presence(PyramidLevels::Finest)),
                bind_view("tint_pyramid", gpu.placeholder),
                bind_buffer("bound_scatter", &slab),
                bind_buffer("footprint_table", scatterer.footprints()),
                bind_buffer("rays", rays),
                sampler("clamped", clamped),
            ],
        );
        let of_lights = light_bind_group(gpu, &pipeline, looked_up);
        for phase in &self.phases {
            let turn =
                pass::bind(context, "Footprints::phase", &pipeline, 3, &[bind_buffer("bound_phase", phase)]);
            let groups = [&own, &shared, &of_lights, &turn];
            pass::dispatch(
                encoder,
                "Footprints::draw",
                &pipeline,
                &groups,
                [uniform.count.div_ceil(64), 1, 1],
            );
        }
        Ok(())
    }
}
