//! Render target of a picture: linear light of the volume, light of the floor, and the displayed result.

use crate::gpu::resources::cached::Cached;
use crate::gpu::{Context, GpuError};
use crate::plan::{DisplayKey, EyeKey, FloorKey};

/// Size and depth of a [`Target`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Shape {
    /// Displayed pixels per row and column.
    pub size: [u32; 2],
    /// Number of samples along an edge of a pixel.
    pub samples: u32,
    /// `true` if the displayed picture has more than 8 bits per channel.
    pub deep: bool,
}

impl Shape {
    /// Returns the number of samples per row and column.
    pub(crate) fn drawn(&self) -> [u32; 2] {
        self.size.map(|n| n * self.samples)
    }
}

/// Two-dimensional texture with its view.
#[derive(Debug)]
pub(crate) struct Plane {
    pub texture: wgpu::Texture,
    pub view: wgpu::TextureView,
}

/// Linear, premultiplied light of the volume before tone mapping.
#[derive(Debug)]
pub(crate) struct Light {
    pub plane: Plane,
    /// Buffer that counts the footprints scattered; `None` for the gathering engine.
    pub splats: Option<wgpu::Buffer>,
}

/// Textures of a picture, each with its key; `None` for textures that were never drawn.
#[derive(Debug)]
pub(crate) struct Target {
    pub shape: Shape,
    /// Output of the eye pass.
    pub light: Cached<Option<EyeKey>, Light>,
    /// Output of the floor pass, premultiplied; a single texel without a floor.
    pub floor: Cached<Option<FloorKey>, Plane>,
    /// Output of the display pass: sRGB bytes, or floats if the shape is deep.
    pub shown: Cached<Option<ShownKey>, Plane>,
}

/// Key of the displayed picture.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct ShownKey {
    pub eye: EyeKey,
    pub floor: Option<FloorKey>,
    pub display: DisplayKey,
}

impl Target {
    /// Creates the textures, without those of a floor.
    ///
    /// # Errors
    /// Returns an error if the picture exceeds the adapter's limits or memory is exhausted.
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
            // Textures that were never written to are zero: no floor at all.
            floor: Cached::complete(None, floor_plane(context, [1; 2])?),
            shown: Cached::unfilled(None, plane(context, "Target::shown", shape.size, shown_format)?),
        })
    }

    /// Allocates the floor's texture, or drops it if `key` is `None`. Returns true if textures have changed.
    ///
    /// # Errors
    /// Returns an error if memory is exhausted.
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

    /// Returns true if there is a full-size floor texture.
    pub(crate) fn has_floor(&self) -> bool {
        self.floor.value.texture.width() > 1 || self.floor.value.texture.height() > 1
    }

    /// Returns true if the linear light of this key is complete.
    pub(crate) fn holds_light(&self, key: &EyeKey) -> bool {
        self.light.is_complete() && self.light.key().as_ref() == Some(key)
    }

    /// Invalidates all textures, because their inputs were changed from outside.
    pub(crate) fn forget(&mut self) {
        self.light.restart(None);
        self.shown.restart(None);
        if self.has_floor() {
            self.floor.restart(None);
        }
    }

    /// Returns the size of the textures, in bytes.
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
