//! Display pass: average of a pixel's samples, tone map, background and sRGB.

use super::render_target::{RenderTarget, TargetShape};
use crate::pipelines::binding::{bind_buffer, bind_view};
use crate::pipelines::pipeline_variant::{PipelineVariant, ShaderConstants};
use crate::pipelines::uniforms;
use crate::resources::gpu_tools::GpuTools;
use crate::resources::pass;
use crate::{GpuError, RenderOptions};
use chiaroscuro_scene::{Background, OutputSettings, PixelFormat, ToneMap};

/// Pipeline variant of the display pass.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct DisplayVariant {
    /// Number of samples along an edge of a pixel.
    pub samples: u32,
    /// `true` if linear light is written, without the sRGB curve.
    pub is_linear: bool,
    /// `true` if more than 8 bits per channel are written.
    pub is_deep: bool,
}

impl PipelineVariant for DisplayVariant {
    fn shader(&self) -> &'static str {
        if self.is_deep { "output/display_deep.wgsl" } else { "output/display.wgsl" }
    }

    fn constants(&self) -> ShaderConstants {
        let mut constants = Vec::new();
        if self.samples > 1 {
            constants.push(("SAMPLES", f64::from(self.samples)));
        }
        if self.is_linear {
            constants.push(("LINEAR", 1.0));
        }
        constants
    }
}

/// Converts linear light of the volume to the displayed picture of a target. All light is multiplied by the exposure of the settings, and
/// that of the volume also by the preview's exposure.
pub(crate) fn record_display(
    GpuTools { context, shaders, pool, .. }: &GpuTools,
    output: &OutputSettings,
    options: &RenderOptions,
    target: &RenderTarget,
    light: &wgpu::TextureView,
    encoder: &mut wgpu::CommandEncoder,
) -> Result<(), GpuError> {
    let TargetShape { size, samples, is_deep: deep } = target.shape;
    let variant =
        DisplayVariant { samples, is_linear: options.picture.depth == PixelFormat::Linear, is_deep: deep };
    let pipeline = shaders.pipeline(&variant)?;
    let ([first_column, first_row], rows) =
        options.picture.part.map_or(([0; 2], size[1]), |part| (part.first, part.whole[1]));
    let Background { top, bottom } = output.background;
    // A uniform background stays uniform, and pictures with more than 8 bits or a transparent background need no
    // dither.
    let is_dithered = top != bottom && !deep && !options.picture.transparent;
    let opaque = |[r, g, b]: [f32; 3]| [r, g, b, 1.0];
    let uniform = uniforms::DisplayUniform {
        top: opaque(top),
        bottom: opaque(bottom),
        transparent: u32::from(options.picture.transparent),
        clip: u32::from(output.tone_map == ToneMap::Clip),
        exposure: options.picture.exposure * output.exposure as f32,
        first_row: first_row as f32,
        rows: rows as f32,
        first_column: first_column as f32,
        dither_step: if is_dithered { 1.0 / 255.0 } else { 0.0 },
        floor_exposure: output.exposure as f32,
    };
    let uniform = pool.buffer(context, "Display::uniform", &[uniform], wgpu::BufferUsages::UNIFORM);
    let bind_group = pool.bind(
        context,
        "Display::bind_group",
        &pipeline,
        0,
        &[
            bind_buffer("bound_display", &uniform),
            bind_view("picture", light),
            bind_view("shown", &target.display.product.view),
            bind_view("floor_light", &target.floor.product.view),
        ],
    );
    pass::dispatch(
        encoder,
        "Display::pass",
        &pipeline,
        &[&bind_group],
        [size[0].div_ceil(8), size[1].div_ceil(8), 1],
    );
    Ok(())
}
