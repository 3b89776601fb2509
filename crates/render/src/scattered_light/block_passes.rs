//! Passes over all blocks of scattered light between its sweeps: light received, steps of the series, and the result.

use super::textures::ScatteringTextures;
use super::volume::ScatteredLightVolume;
use crate::GpuError;
use crate::pipelines::binding::{NamedResource, bind_buffer, bind_view};
use crate::pipelines::pipeline_variant::{PipelineVariant, ShaderConstants, flag};
use crate::resources::pass;
use crate::volume::VolumeContext;
use crate::volume::cell_list::CellList;

/// Passes over all blocks, and what they share.
pub(super) struct BlockPasses<'a> {
    pub(super) gpu: VolumeContext<'a>,
    /// Uniform of `scattered_light/bounce.wgsl`.
    pub(super) shared: wgpu::Buffer,
    pub(super) textures: &'a ScatteringTextures,
    /// Light of all later bounces.
    pub(super) solution: &'a wgpu::Buffer,
    /// Blocks that pictures look up.
    pub(super) output_cells: &'a CellList,
    pub(super) volume: &'a ScatteredLightVolume,
}

impl BlockPasses<'_> {
    /// Records the pass that turns the sums of a sweep into the light that blocks receive; if it `sharpens`, without
    /// what the interpolation between rays has spread.
    pub(super) fn record_received_light(
        &self,
        sharpens: bool,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<(), GpuError> {
        self.record(&ReceivedLightVariant { sharpens }, encoder)
    }

    /// Records one of the passes.
    pub(super) fn record(
        &self,
        variant: &impl PipelineVariant,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<(), GpuError> {
        let Self { gpu, textures, volume, .. } = *self;
        let shader = variant.shader();
        let mut entries: Vec<NamedResource<'_>> = vec![bind_buffer("bound_bounce", &self.shared)];
        let mut groups = workgroups_over_blocks(volume);
        match shader {
            "scattered_light/result.wgsl" => {
                groups = self.output_cells.workgroups();
                entries.extend([
                    bind_buffer("sums", &textures.sums),
                    bind_view("bounced", &volume.blocks.view),
                    self.output_cells.binding(),
                ]);
            }
            "scattered_light/received_light.wgsl" => entries.extend([
                bind_buffer("sums", &textures.sums),
                bind_buffer("scattering", &textures.scattering),
                bind_buffer("received", &textures.received),
            ]),
            _ => entries.extend([
                bind_buffer("scattering", &textures.scattering),
                bind_buffer("received", &textures.received),
                bind_buffer("last", &textures.previous),
                bind_buffer("step_before", &textures.previous_step),
                bind_buffer("solution", self.solution),
                bind_buffer("mixing", &textures.mixing),
            ]),
        }
        if shader == "scattered_light/mixing.wgsl" {
            groups = [1; 3];
        }
        if shader == "scattered_light/source.wgsl" {
            entries.extend([
                bind_buffer("first", &textures.single_scattering),
                bind_view("medium", &textures.medium),
                bind_buffer("reached_before", &textures.previously_reached),
            ]);
        }
        let pipeline = gpu.shaders.pipeline_into(variant, textures.medium_format)?;
        let own = gpu.bind("Bounces::whole", &pipeline, 0, &entries);
        pass::dispatch(encoder, "Bounces::whole", &pipeline, &[&own], groups);
        Ok(())
    }
}

/// Pipeline variant of the pass that finds the light that blocks receive.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
struct ReceivedLightVariant {
    /// True if what the interpolation between rays has spread is taken out.
    sharpens: bool,
}

impl PipelineVariant for ReceivedLightVariant {
    fn shader(&self) -> &'static str {
        "scattered_light/received_light.wgsl"
    }

    fn constants(&self) -> ShaderConstants {
        vec![flag("SHARPENS", self.sharpens)]
    }
}

/// Returns the number of workgroups of 4³ blocks along each axis.
pub(super) fn workgroups_over_blocks(volume: &ScatteredLightVolume) -> [u32; 3] {
    volume.blocks.dims.map(|n| (n as u32).div_ceil(4))
}
