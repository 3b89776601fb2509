//! Warm-up: compiling shader pipelines in the background, before they are needed.

use std::time::Duration;

use eframe::egui;

use super::jobs::{JobHandle, JobKind};
use chiaroscuro_render::{GpuError, ShaderLibrary};
use chiaroscuro_volume::CancelToken;

/// Jobs that compile pipelines in advance. Dropping this waits for them: a driver must not be unloaded while a thread
/// executes in it.
#[derive(Debug, Default)]
pub(super) struct PipelineWarmUp {
    jobs: Vec<JobHandle<()>>,
    /// True if nothing more is to be compiled in advance.
    pub is_complete: bool,
}

impl PipelineWarmUp {
    /// Starts the job that compiles pipelines which the first pictures do not use, once.
    pub(super) fn start_rest(&mut self, shaders: &ShaderLibrary, ctx: &egui::Context) {
        if !std::mem::replace(&mut self.is_complete, true)
            && let Err(err) = self.start(shaders, ShaderLibrary::warm_up_optional, ctx)
        {
            log::warn!("pipelines cannot be created ahead of time: {err}");
        }
    }

    /// Starts a job that compiles pipelines by calling `what`.
    pub(super) fn start(
        &mut self,
        shaders: &ShaderLibrary,
        what: fn(&ShaderLibrary, &CancelToken) -> Result<(), GpuError>,
        ctx: &egui::Context,
    ) -> std::io::Result<()> {
        let shaders = shaders.clone();
        self.jobs.push(JobHandle::start(JobKind::WarmUp, ctx, move |job| {
            if let Err(err) = what(&shaders, job.token()) {
                log::error!("pipelines could not be created ahead of time: {err}");
            }
            if let Err(err) = shaders.save_cache() {
                log::warn!("pipelines could not be cached for the next start: {err}");
            }
        })?);
        Ok(())
    }
}

impl Drop for PipelineWarmUp {
    fn drop(&mut self) {
        self.jobs.iter().for_each(|job| job.token().cancel());
        for job in self.jobs.drain(..) {
            // A panic was logged by its thread.
            drop(job.wait(Duration::MAX));
        }
    }
}
