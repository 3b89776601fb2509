//! Readback of the displayed picture, its linear light, the floor and attenuation volumes.

use crate::gpu::light::volume::LightVolume;
use crate::gpu::output::target::Target;
use crate::gpu::resources::readback::{Attenuation, read_floats, read_texture};
use crate::gpu::{GpuError, Renderer};
use crate::math::luminance;
use crate::plan::{LightKey, Request};

/// Opacity from which the volume is noticeable in a pixel: five of 255 steps on a background of the opposite
/// brightness, the smallest visible difference.
const SEEN_AT_ALL: f32 = 0.02;

/// Returns true if the volume is noticeable in no pixel of the given light: linear, premultiplied RGBA.
pub fn is_empty_light(light: &[[f32; 4]]) -> bool {
    light.iter().all(|texel| texel[3] < SEEN_AT_ALL)
}

impl Renderer {
    /// Returns true if the volume is not visible in the displayed picture: transparent, smaller than pixels, or
    /// outside the view.
    ///
    /// # Errors
    /// Same as [`Self::read_shown`].
    pub fn is_picture_empty(&self) -> Result<bool, GpuError> {
        Ok(self.shows_nothing() || is_empty_light(&self.read_light()?))
    }

    /// Returns the target with the displayed picture.
    pub(crate) fn shown(&self) -> Result<&Target, GpuError> {
        let front = &self.targets.front;
        if front.shown.is_complete() { Ok(front) } else { Err(GpuError::NothingDrawn("picture")) }
    }

    /// Returns the view of the displayed picture, for passes on the same device.
    pub(in crate::gpu) fn shown_view(&self) -> Result<&wgpu::TextureView, GpuError> {
        Ok(&self.shown()?.shown.value.view)
    }

    /// Reads back the displayed picture: sRGB bytes, RGBA, row by row from the top left.
    ///
    /// # Errors
    /// Returns an error if there is no picture or the device fails.
    pub fn read_shown(&self) -> Result<Vec<u8>, GpuError> {
        read_texture(self.context(), &self.shown()?.shown.value.texture)
    }

    /// Reads back the linear light of the displayed picture: premultiplied RGBA before tone mapping, row by row from
    /// the top left.
    ///
    /// # Errors
    /// Same as [`Self::read_shown`].
    pub fn read_light(&self) -> Result<Vec<[f32; 4]>, GpuError> {
        let bytes = read_texture(self.context(), &self.shown()?.light.value.plane.texture)?;
        let float = |word: &[u8]| f32::from_le_bytes([word[0], word[1], word[2], word[3]]);
        let texels = bytes.chunks_exact(16);
        Ok(texels.map(|texel| std::array::from_fn(|c| float(&texel[4 * c..]))).collect())
    }

    /// Reads back the floor of the displayed picture: linear, premultiplied RGBA, row by row from the top left.
    ///
    /// # Errors
    /// Same as [`Self::read_shown`]; also if there is no floor.
    pub fn read_floor(&self) -> Result<Vec<[f32; 4]>, GpuError> {
        let target = self.shown()?;
        if !target.has_floor() {
            return Err(GpuError::NothingDrawn("floor"));
        }
        let bytes = read_texture(self.context(), &target.floor.value.texture)?;
        let float = |word: &[u8]| half::f16::from_le_bytes([word[0], word[1]]).to_f32();
        let texels = bytes.chunks_exact(8);
        Ok(texels.map(|texel| std::array::from_fn(|c| float(&texel[2 * c..]))).collect())
    }

    /// Returns the complete volume of a light, if it is cached.
    pub(crate) fn light_volume(&self, request: &Request, light: usize) -> Option<&LightVolume> {
        let key = LightKey::of(request, light)?;
        let lights = &self.loaded.as_ref()?.value.lights;
        lights.iter().find(|known| known.holds(&key)).map(|known| &known.value)
    }

    /// Reads back the attenuation volume of a light in the last picture; `None` if the light has no volume.
    ///
    /// # Errors
    /// Returns an error if the device fails.
    pub fn attenuation(&self, request: &Request, light: usize) -> Result<Option<Attenuation>, GpuError> {
        let Some(found) = self.light_volume(request, light) else { return Ok(None) };
        let floats = read_floats(self.context(), &found.texture)?;
        let (dims, divisor) = (found.dims, found.divisor);
        if !found.has_colors() {
            return Ok(Some(Attenuation { dims, divisor, values: floats, colors: Vec::new() }));
        }
        let colors: Vec<[f32; 3]> =
            floats.chunks_exact(4).map(|texel| [texel[0], texel[1], texel[2]]).collect();
        let values = colors.iter().map(|color| luminance(color.map(f64::from)) as f32).collect();
        Ok(Some(Attenuation { dims, divisor, values, colors }))
    }
}
