//! The display pass: the mean of a pixel's samples, tone map, background and sRGB.

use crate::gpu::resources::pass;
use crate::gpu::resources::pool::Recycled;
use crate::gpu::resources::uniforms;
use crate::gpu::volume::entry;
use crate::gpu::volume::transfer_tables::view_entry;
use crate::gpu::{Context, GpuError, RenderOptions, ShaderLibrary};
use crate::model::{Depth, Output, ToneMap};

/// What a [`Target`] has room for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Shape {
    /// Pixels shown per row and column.
    pub size: [u32; 2],
    /// Samples of each along an edge.
    pub samples: u32,
    /// Whether there is a floor.
    pub has_floor: bool,
    /// Whether what is shown has more than 8 bits.
    pub deep: bool,
}

impl Shape {
    /// Samples per row and column.
    pub(crate) fn drawn(&self) -> [u32; 2] {
        self.size.map(|n| n * self.samples)
    }
}

/// A picture in the making: linear light, and what is shown of it.
#[derive(Debug)]
pub(crate) struct Target {
    /// What it is made for.
    pub shape: Shape,
    /// Linear, premultiplied, before tone mapping.
    pub picture: wgpu::Texture,
    /// The same.
    pub picture_view: wgpu::TextureView,
    /// The floor under it, premultiplied, too; a single texel where there is none.
    pub floor: wgpu::Texture,
    /// The same.
    pub floor_view: wgpu::TextureView,
    /// sRGB bytes; more than them if its shape says so.
    pub shown: wgpu::Texture,
    /// The same.
    pub shown_view: wgpu::TextureView,
}

impl Target {
    /// Makes its textures.
    ///
    /// # Errors
    /// When the picture is too large for the adapter.
    pub(crate) fn new(context: &Context, shape: Shape) -> Result<Self, GpuError> {
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
        let picture = make("Target::picture", shape.drawn(), wgpu::TextureFormat::Rgba32Float)?;
        // Never written to, textures are zeros.
        let floor_size = if shape.has_floor { shape.drawn() } else { [1; 2] };
        let floor = make("Target::floor", floor_size, wgpu::TextureFormat::Rgba16Float)?;
        let format =
            if shape.deep { wgpu::TextureFormat::Rgba32Float } else { wgpu::TextureFormat::Rgba8Unorm };
        let shown = make("Target::shown", shape.size, format)?;
        Ok(Self {
            shape,
            picture_view: picture.create_view(&wgpu::TextureViewDescriptor::default()),
            picture,
            floor_view: floor.create_view(&wgpu::TextureViewDescriptor::default()),
            floor,
            shown_view: shown.create_view(&wgpu::TextureViewDescriptor::default()),
            shown,
        })
    }

    /// Bytes of its textures.
    pub(crate) fn bytes(&self) -> u64 {
        let texels = |texture: &wgpu::Texture| u64::from(texture.width()) * u64::from(texture.height());
        let shown = if self.shape.deep { 16 } else { 4 };
        16 * texels(&self.picture) + 8 * texels(&self.floor) + shown * texels(&self.shown)
    }
}

/// Turns the linear picture into the shown one, with all light multiplied by an exposure.
pub(crate) fn display(
    (context, recycled): (&Context, &Recycled),
    shaders: &ShaderLibrary,
    output: &Output,
    (options, transparent, exposure): (&RenderOptions, bool, f32),
    target: &Target,
    encoder: &mut wgpu::CommandEncoder,
) -> Result<(), GpuError> {
    let Shape { size, samples, deep, .. } = target.shape;
    let mut constants = Vec::new();
    if samples > 1 {
        constants.push(("SAMPLES", f64::from(samples)));
    }
    if options.depth == Depth::Linear {
        constants.push(("LINEAR", 1.0));
    }
    let pipeline = shaders
        .pipeline(if deep { "output/display_deep.wgsl" } else { "output/display.wgsl" }, &constants)?;
    let (first_row, rows) = options.part.map_or((0, size[1]), |part| (part.first[1], part.whole[1]));
    let opaque = |[r, g, b]: [f32; 3]| [r, g, b, 1.0];
    let uniform = uniforms::Display {
        top: opaque(output.background.top),
        bottom: opaque(output.background.bottom),
        transparent: u32::from(transparent),
        clip: u32::from(output.tone_map == ToneMap::Clip),
        exposure,
        first_row: first_row as f32,
        rows: rows as f32,
        pad0: 0,
        pad1: 0,
        pad2: 0,
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
        [size[0].div_ceil(8), size[1].div_ceil(8), 1],
    );
    Ok(())
}
