//! What is asked of the renderer besides the look, and what it answers.

use crate::model::{Depth, Shot};
use crate::plan::{PixelWindow, Request};

/// Ways of rendering that are no part of the look.
#[derive(Debug, Clone, PartialEq)]
pub struct RenderOptions {
    /// Leave out the background, write straight alpha.
    pub transparent: bool,
    /// Leap over empty bricks. Only a test that it changes nothing, and a measurement of what it
    /// saves, switch it off.
    pub leaping: bool,
    /// Fill light volumes everywhere, not only where the picture looks them up.
    pub fill_everything: bool,
    /// A ray ends when less than this is left of its light, to the eye or from a light.
    pub dark: f32,
    /// Slabs per chunk of the light march, instead of what memory and time suggest.
    pub chunk: Option<u32>,
    /// Pieces into which each chunk of the light pass is cut, for short submissions.
    pub light_parts: u32,
    /// Take shortcuts with stretched kernels that only previews may: normals from the texture of gradients,
    /// and nothing of their outermost tails.
    pub preview: bool,
    /// Wait after every step, so that a report's stages are true.
    pub timed: bool,
    /// The part of the picture that is drawn, if not all of it.
    pub part: Option<PixelWindow>,
    /// Samples of a pixel along an edge.
    pub samples: u32,
    /// What is shown.
    pub depth: Depth,
}

impl Default for RenderOptions {
    fn default() -> Self {
        Self {
            transparent: false,
            leaping: true,
            fill_everything: false,
            // 1/16 of an 8-bit step.
            dark: 1.0 / 4096.0,
            chunk: None,
            light_parts: 1,
            preview: false,
            timed: false,
            part: None,
            samples: 1,
            depth: Depth::Eight,
        }
    }
}

impl RenderOptions {
    /// What a picture is drawn with that is taken like this.
    pub fn of_shot(shot: &Shot) -> Self {
        let Shot { size: _, transparent, samples, depth } = *shot;
        Self { transparent, samples, depth, ..Self::default() }
    }

    /// The part of a picture that is shown.
    pub(crate) fn shown(&self, request: &Request) -> PixelWindow {
        self.part.unwrap_or_else(|| request.size.into())
    }

    /// The samples that are drawn for it.
    pub(crate) fn window(&self, request: &Request) -> PixelWindow {
        self.shown(request).finer(self.samples)
    }

    /// `dark` as an optical depth.
    pub(crate) fn dark_depth(&self) -> f32 {
        // No 32-bit optical depth is beyond that of nothing at all.
        if self.dark > 0.0 { -self.dark.ln() } else { f32::MAX }
    }
}

/// A finished picture on the CPU.
#[derive(Debug, Clone, PartialEq)]
pub struct Picture {
    /// Pixels per row and column.
    pub size: [u32; 2],
    /// Linear, premultiplied RGBA before tone mapping, row by row from the top left.
    pub light: Vec<[f32; 4]>,
    /// sRGB bytes, RGBA.
    pub shown: Vec<u8>,
}

/// What a picture took.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Report {
    /// Milliseconds of the upload and the pyramid.
    pub upload_ms: f64,
    /// Milliseconds of the transfer functions and brick sets.
    pub bricks_ms: f64,
    /// Milliseconds of the forward half of the light pass.
    pub light_march_ms: f64,
    /// Milliseconds of its reverse half.
    pub light_backproject_ms: f64,
    /// Milliseconds of rays from the voxels of light volumes.
    pub light_raycast_ms: f64,
    /// Milliseconds of the eye pass.
    pub eye_ms: f64,
    /// Milliseconds of the display pass and of reading back.
    pub readback_ms: f64,
    /// The same of both halves and of rays, and of the eye pass, by the GPU's own clock, if it has one.
    pub light_gpu_ms: Option<f64>,
    /// Of the eye pass.
    pub eye_gpu_ms: Option<f64>,
    /// Pixels of the picture.
    pub size: [u32; 2],
    /// Data voxels per voxel, along an axis, of the coarsest light volume that was looked up; 0 without.
    pub light_divisor: usize,
    /// Slabs of the eye's stack.
    pub slabs: u32,
    /// Largest sum of our textures and buffers so far.
    pub peak_gpu_bytes: u64,
}
