//! What only the filling of a volume of bounced light needs.

use super::volume::BouncesVolume;
use crate::gpu::context::pair_format;
use crate::gpu::pipelines::uniforms;
use crate::gpu::sky::sheets::RaySheets;
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
    /// The format of that.
    pub medium_format: wgpu::TextureFormat,
    /// The light along rays.
    pub sheets: RaySheets,
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
    /// Room for the filling of a volume, where the rays of a batch of directions have so many columns, rows and slices; of
    /// light that has one colour all through, or of three colours.
    ///
    /// # Errors
    /// When memory is out.
    pub(super) fn new(
        context: &Context,
        volume: &BouncesVolume,
        [width, height, slices]: [usize; 3],
        one_color: bool,
    ) -> Result<Self, GpuError> {
        let dims = volume.dims;
        let usages = wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::STORAGE_BINDING;
        let (medium_format, sheet_format) = if one_color {
            (pair_format(context.storage_format), context.storage_format)
        } else {
            (wgpu::TextureFormat::Rgba16Float, wgpu::TextureFormat::Rgba16Float)
        };
        let medium_size = dims.map(|n| n + 2);
        let medium = context.texture(&texture_3d("Bounces::medium", medium_size, medium_format, usages))?;
        let sheets = RaySheets::new(context, [width, height, slices], sheet_format)?;
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
        let texel = u64::from(medium_format.block_copy_size(None).unwrap_or(8));
        Ok(Self {
            medium: medium.create_view(&wgpu::TextureViewDescriptor::default()),
            medium_format,
            scattering: list("Bounces::scattering", blocks),
            first: list("Bounces::first", blocks),
            sums: list("Bounces::sums", blocks),
            last: list("Bounces::last", blocks),
            change: list("Bounces::change", blocks),
            ratio: list("Bounces::ratio", 1),
            bytes: texel * texels(medium_size) + sheets.bytes() + SUM_BYTES * (5 * blocks + 1),
            sheets,
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
