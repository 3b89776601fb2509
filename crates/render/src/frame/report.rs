//! Results of the renderer: picture, times and counts.

use super::step::RenderStage;

/// Finished picture in host memory.
#[derive(Debug, Clone, PartialEq)]
pub struct RenderedPicture {
    /// Number of pixels per row and column.
    pub size: [u32; 2],
    /// Linear, premultiplied RGBA before tone mapping, row by row from the top left.
    pub linear: Vec<[f32; 4]>,
    /// Displayed picture: RGBA in sRGB bytes.
    pub display: Vec<u8>,
}

/// Times and counts of one picture.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct RenderReport {
    /// Time of the upload, the pyramid and pre-classification, in milliseconds.
    pub upload_ms: f64,
    /// Time of the transfer tables and brick sets, in milliseconds.
    pub tables_ms: f64,
    /// Time of the light march, in milliseconds.
    pub light_march_ms: f64,
    /// Time of the back-projection of light, in milliseconds.
    pub light_backproject_ms: f64,
    /// Time of casting rays from the voxels of light volumes, in milliseconds.
    pub light_raycast_ms: f64,
    /// Time of computing sky visibility, in milliseconds.
    pub sky_ms: f64,
    /// Time of computing scattered light, in milliseconds.
    pub bounces_ms: f64,
    /// Time of the eye pass, of its antialiasing and of the floor pass, in milliseconds.
    pub eye_ms: f64,
    /// Time of the display pass and of reading back, in milliseconds.
    pub readback_ms: f64,
    /// Time of the host's own work in milliseconds: wall time of planning, and CPU time of layout, recording and
    /// submission, without waiting for the adapter and without reading back.
    pub host_ms: f64,
    /// GPU time of all light volumes, in milliseconds; `None` if the adapter has no timestamps.
    pub light_gpu_ms: Option<f64>,
    /// GPU time of the eye pass, in milliseconds; `None` if the adapter has no timestamps.
    pub eye_gpu_ms: Option<f64>,
    /// Size of the picture, in pixels.
    pub size: [u32; 2],
    /// Number of data voxels per voxel, along an axis, of the coarsest light volume looked up; 0 without one.
    pub light_divisor: usize,
    /// Number of slabs in the eye's stack.
    pub slabs: u32,
    /// Peak size of all textures and buffers so far, in bytes.
    pub peak_gpu_bytes: u64,
    /// Number of steps computed: those that a change made stale, and no others.
    pub step_counts: StepCounts,
}

/// Number of steps of each kind that a picture took.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct StepCounts {
    /// Number of blocks of the volume that were uploaded or prefiltered.
    pub volume: u32,
    /// Number of blocks of pages of finer levels that were uploaded.
    pub pages: u32,
    /// Number of blocks of voxels, or of coarser levels, that were classified.
    pub materials: u32,
    /// Number of lookup tables that were baked.
    pub tables: u32,
    /// Number of light volumes whose filling began.
    pub light_volumes: u32,
    /// Number of steps that filled the combined light volume.
    pub combined_light: u32,
    /// Number of sky-visibility volumes whose filling began.
    pub sky: u32,
    /// Number of scattered-light volumes whose filling began.
    pub bounces: u32,
    /// Number of steps of the eye pass.
    pub eye: u32,
    /// Number of steps of the antialiasing pass.
    pub antialiasing: u32,
    /// Number of steps of the floor pass.
    pub floor: u32,
    /// Number of display passes.
    pub display: u32,
}

impl RenderReport {
    /// Adds the wall time and the GPU time of a step.
    pub(crate) fn add(&mut self, stage: RenderStage, took_ms: f64, gpu_ms: Option<f64>) {
        let (sum, gpu_sum) = match stage {
            RenderStage::Upload | RenderStage::Pyramid => (&mut self.upload_ms, None),
            RenderStage::LightMarch => (&mut self.light_march_ms, Some(&mut self.light_gpu_ms)),
            RenderStage::LightBackproject => (&mut self.light_backproject_ms, Some(&mut self.light_gpu_ms)),
            RenderStage::LightRaycast => (&mut self.light_raycast_ms, Some(&mut self.light_gpu_ms)),
            RenderStage::Sky => (&mut self.sky_ms, Some(&mut self.light_gpu_ms)),
            RenderStage::ScatteredLight => (&mut self.bounces_ms, Some(&mut self.light_gpu_ms)),
            RenderStage::Eye => (&mut self.eye_ms, Some(&mut self.eye_gpu_ms)),
            RenderStage::Display => (&mut self.readback_ms, None),
        };
        *sum += took_ms;
        if let (Some(sum), Some(gpu_ms)) = (gpu_sum, gpu_ms) {
            *sum = Some(sum.unwrap_or(0.0) + gpu_ms);
        }
    }
}
