//! Collapses the light volumes of several lights into one of diffuse light.

use std::sync::Arc;

use super::volume::{LightVolume, light_bind_group};
use crate::gpu::eye::gather::{EyePass, pack_light, pack_shading};
use crate::gpu::resources::listed_bricks::{self, Listed};
use crate::gpu::resources::pass;
use crate::gpu::resources::uniforms;
use crate::gpu::volume::transfer_tables::view_entry;
use crate::gpu::volume::{Gpu, entry, texture_3d};
use crate::gpu::{Context, GpuError, RenderOptions};
use crate::math::SceneSpace;
use crate::model::{Remains, Settings};
use crate::plan::{CellSet, LightKey};

/// Bricks per submission: 2048 × 512 voxels take a software adapter some 0.1 s.
pub(crate) const BRICKS_PER_STEP: usize = 2048;

/// Everything that a collapsed volume is made from: light volumes, and the bytes of lights and
/// shading as the shaders know them.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct CollapsedKey {
    lights: Vec<LightKey>,
    shading: Vec<u8>,
    /// Faces that are seen have normals of their own.
    seen: Remains,
}

impl CollapsedKey {
    /// The key for the light volumes of some settings.
    pub(crate) fn new(
        lights: Vec<LightKey>,
        settings: &Settings,
        scene: &SceneSpace,
        options: &RenderOptions,
    ) -> Self {
        // What the picture does with the light afterwards does not count.
        let shading = uniforms::Shading {
            emission: 0.0,
            ambient: 0.0,
            diffuse: 0.0,
            specular: 0.0,
            shininess: 0.0,
            ..pack_shading(settings, scene, options)
        };
        let mut bytes = bytemuck::bytes_of(&shading).to_vec();
        for light in settings.lights.iter().filter(|light| light.needs_volume()) {
            let packed = pack_light(&light.in_world(&settings.camera), None, scene, settings);
            bytes.extend_from_slice(bytemuck::bytes_of(&packed));
        }
        Self { lights, shading: bytes, seen: settings.cuts.seen() }
    }
}

/// The diffuse light of all lights that cast shadows.
#[derive(Debug)]
pub(crate) struct CollapsedLight {
    /// What it is made from.
    pub key: CollapsedKey,
    dims: [usize; 3],
    divisor: usize,
    /// Linear RGB.
    pub view: wgpu::TextureView,
    /// Cells that hold values.
    pub filled: Arc<CellSet>,
    /// Whether all of them are there.
    pub complete: bool,
}

impl CollapsedLight {
    /// Makes the texture for light volumes like this one; nothing is filled yet.
    ///
    /// # Errors
    /// When memory is out.
    pub(crate) fn new(context: &Context, key: CollapsedKey, like: &LightVolume) -> Result<Self, GpuError> {
        let texture = context.texture(&texture_3d(
            "CollapsedLight::texture",
            like.dims,
            wgpu::TextureFormat::Rgba16Float,
            wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::STORAGE_BINDING,
        ))?;
        let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
        Ok(Self {
            key,
            dims: like.dims,
            divisor: like.divisor,
            view,
            filled: Arc::clone(&like.filled),
            complete: false,
        })
    }

    /// Index space to texture coordinates: (p + ½) × lookup.
    pub(crate) fn lookup(&self) -> [f32; 3] {
        self.dims.map(|n| 1.0 / (n * self.divisor) as f32)
    }

    /// Bytes of its texture.
    pub(crate) fn bytes(&self) -> u64 {
        8 * self.dims.iter().map(|&n| n as u64).product::<u64>()
    }

    /// Fills the listed bricks from the light volumes that `pass` shades with.
    pub(crate) fn fill(
        &self,
        gpu: Gpu<'_>,
        pass: &EyePass,
        attenuation: &[&wgpu::TextureView],
        bricks: &[Listed],
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<(), GpuError> {
        if bricks.is_empty() {
            return Ok(());
        }
        let Gpu { shaders, .. } = gpu;
        let pipeline = shaders.pipeline("light/combine.wgsl", &pass.scatter_constants())?;
        let eye = gpu.uniform("Collapse::eye", pass.uniform());
        let uniform = uniforms::Collapse {
            dims: self.dims.map(|n| n as u32),
            bricks: bricks.len() as u32,
            voxel_step: self.divisor as f32,
            pad0: 0.0,
            pad1: 0.0,
            pad2: 0.0,
        };
        let uniform = gpu.uniform("Collapse::uniform", uniform);
        let list = listed_bricks::upload(gpu, bricks);
        let own = gpu.bind(
            "Collapse::bind_group",
            &pipeline,
            0,
            &[
                entry(0, eye.as_entire_binding()),
                entry(1, uniform.as_entire_binding()),
                entry(3, list.as_entire_binding()),
                view_entry(4, &self.view),
            ],
        );
        let of_volume = gpu.bind_pyramid(&pipeline);
        let of_lights = light_bind_group(gpu, &pipeline, attenuation);
        pass::dispatch(
            encoder,
            "Collapse::pass",
            &pipeline,
            &[&own, &of_volume, &of_lights],
            listed_bricks::workgroups(bricks.len() as u32),
        );
        Ok(())
    }
}
