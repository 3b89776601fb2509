//! Finished pictures in render passes of a program that the renderer is a part of, without a way through host memory.

use crate::gpu::pipelines::shader::ShaderLibrary;
use crate::gpu::{Context, GpuError, Renderer};

/// Draws what a renderer shows into render passes with a colour target of one format, without depth and with one
/// sample per pixel.
///
/// Texels arrive as [`Renderer::read_shown`] gives them, alpha included; nothing is blended. Targets of 8 bits get
/// every byte, also when their format ends in `Srgb`; it is decoded first, because the GPU codes it again. Float
/// targets get the same numbers, from 0 to 1, and 32-bit floats all bits of deeper pictures. With
/// [`crate::model::Depth::Linear`] that is linear light, which needs a float target.
#[derive(Debug, Clone)]
pub struct PicturePainter {
    device: wgpu::Device,
    layout: wgpu::BindGroupLayout,
    pipeline: wgpu::RenderPipeline,
}

impl PicturePainter {
    /// A painter for render passes on the device of a renderer, into targets of a format.
    ///
    /// # Errors
    /// When the device cannot draw into that format.
    pub fn new(context: &Context, target: wgpu::TextureFormat) -> Result<Self, GpuError> {
        let device = &context.device;
        // It stores nothing: the formats do not matter.
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

    /// Records what the renderer shows over the viewport of a pass, which shows it texel by texel if it has the
    /// picture's size, and the nearest texel of each pixel if not. The pass must be submitted before the renderer
    /// draws again.
    ///
    /// # Errors
    /// When there is no picture.
    pub fn paint(&self, renderer: &Renderer, pass: &mut wgpu::RenderPass<'_>) -> Result<(), GpuError> {
        let picture = renderer.shown_view()?;
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
            entry_point: Some("corner"),
            buffers: &[],
            compilation_options: wgpu::PipelineCompilationOptions::default(),
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: None,
        multisample: wgpu::MultisampleState::default(),
        fragment: Some(wgpu::FragmentState {
            module,
            entry_point: Some("painted"),
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
