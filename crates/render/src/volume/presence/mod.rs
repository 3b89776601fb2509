//! Presence textures of volumes with missing or hidden voxels: presence (the fraction of the kernel on existing voxels)
//! and its differences.
//!
//! Mip pyramids parallel to that of density, one for the eye, and one for light if other voxels are hidden from it.
//! Computed on the CPU and uploaded, since few volumes have such voxels.

mod presence_block;

use std::ops::Range;

use self::presence_block::{MAX_LEVEL, PresenceSource, TEXEL_BYTES, presence_levels};
use super::PyramidViews;
use super::texture_shapes::{PYRAMID_PADDING, pyramid_dims, texture_3d};
use crate::{GpuContext, GpuError};
use chiaroscuro_volume::{Observer, Volume};

/// Number of texels of level 0 per upload step: some 20 ms, and 16 MiB of temporary memory.
const STEP_TEXELS: usize = 1 << 20;

/// Reach of a texel of the coarsest level, in texels of level 0 on either side: texel c of level 2 is made of texels 4c − 3 … 4c + 6, its differences reach one texel of level 2 further, and the blur one of level 0.
const COARSEST_REACH: usize = 12;

/// Returns true if a volume has absent voxels, among which missing ones may not count.
pub(crate) fn is_needed(volume: &Volume, counts_missing: bool) -> bool {
    if counts_missing { volume.has_absent_voxels() } else { volume.mask().is_some() }
}

/// Presence textures of a volume with missing or hidden voxels.
#[derive(Debug)]
pub(crate) struct PresenceTextures {
    /// Presence for the eye, and for light unless it has a texture of its own.
    eye: PresenceTexture,
    /// Presence for light, if other voxels are hidden from it.
    light: Option<PresenceTexture>,
    /// `true` if missing voxels are absent; else only hidden ones are, since layers have missing voxels of their own.
    pub counts_missing: bool,
}

impl PresenceTextures {
    /// Creates the textures for a volume as if it had these dimensions; `None` if all voxels that count are present.
    ///
    /// # Errors
    /// Returns an error if the adapter cannot hold them.
    pub(crate) fn new(
        context: &GpuContext,
        volume: &Volume,
        dims: [usize; 3],
        counts_missing: bool,
    ) -> Result<Option<Self>, GpuError> {
        if !is_needed(volume, counts_missing) {
            return Ok(None);
        }
        let eye = PresenceTexture::new(context, dims)?;
        Self { eye, light: None, counts_missing }.with_observers_of(context, volume, dims).map(Some)
    }

    /// Adds or removes the texture of light, as the volume's mask needs it.
    ///
    /// # Errors
    /// Returns an error if the adapter cannot hold it.
    pub(crate) fn with_observers_of(
        self,
        context: &GpuContext,
        volume: &Volume,
        dims: [usize; 3],
    ) -> Result<Self, GpuError> {
        let differs = volume.mask().is_some_and(|mask| mask.differs_by_observer());
        let light = match self.light.filter(|_| differs) {
            None if differs => Some(PresenceTexture::new(context, dims)?),
            known => known,
        };
        Ok(Self { light, ..self })
    }

    /// Returns the texture of an observer, if it has one of its own.
    pub(crate) fn own(&self, observer: Observer) -> Option<&PresenceTexture> {
        match observer {
            Observer::Eye => Some(&self.eye),
            Observer::Light => self.light.as_ref(),
        }
    }

    /// Returns the texture that holds for an observer.
    pub(crate) fn get(&self, observer: Observer) -> &PresenceTexture {
        self.own(observer).unwrap_or(&self.eye)
    }

    /// Uploads a box of texels of the coarsest level of an observer's texture, with those of the finer levels.
    pub(crate) fn upload(
        &self,
        context: &GpuContext,
        volume: &Volume,
        observer: Observer,
        texels: &[Range<usize>; 3],
    ) {
        let source = PresenceSource { volume, observer, counts_missing: self.counts_missing };
        self.get(observer).upload(context, source, texels);
    }

    /// Returns true if other voxels are hidden from light than from the eye.
    pub(crate) fn differ_by_observer(&self) -> bool {
        self.light.is_some()
    }

    /// Returns the size of the textures, in bytes.
    pub(crate) fn bytes(&self) -> u64 {
        self.eye.bytes() + self.light.as_ref().map_or(0, PresenceTexture::bytes)
    }
}

/// Presence texture of a volume for an observer.
#[derive(Debug)]
pub(crate) struct PresenceTexture {
    pub texture: wgpu::Texture,
    pub views: PyramidViews,
}

impl PresenceTexture {
    fn new(context: &GpuContext, dims: [usize; 3]) -> Result<Self, GpuError> {
        let texture = context.texture(&wgpu::TextureDescriptor {
            mip_level_count: MAX_LEVEL + 1,
            ..texture_3d(
                "Volume::presence",
                pyramid_dims(dims),
                wgpu::TextureFormat::Rgba8Snorm,
                wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
            )
        })?;
        let views = PyramidViews::new(&texture);
        Ok(Self { texture, views })
    }

    /// Returns the boxes of texels of the coarsest level that depend on a box of voxels, for short upload steps.
    pub(crate) fn steps(
        &self,
        changed: &[Range<usize>; 3],
    ) -> impl Iterator<Item = [Range<usize>; 3]> + use<> {
        let size = self.texture.size();
        let size = [size.width, size.height, size.depth_or_array_layers].map(|n| (n >> MAX_LEVEL) as usize);
        let [across, down, slices] = [0, 1, 2].map(|axis| {
            let Range { start, end } = changed[axis];
            let first = (start + PYRAMID_PADDING).saturating_sub(COARSEST_REACH) >> MAX_LEVEL;
            first..size[axis].min(((end + PYRAMID_PADDING + COARSEST_REACH) >> MAX_LEVEL) + 1)
        });
        let texels = (across.len() * down.len()) << (3 * MAX_LEVEL);
        let each = (STEP_TEXELS / texels).max(1);
        slices
            .clone()
            .step_by(each)
            .map(move |first| [across.clone(), down.clone(), first..slices.end.min(first + each)])
    }

    /// Computes and uploads a box of texels of the coarsest level, with the corresponding texels of all finer levels.
    fn upload(&self, context: &GpuContext, source: PresenceSource<'_>, coarsest: &[Range<usize>; 3]) {
        for (mip_level, block) in (0..).zip(presence_levels(source, coarsest)) {
            let finer = MAX_LEVEL - mip_level;
            let kept = coarsest.each_ref().map(|range| range.start << finer..range.end << finer);
            let [x, y, z] = kept.each_ref().map(|range| range.start as u32);
            let [width, height, depth] = kept.each_ref().map(|range| range.len() as u32);
            context.queue.write_texture(
                wgpu::TexelCopyTextureInfo {
                    texture: &self.texture,
                    mip_level,
                    origin: wgpu::Origin3d { x, y, z },
                    aspect: wgpu::TextureAspect::All,
                },
                bytemuck::cast_slice(&block.texels(&kept)),
                wgpu::TexelCopyBufferLayout {
                    offset: 0,
                    bytes_per_row: Some(width * TEXEL_BYTES as u32),
                    rows_per_image: Some(height),
                },
                wgpu::Extent3d { width, height, depth_or_array_layers: depth },
            );
        }
    }

    fn bytes(&self) -> u64 {
        let size = self.texture.size();
        let texels = u64::from(size.width) * u64::from(size.height) * u64::from(size.depth_or_array_layers);
        // The coarser levels add a seventh.
        TEXEL_BYTES as u64 * texels * 8 / 7
    }
}
