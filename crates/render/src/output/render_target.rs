//! Render target of a picture: linear light of the volume, light of the floor, and the displayed result.

use crate::plan::{AntialiasedKey, DisplayKey, EyeKey, FloorKey};
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

/// Size of what precedes the pixels in a list of edges, in bytes: three numbers of workgroups, and that of pixels.
pub(crate) const EDGE_LIST_HEADER: u64 = 16;

/// Antialiased light of the volume, and the list of the pixels that have edges.
#[derive(Debug)]
pub(crate) struct AntialiasedLight {
    pub plane: TargetTexture,
    /// Sums of rays while they are drawn.
    pub sums: TargetTexture,
    /// Workgroups for the pixels in the list, their number, and each of them, as `shaders/eye/edges.wgsl` packs it.
    pub edges: wgpu::Buffer,
}

impl AntialiasedLight {
    fn new(context: &GpuContext, size: [u32; 2]) -> Result<Self, GpuError> {
        let pixels = u64::from(size[0]) * u64::from(size[1]);
        let edges = context.uninitialised_buffer(&wgpu::BufferDescriptor {
            label: Some("Target::edges"),
            size: EDGE_LIST_HEADER + 4 * pixels,
            usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::INDIRECT | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        Ok(Self { plane: light_plane(context, size)?, sums: light_plane(context, size)?, edges })
    }
}

/// Textures of a picture, each with its key; `None` for textures that were never drawn.
#[derive(Debug)]
pub(crate) struct RenderTarget {
    pub shape: TargetShape,
    /// Output of the eye pass.
    pub light: CacheEntry<Option<EyeKey>, LinearLight>,
    /// Output of the antialiasing pass; a single texel if there never was one.
    pub antialiased: CacheEntry<Option<AntialiasedKey>, AntialiasedLight>,
    /// Output of the floor pass, premultiplied; a single texel without a floor.
    pub floor: CacheEntry<Option<FloorKey>, TargetTexture>,
    /// Output of the display pass: sRGB bytes, or floats if the shape is deep.
    pub display: CacheEntry<Option<DisplayedKey>, TargetTexture>,
}

/// Key of the displayed picture.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct DisplayedKey {
    pub eye: EyeKey,
    pub antialiased: Option<AntialiasedKey>,
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
        let light = LinearLight { plane: light_plane(context, shape.sample_size())?, splat_counter: None };
        Ok(Self {
            shape,
            light: CacheEntry::incomplete(None, light),
            antialiased: CacheEntry::incomplete(None, AntialiasedLight::new(context, [1; 2])?),
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

    /// Allocates the texture of antialiased light if a picture needs it. Returns true if textures have changed.
    ///
    /// # Errors
    /// Returns an error if memory is exhausted.
    pub(crate) fn resize_antialiased(
        &mut self,
        context: &GpuContext,
        key: Option<&AntialiasedKey>,
    ) -> Result<bool, GpuError> {
        let size = self.shape.sample_size();
        let known = &self.antialiased.product.plane.texture;
        if key.is_none() || [known.width(), known.height()] == size {
            return Ok(false);
        }
        self.antialiased = CacheEntry::incomplete(None, AntialiasedLight::new(context, size)?);
        Ok(true)
    }

    /// Returns the linear light of the volume: antialiased if `key` is that of an antialiased picture.
    pub(crate) fn linear_light(&self, key: Option<&AntialiasedKey>) -> &TargetTexture {
        if key.is_some() { &self.antialiased.product.plane } else { &self.light.product.plane }
    }

    /// Returns the linear light of the volume that is displayed.
    pub(crate) fn displayed_light(&self) -> &TargetTexture {
        let displayed = self.display.key().as_ref();
        self.linear_light(displayed.and_then(|displayed| displayed.antialiased.as_ref()))
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
        self.antialiased.restart(None);
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
            // With the sums, and four bytes of the list.
            + 36 * texels(&self.antialiased.product.plane)
            + 8 * texels(&self.floor.product)
            + shown * texels(&self.display.product)
    }
}

fn light_plane(context: &GpuContext, size: [u32; 2]) -> Result<TargetTexture, GpuError> {
    plane(context, "Target::light", size, wgpu::TextureFormat::Rgba32Float)
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
