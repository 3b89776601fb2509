//! The picture in the middle of the window: previews while something moves, full quality at rest.
//!
//! The only part of the window that knows the renderer. It never waits for the GPU: work goes out
//! in batches of about 30 ms, one at a time, timed by the [`clock::GpuClock`]. The last picture
//! stays on screen until the next one is complete.

mod clock;
mod facts;

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;

use eframe::egui;
use eframe::egui_wgpu::RenderState;

use self::clock::{Elapsed, GpuClock};
pub(super) use self::facts::{Doing, Facts};
use super::refine::{Cost, Look, Missing, REST_S, Refine};
use crate::data::{Bricks, Volume};
use crate::gpu::{Context, GpuError, Job, RenderOptions, Renderer, Stage};
use crate::model::Settings;
use crate::plan::{LightKey, Request, plan};

/// What is to be seen.
#[derive(Debug, Clone, PartialEq)]
struct Wanted {
    settings: Settings,
    size: [u32; 2],
}

#[derive(Debug)]
struct Shown {
    wanted: Wanted,
    look: Look,
}

#[derive(Debug)]
struct Running {
    job: Job,
    wanted: Wanted,
    look: Look,
    /// Started while the user moved something: it is finished before newer settings get their turn.
    interactive: bool,
    tally: Tally,
}

/// What a job took so far.
#[derive(Debug, Clone, Copy, Default)]
struct Tally {
    total_ms: f64,
    light_ms: f64,
    builds: u64,
    size: [u32; 2],
}

#[derive(Debug)]
struct Batch {
    elapsed: Elapsed,
    parts: Vec<(Cost, f64)>,
    look: Look,
    /// The job that it completes.
    completes: Option<Tally>,
}

#[derive(Debug)]
struct Scene {
    renderer: Renderer,
    volume: Arc<Volume>,
    bricks: Arc<Bricks>,
}

/// The picture and the work on it.
pub(super) struct Viewport {
    context: Context,
    paint: RenderState,
    clock: GpuClock,
    scene: Option<Scene>,
    texture: Option<egui::TextureId>,
    shown: Option<Shown>,
    /// The last request that was rendered at full quality: its light volumes are likely there.
    settled: Option<Request>,
    running: Option<Running>,
    batch: Option<Batch>,
    refine: Refine,
    wanted: Option<Wanted>,
    /// When [`Self::wanted`] last changed, in seconds of the window's clock.
    changed_s: f64,
    /// What could not be rendered; it is not tried again.
    failed: Option<Wanted>,
    lost: bool,
    full_ms: Option<f64>,
    preview_ms: Option<f64>,
}

impl std::fmt::Debug for Viewport {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Viewport").field("wanted", &self.wanted).finish_non_exhaustive()
    }
}

impl Viewport {
    /// An empty viewport on the window's device.
    pub(super) fn new(context: Context, paint: RenderState, ctx: &egui::Context) -> std::io::Result<Self> {
        let clock = GpuClock::new(context.device.clone(), context.queue.clone(), ctx.clone())?;
        let refine = Refine::new(context.is_software());
        Ok(Self {
            context,
            paint,
            clock,
            scene: None,
            texture: None,
            shown: None,
            settled: None,
            running: None,
            batch: None,
            refine,
            wanted: None,
            changed_s: f64::NEG_INFINITY,
            failed: None,
            lost: false,
            full_ms: None,
            preview_ms: None,
        })
    }

    /// Shows another volume from now on; its picture replaces the old one when it is complete.
    pub(super) fn set_scene(&mut self, renderer: Renderer, volume: Arc<Volume>, bricks: Arc<Bricks>) {
        self.scene = Some(Scene { renderer, volume, bricks });
        self.refine = Refine::new(self.context.is_software());
        (self.running, self.shown, self.settled, self.failed) = (None, None, None, None);
        (self.full_ms, self.preview_ms) = (None, None);
    }

    /// The device, for workers with a renderer of their own.
    pub(super) fn context(&self) -> &Context {
        &self.context
    }

    /// The volume, for workers with a renderer of their own.
    pub(super) fn volume(&self) -> Option<(Arc<Volume>, Arc<Bricks>)> {
        self.scene.as_ref().map(|scene| (Arc::clone(&scene.volume), Arc::clone(&scene.bricks)))
    }

    /// The picture for the painter, and whether it has fewer pixels than the viewport.
    pub(super) fn texture(&self) -> Option<egui::TextureId> {
        self.texture
    }

    /// Whether the device is gone and nothing will be rendered any more.
    pub(super) fn is_lost(&self) -> bool {
        self.lost
    }

    /// Whether the full-quality picture of exactly these settings is on screen and nothing is under way.
    pub(super) fn is_idle(&self, settings: &Settings) -> bool {
        let is_shown = |shown: &Shown| shown.look == Look::FULL && shown.wanted.settings == *settings;
        let of_size =
            |shown: &Shown| self.wanted.as_ref().is_some_and(|wanted| wanted.size == shown.wanted.size);
        self.running.is_none()
            && self.batch.is_none()
            && self.shown.as_ref().is_some_and(|shown| is_shown(shown) && of_size(shown))
    }

    /// Brings the picture a little further towards these settings at this size (window pixels).
    /// To be called once per frame before the picture is painted.
    pub(super) fn advance(
        &mut self,
        settings: &Settings,
        size: [u32; 2],
        ctx: &egui::Context,
    ) -> Result<(), GpuError> {
        if self.lost {
            return Ok(());
        }
        let polled = catch_unwind(AssertUnwindSafe(|| self.context.device.poll(wgpu::PollType::Poll)));
        if polled.is_err() {
            self.lost = true;
            return Err(GpuError::Lost("the driver reset it".to_owned()));
        }
        if let Err(err) = self.context.check() {
            self.lost = matches!(err, GpuError::Lost(_));
            self.fail();
            return Err(err);
        }
        let now_s = ctx.input(|input| input.time);
        let wanted = Wanted { settings: settings.clone(), size: size.map(|n| n.max(1)) };
        if self.wanted.as_ref() != Some(&wanted) {
            self.changed_s = now_s;
            self.wanted = Some(wanted);
        }
        if self.collect_batch() {
            // What was painted of the state in this frame is out of date.
            ctx.request_repaint();
        }
        if self.batch.is_some() {
            // The clock wakes the window.
            return Ok(());
        }
        let rested_s = now_s - self.changed_s;
        let result = self.start_if_due(rested_s >= REST_S).and_then(|()| self.submit());
        if result.is_err() {
            self.fail();
        }
        if self.running.is_some() && self.batch.is_none() {
            ctx.request_repaint();
        } else if rested_s < REST_S {
            let rest = std::time::Duration::from_secs_f64(REST_S - rested_s.max(0.0));
            ctx.request_repaint_after(rest);
        }
        result
    }

    /// Gives up on what is wanted now.
    fn fail(&mut self) {
        self.running = None;
        self.failed.clone_from(&self.wanted);
    }

    /// Takes the time of the batch that is out, if the GPU has done it; whether it has.
    fn collect_batch(&mut self) -> bool {
        let Some(took_ms) = self.batch.as_ref().and_then(|batch| batch.elapsed.get().copied()) else {
            return false;
        };
        let Some(batch) = self.batch.take() else { return false };
        log::debug!("{:?} {:?} took {took_ms:.1} ms", batch.look, batch.parts);
        self.refine.learn(&batch.parts, took_ms);
        let predicted: f64 = batch.parts.iter().map(|part| part.1).sum();
        let is_light = |part: &&(Cost, f64)| matches!(part.0, Cost::Light(_));
        let light: f64 = batch.parts.iter().filter(is_light).map(|part| part.1).sum();
        let light_ms = if predicted > 0.0 { took_ms * light / predicted } else { 0.0 };
        let add = |tally: &mut Tally| {
            tally.total_ms += took_ms;
            tally.light_ms += light_ms;
        };
        if let Some(mut tally) = batch.completes {
            add(&mut tally);
            let pixels = f64::from(tally.size[0]) * f64::from(tally.size[1]);
            self.refine.learn_picture(batch.look, pixels, tally.total_ms - tally.light_ms);
            if tally.builds > 0 {
                self.refine.learn_build(batch.look, tally.light_ms / tally.builds as f64);
            }
            let kind = if batch.look == Look::FULL { &mut self.full_ms } else { &mut self.preview_ms };
            *kind = Some(tally.total_ms);
        } else if let Some(running) = &mut self.running {
            add(&mut running.tally);
        }
        true
    }

    /// Chooses what to work on: the job under way, a preview or the refinement.
    fn start_if_due(&mut self, at_rest: bool) -> Result<(), GpuError> {
        let Some(wanted) = self.wanted.clone() else { return Ok(()) };
        if let Some(running) = &self.running {
            if running.interactive || running.wanted == wanted {
                return Ok(());
            }
            // A refinement of something that is no longer wanted.
            self.running = None;
        }
        let shown_look = self.shown.as_ref().filter(|shown| shown.wanted == wanted).map(|shown| shown.look);
        if shown_look == Some(Look::FULL) || self.failed.as_ref() == Some(&wanted) {
            return Ok(());
        }
        let full = self.request(Look::FULL, &wanted);
        let Some(full) = full else { return Ok(()) };
        // Something to look at comes first.
        let interactive = shown_look.is_none();
        if !(interactive || at_rest) {
            return Ok(());
        }
        let look =
            if interactive { self.refine.preview(wanted.size, self.missing(&full)) } else { Look::FULL };
        let request = self.request(look, &wanted).unwrap_or(full);
        let Some(scene) = &mut self.scene else { return Ok(()) };
        let before: u64 = scene.renderer.light_rebuilds().iter().sum();
        let light_parts = self.refine.light_parts(look);
        let options = RenderOptions { light_parts, ..RenderOptions::default() };
        let job = scene.renderer.begin(&scene.volume, &scene.bricks, request, &options)?;
        // Counted upwards from here when the job is complete.
        let tally = Tally { builds: before, size: job.request().size, ..Tally::default() };
        self.running = Some(Running { job, wanted, look, interactive, tally });
        Ok(())
    }

    fn request(&self, look: Look, wanted: &Wanted) -> Option<Request> {
        let scene = self.scene.as_ref()?;
        Some(Request {
            volume: scene.volume.content_id(),
            settings: look.settings(&wanted.settings),
            size: look.size(wanted.size),
            coarse: look.coarse,
        })
    }

    /// Light volumes of full quality that a request would have to fill.
    fn missing(&self, full: &Request) -> Missing {
        let count = plan(self.settled.as_ref(), full).lights.iter().filter(|&&rebuild| rebuild).count();
        let needed =
            (0..full.settings.lights.len()).filter(|&light| LightKey::of(full, light).is_some()).count();
        Missing { count, others: needed > count }
    }

    /// Sends out one batch of the job under way.
    fn submit(&mut self) -> Result<(), GpuError> {
        let (Some(scene), Some(running)) = (&mut self.scene, &mut self.running) else { return Ok(()) };
        let look = running.look;
        running.job.set_band(self.refine.rows(look, running.job.request().size[0]));
        self.clock.begin();
        let mut parts: Vec<(Cost, f64)> = Vec::new();
        let mut predicted = 0.0;
        let mut more = true;
        let mut light_steps = 0;
        while more {
            let Some(stage) = running.job.stage() else { break };
            let [width, height] = running.job.request().size;
            let rows = self.refine.rows(look, width).min(height);
            let (cost, units) = match stage {
                Stage::Upload | Stage::Pyramid | Stage::Display => (Cost::Other, 1.0),
                Stage::LightMarch | Stage::LightBackproject => (Cost::Light(look), 1.0),
                Stage::Eye => (Cost::Eye(look), f64::from(rows) * f64::from(width)),
            };
            // The display pass is a few operations per pixel.
            let ms = if stage == Stage::Display { 0.0 } else { self.refine.unit_ms(cost) * units };
            if predicted > 0.0 && predicted + ms > 1.2 * self.refine.batch_ms(look) {
                break;
            }
            if let Cost::Light(_) = cost {
                // Chunks in empty space cost next to nothing and promise too much for the others.
                if light_steps == self.refine.light_steps(look) {
                    break;
                }
                light_steps += 1;
            }
            more = scene.renderer.step(&mut running.job)?;
            predicted += ms;
            match parts.iter_mut().find(|part| part.0 == cost) {
                Some(part) => part.1 += ms,
                None => parts.push((cost, ms)),
            }
        }
        let elapsed = self.clock.end();
        let done = running.job.is_done();
        let mut tally = running.tally;
        let completes = done.then(|| {
            let now: u64 = scene.renderer.light_rebuilds().iter().sum();
            tally.builds = now.saturating_sub(tally.builds);
            tally
        });
        self.batch = Some(Batch { elapsed, parts, look, completes });
        if done {
            self.publish();
        }
        Ok(())
    }

    /// Gives the complete picture to the painter. The queue works in order: what the painter submits
    /// later finds it done.
    fn publish(&mut self) {
        let Some(Running { job, wanted, look, .. }) = self.running.take() else { return };
        let Some((view, size)) = self.scene.as_ref().and_then(|scene| scene.renderer.shown()) else { return };
        // Pixel for pixel where there are enough of them.
        let exact = size == wanted.size;
        let filter = if exact { wgpu::FilterMode::Nearest } else { wgpu::FilterMode::Linear };
        let device = &self.paint.device;
        let mut painter = self.paint.renderer.write();
        match self.texture {
            Some(id) => painter.update_egui_texture_from_wgpu_texture(device, view, filter, id),
            None => self.texture = Some(painter.register_native_texture(device, view, filter)),
        }
        if look == Look::FULL {
            self.settled = Some(job.request().clone());
        }
        self.shown = Some(Shown { wanted, look });
    }
}
