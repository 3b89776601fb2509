//! What only the filling of a volume of bounced light needs.

use super::volume::BouncesVolume;
use crate::gpu::context::pair_format;
use crate::gpu::sky::sheets::RaySheets;
use crate::gpu::sky::volume::SUM_BYTES;
use crate::gpu::volume::texture_3d;
use crate::gpu::{Context, GpuError};

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

/// The format of three colours, with or without an extinction.
const COLORS: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;

impl Textures {
    /// The format of sheets of light that has one colour all through, or of three colours.
    pub(super) fn sheet_format(context: &Context, one_color: bool) -> wgpu::TextureFormat {
        if one_color { context.storage_format } else { COLORS }
    }

    /// Room for the filling of a volume, with sheets of so many columns, rows and layers; of light that has one colour all
    /// through, or of three colours.
    ///
    /// # Errors
    /// When memory is out.
    pub(super) fn new(
        context: &Context,
        volume: &BouncesVolume,
        sheet_size: [usize; 3],
        one_color: bool,
    ) -> Result<Self, GpuError> {
        let dims = volume.dims;
        let usages = wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::STORAGE_BINDING;
        let medium_format = if one_color { pair_format(context.storage_format) } else { COLORS };
        let sheet_format = Self::sheet_format(context, one_color);
        let medium_size = dims.map(|n| n + 2);
        let medium = context.texture(&texture_3d("Bounces::medium", medium_size, medium_format, usages))?;
        let sheets = RaySheets::new(context, sheet_size, sheet_format)?;
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
