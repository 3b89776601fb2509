//! Readback of textures and buffers from the GPU to host memory.

use crate::{GpuContext, GpuError};

/// Attenuation volume of a light, read back.
#[derive(Debug, Clone, PartialEq)]
pub struct AttenuationData {
    /// Number of voxels along x, y and z.
    pub dims: [usize; 3],
    /// Number of data voxels per voxel of this volume, along an axis.
    pub divisor: usize,
    /// Attenuation from 0 (fully shadowed) to 1 (fully lit), x fastest; the luminance where shadows are coloured.
    pub values: Vec<f32>,
    /// Attenuation of red, green and blue light where shadows are coloured; else empty.
    pub colors: Vec<[f32; 3]>,
}

impl AttenuationData {
    /// Description of the values in files of light volumes.
    pub const CONTENT: &str = "light attenuation";
}

/// Reads the texels of a texture's first level, tightly packed, row by row and slice by slice.
pub(crate) fn read_texture(context: &GpuContext, texture: &wgpu::Texture) -> Result<Vec<u8>, GpuError> {
    let size = texture.size();
    let texel = texture.format().block_copy_size(None).unwrap_or(4);
    let row = size.width * texel;
    let padded = row.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
    let mut bytes = Vec::with_capacity((row * size.height) as usize * size.depth_or_array_layers as usize);
    // One slice at a time: a volume may be larger than the largest buffer.
    let buffer = context.uninitialised_buffer(&wgpu::BufferDescriptor {
        label: Some("Readback::buffer"),
        size: u64::from(padded) * u64::from(size.height),
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    });
    for slice in 0..size.depth_or_array_layers {
        let mut encoder = context.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        encoder.copy_texture_to_buffer(
            wgpu::TexelCopyTextureInfo {
                texture,
                mip_level: 0,
                origin: wgpu::Origin3d { x: 0, y: 0, z: slice },
                aspect: wgpu::TextureAspect::All,
            },
            wgpu::TexelCopyBufferInfo {
                buffer: &buffer,
                layout: wgpu::TexelCopyBufferLayout {
                    offset: 0,
                    bytes_per_row: Some(padded),
                    rows_per_image: Some(size.height),
                },
            },
            wgpu::Extent3d { depth_or_array_layers: 1, ..size },
        );
        context.queue.submit([encoder.finish()]);
        buffer.map_async(wgpu::MapMode::Read, .., |result| {
            if let Err(err) = result {
                log::error!("reading back failed: {err}");
            }
        });
        context.wait()?;
        let view = buffer.get_mapped_range(..).map_err(|err| GpuError::Refused(err.to_string()))?;
        for line in view.chunks_exact(padded as usize) {
            bytes.extend_from_slice(&line[..row as usize]);
        }
        drop(view);
        buffer.unmap();
    }
    Ok(bytes)
}

/// Reads the first 32-bit word of a buffer.
pub(crate) fn read_word(context: &GpuContext, source: &wgpu::Buffer) -> Result<u32, GpuError> {
    let buffer = context.uninitialised_buffer(&wgpu::BufferDescriptor {
        label: Some("Readback::word"),
        size: 4,
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    });
    let mut encoder = context.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    encoder.copy_buffer_to_buffer(source, 0, &buffer, 0, 4);
    context.queue.submit([encoder.finish()]);
    buffer.map_async(wgpu::MapMode::Read, .., |result| {
        if let Err(err) = result {
            log::error!("reading back failed: {err}");
        }
    });
    context.wait()?;
    let view = buffer.get_mapped_range(..).map_err(|err| GpuError::Refused(err.to_string()))?;
    Ok(u32::from_le_bytes([view[0], view[1], view[2], view[3]]))
}

/// Reads the channels of a float texture's texels, decoded to `f32`.
pub(crate) fn read_floats(context: &GpuContext, texture: &wgpu::Texture) -> Result<Vec<f32>, GpuError> {
    let bytes = read_texture(context, texture)?;
    Ok(match texture.format() {
        wgpu::TextureFormat::R16Float | wgpu::TextureFormat::Rgba16Float => {
            bytes.chunks_exact(2).map(|pair| half::f16::from_le_bytes([pair[0], pair[1]]).to_f32()).collect()
        }
        wgpu::TextureFormat::R8Unorm | wgpu::TextureFormat::Rgba8Unorm => {
            bytes.into_iter().map(|byte| f32::from(byte) / 255.0).collect()
        }
        _ => bytes
            .chunks_exact(4)
            .map(|word| f32::from_le_bytes([word[0], word[1], word[2], word[3]]))
            .collect(),
    })
}
