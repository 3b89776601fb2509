//! Warm-up: compiling shader pipelines in the background, before they are needed.

use std::thread::JoinHandle;

use chiaroscuro_render::{GpuError, ShaderLibrary};
use chiaroscuro_volume::CancelToken;

/// Threads that compile pipelines in advance. Dropping this waits for them: a driver must not be unloaded while a
/// thread executes in it.
#[derive(Debug, Default)]
pub(super) struct PipelineWarmUp {
    cancel: CancelToken,
    threads: Vec<JoinHandle<()>>,
}

impl PipelineWarmUp {
    /// Number of threads that were started.
    pub(super) fn thread_count(&self) -> usize {
        self.threads.len()
    }

    /// Starts a thread that compiles pipelines by calling `what`.
    pub(super) fn start(
        &mut self,
        shaders: &ShaderLibrary,
        what: fn(&ShaderLibrary, &CancelToken) -> Result<(), GpuError>,
    ) -> std::io::Result<()> {
        let (shaders, cancel) = (shaders.clone(), self.cancel.clone());
        let thread = std::thread::Builder::new().name("warm-up".to_owned());
        self.threads.push(thread.spawn(move || {
            if let Err(err) = what(&shaders, &cancel) {
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
        self.cancel.cancel();
        for thread in self.threads.drain(..) {
            // A panic was logged by its thread.
            drop(thread.join());
        }
    }
}
