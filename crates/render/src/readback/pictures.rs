//! Readback of the displayed picture, its linear light, the floor and attenuation volumes.

use crate::light::light_volume::LightVolume;
use crate::output::render_target::RenderTarget;
use crate::plan::{LightKey, RenderRequest};
use crate::resources::textures::{AttenuationData, read_floats, read_texture};
use crate::{GpuError, Renderer};
use chiaroscuro_volume::math::luminance;

/// Opacity from which the volume is noticeable in a pixel: five of 255 steps on a background of the opposite
/// brightness, the smallest visible difference.
const NOTICEABLE_OPACITY: f32 = 0.02;

/// Returns true if the volume is noticeable in no pixel of the given light: linear, premultiplied RGBA.
pub fn is_empty_light(light: &[[f32; 4]]) -> bool {
    light.iter().all(|texel| texel[3] < NOTICEABLE_OPACITY)
}

impl Renderer {
    /// Returns true if the volume is not visible in the displayed picture: transparent, smaller than pixels, or
    /// outside the view.
    ///
    /// # Errors
    /// Same as [`Self::read_display`].
    pub fn is_picture_empty(&self) -> Result<bool, GpuError> {
        Ok(self.is_volume_transparent() || is_empty_light(&self.read_light()?))
    }

    /// Returns the target with the displayed picture.
    pub(crate) fn displayed_target(&self) -> Result<&RenderTarget, GpuError> {
        let front = &self.targets.front;
        if front.display.is_complete() { Ok(front) } else { Err(GpuError::NothingDrawn("picture")) }
    }

    /// Returns the view of the displayed picture, for passes on the same device.
    pub(crate) fn display_view(&self) -> Result<&wgpu::TextureView, GpuError> {
        Ok(&self.displayed_target()?.display.product.view)
    }

    /// Reads back the displayed picture: sRGB bytes, RGBA, row by row from the top left.
    ///
    /// # Errors
    /// Returns an error if there is no picture or the device fails.
    pub fn read_display(&self) -> Result<Vec<u8>, GpuError> {
        read_texture(self.context(), &self.displayed_target()?.display.product.texture)
    }

    /// Reads back the linear light of the displayed picture: premultiplied RGBA before tone mapping, row by row from
    /// the top left.
    ///
    /// # Errors
    /// Same as [`Self::read_display`].
    pub fn read_light(&self) -> Result<Vec<[f32; 4]>, GpuError> {
        let bytes = read_texture(self.context(), &self.displayed_target()?.displayed_light().texture)?;
        let float = |word: &[u8]| f32::from_le_bytes([word[0], word[1], word[2], word[3]]);
        let texels = bytes.chunks_exact(16);
        Ok(texels.map(|texel| std::array::from_fn(|c| float(&texel[4 * c..]))).collect())
    }

    /// Reads back the floor of the displayed picture: linear, premultiplied RGBA, row by row from the top left.
    ///
    /// # Errors
    /// Same as [`Self::read_display`]; also if there is no floor.
    #[cfg(feature = "testing")]
    pub fn read_floor(&self) -> Result<Vec<[f32; 4]>, GpuError> {
        let target = self.displayed_target()?;
        if !target.has_floor() {
            return Err(GpuError::NothingDrawn("floor"));
        }
        let bytes = read_texture(self.context(), &target.floor.product.texture)?;
        let float = |word: &[u8]| half::f16::from_le_bytes([word[0], word[1]]).to_f32();
        let texels = bytes.chunks_exact(8);
        Ok(texels.map(|texel| std::array::from_fn(|c| float(&texel[2 * c..]))).collect())
    }

    /// Returns the complete volume of a light, if it is cached.
    pub(crate) fn light_volume(&self, request: &RenderRequest, light: usize) -> Option<&LightVolume> {
        let loaded = &self.loaded.as_ref()?.product;
        // The volume was filled with the settings as they are drawn.
        let settings = request.settings.resolved_for_dataset(&loaded.dataset).into_owned();
        let key = LightKey::new(&RenderRequest { settings, ..request.clone() }, light)?;
        let lights = &loaded.lights;
        lights.iter().find(|known| known.is_valid_for(&key)).map(|known| &known.product)
    }

    /// Reads back the attenuation volume of a light in the last picture; `None` if the light has no volume.
    ///
    /// # Errors
    /// Returns an error if the device fails.
    pub fn attenuation(
        &self,
        request: &RenderRequest,
        light: usize,
    ) -> Result<Option<AttenuationData>, GpuError> {
        let Some(found) = self.light_volume(request, light) else { return Ok(None) };
        let floats = read_floats(self.context(), &found.texture)?;
        let (dims, divisor) = (found.dims, found.divisor);
        if !found.has_colors() {
            return Ok(Some(AttenuationData { dims, divisor, values: floats, colors: Vec::new() }));
        }
        let colors: Vec<[f32; 3]> =
            floats.chunks_exact(4).map(|texel| [texel[0], texel[1], texel[2]]).collect();
        let values = colors.iter().map(|color| luminance(color.map(f64::from)) as f32).collect();
        Ok(Some(AttenuationData { dims, divisor, values, colors }))
    }
}
