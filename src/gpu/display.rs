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
    /// The floor under it, premultiplied, too; a single texel where there is none.
    pub floor: wgpu::Texture,
    /// The same.
    pub floor_view: wgpu::TextureView,
    /// sRGB bytes.
    pub shown: wgpu::Texture,
    /// The same.
    pub shown_view: wgpu::TextureView,
}

impl Target {
    /// Makes its textures.
    ///
    /// # Errors
    /// When the picture is too large for the adapter.
    pub(super) fn new(context: &Context, size: [u32; 2], has_floor: bool) -> Result<Self, GpuError> {
        let usage = wgpu::TextureUsages::TEXTURE_BINDING
            | wgpu::TextureUsages::STORAGE_BINDING
            | wgpu::TextureUsages::COPY_SRC;
        let make = |label, size: [u32; 2], format| {
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
        let picture = make("Target::picture", size, wgpu::TextureFormat::Rgba32Float)?;
        // Never written to, textures are zeros.
        let floor_size = if has_floor { size } else { [1; 2] };
        let floor = make("Target::floor", floor_size, wgpu::TextureFormat::Rgba16Float)?;
        let shown = make("Target::shown", size, wgpu::TextureFormat::Rgba8Unorm)?;
        Ok(Self {
            size,
            picture_view: picture.create_view(&wgpu::TextureViewDescriptor::default()),
            picture,
            floor_view: floor.create_view(&wgpu::TextureViewDescriptor::default()),
            floor,
            shown_view: shown.create_view(&wgpu::TextureViewDescriptor::default()),
            shown,
        })
    }

    /// Whether it has that size, and room for a floor if there is one.
    pub(super) fn is_for(&self, size: [u32; 2], has_floor: bool) -> bool {
        let floor_size = if has_floor { size } else { [1; 2] };
        self.size == size && [self.floor.width(), self.floor.height()] == floor_size
    }

    /// Bytes of its textures.
    pub(super) fn bytes(&self) -> u64 {
        let floor = 8 * u64::from(self.floor.width()) * u64::from(self.floor.height());
        20 * u64::from(self.size[0]) * u64::from(self.size[1]) + floor
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
            view_entry(3, &target.floor_view),
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
