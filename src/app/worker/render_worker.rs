//! What the thread that renders the window's pictures does.
//!
//! It works on the latest of what is wanted, one job at a time: a preview at once, full quality when
//! nothing has changed for a moment. A preview is always finished, so that a hand that never rests
//! sees pictures; a refinement is dropped as soon as something else is wanted.

use std::sync::{Arc, PoisonError};
use std::time::{Duration, Instant};

use eframe::egui::{self, ColorImage};

use super::difference::Difference;
use super::exposure::{Exposures, Kind};
use super::quality::{Missing, QualityController, QualityLevel};
use super::render_thread::{Figures, Frame, Shared};
use super::request::{FrameRequest, Scene};
use crate::gpu::{Context, GpuError, RenderOptions, Renderer, Report, Stage, dark_share, mean_luminance};
use crate::model::Settings;
use crate::plan::{FrameKeys, Request};

/// A change this long ago is over: time to refine.
const REST: Duration = Duration::from_millis(150);

/// How often a refinement tells how far it is: each time the window is drawn, where the driver is software by the
/// same processors.
const TELL_EVERY: Duration = Duration::from_millis(400);

/// Largest previews whose brightness is measured: two milliseconds for a software adapter.
const EXPOSED_PIXELS: u64 = 1 << 18;

/// How often darkness is measured while something moves on an adapter that previews at full quality:
/// it reads back sixteen bytes per pixel.
const MEASURE_EVERY: Duration = Duration::from_millis(250);

/// A picture to be made now.
#[derive(Debug, Clone)]
struct Task {
    wanted: FrameRequest,
    quality: QualityLevel,
    /// Begun while the user moves something: it is finished whatever happens.
    is_preview: bool,
}

impl Task {
    /// Whether it is a preview whose brightness is compensated: not of two looks, whose difference counts.
    fn is_exposed(&self) -> bool {
        self.quality != QualityLevel::FULL && self.wanted.other.is_none()
    }
}

/// A finished picture of one look.
struct Made {
    image: ColorImage,
    request: Request,
    total_ms: f64,
}

/// Whether only the camera and the places of lights differ.
fn is_movement(from: &Settings, to: &Settings) -> bool {
    let mut moved = from.clone();
    moved.camera = to.camera.clone();
    for (light, target) in moved.lights.iter_mut().zip(&to.lights) {
        light.position = target.position;
    }
    moved == *to
}

/// What decides how far the brightness of a preview is off.
fn kind_of(quality: QualityLevel, report: &Report) -> Kind {
    Kind { scale: quality.scale, quick_eye: quality.quick_eye, light_divisor: report.light_divisor }
}

/// The thread's own side.
pub(super) struct RenderWorker {
    ctx: egui::Context,
    shared: Arc<Shared>,
    software: bool,
    controller: QualityController,
    scene: Option<Scene>,
    /// A scene has come that replaces the one that is worked on.
    next_scene: Option<Scene>,
    wanted: Option<FrameRequest>,
    changed: Instant,
    /// A picture was handed over, and the window had not taken it when the mailbox was looked at last.
    is_frame_pending: bool,
    is_closed: bool,
    /// What is on screen, or on its way there.
    shown: Option<(FrameRequest, QualityLevel)>,
    /// The last request that was rendered at full quality: its light volumes are likely there.
    last_full: Option<(Request, FrameKeys)>,
    failed: Option<FrameRequest>,
    last_progress: Instant,
    /// When darkness was measured.
    measured: Instant,
    exposures: Exposures,
    last_preview: Option<FrameRequest>,
}

impl RenderWorker {
    pub(super) fn new(context: &Context, ctx: egui::Context, shared: Arc<Shared>) -> Self {
        let software = context.is_software();
        let now = Instant::now();
        Self {
            ctx,
            shared,
            software,
            controller: QualityController::new(software),
            scene: None,
            next_scene: None,
            wanted: None,
            changed: now,
            is_frame_pending: false,
            is_closed: false,
            shown: None,
            last_full: None,
            failed: None,
            last_progress: now,
            measured: now,
            exposures: Exposures::default(),
            last_preview: None,
        }
    }

    /// Renders what is wanted until the window closes.
    pub(super) fn work(&mut self) {
        while let Some((mut scene, is_preview)) = self.wait_for_work() {
            let result = self.make(&mut scene, is_preview);
            self.scene = Some(scene);
            if let Err(err) = result {
                self.failed.clone_from(&self.wanted);
                let lost = matches!(err, GpuError::Lost(_));
                self.tell(err);
                if lost {
                    return;
                }
            }
        }
    }

    /// Waits until something is to be drawn: a preview (`true`), or full quality. `None` when the window closed.
    fn wait_for_work(&mut self) -> Option<(Scene, bool)> {
        let shared = Arc::clone(&self.shared);
        loop {
            self.read_mailbox();
            if self.is_closed {
                return None;
            }
            if let Some(scene) = self.next_scene.take() {
                self.controller = QualityController::new(self.software);
                self.scene = Some(scene);
                (self.shown, self.last_full, self.failed) = Default::default();
                (self.exposures, self.last_preview) = (Exposures::default(), None);
            }
            if let Some(is_preview) = self.due()
                && let Some(scene) = self.scene.take()
            {
                return Some((scene, is_preview));
            }
            let rest = (self.is_unfinished() && !self.is_frame_pending)
                .then(|| REST.saturating_sub(self.changed.elapsed()).max(Duration::from_millis(1)));
            let mailbox = shared.mailbox();
            // Something may have come since it was read.
            if mailbox.has_news(self.is_frame_pending) {
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

    /// Takes note of what the window wants now.
    fn read_mailbox(&mut self) {
        let shared = Arc::clone(&self.shared);
        let mut mailbox = shared.mailbox();
        self.is_closed = mailbox.closed;
        if let Some(scene) = mailbox.scene.take() {
            mailbox.figures = Figures { gpu_bytes: scene.renderer.gpu_bytes(), ..Figures::default() };
            self.next_scene = Some(scene);
            self.wanted = None;
        }
        self.controller.set_frame_ms(mailbox.frame_ms);
        if let Some(wanted) = mailbox.wanted.take() {
            self.changed = Instant::now();
            self.wanted = Some(wanted);
        }
        // Until the window takes a picture nobody knows what it wants next: refining might only delay it.
        if self.is_frame_pending {
            self.changed = Instant::now();
            self.is_frame_pending = mailbox.frame.is_some();
        }
    }

    /// Whether a task must be dropped: the window closed or shows something else, or a refinement is of something
    /// that is no longer wanted.
    fn is_obsolete(&mut self, task: &Task) -> bool {
        self.read_mailbox();
        let is_other = !task.is_preview && Some(&task.wanted) != self.wanted.as_ref();
        self.is_closed || self.next_scene.is_some() || is_other
    }

    /// Whether something is wanted that is not on screen at full quality.
    fn is_unfinished(&self) -> bool {
        let Some(wanted) = &self.wanted else { return false };
        let is_shown = self
            .shown
            .as_ref()
            .is_some_and(|(shown, quality)| shown == wanted && *quality == QualityLevel::FULL);
        self.scene.is_some() && !is_shown && self.failed.as_ref() != Some(wanted)
    }

    /// What should be begun now: a preview (`true`), or full quality.
    fn due(&self) -> Option<bool> {
        if !self.is_unfinished() {
            return None;
        }
        // Something to look at comes first.
        let is_preview = self.shown.as_ref().map(|(shown, _)| shown) != self.wanted.as_ref();
        (is_preview || self.changed.elapsed() >= REST).then_some(is_preview)
    }

    /// Makes the picture that is wanted, or both of two that are compared, and hands it over.
    fn make(&mut self, scene: &mut Scene, is_preview: bool) -> Result<(), GpuError> {
        let Some(wanted) = self.wanted.clone() else { return Ok(()) };
        let quality = if is_preview { self.preview_quality(scene, &wanted) } else { QualityLevel::FULL };
        let task = Task { wanted, quality, is_preview };
        let Some(left) = self.render(scene, &task, &task.wanted.settings, true)? else { return Ok(()) };
        let mut other = None;
        if let Some(settings) = &task.wanted.other {
            let Some(right) = self.render(scene, &task, settings, false)? else { return Ok(()) };
            other = Some((right.image, right.total_ms));
        }
        self.hand_over(scene, task, left, other);
        Ok(())
    }

    /// How a preview is rendered: in full where that takes no more than a display pass.
    fn preview_quality(&self, scene: &Scene, wanted: &FrameRequest) -> QualityLevel {
        let options = self.options(QualityLevel::FULL);
        let is_drawn = |settings: &Settings| {
            let request = request_of(scene, settings, wanted.size, QualityLevel::FULL);
            scene.renderer.is_drawn(&request, &options)
        };
        if is_drawn(&wanted.settings) && wanted.other.as_ref().is_none_or(is_drawn) {
            return QualityLevel::FULL;
        }
        // Two pictures have twice the pixels.
        let [width, height] = wanted.size;
        let pixels = if wanted.other.is_some() { [2 * width, height] } else { wanted.size };
        let settled = self.last_full.as_ref().map(|(_, keys)| keys);
        self.controller.preview(pixels, missing(settled, wanted.keys()))
    }

    /// How the renderer is to go about a quality.
    fn options(&self, quality: QualityLevel) -> RenderOptions {
        RenderOptions {
            light_parts: self.controller.light_parts(quality),
            preview: quality != QualityLevel::FULL,
            ..RenderOptions::default()
        }
    }

    /// Renders one look of a task; `None` if the task was dropped meanwhile.
    fn render(
        &mut self,
        scene: &mut Scene,
        task: &Task,
        settings: &Settings,
        is_left: bool,
    ) -> Result<Option<Made>, GpuError> {
        let Task { wanted, quality, is_preview } = task;
        let request = request_of(scene, settings, wanted.size, *quality);
        let mut options = self.options(*quality);
        let fills_before: u64 = scene.renderer.light_rebuilds().iter().sum();
        let context = scene.renderer.context().clone();
        let (mut total_ms, mut light_ms) = (0.0, 0.0);
        let mut job = scene.renderer.begin(&scene.dataset, request.clone(), &options)?;
        job.set_band(self.controller.rows(*quality, request.size));
        if task.is_exposed() {
            let kind = kind_of(*quality, job.report());
            options.exposure = self.exposures.of(kind).unwrap_or(1.0) as f32;
            job.set_exposure(options.exposure);
        }
        loop {
            let stage = job.stage();
            let start = Instant::now();
            let more = job.step()?;
            context.wait()?;
            let took_ms = start.elapsed().as_secs_f64() * 1000.0;
            total_ms += took_ms;
            if matches!(stage, Some(Stage::LightMarch | Stage::LightBackproject)) {
                light_ms += took_ms;
            }
            if !more {
                break;
            }
            if self.last_progress.elapsed() >= TELL_EVERY {
                self.last_progress = Instant::now();
                let refining = job.stage().filter(|_| !is_preview);
                let progress = job.progress().clamp(0.0, 1.0);
                self.shared.mailbox().figures.refining = refining.map(|stage| (stage, progress));
                self.ctx.request_repaint();
            }
            if self.is_obsolete(task) {
                return Ok(None);
            }
        }
        let start = Instant::now();
        let dark_share = self.measure(scene, task, &request, &options, is_left)?;
        let bytes = scene.renderer.read_shown()?;
        let image = ColorImage::from_rgba_premultiplied(request.size.map(|n| n as usize), &bytes);
        let is_settled = is_left && *quality == QualityLevel::FULL;
        let splats = if is_settled { Some(scene.renderer.splats()?) } else { None };
        total_ms += start.elapsed().as_secs_f64() * 1000.0;
        log::debug!("{quality:?} took {total_ms:.1} ms, of which the light {light_ms:.1} ms");
        let fills: u64 = scene.renderer.light_rebuilds().iter().sum();
        if scene.renderer.report().runs.eye > 0 {
            let pixels = f64::from(request.size[0]) * f64::from(request.size[1]);
            self.controller.learn_picture(*quality, pixels, total_ms - light_ms);
        }
        if fills > fills_before {
            self.controller.learn_build(*quality, light_ms / (fills - fills_before) as f64);
        }
        if is_settled {
            self.last_full = Some((request.clone(), FrameKeys::of(&request, &options)));
        }
        let mut mailbox = self.shared.mailbox();
        mailbox.figures.dark_share = dark_share.or(mailbox.figures.dark_share);
        mailbox.figures.splats = splats.unwrap_or(mailbox.figures.splats);
        Ok(Some(Made { image, request, total_ms }))
    }

    /// Learns from the light of a complete picture, and keeps a preview as bright as those at full quality.
    /// Returns the share of a picture at full quality that is nearly black.
    fn measure(
        &mut self,
        scene: &mut Scene,
        task: &Task,
        request: &Request,
        options: &RenderOptions,
        is_left: bool,
    ) -> Result<Option<f64>, GpuError> {
        let Task { wanted, quality, is_preview } = task;
        if *quality == QualityLevel::FULL {
            let is_due = !is_preview || self.measured.elapsed() >= MEASURE_EVERY;
            if !is_left || !is_due {
                return Ok(None);
            }
            self.measured = Instant::now();
            let light = scene.renderer.read_light()?;
            if wanted.other.is_none() {
                let is_of_last_preview = self.last_preview.as_ref() == Some(wanted);
                self.exposures.settle(mean_luminance(&light), is_of_last_preview);
            }
            return Ok(Some(dark_share(&light)));
        }
        let [width, height] = request.size;
        // What changes more than a movement may change the brightness, and should be seen to.
        let settled = self.last_full.as_ref().map(|(request, _)| &request.settings);
        let moves = settled.is_some_and(|settled| is_movement(settled, &wanted.settings));
        if !(task.is_exposed() && moves && u64::from(width) * u64::from(height) <= EXPOSED_PIXELS) {
            return Ok(None);
        }
        let mean = mean_luminance(&scene.renderer.read_light()?);
        self.last_preview = Some(wanted.clone());
        let kind = kind_of(*quality, scene.renderer.report());
        if let Some(exposure) = self.exposures.preview(kind, mean) {
            expose(scene, request, RenderOptions { exposure: exposure as f32, ..options.clone() })?;
        }
        Ok(None)
    }

    /// Hands over what is complete.
    fn hand_over(&mut self, scene: &Scene, task: Task, left: Made, right: Option<(ColorImage, f64)>) {
        let Task { wanted, quality, .. } = task;
        let Made { image, request, total_ms } = left;
        let (total_ms, other) = match right {
            None => (total_ms, None),
            Some((right, right_ms)) => {
                let difference = Difference::of(&image, &right);
                (right_ms, Some((right, difference)))
            }
        };
        self.shown = Some((wanted.clone(), quality));
        let renderer = &scene.renderer;
        let mut mailbox = self.shared.mailbox();
        let figures = &mut mailbox.figures;
        let time = if quality == QualityLevel::FULL { &mut figures.full_ms } else { &mut figures.preview_ms };
        *time = Some(total_ms);
        figures.light_rebuilds = renderer.light_rebuilds().iter().sum();
        figures.cached_light_volumes = renderer.cached_light_volumes();
        figures.light_bytes = renderer.light_bytes();
        figures.light_volumes = renderer.light_figures(&request);
        figures.gpu_bytes = renderer.gpu_bytes();
        figures.refining = None;
        mailbox.frame = Some(Frame { wanted, quality, image, other });
        drop(mailbox);
        self.is_frame_pending = true;
        self.shared.finished.notify_one();
        self.ctx.request_repaint();
    }

    pub(super) fn tell(&self, err: GpuError) {
        self.shared.mailbox().error = Some(err);
        self.shared.finished.notify_one();
        self.ctx.request_repaint();
    }
}

/// Shows a picture again with another exposure: a display pass.
fn expose(scene: &mut Scene, request: &Request, options: RenderOptions) -> Result<(), GpuError> {
    let renderer: &mut Renderer = &mut scene.renderer;
    let mut job = renderer.begin(&scene.dataset, request.clone(), &options)?;
    while job.step()? {}
    renderer.context().wait()
}

/// What to ask of the renderer for a look.
fn request_of(scene: &Scene, settings: &Settings, size: [u32; 2], quality: QualityLevel) -> Request {
    let volume = scene.dataset.volume();
    Request {
        volume: volume.content_id(),
        settings: quality.settings(settings, &volume.scene(), size),
        size: quality.size(size),
        coarse: quality.coarse,
    }
}

/// Light volumes of full quality that a picture would have to fill.
fn missing(settled: Option<&FrameKeys>, full: &FrameKeys) -> Missing {
    // The first look has filled them all.
    let Some(settled) = settled else { return Missing::default() };
    let count = full.lights_missing_in(settled);
    Missing { count, others: full.lights.iter().flatten().count() > count }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_camera_and_lights_move() {
        let home = Settings::default();
        let changed = |change: fn(&mut Settings)| {
            let mut settings = home.clone();
            change(&mut settings);
            is_movement(&home, &settings)
        };
        assert!(changed(|settings| settings.camera.orbit(20.0, 5.0)));
        assert!(changed(|settings| settings.lights[0].position = [1.0, 2.0, 3.0]));
        assert!(!changed(|settings| settings.lights[0].intensity = 0.1));
        assert!(!changed(|settings| settings.shadows.gain = 2.0));
        assert!(!changed(|settings| settings.lights.clear()));
    }
}
