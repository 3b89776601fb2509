//! The display pass: tone map, background and sRGB.

use super::pass;
use super::recycled::Recycled;
use super::tables::view_entry;
use super::uniforms;
use super::volume::entry;
use super::{Context, GpuError, ShaderLibrary};
use crate::model::{Output, ToneMap};

/// A picture in the making: linear light, and what is shown of it.
#[derive(Debug)]
pub(super) struct Target {
    /// Pixels per row and column.
    pub size: [u32; 2],
    /// Linear, premultiplied, before tone mapping.
    pub picture: wgpu::Texture,
    /// The same.
    pub picture_view: wgpu::TextureView,
    /// sRGB bytes.
    pub shown: wgpu::Texture,
    /// The same.
    pub shown_view: wgpu::TextureView,
}

impl Target {
    /// Makes both textures.
    ///
    /// # Errors
    /// When the picture is too large for the adapter.
    pub(super) fn new(context: &Context, size: [u32; 2]) -> Result<Self, GpuError> {
        let usage = wgpu::TextureUsages::TEXTURE_BINDING
            | wgpu::TextureUsages::STORAGE_BINDING
            | wgpu::TextureUsages::COPY_SRC;
        let make = |label, format| {
            context.texture(&wgpu::TextureDescriptor {
                label: Some(label),
                size: wgpu::Extent3d { width: size[0], height: size[1], depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage,
                view_formats: &[],
            })
        };
        let picture = make("Target::picture", wgpu::TextureFormat::Rgba32Float)?;
        let shown = make("Target::shown", wgpu::TextureFormat::Rgba8Unorm)?;
        Ok(Self {
            size,
            picture_view: picture.create_view(&wgpu::TextureViewDescriptor::default()),
            picture,
            shown_view: shown.create_view(&wgpu::TextureViewDescriptor::default()),
            shown,
        })
    }

    /// Bytes of both textures.
    pub(super) fn bytes(&self) -> u64 {
        20 * u64::from(self.size[0]) * u64::from(self.size[1])
    }
}

/// Turns the linear picture into the shown one, with all light multiplied by an exposure.
pub(super) fn display(
    (context, recycled): (&Context, &Recycled),
    shaders: &ShaderLibrary,
    output: &Output,
    (transparent, exposure): (bool, f32),
    target: &Target,
    encoder: &mut wgpu::CommandEncoder,
) -> Result<(), GpuError> {
    let pipeline = shaders.pipeline("display.wgsl", &[])?;
    let opaque = |[r, g, b]: [f32; 3]| [r, g, b, 1.0];
    let uniform = uniforms::Display {
        top: opaque(output.background.top),
        bottom: opaque(output.background.bottom),
        transparent: u32::from(transparent),
        clip: u32::from(output.tone_map == ToneMap::Clip),
        exposure,
        pad0: 0,
    };
    let uniform = recycled.buffer(context, "Display::uniform", &[uniform], wgpu::BufferUsages::UNIFORM);
    let bind_group = recycled.bind(
        context,
        "Display::bind_group",
        &pipeline,
        0,
        &[
            entry(0, uniform.as_entire_binding()),
            view_entry(1, &target.picture_view),
            view_entry(2, &target.shown_view),
        ],
    );
    pass::dispatch(
        encoder,
        "Display::pass",
        &pipeline,
        &[&bind_group],
        [target.size[0].div_ceil(8), target.size[1].div_ceil(8), 1],
    );
    Ok(())
}
