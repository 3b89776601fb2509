//! Drawing of pictures into the window, and of the fill under its panels, in a render pass of the window's device.

use super::painter::{PaintMode, PainterPipeline};
use crate::GpuError;

/// Pipelines that draw pictures and fills into a target of one format.
#[derive(Debug, Clone)]
pub struct WindowPainter {
    device: wgpu::Device,
    queue: wgpu::Queue,
    picture: PainterPipeline,
    fill: PainterPipeline,
    /// Samplers for pictures that are scaled (linear), and for those with as many pixels as the window has there
    /// (nearest).
    samplers: [wgpu::Sampler; 2],
}

/// Picture in a texture of the window's device.
#[derive(Debug, Clone)]
pub struct WindowPicture {
    texture: wgpu::Texture,
    is_exact: bool,
    bind_group: wgpu::BindGroup,
    pipeline: PainterPipeline,
}

impl WindowPainter {
    /// Creates the pipelines for render passes into `target`, without depth and with one sample per pixel.
    ///
    /// # Errors
    /// Returns an error if the device cannot render into that format.
    pub fn new(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        target: wgpu::TextureFormat,
    ) -> Result<Self, GpuError> {
        let modes = [PaintMode::Picture, PaintMode::Fill];
        let [picture, fill] = PainterPipeline::for_modes(device, target, modes)?;
        let sampler = |filter| {
            device.create_sampler(&wgpu::SamplerDescriptor {
                label: Some("WindowPainter::sampler"),
                mag_filter: filter,
                min_filter: filter,
                ..wgpu::SamplerDescriptor::default()
            })
        };
        Ok(Self {
            picture,
            fill,
            samplers: [sampler(wgpu::FilterMode::Linear), sampler(wgpu::FilterMode::Nearest)],
            device: device.clone(),
            queue: queue.clone(),
        })
    }

    /// Uploads a picture of `size` pixels (sRGB, four bytes each, rows from the top), reusing the texture of the
    /// picture before it if size and filter are the same. `is_exact` tells that the window shows it with as many
    /// pixels.
    pub fn upload(
        &self,
        before: Option<WindowPicture>,
        size: [u32; 2],
        bytes: &[u8],
        is_exact: bool,
    ) -> WindowPicture {
        let [width, height] = size;
        let extent = wgpu::Extent3d { width, height, depth_or_array_layers: 1 };
        let picture = before
            .filter(|before| before.texture.size() == extent && before.is_exact == is_exact)
            .unwrap_or_else(|| self.new_picture(extent, is_exact));
        let rows =
            wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(4 * width), rows_per_image: None };
        self.queue.write_texture(picture.texture.as_image_copy(), bytes, rows, extent);
        picture
    }

    fn new_picture(&self, size: wgpu::Extent3d, is_exact: bool) -> WindowPicture {
        let texture = self.device.create_texture(&wgpu::TextureDescriptor {
            label: Some("WindowPicture::texture"),
            size,
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: wgpu::TextureFormat::Rgba8Unorm,
            usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
            view_formats: &[],
        });
        let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
        let sampler = &self.samplers[usize::from(is_exact)];
        let resources = [wgpu::BindingResource::TextureView(&view), wgpu::BindingResource::Sampler(sampler)];
        let bind_group = self.picture.bind(&self.device, "WindowPicture::bind_group", &resources);
        WindowPicture { texture, is_exact, bind_group, pipeline: self.picture.clone() }
    }

    /// Fills the viewport of a pass with an sRGB colour.
    pub fn fill(&self, pass: &mut wgpu::RenderPass<'_>, [red, green, blue]: [u8; 3]) {
        let number = u32::from_le_bytes([red, green, blue, 0]);
        self.fill.draw(pass, None, number);
    }
}

impl WindowPicture {
    /// Returns the width in pixels.
    pub fn width(&self) -> u32 {
        self.texture.width()
    }

    /// Draws the picture over the viewport of a pass with an opacity of `opacity` / 255, shifted right by `shift` of
    /// its own pixels; the area that the shift uncovers repeats the pixels of the edge.
    pub fn draw(&self, pass: &mut wgpu::RenderPass<'_>, opacity: u8, shift: i16) {
        let number = u32::from(opacity) | (u32::from(shift.wrapping_sub(i16::MIN) as u16) << 8);
        self.pipeline.draw(pass, Some(&self.bind_group), number);
    }
}
