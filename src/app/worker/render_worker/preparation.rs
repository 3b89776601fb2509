//! Preparation of time steps that may be shown next: while nothing is to be drawn, their voxels are uploaded and their
//! light volumes are filled.

use super::RenderWorker;
use crate::app::worker::mailbox::UpcomingSteps;
use crate::app::worker::missing_light_volumes::MissingLightVolumes;
use crate::app::worker::quality::QualityLevel;
use crate::app::worker::request::{FrameRequest, RenderScene};
use chiaroscuro_render::{GpuError, RenderStage};
use chiaroscuro_volume::{Dataset, memory_budget_bytes};

/// Memory of the adapter for steps that are not shown, in bytes: about eight steps of 256³ voxels with the light of two
/// lights, or one of 512³; an eighth of the memory of common cards.
const PREPARED_BYTES: u64 = 1 << 30;

/// Returns the memory for steps that are not shown, in bytes. The memory of a software adapter is that of the machine, of
/// which a quarter of what is free is left to them: filling the levels of a step again takes such an adapter long.
fn prepared_bytes(is_software: bool) -> u64 {
    if is_software { PREPARED_BYTES.max(memory_budget_bytes() / 4) } else { PREPARED_BYTES }
}

/// Time steps to prepare, and those that are.
#[derive(Default)]
pub(super) struct StepPreparation {
    upcoming: UpcomingSteps,
    /// Number of the steps that are prepared, from the first on.
    done: usize,
    /// Request for whose look they are.
    request: Option<FrameRequest>,
}

impl StepPreparation {
    /// Starts with steps of which none is prepared.
    pub(super) fn new(upcoming: UpcomingSteps) -> Self {
        Self { upcoming, ..Self::default() }
    }

    /// Returns the next step to prepare for a look, if any is left; another look begins again.
    fn next_for(&mut self, request: &FrameRequest) -> Option<Dataset> {
        if self.request.as_ref() != Some(request) {
            (self.request, self.done) = (Some(request.clone()), 0);
        }
        self.upcoming.datasets.get(self.done).cloned()
    }
}

impl RenderWorker {
    /// Returns true if the volume is one of several time steps, and its light has yet to be filled.
    pub(super) fn lacks_light_of_step(&self, scene: &RenderScene, frame_request: &FrameRequest) -> bool {
        let FrameRequest { looks, size, .. } = frame_request;
        let request = scene.request(&looks.left, *size, QualityLevel::FULL);
        let options = self.options(QualityLevel::FULL, &looks.left);
        self.preparation.upcoming.is_series && !scene.renderer.is_prepared(&scene.dataset, &request, &options)
    }

    /// Prepares the time steps that may be shown next, one after the other, until something is to be drawn.
    pub(super) fn prepare_upcoming(&mut self) {
        if !self.preparation.upcoming.is_series
            && let Some(scene) = &mut self.scene
        {
            // Steps of a series that has ended.
            scene.renderer.set_spare_volume_bytes(0);
        }
        loop {
            let Some(frame_request) = self.agenda.request_at_rest().cloned() else { return };
            let Some(dataset) = self.preparation.next_for(&frame_request) else { return };
            let Some(mut scene) = self.scene.take() else { return };
            let id = dataset.id();
            let bytes = prepared_bytes(scene.renderer.context().is_software());
            scene.renderer.set_spare_volume_bytes(bytes);
            let shown = std::mem::replace(&mut scene.dataset, dataset);
            let prepared = self.prepare(&mut scene, &frame_request);
            scene.dataset = shown;
            let is_interrupted = matches!(prepared, Ok(false));
            match prepared {
                // Others may have been named meanwhile.
                Ok(true) if self.preparation.next_for(&frame_request).is_some_and(|next| next.id() == id) => {
                    self.preparation.done += 1;
                }
                Ok(_) => {}
                // The picture that is shown is complete; only the memory for others is missing.
                Err(err) => {
                    log::warn!("a time step could not be prepared: {err}");
                    scene.renderer.drop_all();
                    self.stop_preparing(&mut scene);
                }
            }
            self.scene = Some(scene);
            if is_interrupted {
                return;
            }
        }
    }

    /// Stops preparing time steps until others are named, and frees their memory; returns false if none were prepared.
    pub(super) fn stop_preparing(&mut self, scene: &mut RenderScene) -> bool {
        let was_in_use = self.preparation.upcoming.is_series;
        self.preparation = StepPreparation::default();
        scene.renderer.set_spare_volume_bytes(0);
        was_in_use
    }

    /// Uploads the dataset of a scene and fills its light volumes, as a request needs them; returns false if something
    /// else came first.
    fn prepare(&mut self, scene: &mut RenderScene, frame_request: &FrameRequest) -> Result<bool, GpuError> {
        let look = &frame_request.looks.left;
        let quality = if self.preparation.upcoming.is_playing {
            let missing = MissingLightVolumes::all_of(frame_request.keys(), look.sky.intensity);
            self.controller.preview_level(frame_request.size, missing)
        } else {
            QualityLevel::FULL
        };
        let (request, options) =
            (scene.request(look, frame_request.size, quality), self.options(quality, look));
        if scene.renderer.is_prepared(&scene.dataset, &request, &options) {
            return Ok(true);
        }
        let context = scene.renderer.context().clone();
        let mut job = scene.renderer.begin(&scene.dataset, request, &options)?;
        while !matches!(job.stage(), None | Some(RenderStage::Eye | RenderStage::Display)) {
            let start = std::time::Instant::now();
            job.step()?;
            context.wait()?;
            job.learn_pace(start.elapsed().as_secs_f64() * 1000.0);
            self.read_mailbox();
            if self.agenda.request_at_rest() != Some(frame_request) {
                return Ok(false);
            }
        }
        Ok(true)
    }
}
