//! Job: the work for one picture in steps, which borrows the renderer until it is done or dropped.

use std::collections::VecDeque;

use super::caches::scattered_light_volumes::ScatteredLightPlace;
use super::caches::sky_volumes::SkyPlace;
use super::double_buffer::{DoubleBuffer, TargetRole};
use super::light_fill::LightFill;
use super::loaded_volume::LoadedVolume;
use super::report::RenderReport;
use super::step::{RenderStage, RenderStep, split_into_bands};
use crate::context::gpu_clock::GpuClock;
use crate::eye::eye_pass::EyePass;
use crate::pipelines::shader_library::PipelinePreparation;
use crate::plan::{ActiveLights, FrameKeys, RenderRequest, VolumeKey};
use crate::resources::cache_entry::CacheEntry;
use crate::resources::gpu_tools::GpuTools;
use crate::resources::host_clock::HostClock;
use crate::resources::submission_pace::StepKind;
use crate::scatter::eye::EyeScatter;
use crate::scatter::voxels::ScatterState;
use crate::{GpuError, RenderOptions};
use chiaroscuro_scene::ShadowAlgorithm;

/// Approximate ratio of times per row, with rays to lights from every sample and without; bands have fewer rows by
/// this factor.
const RAY_ROW_COST: u32 = 16;

/// Work for one picture, executed step by step.
///
/// It borrows the renderer, so only one job exists at a time. Dropping it keeps the picture shown before, and the
/// products that are complete.
#[derive(Debug)]
pub struct RenderJob<'r> {
    pub(super) tools: &'r GpuTools,
    pub(super) gpu_clock: Option<&'r GpuClock>,
    pub(super) loaded: &'r mut CacheEntry<VolumeKey, LoadedVolume>,
    pub(super) targets: &'r mut DoubleBuffer,
    pub(super) fill_counts: &'r mut Vec<u64>,
    pub(super) report: &'r mut RenderReport,
    pub(super) request: RenderRequest,
    pub(super) options: RenderOptions,
    /// Keys of the products, with those of the light volumes in actual use (which may be coarser than requested).
    pub(super) keys: FrameKeys,
    pub(super) lights: ActiveLights,
    /// Index of each light's volume among the cached ones.
    pub(super) light_indices: Vec<Option<usize>>,
    pub(super) light_fills: Vec<LightFill>,
    /// Cached or new volume of sky visibility.
    pub(super) sky: SkyPlace,
    /// Cached or new volume of scattered light.
    pub(super) scattered_light: ScatteredLightPlace,
    /// Shading parameters with the volume of each light, for filling the combined volume.
    pub(super) combine_pass: Option<EyePass>,
    pub(super) eye_pass: EyePass,
    /// Rays of the picture in the index space of the volume in memory, for the floor, if those of the eye pass are in another.
    pub(super) floor_pass: Option<EyePass>,
    /// Compilation of its pipeline, if that was missing.
    pub(super) _eye_preparation: Option<PipelinePreparation>,
    pub(super) scattering: Option<ScatterState>,
    /// Sheets of the eye, for the scattering engine.
    pub(super) eye_sheets: Option<EyeScatter>,
    /// Target that is drawn into.
    pub(super) role: TargetRole,
    pub(super) steps: VecDeque<RenderStep>,
    pub(super) step_count: usize,
    /// Kind and number of the steps submitted last, until the pace has learned from them.
    pub(super) submitted: Option<(StepKind, u32)>,
}

impl RenderJob<'_> {
    /// Returns the request that the picture is made for.
    pub fn request(&self) -> &RenderRequest {
        &self.request
    }

    /// Returns the times and counts so far.
    pub fn report(&self) -> &RenderReport {
        self.report
    }

    /// Returns the fraction of the steps that are done, 0 to 1.
    pub fn progress(&self) -> f32 {
        1.0 - self.steps.len() as f32 / self.step_count.max(1) as f32
    }

    /// Returns the stage of the next step; `None` when the picture is complete.
    pub fn stage(&self) -> Option<RenderStage> {
        self.steps.iter().find_map(RenderStep::stage)
    }

    /// Returns true when the picture is complete.
    pub fn is_done(&self) -> bool {
        self.stage().is_none()
    }

    /// Sets the exposure of previews, which multiplies the displayed light; the linear picture is unchanged.
    pub fn set_exposure(&mut self, exposure: f32) {
        self.options.picture.exposure = exposure;
        self.keys.display = self.keys.display.clone().with_exposure(exposure);
    }

    /// Splits the rows that are still to be drawn into bands of `rows`.
    pub fn set_band(&mut self, rows: u32) {
        let direct = self.request.settings.shadows.algorithm == ShadowAlgorithm::Direct;
        // Rays to each light from every sample take that much longer.
        let rows = if direct { (rows / RAY_ROW_COST).max(8) } else { rows.max(1) };
        let before = self.steps.len();
        split_into_bands(&mut self.steps, rows);
        // Keeps the number of finished steps, so that progress stays correct.
        self.step_count = self.step_count - before + self.steps.len();
    }

    /// Submits the next steps: as many of a kind as the adapter takes at a time, or one if times are reported. Returns
    /// true if there are more; after the last one the new picture is the one that the renderer reads back.
    ///
    /// # Errors
    /// Returns the device's error.
    pub fn step(&mut self) -> Result<bool, GpuError> {
        self.finish_products();
        let Some(stage) = self.stage() else { return Ok(false) };
        let start = HostClock::start();
        let GpuTools { context, pool, pace, .. } = self.tools;
        let mut encoder = context.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let clock = self.gpu_clock.filter(|_| self.options.work.timed);
        if let Some(clock) = clock {
            clock.start(&mut encoder);
        }
        pool.begin_submission();
        let most = if self.options.work.timed { 1 } else { pace.steps(stage.kind()) };
        let recorded = self.record_steps(stage.kind(), most, &mut encoder);
        if let Some(clock) = clock {
            clock.stop(&mut encoder);
        }
        // Products of earlier steps count as complete, so these are submitted even if a later one failed.
        context.queue.submit([encoder.finish()]);
        self.report.host_ms += start.cpu_ms();
        let count = recorded?;
        self.submitted = Some((stage.kind(), count));
        self.finish_products();
        if self.options.work.timed {
            context.wait()?;
        }
        let took = start.wall_ms();
        self.report.add(stage, took, clock.map(|clock| clock.read_ms(context)).transpose()?);
        Ok(!self.is_done())
    }

    /// Records up to `most` steps of a kind into the encoder, and returns their number. Volumes end a submission, so
    /// that their filling can be timed.
    fn record_steps(
        &mut self,
        kind: StepKind,
        most: u32,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<u32, GpuError> {
        let mut count = 0;
        while count < most {
            if count > 0 && kind == StepKind::Picture {
                self.finish_products();
            }
            let is_next = |step: &RenderStep| step.stage().is_some_and(|stage| stage.kind() == kind);
            let Some(step) = self.steps.front().filter(|step| is_next(step)).cloned() else { break };
            self.encode(&step, encoder)?;
            self.steps.pop_front();
            count += 1;
        }
        Ok(count)
    }

    /// Returns true if the time of the last submission tells how many steps to submit at a time.
    pub(super) fn awaits_pace(&self) -> bool {
        self.submitted.is_some_and(|(kind, _)| self.tools.pace.grows(kind))
    }

    /// Adapts the number of steps per submission to the time of the last one, from its beginning until the adapter had
    /// finished it.
    pub fn learn_pace(&mut self, took_ms: f64) {
        self.learn_pace_of(1, took_ms);
    }

    /// Adapts the number of steps per submission to the time that the last `submissions` took together.
    pub(super) fn learn_pace_of(&mut self, submissions: u32, took_ms: f64) {
        let pace = &self.tools.pace;
        match self.submitted.take() {
            Some((kind, count)) if submissions == 1 => pace.learn(kind, count, took_ms),
            _ => pace.slow_down(submissions, took_ms),
        }
    }
}
