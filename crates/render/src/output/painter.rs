//! Pipelines that paint pictures and fills over the viewport of a render pass.

use crate::GpuError;
use crate::pipelines::shader_library::ShaderLibrary;

/// Shader of all pipelines.
const SHADER: &str = "output/painter.wgsl";

/// Content that a pipeline paints.
#[derive(Debug, Clone, Copy)]
pub(crate) enum PaintMode {
    /// Picture through a sampler, blended with a uniform opacity.
    Picture,
    /// Texels of a picture with their own alpha, in place of what is in the target.
    Texels,
    /// Uniform colour over the whole viewport.
    Fill,
}

impl PaintMode {
    fn entry_point(self) -> &'static str {
        match self {
            Self::Picture => "draw_picture",
            Self::Texels => "draw_texel",
            Self::Fill => "draw_fill",
        }
    }

    /// Returns the types of the bindings of the shader, in order.
    fn binding_types(self) -> Vec<wgpu::BindingType> {
        let texture = |filterable| wgpu::BindingType::Texture {
            sample_type: wgpu::TextureSampleType::Float { filterable },
            view_dimension: wgpu::TextureViewDimension::D2,
            multisampled: false,
        };
        match self {
            Self::Picture => {
                vec![texture(true), wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering)]
            }
            Self::Texels => vec![texture(false)],
            Self::Fill => Vec::new(),
        }
    }

    fn blend(self) -> Option<wgpu::BlendState> {
        match self {
            Self::Picture | Self::Fill => Some(wgpu::BlendState::PREMULTIPLIED_ALPHA_BLENDING),
            Self::Texels => None,
        }
    }
}

/// Pipeline for render passes with a colour target of one format, without depth and with one sample per pixel.
#[derive(Debug, Clone)]
pub(crate) struct PainterPipeline {
    raw: wgpu::RenderPipeline,
    layout: wgpu::BindGroupLayout,
}

impl PainterPipeline {
    /// Creates a pipeline for each mode, for a format of targets.
    ///
    /// # Errors
    /// Returns an error if the device cannot render into that format.
    pub(crate) fn for_modes<const N: usize>(
        device: &wgpu::Device,
        target: wgpu::TextureFormat,
        modes: [PaintMode; N],
    ) -> Result<[Self; N], GpuError> {
        // The shader writes no storage textures, so these formats are unused.
        let format = wgpu::TextureFormat::R16Float;
        let source = ShaderLibrary::source(SHADER, format, format)?;
        let scope = device.push_error_scope(wgpu::ErrorFilter::Validation);
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some(SHADER),
            source: wgpu::ShaderSource::Wgsl(source.into()),
        });
        let pipelines = modes.map(|mode| Self::new(device, &module, target, mode));
        match pollster::block_on(scope.pop()) {
            None => Ok(pipelines),
            Some(err) => Err(GpuError::Refused(format!("{SHADER}: {err}"))),
        }
    }

    fn new(
        device: &wgpu::Device,
        module: &wgpu::ShaderModule,
        target: wgpu::TextureFormat,
        mode: PaintMode,
    ) -> Self {
        let entry = |(binding, ty)| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: wgpu::ShaderStages::FRAGMENT,
            ty,
            count: None,
        };
        let entries: Vec<_> = (0..).zip(mode.binding_types()).map(entry).collect();
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some(mode.entry_point()),
            entries: &entries,
        });
        let groups = [Some(&layout)];
        let pipeline_layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some(mode.entry_point()),
            bind_group_layouts: &groups[..usize::from(!entries.is_empty())],
            ..wgpu::PipelineLayoutDescriptor::default()
        });
        let constants = [("LINEAR_TARGET", f64::from(u8::from(target.is_srgb())))];
        let raw = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some(mode.entry_point()),
            layout: Some(&pipeline_layout),
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
                entry_point: Some(mode.entry_point()),
                targets: &[Some(wgpu::ColorTargetState {
                    format: target,
                    blend: mode.blend(),
                    write_mask: wgpu::ColorWrites::ALL,
                })],
                compilation_options: wgpu::PipelineCompilationOptions {
                    constants: &constants,
                    ..wgpu::PipelineCompilationOptions::default()
                },
            }),
            multiview_mask: None,
            cache: None,
        });
        Self { raw, layout }
    }

    /// Binds the resources of the mode, in the order of the shader's bindings.
    pub(crate) fn bind(
        &self,
        device: &wgpu::Device,
        label: &str,
        resources: &[wgpu::BindingResource<'_>],
    ) -> wgpu::BindGroup {
        let entries: Vec<_> = (0..)
            .zip(resources)
            .map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource: resource.clone() })
            .collect();
        device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some(label),
            layout: &self.layout,
            entries: &entries,
        })
    }

    /// Records the drawing over the viewport of a pass; `number` carries the parameters of the mode.
    pub(crate) fn draw(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        bind_group: Option<&wgpu::BindGroup>,
        number: u32,
    ) {
        pass.set_pipeline(&self.raw);
        if bind_group.is_some() {
            pass.set_bind_group(0, bind_group, &[]);
        }
        pass.draw(0..3, number..number + 1);
    }
}
