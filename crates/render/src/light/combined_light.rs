//! Combined light: one volume with the diffuse light of all shadowed lights.

use super::light_uniform::{LightInput, attenuation_bindings};
use super::light_volume::LightVolume;
use crate::pipelines::binding::{bind_buffer, bind_view};
use crate::pipelines::pipeline_variant::{
    GridBoundaries, PipelineVariant, ShaderConstants, ShadingVariant, SkyVariant,
};
use crate::pipelines::uniforms;
use crate::resources::filled_cells::FilledCells;
use crate::resources::pass;
use crate::volume::brick_list::{self, BrickEntry};
use crate::volume::transfer_tables::TransferTables;
use crate::volume::{VolumeContext, texture_3d};
use crate::{GpuContext, GpuError};

/// Number of bricks per submission: 2048 × 512 voxels take a software adapter some 0.1 s.
pub(crate) const BRICKS_PER_STEP: usize = 2048;

/// Pipeline variant of the pass that combines lights.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
struct CombineVariant {
    shading: ShadingVariant,
    ends: GridBoundaries,
}

impl PipelineVariant for CombineVariant {
    fn shader(&self) -> &'static str {
        "light/combined_light.wgsl"
    }

    fn constants(&self) -> ShaderConstants {
        let mut constants = self.shading.constants();
        constants.extend(self.ends.constants());
        constants
    }
}

/// Volume with the sum of the diffuse light of all lights that cast shadows.
#[derive(Debug)]
pub(crate) struct CombinedLight {
    dims: [usize; 3],
    divisor: usize,
    /// View of the texture of linear RGB.
    pub view: wgpu::TextureView,
    /// Cells that are filled with values.
    pub filled: FilledCells,
}

/// Shading of the picture for which light is combined.
#[derive(Debug, Clone, Copy)]
pub(crate) struct CombinedLightShading {
    pub eye: uniforms::EyeUniform,
    pub shading: ShadingVariant,
}

impl CombinedLight {
    /// Creates the texture with the dimensions of the light volumes; nothing is filled yet.
    ///
    /// # Errors
    /// Returns an error if memory is exhausted.
    pub(crate) fn new(context: &GpuContext, like: &LightVolume) -> Result<Self, GpuError> {
        let texture = context.texture(&texture_3d(
            "CombinedLight::texture",
            like.dims,
            wgpu::TextureFormat::Rgba16Float,
            wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::STORAGE_BINDING,
        ))?;
        let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
        Ok(Self { dims: like.dims, divisor: like.divisor, view, filled: like.filled_cells.clone() })
    }

    /// Returns the scale from index space to texture coordinates: (p + ½) × lookup.
    pub(crate) fn lookup(&self) -> [f32; 3] {
        self.dims.map(|n| 1.0 / (n * self.divisor) as f32)
    }

    /// Returns the size of the texture, in bytes.
    pub(crate) fn bytes(&self) -> u64 {
        8 * self.dims.iter().map(|&n| n as u64).product::<u64>()
    }

    /// Fills the listed bricks from the volumes of `lights`, which are those of `eye` and `shading`.
    pub(crate) fn fill(
        &self,
        gpu: VolumeContext<'_>,
        tables: &TransferTables,
        CombinedLightShading { eye, shading }: CombinedLightShading,
        lights: &[LightInput<'_>],
        bricks: &[BrickEntry],
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<(), GpuError> {
        if bricks.is_empty() {
            return Ok(());
        }
        let attenuation: Vec<_> =
            lights.iter().filter_map(|input| input.volume).map(|volume| &volume.view).collect();
        let VolumeContext { shaders, volume, .. } = gpu;
        // The sky and scattered light are not part of the combined light.
        let shading = ShadingVariant { sky: SkyVariant::None, has_scattered_light: false, ..shading };
        let pipeline = shaders.pipeline(&CombineVariant { shading, ends: volume.possible_boundaries() })?;
        let eye = gpu.uniform("Combine::eye", eye);
        let uniform = uniforms::CombineUniform {
            dims: self.dims.map(|n| n as u32),
            bricks: bricks.len() as u32,
            voxel_step: self.divisor as f32,
            pad0: 0.0,
            pad1: 0.0,
            pad2: 0.0,
        };
        let uniform = gpu.uniform("Combine::uniform", uniform);
        let list = brick_list::upload_bricks(gpu, bricks);
        let own = gpu.bind(
            "Combine::bind_group",
            &pipeline,
            0,
            &[
                bind_buffer("bound_eye", &eye),
                bind_buffer("table", tables.eye.lookup_buffer()),
                bind_buffer("bound_combine", &uniform),
                bind_buffer("bricks", &list),
                bind_view("combined", &self.view),
            ],
        );
        let of_volume = gpu.bind_pyramid(&pipeline, tables.eye.pyramid(volume));
        let of_lights = gpu.bind("Combine::lights", &pipeline, 2, &attenuation_bindings(gpu, &attenuation));
        pass::dispatch(
            encoder,
            "Combine::pass",
            &pipeline,
            &[&own, &of_volume, &of_lights],
            brick_list::two_workgroups_per_brick(bricks.len() as u32),
        );
        Ok(())
    }
}
