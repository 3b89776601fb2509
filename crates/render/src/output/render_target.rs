//! Render target of a picture: linear light of the volume, light of the floor, and the displayed result.

use crate::plan::{DisplayKey, EyeKey, FloorKey};
use crate::resources::cache_entry::CacheEntry;
use crate::{GpuContext, GpuError};

/// Size and depth of a [`RenderTarget`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct TargetShape {
    /// Displayed pixels per row and column.
    pub size: [u32; 2],
    /// Number of samples along an edge of a pixel.
    pub samples: u32,
    /// `true` if the displayed picture has more than 8 bits per channel.
    pub is_deep: bool,
}

impl TargetShape {
    /// Returns the number of samples per row and column.
    pub(crate) fn sample_size(&self) -> [u32; 2] {
        self.size.map(|n| n * self.samples)
    }
}

/// Two-dimensional texture with its view.
#[derive(Debug)]
pub(crate) struct TargetTexture {
    pub texture: wgpu::Texture,
    pub view: wgpu::TextureView,
}

/// Linear, premultiplied light of the volume before tone mapping.
#[derive(Debug)]
pub(crate) struct LinearLight {
    pub plane: TargetTexture,
    /// Buffer that counts the footprints scattered; `None` for the gathering engine.
    pub splat_counter: Option<wgpu::Buffer>,
}

/// Textures of a picture, each with its key; `None` for textures that were never drawn.
#[derive(Debug)]
pub(crate) struct RenderTarget {
    pub shape: TargetShape,
    /// Output of the eye pass.
    pub light: CacheEntry<Option<EyeKey>, LinearLight>,
    /// Output of the floor pass, premultiplied; a single texel without a floor.
    pub floor: CacheEntry<Option<FloorKey>, TargetTexture>,
    /// Output of the display pass: sRGB bytes, or floats if the shape is deep.
    pub display: CacheEntry<Option<DisplayedKey>, TargetTexture>,
}

/// Key of the displayed picture.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct DisplayedKey {
    pub eye: EyeKey,
    pub floor: Option<FloorKey>,
    pub display: DisplayKey,
}

impl RenderTarget {
    /// Creates the textures, without those of a floor.
    ///
    /// # Errors
    /// Returns an error if the picture exceeds the adapter's limits or memory is exhausted.
    pub(crate) fn new(context: &GpuContext, shape: TargetShape) -> Result<Self, GpuError> {
        let shown_format =
            if shape.is_deep { wgpu::TextureFormat::Rgba32Float } else { wgpu::TextureFormat::Rgba8Unorm };
        let light = LinearLight {
            plane: plane(context, "Target::light", shape.sample_size(), wgpu::TextureFormat::Rgba32Float)?,
            splat_counter: None,
        };
        Ok(Self {
            shape,
            light: CacheEntry::incomplete(None, light),
            // Textures that were never written to are zero: no floor at all.
            floor: CacheEntry::complete(None, floor_plane(context, [1; 2])?),
            display: CacheEntry::incomplete(None, plane(context, "Target::shown", shape.size, shown_format)?),
        })
    }

    /// Allocates the floor's texture, or drops it if `key` is `None`. Returns true if textures have changed.
    ///
    /// # Errors
    /// Returns an error if memory is exhausted.
    pub(crate) fn resize_floor(
        &mut self,
        context: &GpuContext,
        key: Option<&FloorKey>,
    ) -> Result<bool, GpuError> {
        if key.is_some() == self.has_floor() {
            return Ok(false);
        }
        self.floor = if key.is_some() {
            CacheEntry::incomplete(None, floor_plane(context, self.shape.sample_size())?)
        } else {
            CacheEntry::complete(None, floor_plane(context, [1; 2])?)
        };
        Ok(true)
    }

    /// Returns true if there is a full-size floor texture.
    pub(crate) fn has_floor(&self) -> bool {
        self.floor.product.texture.width() > 1 || self.floor.product.texture.height() > 1
    }

    /// Returns true if the linear light of this key is complete.
    pub(crate) fn has_light(&self, key: &EyeKey) -> bool {
        self.light.is_complete() && self.light.key().as_ref() == Some(key)
    }

    /// Invalidates all textures, because their inputs were changed from outside.
    pub(crate) fn invalidate(&mut self) {
        self.light.restart(None);
        self.display.restart(None);
        if self.has_floor() {
            self.floor.restart(None);
        }
    }

    /// Returns the size of the textures, in bytes.
    pub(crate) fn bytes(&self) -> u64 {
        let texels =
            |plane: &TargetTexture| u64::from(plane.texture.width()) * u64::from(plane.texture.height());
        let shown = if self.shape.is_deep { 16 } else { 4 };
        16 * texels(&self.light.product.plane)
            + 8 * texels(&self.floor.product)
            + shown * texels(&self.display.product)
    }
}

fn floor_plane(context: &GpuContext, size: [u32; 2]) -> Result<TargetTexture, GpuError> {
    plane(context, "Target::floor", size, wgpu::TextureFormat::Rgba16Float)
}

fn plane(
    context: &GpuContext,
    label: &'static str,
    size: [u32; 2],
    format: wgpu::TextureFormat,
) -> Result<TargetTexture, GpuError> {
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
    Ok(TargetTexture { texture, view })
}
