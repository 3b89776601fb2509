//! Temporary textures and buffers for filling a volume of scattered light.

use super::diffusion::DiffusionInputs;
use super::volume::ScatteredLightVolume;
use crate::context::pair_format;
use crate::sky::sheets::RaySheets;
use crate::sky::volume::SUM_BYTES;
use crate::volume::texture_3d;
use crate::{GpuContext, GpuError};

/// Temporary textures and buffers of the filling.
#[derive(Debug)]
pub(super) struct ScatteringTextures {
    /// Emission of the blocks and their optical depth, with a border of empty blocks around the grid.
    pub medium: wgpu::TextureView,
    /// Format of the medium texture.
    pub medium_format: wgpu::TextureFormat,
    /// Light along the rays of a sweep.
    pub sheets: RaySheets,
    /// Scattering of the blocks for each colour, and their optical depth.
    pub scattering: wgpu::Buffer,
    /// Light that blocks scatter directly from the lights and the sky.
    pub single_scattering: wgpu::Buffer,
    /// Sums of the light that a bounce brings to blocks.
    pub sums: wgpu::Buffer,
    /// Mean light that blocks receive of a bounce.
    pub received: wgpu::Buffer,
    /// Light of which the last sweep followed a bounce.
    pub previous: wgpu::Buffer,
    /// Step towards the limit of the series before this one.
    pub previous_step: wgpu::Buffer,
    /// Light that the step before reached.
    pub previously_reached: wgpu::Buffer,
    /// Share of the step before that is taken out of a step.
    pub mixing: wgpu::Buffer,
    pub bytes: u64,
}

/// Format of three colours, with or without extinction in alpha.
const COLOR_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;

impl ScatteringTextures {
    /// Returns the format of sheets, for light of one colour or of three.
    pub(super) fn sheet_format(context: &GpuContext, one_color: bool) -> wgpu::TextureFormat {
        if one_color { context.storage_format } else { COLOR_FORMAT }
    }

    /// Allocates the resources for filling a volume, with sheets of `sheet_size` columns, rows and layers, for light
    /// of one colour or of three.
    ///
    /// # Errors
    /// Returns an error if memory is exhausted.
    pub(super) fn new(
        context: &GpuContext,
        volume: &ScatteredLightVolume,
        sheet_size: [usize; 3],
        one_color: bool,
    ) -> Result<Self, GpuError> {
        let dims = volume.blocks.dims;
        let usages = wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::STORAGE_BINDING;
        let medium_format = if one_color { pair_format(context.storage_format) } else { COLOR_FORMAT };
        let sheet_format = Self::sheet_format(context, one_color);
        let medium_size = dims.map(|n| n + 2);
        let medium = context.texture(&texture_3d("Bounces::medium", medium_size, medium_format, usages))?;
        let sheets = RaySheets::new(context, sheet_size, sheet_format)?;
        let texels = |size: [usize; 3]| size.iter().map(|&n| n as u64).product::<u64>();
        let list = |label, count: u64| {
            context.uninitialised_buffer(&wgpu::BufferDescriptor {
                label: Some(label),
                size: SUM_BYTES * count,
                usage: wgpu::BufferUsages::STORAGE,
                mapped_at_creation: false,
            })
        };
        let blocks = texels(dims);
        let texel = u64::from(medium_format.block_copy_size(None).unwrap_or(8));
        Ok(Self {
            medium: medium.create_view(&wgpu::TextureViewDescriptor::default()),
            medium_format,
            scattering: list("Bounces::scattering", blocks),
            single_scattering: list("Bounces::first", blocks),
            sums: list("Bounces::sums", blocks),
            received: list("Bounces::received", blocks),
            previous: list("Bounces::last", blocks),
            previous_step: list("Bounces::step", blocks),
            previously_reached: list("Bounces::reached", blocks),
            mixing: list("Bounces::mixing", 1),
            bytes: texel * texels(medium_size) + sheets.bytes() + SUM_BYTES * (7 * blocks + 1),
            sheets,
        })
    }

    /// Returns the buffers that the diffusion equation refers to.
    pub(super) fn diffusion_inputs(&self) -> DiffusionInputs<'_> {
        DiffusionInputs {
            scattering: &self.scattering,
            received: &self.received,
            single_scattering: &self.single_scattering,
            previous: &self.previous,
        }
    }
}
