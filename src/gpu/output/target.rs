//! A picture in the making: its linear light, the floor under it, and what is shown of both.

use crate::gpu::resources::cached::Cached;
use crate::gpu::{Context, GpuError};
use crate::plan::{DisplayKey, EyeKey, FloorKey};

/// What a [`Target`] has room for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Shape {
    /// Pixels shown per row and column.
    pub size: [u32; 2],
    /// Samples of each along an edge.
    pub samples: u32,
    /// Whether what is shown has more than 8 bits.
    pub deep: bool,
}

impl Shape {
    /// Samples per row and column.
    pub(crate) fn drawn(&self) -> [u32; 2] {
        self.size.map(|n| n * self.samples)
    }
}

/// A texture, and how passes see it.
#[derive(Debug)]
pub(crate) struct Plane {
    pub texture: wgpu::Texture,
    pub view: wgpu::TextureView,
}

/// The linear, premultiplied light of a volume before tone mapping.
#[derive(Debug)]
pub(crate) struct Light {
    pub plane: Plane,
    /// How many footprints it took, where voxels were scattered.
    pub splats: Option<wgpu::Buffer>,
}

/// A picture's textures, each with what it was made from: `None` of what was never drawn.
#[derive(Debug)]
pub(crate) struct Target {
    pub shape: Shape,
    /// What the eye pass draws.
    pub light: Cached<Option<EyeKey>, Light>,
    /// What the floor pass draws, premultiplied; a single texel where there is no floor.
    pub floor: Cached<Option<FloorKey>, Plane>,
    /// What the display pass draws: sRGB bytes, or more than them if the shape says so.
    pub shown: Cached<Option<ShownKey>, Plane>,
}

/// Everything that the display pass shows.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct ShownKey {
    pub eye: EyeKey,
    pub floor: Option<FloorKey>,
    pub display: DisplayKey,
}

impl Target {
    /// Makes textures without a floor.
    ///
    /// # Errors
    /// When the picture is too large for the adapter.
    pub(crate) fn new(context: &Context, shape: Shape) -> Result<Self, GpuError> {
        let shown_format =
            if shape.deep { wgpu::TextureFormat::Rgba32Float } else { wgpu::TextureFormat::Rgba8Unorm };
        let light = Light {
            plane: plane(context, "Target::light", shape.drawn(), wgpu::TextureFormat::Rgba32Float)?,
            splats: None,
        };
        Ok(Self {
            shape,
            light: Cached::unfilled(None, light),
            // Never written to, textures are zeros: no floor at all.
            floor: Cached::complete(None, floor_plane(context, [1; 2])?),
            shown: Cached::unfilled(None, plane(context, "Target::shown", shape.size, shown_format)?),
        })
    }

    /// Makes room for a floor, or drops it. Returns whether textures have changed.
    ///
    /// # Errors
    /// When memory is out.
    pub(crate) fn place_floor(
        &mut self,
        context: &Context,
        key: Option<&FloorKey>,
    ) -> Result<bool, GpuError> {
        if key.is_some() == self.has_floor() {
            return Ok(false);
        }
        self.floor = if key.is_some() {
            Cached::unfilled(None, floor_plane(context, self.shape.drawn())?)
        } else {
            Cached::complete(None, floor_plane(context, [1; 2])?)
        };
        Ok(true)
    }

    /// Whether there is room for a floor.
    pub(crate) fn has_floor(&self) -> bool {
        self.floor.value.texture.width() > 1 || self.floor.value.texture.height() > 1
    }

    /// Whether the linear light that a key asks for is here.
    pub(crate) fn holds_light(&self, key: &EyeKey) -> bool {
        self.light.is_complete() && self.light.key().as_ref() == Some(key)
    }

    /// Nothing of it may be shown again: what it was made from has been changed from outside.
    pub(crate) fn forget(&mut self) {
        self.light.restart(None);
        self.shown.restart(None);
        if self.has_floor() {
            self.floor.restart(None);
        }
    }

    /// Bytes of its textures.
    pub(crate) fn bytes(&self) -> u64 {
        let texels = |plane: &Plane| u64::from(plane.texture.width()) * u64::from(plane.texture.height());
        let shown = if self.shape.deep { 16 } else { 4 };
        16 * texels(&self.light.value.plane)
            + 8 * texels(&self.floor.value)
            + shown * texels(&self.shown.value)
    }
}

fn floor_plane(context: &Context, size: [u32; 2]) -> Result<Plane, GpuError> {
    plane(context, "Target::floor", size, wgpu::TextureFormat::Rgba16Float)
}

fn plane(
    context: &Context,
    label: &'static str,
    size: [u32; 2],
    format: wgpu::TextureFormat,
) -> Result<Plane, GpuError> {
    let texture = context.texture(&wgpu::TextureDescriptor {
        label: Some(label),
        size: wgpu::Extent3d { width: size[0], height: size[1], depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::TEXTURE_BINDING
            | wgpu::TextureUsages::STORAGE_BINDING
            | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    })?;
    let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
    Ok(Plane { texture, view })
}
