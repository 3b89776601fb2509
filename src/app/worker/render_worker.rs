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
use super::quality::{Look, Missing, Refine};
use super::render_thread::{Figures, Frame, Shared};
use super::request::{Scene, Wanted};
use crate::gpu::{Context, GpuError, Job, RenderOptions, Renderer, Stage, dark_share, mean_luminance};
use crate::model::Settings;
use crate::plan::{LightKey, Request, plan};

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

struct Running {
    job: Job,
    wanted: Wanted,
    look: Look,
    /// Started while the user moved something.
    preview: bool,
    /// Of a comparison: the left picture, when this is the job for the right one.
    left: Option<ColorImage>,
    total_ms: f64,
    light_ms: f64,
    rebuilds_before: u64,
}

impl Running {
    /// Whether it is a preview whose brightness is compensated: not of two looks, whose difference counts.
    fn is_exposed(&self) -> bool {
        self.look != Look::FULL && self.wanted.other.is_none()
    }
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

/// What decides how far the brightness of a preview is off that was just drawn.
fn kind_of(look: Look, renderer: &Renderer) -> Kind {
    Kind { scale: look.scale, quick_eye: look.quick_eye, light_divisor: renderer.report().light_divisor }
}

/// The thread's own side.
pub(crate) struct Easel {
    ctx: egui::Context,
    shared: Arc<Shared>,
    software: bool,
    refine: Refine,
    scene: Option<Scene>,
    wanted: Option<Wanted>,
    changed: Instant,
    /// A picture was left on the desk, and the window had not taken it when the desk was looked at last.
    handed: bool,
    running: Option<Running>,
    /// What is on screen, or on its way there.
    shown: Option<(Wanted, Look)>,
    /// The last request that was rendered at full quality: its light volumes are likely there.
    settled: Option<Request>,
    failed: Option<Wanted>,
    told: Instant,
    /// When darkness was measured.
    measured: Instant,
    exposures: Exposures,
    /// What the last preview was of.
    previewed: Option<Wanted>,
}

impl Easel {
    pub(crate) fn new(context: &Context, ctx: egui::Context, shared: Arc<Shared>) -> Self {
        let software = context.is_software();
        let now = Instant::now();
        Self {
            ctx,
            shared,
            software,
            refine: Refine::new(software),
            scene: None,
            wanted: None,
            changed: now,
            handed: false,
            running: None,
            shown: None,
            settled: None,
            failed: None,
            told: now,
            measured: now,
            exposures: Exposures::default(),
            previewed: None,
        }
    }

    /// Renders what is wanted until the window closes.
    pub(crate) fn work(&mut self) {
        while self.take_orders() {
            if let Err(err) = self.start_if_due().and_then(|()| self.step()) {
                self.running = None;
                self.failed.clone_from(&self.wanted);
                let lost = matches!(err, GpuError::Lost(_));
                self.tell(err);
                if lost {
                    return;
                }
            }
        }
    }

    /// Looks at the desk; waits there while nothing is to be done. `false` when the window closed.
    fn take_orders(&mut self) -> bool {
        let shared = Arc::clone(&self.shared);
        let mut desk = shared.desk();
        loop {
            if desk.closed {
                return false;
            }
            if let Some(scene) = desk.scene.take() {
                let figures = Figures { gpu_bytes: scene.renderer.gpu_bytes(), ..Figures::default() };
                desk.figures = figures;
                self.refine = Refine::new(self.software);
                self.scene = Some(scene);
                (self.wanted, self.running, self.shown, self.settled, self.failed) = Default::default();
                (self.exposures, self.previewed) = (Exposures::default(), None);
            }
            self.refine.set_frame_ms(desk.frame_ms);
            if let Some(wanted) = desk.wanted.take() {
                self.changed = Instant::now();
                self.wanted = Some(wanted);
            }
            // Until the window takes a picture nobody knows what it wants next: refining might only delay it.
            if self.handed {
                self.changed = Instant::now();
                self.handed = desk.frame.is_some();
            }
            if self.running.is_some() || self.due().is_some() {
                return true;
            }
            let rest =
                (self.is_unfinished() && !self.handed).then(|| REST.saturating_sub(self.changed.elapsed()));
            desk = match rest {
                None => shared.changed.wait(desk).unwrap_or_else(PoisonError::into_inner),
                Some(rest) => {
                    let rest = rest.max(Duration::from_millis(1));
                    shared.changed.wait_timeout(desk, rest).unwrap_or_else(PoisonError::into_inner).0
                }
            };
        }
    }

    /// Whether something is wanted that is not on screen at full quality.
    fn is_unfinished(&self) -> bool {
        let Some(wanted) = &self.wanted else { return false };
        let is_shown =
            self.shown.as_ref().is_some_and(|(shown, look)| shown == wanted && *look == Look::FULL);
        self.scene.is_some() && !is_shown && self.failed.as_ref() != Some(wanted)
    }

    /// What should be begun now: a preview (`true`), or full quality.
    fn due(&self) -> Option<bool> {
        if !self.is_unfinished() {
            return None;
        }
        // Something to look at comes first.
        let preview = self.shown.as_ref().map(|(shown, _)| shown) != self.wanted.as_ref();
        (preview || self.changed.elapsed() >= REST).then_some(preview)
    }

    /// Begins the next job, unless one must be finished first.
    fn start_if_due(&mut self) -> Result<(), GpuError> {
        if let Some(running) = &self.running {
            if running.preview || Some(&running.wanted) == self.wanted.as_ref() {
                return Ok(());
            }
            // A refinement of something that is no longer wanted.
            self.running = None;
        }
        let (Some(preview), Some(wanted)) = (self.due(), self.wanted.clone()) else { return Ok(()) };
        let Some(scene) = &mut self.scene else { return Ok(()) };
        let full = request_of(scene, &wanted.settings, &wanted, Look::FULL);
        let missing = missing(self.settled.as_ref(), &full);
        // Two pictures have twice the pixels.
        let [width, height] = wanted.size;
        let pixels = if wanted.other.is_some() { [2 * width, height] } else { wanted.size };
        let look = if preview { self.refine.preview(pixels, missing) } else { Look::FULL };
        self.begin(wanted, look, preview, None)
    }

    /// Begins a picture; of a comparison the right one when the left one is there.
    fn begin(
        &mut self,
        wanted: Wanted,
        look: Look,
        preview: bool,
        left: Option<ColorImage>,
    ) -> Result<(), GpuError> {
        let Some(scene) = &mut self.scene else { return Ok(()) };
        let settings = wanted.other.as_ref().filter(|_| left.is_some()).unwrap_or(&wanted.settings);
        let request = request_of(scene, settings, &wanted, look);
        let options = RenderOptions {
            light_parts: self.refine.light_parts(look),
            preview: look != Look::FULL,
            ..RenderOptions::default()
        };
        let rebuilds_before = scene.renderer.light_rebuilds().iter().sum();
        let mut job = scene.renderer.begin(&scene.volume, &scene.bricks, request, &options)?;
        job.set_band(self.refine.rows(look, job.request().size));
        let (total_ms, light_ms) = (0.0, 0.0);
        self.running =
            Some(Running { job, wanted, look, preview, left, total_ms, light_ms, rebuilds_before });
        Ok(())
    }

    /// Does the next piece of the job and waits for it.
    fn step(&mut self) -> Result<(), GpuError> {
        let (Some(scene), Some(running)) = (&mut self.scene, &mut self.running) else { return Ok(()) };
        let stage = running.job.stage();
        if stage == Some(Stage::Display) && running.is_exposed() {
            let kind = kind_of(running.look, &scene.renderer);
            running.job.set_exposure(self.exposures.of(kind).unwrap_or(1.0) as f32);
        }
        let start = Instant::now();
        let more = scene.renderer.step(&mut running.job)?;
        scene.renderer.context().wait()?;
        let took_ms = start.elapsed().as_secs_f64() * 1000.0;
        running.total_ms += took_ms;
        if matches!(stage, Some(Stage::LightMarch | Stage::LightBackproject)) {
            running.light_ms += took_ms;
        }
        if !more {
            return self.finish();
        }
        if self.told.elapsed() >= TELL_EVERY {
            self.told = Instant::now();
            let refining = running.job.stage().filter(|_| !running.preview);
            let progress = running.job.progress().clamp(0.0, 1.0);
            self.shared.desk().figures.refining = refining.map(|stage| (stage, progress));
            self.ctx.request_repaint();
        }
        Ok(())
    }

    /// Learns from the light of a complete picture, and keeps a preview as bright as those at full quality.
    /// Returns the share of a picture at full quality that is nearly black.
    fn measure(&mut self) -> Result<Option<f64>, GpuError> {
        let (Some(scene), Some(running)) = (&mut self.scene, &self.running) else { return Ok(None) };
        if running.look == Look::FULL {
            let is_due = !running.preview || self.measured.elapsed() >= MEASURE_EVERY;
            if running.left.is_some() || !is_due {
                return Ok(None);
            }
            self.measured = Instant::now();
            let light = scene.renderer.read_light()?;
            if running.wanted.other.is_none() {
                let is_of_last_preview = self.previewed.as_ref() == Some(&running.wanted);
                self.exposures.settle(mean_luminance(&light), is_of_last_preview);
            }
            return Ok(Some(dark_share(&light)));
        }
        let [width, height] = running.job.request().size;
        // What changes more than a movement may change the brightness, and should be seen to.
        let settled = self.settled.as_ref().map(|settled| &settled.settings);
        let moves = settled.is_some_and(|settled| is_movement(settled, &running.wanted.settings));
        if !(running.is_exposed() && moves && u64::from(width) * u64::from(height) <= EXPOSED_PIXELS) {
            return Ok(None);
        }
        let mean = mean_luminance(&scene.renderer.read_light()?);
        self.previewed = Some(running.wanted.clone());
        if let Some(exposure) = self.exposures.preview(kind_of(running.look, &scene.renderer), mean) {
            scene.renderer.expose(&running.job, exposure as f32)?;
        }
        Ok(None)
    }

    /// Hands over the complete picture and learns from what it took.
    fn finish(&mut self) -> Result<(), GpuError> {
        let start = Instant::now();
        let dark_share = self.measure()?;
        let (Some(scene), Some(running)) = (&self.scene, self.running.take()) else { return Ok(()) };
        let Running { job, wanted, look, preview, left, total_ms, light_ms, rebuilds_before } = running;
        let size = job.request().size;
        let bytes = scene.renderer.read_shown()?;
        let image = ColorImage::from_rgba_premultiplied(size.map(|n| n as usize), &bytes);
        let is_settled = left.is_none() && look == Look::FULL;
        let splats = if is_settled { Some(scene.renderer.splats()?) } else { None };
        let total_ms = total_ms + start.elapsed().as_secs_f64() * 1000.0;
        log::debug!("{look:?} took {total_ms:.1} ms, of which the light {light_ms:.1} ms");
        let light_volumes = scene.renderer.light_figures(&job);
        let light_rebuilds: u64 = scene.renderer.light_rebuilds().iter().sum();
        let pixels = f64::from(size[0]) * f64::from(size[1]);
        self.refine.learn_picture(look, pixels, total_ms - light_ms);
        if light_rebuilds > rebuilds_before {
            self.refine.learn_build(look, light_ms / (light_rebuilds - rebuilds_before) as f64);
        }
        if is_settled {
            self.settled = Some(job.request().clone());
        }
        if let Some(dark_share) = dark_share {
            self.shared.desk().figures.dark_share = Some(dark_share);
        }
        if left.is_none() && wanted.other.is_some() {
            return self.begin(wanted, look, preview, Some(image));
        }
        let (image, other) = match left {
            None => (image, None),
            Some(left) => {
                let difference = Difference::of(&left, &image);
                (left, Some((image, difference)))
            }
        };
        self.shown = Some((wanted.clone(), look));
        let mut desk = self.shared.desk();
        let kind = if look == Look::FULL { &mut desk.figures.full_ms } else { &mut desk.figures.preview_ms };
        *kind = Some(total_ms);
        desk.figures.light_rebuilds = light_rebuilds;
        desk.figures.cached_light_volumes = scene.renderer.cached_light_volumes();
        if let Some(splats) = splats {
            desk.figures.splats = splats;
        }
        desk.figures.light_bytes = scene.renderer.light_bytes();
        desk.figures.light_volumes = light_volumes;
        desk.figures.gpu_bytes = scene.renderer.gpu_bytes();
        desk.figures.refining = None;
        desk.frame = Some(Frame { wanted, look, image, other });
        drop(desk);
        self.handed = true;
        self.shared.finished.notify_one();
        self.ctx.request_repaint();
        Ok(())
    }

    pub(crate) fn tell(&self, err: GpuError) {
        self.shared.desk().error = Some(err);
        self.shared.finished.notify_one();
        self.ctx.request_repaint();
    }
}

/// What to ask of the renderer for one of the wanted looks.
fn request_of(scene: &Scene, settings: &Settings, wanted: &Wanted, look: Look) -> Request {
    Request {
        volume: scene.volume.content_id(),
        settings: look.settings(settings, &scene.volume.scene(), wanted.size),
        size: look.size(wanted.size),
        coarse: look.coarse,
    }
}

/// Light volumes of full quality that a request would have to fill.
fn missing(settled: Option<&Request>, full: &Request) -> Missing {
    let needed = (0..full.settings.lights.len()).filter(|&light| LightKey::of(full, light).is_some()).count();
    // The first look has filled them all.
    let Some(settled) = settled else { return Missing::default() };
    let count = plan(Some(settled), full).lights.iter().filter(|&&rebuild| rebuild).count();
    Missing { count, others: needed > count }
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
