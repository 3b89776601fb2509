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
}

impl PipelineWarmUp {
    /// Number of jobs that were started.
    pub(super) fn job_count(&self) -> usize {
        self.jobs.len()
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
