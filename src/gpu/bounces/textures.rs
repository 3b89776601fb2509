//! What only the filling of a volume of bounced light needs.

use super::volume::BouncesVolume;
use crate::gpu::pipelines::uniforms;
use crate::gpu::sky::sweep::{BATCH_BLOCKS, MOST_LAYERS};
use crate::gpu::sky::volume::SUM_BYTES;
use crate::gpu::volume::texture_3d;
use crate::gpu::{Context, GpuError};

/// Most texels of the rays of a batch: 128 MiB.
const BATCH_TEXELS: usize = 1 << 24;

/// What only the filling needs.
#[derive(Debug)]
pub(super) struct Textures {
    /// What blocks give off, and their optical depth, with one of nothing around the grid.
    pub medium: wgpu::TextureView,
    /// The light along rays: columns and rows of them, and a layer for each slice of each direction.
    pub sheets: wgpu::TextureView,
    pub sheet_size: [usize; 3],
    /// What blocks scatter, and their optical depth.
    pub scattering: wgpu::Buffer,
    /// What they give off of unscattered light.
    pub first: wgpu::Buffer,
    /// What a bounce brings them.
    pub sums: wgpu::Buffer,
    /// What the bounce before had brought.
    pub last: wgpu::Buffer,
    /// How much more that was than the one before that.
    pub change: wgpu::Buffer,
    /// What a bounce brings of what the last did.
    pub ratio: wgpu::Buffer,
    pub bytes: u64,
}

impl Textures {
    /// Room for the filling of a volume, where a direction has so many columns and rows of rays, and a batch so many
    /// directions.
    ///
    /// # Errors
    /// When memory is out.
    pub(super) fn new(
        context: &Context,
        volume: &BouncesVolume,
        [width, height]: [usize; 2],
        each: usize,
    ) -> Result<Self, GpuError> {
        let dims = volume.dims;
        let usages = wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::STORAGE_BINDING;
        let format = wgpu::TextureFormat::Rgba16Float;
        let slices = dims.into_iter().max().unwrap_or(1);
        let sheet_size = [width, height, slices * each];
        let medium_size = dims.map(|n| n + 2);
        let medium = context.texture(&texture_3d("Bounces::medium", medium_size, format, usages))?;
        let sheets = context.texture(&texture_3d("Bounces::sheets", sheet_size, format, usages))?;
        let texels = |size: [usize; 3]| size.iter().map(|&n| n as u64).product::<u64>();
        let list = |label, count: u64| {
            context.empty_buffer(&wgpu::BufferDescriptor {
                label: Some(label),
                size: SUM_BYTES * count,
                usage: wgpu::BufferUsages::STORAGE,
                mapped_at_creation: false,
            })
        };
        let blocks = texels(dims);
        let view = |texture: &wgpu::Texture| texture.create_view(&wgpu::TextureViewDescriptor::default());
        Ok(Self {
            medium: view(&medium),
            sheets: view(&sheets),
            sheet_size,
            scattering: list("Bounces::scattering", blocks),
            first: list("Bounces::first", blocks),
            sums: list("Bounces::sums", blocks),
            last: list("Bounces::last", blocks),
            change: list("Bounces::change", blocks),
            ratio: list("Bounces::ratio", 1),
            bytes: 8 * (texels(medium_size) + texels(sheet_size)) + SUM_BYTES * (5 * blocks + 1),
        })
    }
}

/// As many directions in a batch as it has room for.
pub(super) fn directions_of_a_batch(dims: [usize; 3], [width, height]: [usize; 2]) -> usize {
    let blocks: usize = dims.iter().product();
    let slices = dims.into_iter().max().unwrap_or(1);
    (BATCH_BLOCKS / blocks.max(1))
        .min(MOST_LAYERS / slices)
        .min(BATCH_TEXELS / (width * height * slices))
        .clamp(1, uniforms::MAX_SKY_RAYS)
}
