//! Render worker: renders the window's pictures on the render thread.
//!
//! It works on the latest request, one job at a time: a preview at once, full quality when nothing has changed for a
//! moment, and antialiased edges after another one. A preview is always finished, so that a continuous drag shows pictures; a refinement is dropped as soon as
//! something else is requested.

mod balance;
mod finer_levels;
mod preparation;

use std::sync::{Arc, PoisonError};
use std::time::{Duration, Instant};

use eframe::egui::{self, ColorImage};

use self::finer_levels::{FinerLevelReader, with_pages_of};
use self::preparation::StepPreparation;
use super::brightness::BrightnessTracker;
use super::difference::PictureDifference;
use super::mailbox::{FinishedFrame, RenderStatistics, SharedMailbox};
use super::missing_light_volumes::MissingLightVolumes;
use super::quality::{QualityController, QualityLevel};
use super::render_schedule::{NextRender, RenderPurpose, RenderSchedule};
use super::request::{FrameRequest, RenderScene};
use chiaroscuro_files::fault::{FaultThread, panic_if_injected};
use chiaroscuro_render::{
    GpuContext, GpuError, PictureOptions, RenderOptions, RenderStage, WorkOptions,
    plan::{FrameKeys, RenderRequest},
};
use chiaroscuro_scene::Settings;
use chiaroscuro_volume::Dataset;

/// Interval at which a refinement reports progress: each report redraws the window, on the same processors if the
/// driver is software.
const PROGRESS_INTERVAL: Duration = Duration::from_millis(400);

/// Picture to be rendered next, with its purpose and quality.
#[derive(Debug, Clone)]
struct RenderTask {
    frame_request: FrameRequest,
    purpose: RenderPurpose,
    quality: QualityLevel,
}

/// Finished picture of one look.
struct RenderedLook {
    image: ColorImage,
    dataset: Dataset,
    shows_nothing: bool,
    request: RenderRequest,
    total_ms: f64,
}

/// State of the render thread.
pub(super) struct RenderWorker {
    ctx: egui::Context,
    shared: Arc<SharedMailbox>,
    agenda: RenderSchedule,
    controller: QualityController,
    brightness: BrightnessTracker,
    scene: Option<RenderScene>,
    /// Last request that was rendered at full quality: its light volumes are probably still cached.
    last_full_request: Option<(RenderRequest, FrameKeys)>,
    last_progress: Instant,
    preparation: StepPreparation,
    finer: FinerLevelReader,
}

impl RenderWorker {
    pub(super) fn new(context: &GpuContext, ctx: egui::Context, shared: Arc<SharedMailbox>) -> Self {
        Self {
            ctx,
            shared,
            agenda: RenderSchedule::new(),
            controller: QualityController::new(context.is_software()),
            brightness: BrightnessTracker::new(),
            scene: None,
            last_full_request: None,
            last_progress: Instant::now(),
            preparation: StepPreparation::default(),
            finer: FinerLevelReader::default(),
        }
    }

    /// Renders requests until the window closes or the device is lost.
    pub(super) fn run(&mut self) {
        while let Some((mut scene, purpose, frame_request)) = self.wait_for_work() {
            panic_if_injected(FaultThread::Worker);
            let result = self.render_request(&mut scene, purpose, frame_request);
            let lost = matches!(result, Err(GpuError::DeviceLost(_)));
            if result.is_err() && !lost {
                scene.renderer.drop_all();
                self.last_full_request = None;
            }
            // Without the memory of the steps that were prepared, the picture may succeed.
            let is_tried_again = result.is_err() && !lost && self.stop_preparing(&mut scene);
            self.scene = Some(scene);
            if let Err(err) = result
                && !is_tried_again
            {
                self.agenda.mark_failed();
                self.report(err);
                if lost {
                    return;
                }
            }
        }
    }

    /// Waits until a picture is due. Returns `None` when the window has closed.
    fn wait_for_work(&mut self) -> Option<(RenderScene, RenderPurpose, FrameRequest)> {
        let shared = Arc::clone(&self.shared);
        loop {
            self.read_mailbox();
            if self.agenda.is_closed {
                return None;
            }
            if let Some(scene) = self.agenda.take_scene() {
                self.controller.reset();
                self.brightness.reset();
                self.last_full_request = None;
                self.preparation = StepPreparation::default();
                self.finer = FinerLevelReader::default();
                self.scene = Some(scene);
            }
            if let Some(dataset) = self.agenda.take_dataset()
                && let Some(scene) = &mut self.scene
            {
                self.brightness.reset();
                self.last_full_request = None;
                scene.dataset = dataset;
                self.finer = FinerLevelReader::default();
            }
            self.measure_balance();
            self.prepare_upcoming();
            self.show_finer_levels();
            if self.agenda.has_other_volume() {
                // It has arrived meanwhile, and the request is of its generation: a picture of the present volume would be
                // taken for one of it.
                continue;
            }
            let due = if self.scene.is_some() { self.agenda.due() } else { NextRender::OnMailboxChange };
            let rest = match due {
                NextRender::Now(purpose, frame_request) => {
                    return self.scene.take().map(|scene| (scene, purpose, *frame_request));
                }
                NextRender::After(rest) => Some(rest),
                NextRender::OnMailboxChange => None,
            };
            let mailbox = shared.mailbox();
            // The mailbox may have changed since it was read.
            if self.agenda.has_news(&mailbox) || mailbox.balance_request.is_some() && self.can_measure() {
                continue;
            }
            match rest {
                None => drop(shared.changed.wait(mailbox).unwrap_or_else(PoisonError::into_inner)),
                Some(rest) => {
                    drop(shared.changed.wait_timeout(mailbox, rest).unwrap_or_else(PoisonError::into_inner));
                }
            }
        }
    }

    /// Takes new requests and options out of the mailbox.
    fn read_mailbox(&mut self) {
        let mut mailbox = self.shared.mailbox();
        if let Some(scene) = &mailbox.scene {
            mailbox.figures =
                RenderStatistics { gpu_bytes: scene.renderer.gpu_bytes(), ..RenderStatistics::default() };
        }
        self.agenda.read(&mut mailbox);
        mailbox.pages_arrived = false;
        if let Some(upcoming) = mailbox.upcoming.take() {
            self.preparation = StepPreparation::new(upcoming);
        }
        self.controller.set_frame_ms(mailbox.frame_ms);
    }

    /// Renders the requested picture, or both pictures of a comparison, and publishes it.
    fn render_request(
        &mut self,
        scene: &mut RenderScene,
        purpose: RenderPurpose,
        frame_request: FrameRequest,
    ) -> Result<(), GpuError> {
        let quality = match purpose {
            RenderPurpose::Preview => self.preview_quality(scene, &frame_request),
            RenderPurpose::Refinement => QualityLevel::FULL,
            RenderPurpose::Antialiasing => QualityLevel::ANTIALIASED,
        };
        let task = RenderTask { frame_request, purpose, quality };
        let looks = &task.frame_request.looks;
        let Some(left) = self.render_look(scene, &task, &looks.left, true)? else { return Ok(()) };
        let mut right = None;
        if let Some(settings) = &looks.right {
            right = self.render_look(scene, &task, settings, false)?;
            if right.is_none() {
                return Ok(());
            }
        }
        self.publish(scene, task, left, right);
        Ok(())
    }

    /// Chooses the quality level of a preview: a full one if only a display pass is needed.
    fn preview_quality(&self, scene: &RenderScene, frame_request: &FrameRequest) -> QualityLevel {
        let FrameRequest { looks, size, .. } = frame_request;
        for quality in [frame_request.final_quality(), QualityLevel::FULL] {
            let is_drawn = |settings: &Settings| {
                let request = scene.request(settings, *size, quality);
                scene.renderer.is_drawn(&request, &self.options(quality, settings))
            };
            if is_drawn(&looks.left) && looks.right.as_ref().is_none_or(is_drawn) {
                return quality;
            }
        }
        // A comparison has twice the pixels.
        let [width, height] = *size;
        let pixels = if looks.right.is_some() { [2 * width, height] } else { *size };
        let last_full_keys = self.last_full_request.as_ref().map(|(_, keys)| keys);
        let sky_intensity = looks.left.sky.intensity;
        let missing = if last_full_keys.is_none() && self.lacks_light_of_step(scene, frame_request) {
            MissingLightVolumes::all_of(frame_request.keys(), sky_intensity)
        } else {
            MissingLightVolumes::new(last_full_keys, frame_request.keys(), sky_intensity)
        };
        self.controller.preview_level(pixels, missing)
    }

    /// Returns the renderer's options for a look at a quality level.
    fn options(&self, quality: QualityLevel, look: &Settings) -> RenderOptions {
        let rays = if quality.antialiased { look.rays_per_pixel() } else { 1 };
        let work = WorkOptions {
            light_parts: self.controller.light_parts(quality),
            preview: !quality.is_full(),
            ..WorkOptions::default()
        };
        RenderOptions { picture: PictureOptions { rays, ..PictureOptions::default() }, ..work.into() }
    }

    /// Renders one look of a task; `None` if the task was dropped meanwhile.
    fn render_look(
        &mut self,
        scene: &mut RenderScene,
        task: &RenderTask,
        settings: &Settings,
        is_left: bool,
    ) -> Result<Option<RenderedLook>, GpuError> {
        let RenderTask { frame_request, purpose, quality } = task;
        let request = scene.request(settings, frame_request.size, *quality);
        let mut options = self.options(*quality, settings);
        let fills_before: u64 = scene.renderer.light_rebuilds().iter().sum();
        let context = scene.renderer.context().clone();
        let (mut total_ms, mut light_ms, mut indirect_ms, mut upload_ms) = (0.0, 0.0, 0.0, 0.0);
        let mut job = scene.renderer.begin(&scene.dataset, request.clone(), &options)?;
        job.set_band(self.controller.band_rows(*quality, request.size));
        if let Some(exposure) = self.brightness.exposure(frame_request, *quality, job.report()) {
            options.picture.exposure = exposure;
            job.set_exposure(exposure);
        }
        loop {
            let stage = job.stage();
            if self.agenda.is_stopped(*purpose) {
                self.shared.mailbox().figures.refinement_progress = None;
                return Ok(None);
            }
            if self.agenda.is_on_hold(*purpose)
                && matches!(stage, Some(RenderStage::Eye | RenderStage::Display))
            {
                // The products for volume and lights stay cached.
                self.agenda.mark_prepared(frame_request.clone());
                self.shared.mailbox().figures.refinement_progress = None;
                return Ok(None);
            }
            let start = Instant::now();
            let more = job.step()?;
            context.wait()?;
            let took_ms = start.elapsed().as_secs_f64() * 1000.0;
            job.learn_pace(took_ms);
            total_ms += took_ms;
            match stage {
                Some(RenderStage::LightMarch | RenderStage::LightBackproject) => light_ms += took_ms,
                Some(RenderStage::Sky | RenderStage::ScatteredLight) => indirect_ms += took_ms,
                Some(RenderStage::Upload | RenderStage::Pyramid) => upload_ms += took_ms,
                _ => {}
            }
            if !more {
                break;
            }
            if self.last_progress.elapsed() >= PROGRESS_INTERVAL {
                self.last_progress = Instant::now();
                let refining = job.stage().filter(|_| *purpose != RenderPurpose::Preview);
                let progress = job.progress().clamp(0.0, 1.0);
                self.shared.mailbox().figures.refinement_progress = refining.map(|stage| (stage, progress));
                self.ctx.request_repaint();
            }
            self.read_mailbox();
            if self.agenda.is_obsolete(*purpose, frame_request) {
                return Ok(None);
            }
        }
        let start = Instant::now();
        let is_full = quality.is_full();
        // Antialiasing changes neither the brightness nor what is measured of it, nor the time of a picture.
        let is_measured = !quality.antialiased;
        let mut dark_share = None;
        if is_full && is_left && is_measured {
            let is_at_rest = *purpose == RenderPurpose::Refinement;
            dark_share = self.brightness.measure_full(scene, frame_request, is_at_rest)?;
        } else if !is_full {
            let last_full = self.last_full_request.as_ref().map(|(request, _)| &request.settings);
            self.brightness.measure_preview(scene, frame_request, *quality, &request, &options, last_full)?;
        }
        let bytes = scene.renderer.read_display()?;
        let image = ColorImage::from_rgba_premultiplied(request.size.map(|n| n as usize), &bytes);
        let splats =
            if is_full && is_left && is_measured { Some(scene.renderer.splat_count()?) } else { None };
        total_ms += start.elapsed().as_secs_f64() * 1000.0;
        log::debug!("{quality:?} took {total_ms:.1} ms (light {light_ms:.1}, upload {upload_ms:.1})");
        let fills: u64 = scene.renderer.light_rebuilds().iter().sum();
        let runs = &scene.renderer.report().step_counts;
        if runs.eye > 0 && is_measured {
            let pixels = f64::from(request.size[0]) * f64::from(request.size[1]);
            self.controller.learn_picture(*quality, pixels, total_ms - light_ms - indirect_ms - upload_ms);
        }
        if fills > fills_before {
            self.controller.learn_build(*quality, light_ms / (fills - fills_before) as f64);
        }
        if is_full && is_left {
            self.last_full_request = Some((request.clone(), FrameKeys::new(&request, &options)));
        }
        if let Some(dataset) = scene.renderer.dataset() {
            // Keeps what the renderer computed for the dataset, so that the next picture does not repeat it.
            scene.dataset = with_pages_of(dataset, &scene.dataset);
        }
        let dataset = scene.dataset.clone().with_pages(None);
        let shows_nothing = scene.renderer.is_volume_transparent() || self.brightness.is_picture_empty();
        let mut mailbox = self.shared.mailbox();
        mailbox.figures.dark_share = dark_share.or(mailbox.figures.dark_share);
        mailbox.figures.splats = splats.unwrap_or(mailbox.figures.splats);
        Ok(Some(RenderedLook { image, dataset, shows_nothing, request, total_ms }))
    }

    /// Puts a finished picture and the statistics into the mailbox.
    fn publish(
        &mut self,
        scene: &RenderScene,
        task: RenderTask,
        left: RenderedLook,
        right: Option<RenderedLook>,
    ) {
        let RenderTask { frame_request, purpose, quality } = task;
        let RenderedLook { image, dataset, shows_nothing, request, total_ms } = left;
        let total_ms = right.as_ref().map_or(total_ms, |right| right.total_ms);
        let other = right.map(|right| {
            let difference = PictureDifference::between(&image, &right.image);
            (right.image, difference)
        });
        self.agenda.publish(frame_request.clone(), quality);
        let renderer = &scene.renderer;
        let mut mailbox = self.shared.mailbox();
        let figures = &mut mailbox.figures;
        if quality == QualityLevel::FULL {
            figures.full_ms = Some(total_ms);
        } else if !quality.is_full() {
            figures.preview_ms = Some(total_ms);
        }
        figures.refinements += u64::from(purpose == RenderPurpose::Refinement);
        figures.light_rebuilds = renderer.light_rebuilds().iter().sum();
        figures.cached_light_volumes = renderer.cached_light_volumes();
        figures.light_bytes = renderer.light_bytes();
        figures.light_volumes = renderer.light_statistics(&request);
        figures.sky = renderer.sky_statistics(&request);
        figures.bounces = renderer.scattered_light_statistics(&request);
        figures.gpu_bytes = renderer.gpu_bytes();
        figures.shows_nothing = shows_nothing;
        figures.refinement_progress = None;
        mailbox.frame =
            Some(FinishedFrame { request: frame_request, quality, dataset, image, compared: other });
        drop(mailbox);
        self.shared.finished.notify_one();
        self.ctx.request_repaint();
    }

    /// Puts an error into the mailbox.
    pub(super) fn report(&self, err: GpuError) {
        self.shared.mailbox().error = Some(err);
        self.shared.finished.notify_one();
        self.ctx.request_repaint();
    }
}
