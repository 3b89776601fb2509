//! Drawing of finished pictures into a host program's render passes, without a copy through host memory.

use crate::output::painter::{PaintMode, PainterPipeline};
use crate::{GpuContext, GpuError, Renderer};

/// Painter that draws a renderer's picture into render passes with a colour target of one format, without depth and
/// with one sample per pixel.
///
/// Texels arrive as [`Renderer::read_display`] returns them, alpha included; nothing is blended. Targets of 8 bits
/// receive the exact bytes, even if their format ends in `Srgb`: the shader decodes them first, because the GPU
/// encodes them again. Float targets receive the same numbers, from 0 to 1, and 32-bit floats all bits of deep
/// pictures. With [`chiaroscuro_scene::PixelFormat::Linear`] the values are linear light, which needs a float target.
#[derive(Debug, Clone)]
pub struct PicturePainter {
    device: wgpu::Device,
    pipeline: PainterPipeline,
}

impl PicturePainter {
    /// Creates a painter for the device of a renderer and targets of a format.
    ///
    /// # Errors
    /// Returns an error if the device cannot render into that format.
    pub fn new(context: &GpuContext, target: wgpu::TextureFormat) -> Result<Self, GpuError> {
        let [pipeline] = PainterPipeline::for_modes(&context.device, target, [PaintMode::Texels])?;
        Ok(Self { device: context.device.clone(), pipeline })
    }

    /// Records the drawing of the renderer's picture over the viewport of a pass: texel by texel if the viewport has
    /// the picture's size, else with the nearest texel of each pixel. The pass must be submitted before the renderer
    /// draws again.
    ///
    /// # Errors
    /// Returns an error if there is no picture.
    pub fn paint(&self, renderer: &Renderer, pass: &mut wgpu::RenderPass<'_>) -> Result<(), GpuError> {
        let picture = renderer.display_view()?;
        let resources = [wgpu::BindingResource::TextureView(picture)];
        let bind_group = self.pipeline.bind(&self.device, "PicturePainter::bind_group", &resources);
        self.pipeline.draw(pass, Some(&bind_group), 0);
        Ok(())
    }
}
