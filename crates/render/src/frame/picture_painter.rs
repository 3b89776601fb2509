//! Drawing of finished pictures into a host program's render passes, without a copy through host memory.

use crate::pipelines::shader_library::ShaderLibrary;
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
    layout: wgpu::BindGroupLayout,
    pipeline: wgpu::RenderPipeline,
}

impl PicturePainter {
    /// Creates a painter for the device of a renderer and targets of a format.
    ///
    /// # Errors
    /// Returns an error if the device cannot render into that format.
    pub fn new(context: &GpuContext, target: wgpu::TextureFormat) -> Result<Self, GpuError> {
        let device = &context.device;
        // The shader writes no storage textures, so these formats are unused.
        let format = wgpu::TextureFormat::R16Float;
        let source = ShaderLibrary::source("output/painter.wgsl", format, format)?;
        let scope = device.push_error_scope(wgpu::ErrorFilter::Validation);
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("output/painter.wgsl"),
            source: wgpu::ShaderSource::Wgsl(source.into()),
        });
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("PicturePainter::layout"),
            entries: &[wgpu::BindGroupLayoutEntry {
                binding: 0,
                visibility: wgpu::ShaderStages::FRAGMENT,
                ty: wgpu::BindingType::Texture {
                    sample_type: wgpu::TextureSampleType::Float { filterable: false },
                    view_dimension: wgpu::TextureViewDimension::D2,
                    multisampled: false,
                },
                count: None,
            }],
        });
        let pipeline = pipeline(device, &module, &layout, target);
        match pollster::block_on(scope.pop()) {
            None => Ok(Self { device: device.clone(), layout, pipeline }),
            Some(err) => Err(GpuError::Refused(format!("output/painter.wgsl: {err}"))),
        }
    }

    /// Records the drawing of the renderer's picture over the viewport of a pass: texel by texel if the viewport has
    /// the picture's size, else with the nearest texel of each pixel. The pass must be submitted before the renderer
    /// draws again.
    ///
    /// # Errors
    /// Returns an error if there is no picture.
    pub fn paint(&self, renderer: &Renderer, pass: &mut wgpu::RenderPass<'_>) -> Result<(), GpuError> {
        let picture = renderer.display_view()?;
        let bind_group = self.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("PicturePainter::bind_group"),
            layout: &self.layout,
            entries: &[wgpu::BindGroupEntry {
                binding: 0,
                resource: wgpu::BindingResource::TextureView(picture),
            }],
        });
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &bind_group, &[]);
        pass.draw(0..3, 0..1);
        Ok(())
    }
}

fn pipeline(
    device: &wgpu::Device,
    module: &wgpu::ShaderModule,
    layout: &wgpu::BindGroupLayout,
    target: wgpu::TextureFormat,
) -> wgpu::RenderPipeline {
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some("PicturePainter::pipeline_layout"),
        bind_group_layouts: &[Some(layout)],
        ..wgpu::PipelineLayoutDescriptor::default()
    });
    let constants = [("LINEAR_TARGET", f64::from(u8::from(target.is_srgb())))];
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("PicturePainter::pipeline"),
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module,
            entry_point: Some("triangle_corner"),
            buffers: &[],
            compilation_options: wgpu::PipelineCompilationOptions::default(),
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: None,
        multisample: wgpu::MultisampleState::default(),
        fragment: Some(wgpu::FragmentState {
            module,
            entry_point: Some("paint_pixel"),
            targets: &[Some(target.into())],
            compilation_options: wgpu::PipelineCompilationOptions {
                constants: &constants,
                ..wgpu::PipelineCompilationOptions::default()
            },
        }),
        multiview_mask: None,
        cache: None,
    })
}
