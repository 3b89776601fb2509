//! Looking into the renderer: pictures and light volumes, read back.

use crate::gpu::light::volume::LightVolume;
use crate::gpu::output::target::Target;
use crate::gpu::resources::readback::{Attenuation, read_floats, read_texture};
use crate::gpu::{GpuError, Renderer};
use crate::math::luminance;
use crate::plan::{LightKey, Request};

/// Opacity from which the volume is seen in a pixel: five of 255 steps before a background of the opposite brightness, the
/// least that an eye finds in a picture.
const SEEN_AT_ALL: f32 = 0.02;

/// Whether no pixel of some light shows anything of the volume, however much of it is there: linear, premultiplied RGBA.
pub fn is_empty_light(light: &[[f32; 4]]) -> bool {
    light.iter().all(|texel| texel[3] < SEEN_AT_ALL)
}

impl Renderer {
    /// Whether nothing of the volume is seen in what is shown now: all of it is transparent, too small for its pixels, or
    /// outside of the picture.
    ///
    /// # Errors
    /// As [`Self::read_shown`].
    pub fn is_picture_empty(&self) -> Result<bool, GpuError> {
        Ok(self.shows_nothing() || is_empty_light(&self.read_light()?))
    }

    /// What is shown now.
    pub(crate) fn shown(&self) -> Result<&Target, GpuError> {
        let front = &self.targets.front;
        if front.shown.is_complete() { Ok(front) } else { Err(GpuError::NothingDrawn("picture")) }
    }

    /// The texture of what is shown now, for passes on the same device.
    pub(in crate::gpu) fn shown_view(&self) -> Result<&wgpu::TextureView, GpuError> {
        Ok(&self.shown()?.shown.value.view)
    }

    /// Reads back what is shown now: sRGB bytes, RGBA, row by row from the top left.
    ///
    /// # Errors
    /// When there is no picture or the GPU cannot do it.
    pub fn read_shown(&self) -> Result<Vec<u8>, GpuError> {
        read_texture(self.context(), &self.shown()?.shown.value.texture)
    }

    /// Reads back the light of what is shown now: linear, premultiplied RGBA before tone mapping, row by
    /// row from the top left.
    ///
    /// # Errors
    /// As [`Self::read_shown`].
    pub fn read_light(&self) -> Result<Vec<[f32; 4]>, GpuError> {
        let bytes = read_texture(self.context(), &self.shown()?.light.value.plane.texture)?;
        let float = |word: &[u8]| f32::from_le_bytes([word[0], word[1], word[2], word[3]]);
        let texels = bytes.chunks_exact(16);
        Ok(texels.map(|texel| std::array::from_fn(|c| float(&texel[4 * c..]))).collect())
    }

    /// Reads back the floor under what is shown now: linear, premultiplied RGBA, row by row from the top left.
    ///
    /// # Errors
    /// As [`Self::read_shown`]; when there is no floor.
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

    /// The complete volume of a light, if it is kept.
    pub(crate) fn light_volume(&self, request: &Request, light: usize) -> Option<&LightVolume> {
        let key = LightKey::of(request, light)?;
        let lights = &self.loaded.as_ref()?.value.lights;
        lights.iter().find(|known| known.holds(&key)).map(|known| &known.value)
    }

    /// Reads back the attenuation volume that a light of the last picture used.
    ///
    /// # Errors
    /// When the GPU cannot do it. `None` when the light has no volume.
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
