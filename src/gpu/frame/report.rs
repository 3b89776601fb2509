//! What the renderer answers: a picture, and what it took.

use super::step::Stage;

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
    /// Milliseconds of the light of the sky.
    pub sky_ms: f64,
    /// Milliseconds of light that bounces.
    pub bounces_ms: f64,
    /// Milliseconds of the eye pass.
    pub eye_ms: f64,
    /// Milliseconds of the display pass and of reading back.
    pub readback_ms: f64,
    /// Milliseconds of the light pass, both halves and rays, by the GPU's own clock, if it has one.
    pub light_gpu_ms: Option<f64>,
    /// Milliseconds of the eye pass by the GPU's own clock, if it has one.
    pub eye_gpu_ms: Option<f64>,
    /// Pixels of the picture.
    pub size: [u32; 2],
    /// Data voxels per voxel, along an axis, of the coarsest light volume that was looked up; 0 without.
    pub light_divisor: usize,
    /// Slabs of the eye's stack.
    pub slabs: u32,
    /// Largest sum of our textures and buffers so far.
    pub peak_gpu_bytes: u64,
    /// What was computed for it, in steps: what a change made stale, and nothing else.
    pub runs: Runs,
}

/// How many pieces of each kind of work a picture took.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Runs {
    /// Blocks of the volume that were uploaded or prefiltered.
    pub volume: u32,
    /// Blocks of voxels that were classified, or of coarser levels of them.
    pub materials: u32,
    /// Lookup tables that were baked.
    pub tables: u32,
    /// Light volumes whose filling began.
    pub light_volumes: u32,
    /// Pieces of the combined light volume.
    pub combined_light: u32,
    /// Volumes of the sky's visibility whose filling began.
    pub sky: u32,
    /// Volumes of bounced light whose filling began.
    pub bounces: u32,
    /// Pieces of the eye pass.
    pub eye: u32,
    /// Pieces of the floor pass.
    pub floor: u32,
    /// Display passes.
    pub display: u32,
}

impl Report {
    /// Notes what a step took, in all and by the GPU's own clock.
    pub(crate) fn add(&mut self, stage: Stage, took_ms: f64, gpu_ms: Option<f64>) {
        let (sum, gpu_sum) = match stage {
            Stage::Upload | Stage::Pyramid => (&mut self.upload_ms, None),
            Stage::LightMarch => (&mut self.light_march_ms, Some(&mut self.light_gpu_ms)),
            Stage::LightBackproject => (&mut self.light_backproject_ms, Some(&mut self.light_gpu_ms)),
            Stage::LightRaycast => (&mut self.light_raycast_ms, Some(&mut self.light_gpu_ms)),
            Stage::Sky => (&mut self.sky_ms, Some(&mut self.light_gpu_ms)),
            Stage::Bounces => (&mut self.bounces_ms, Some(&mut self.light_gpu_ms)),
            Stage::Eye => (&mut self.eye_ms, Some(&mut self.eye_gpu_ms)),
            Stage::Display => (&mut self.readback_ms, None),
        };
        *sum += took_ms;
        if let (Some(sum), Some(gpu_ms)) = (gpu_sum, gpu_ms) {
            *sum = Some(sum.unwrap_or(0.0) + gpu_ms);
        }
    }
}
