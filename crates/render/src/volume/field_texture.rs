//! Field texture: densities of all fields of a picture in one texel, where voxels are composed of layers.

use std::ops::Range;
use std::sync::Arc;

use rayon::prelude::*;

use super::texture_3d;
use crate::{GpuContext, GpuError};
use chiaroscuro_volume::{DatasetField, MAX_FIELDS};

/// Largest stored density, of `shaders/volume/field.wgsl`.
const LARGEST_STORED_DENSITY: f32 = 65534.0;

/// Stored number of a missing voxel, and of fields that there are not.
const MISSING: u16 = u16::MAX;

/// Densities of up to [`MAX_FIELDS`] fields at the voxels of the grid.
#[derive(Debug)]
pub(crate) struct FieldTexture {
    /// Fields in the order of their channels.
    pub fields: Arc<[DatasetField]>,
    texture: wgpu::Texture,
    pub view: wgpu::TextureView,
    /// Number of channels per texel, 1, 2 or [`MAX_FIELDS`].
    channels: usize,
}

impl FieldTexture {
    /// Creates the texture of some fields on one grid; nothing is uploaded yet.
    ///
    /// # Errors
    /// Returns an error if the adapter cannot hold the texture.
    pub(crate) fn new(context: &GpuContext, fields: &Arc<[DatasetField]>) -> Result<Self, GpuError> {
        let (format, channels) = match fields.len() {
            1 => (wgpu::TextureFormat::R16Uint, 1),
            2 => (wgpu::TextureFormat::Rg16Uint, 2),
            _ => (wgpu::TextureFormat::Rgba16Uint, MAX_FIELDS),
        };
        let usage = wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST;
        let dims = fields[0].volume().dims();
        let texture = context.texture(&texture_3d("Volume::fields", dims, format, usage))?;
        let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
        Ok(Self { fields: Arc::clone(fields), texture, view, channels })
    }

    /// Uploads some z-slices of all fields.
    pub(crate) fn upload(&self, context: &GpuContext, slices: Range<usize>) {
        let [nx, ny, _] = self.fields[0].volume().dims();
        let words: Vec<u16> = slices.clone().into_par_iter().flat_map_iter(|z| self.slice(z)).collect();
        context.queue.write_texture(
            wgpu::TexelCopyTextureInfo {
                texture: &self.texture,
                mip_level: 0,
                origin: wgpu::Origin3d { x: 0, y: 0, z: slices.start as u32 },
                aspect: wgpu::TextureAspect::All,
            },
            bytemuck::cast_slice(&words),
            wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some((2 * self.channels * nx) as u32),
                rows_per_image: Some(ny as u32),
            },
            wgpu::Extent3d {
                width: nx as u32,
                height: ny as u32,
                depth_or_array_layers: slices.len() as u32,
            },
        );
    }

    /// Returns the texels of a slice.
    fn slice(&self, z: usize) -> Vec<u16> {
        let [nx, ny, _] = self.fields[0].volume().dims();
        let mut texels = vec![MISSING; nx * ny * self.channels];
        for (channel, field) in self.fields.iter().enumerate() {
            let volume = field.volume();
            let first = z * nx * ny;
            // Hidden voxels are stored, too: what a mask leaves of matter is known once it is composed.
            let is_missing = |at: usize| volume.missing().is_some_and(|missing| missing.contains(first + at));
            for (at, density) in volume.slice_densities(z).into_iter().enumerate() {
                if !is_missing(at) {
                    texels[at * self.channels + channel] = stored(density);
                }
            }
        }
        texels
    }

    /// Returns the size of the texture, in bytes.
    pub(crate) fn bytes(&self) -> u64 {
        (2 * self.channels * self.fields[0].volume().voxel_count()) as u64
    }
}

fn stored(density: f32) -> u16 {
    (density.clamp(0.0, 1.0) * LARGEST_STORED_DENSITY).round() as u16
}
