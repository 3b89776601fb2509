//! Viewport: the picture in the middle of the window, with previews during interaction and full quality when idle.
//!
//! The window's thread only posts requests and takes finished pictures; the render thread renders them on a separate
//! GPU device. The window therefore stays responsive whatever the GPU does: long work never enters the queue of its
//! frames, and when a driver loses one device, the other one remains.

pub(super) mod camera_transition;
pub(super) mod canvas;
pub(super) mod compare;
pub(super) mod cut_handles;
pub(super) mod empty_picture_notice;
pub(super) mod first_use_hints;
pub(super) mod light_chips;
pub(super) mod light_handles;
pub(super) mod light_probe;
pub(super) mod mouse_navigation;
pub(super) mod overlay;
pub(super) mod paint_callback;
mod renderer_status;
pub(super) mod view_projection;

use std::sync::Arc;
use std::time::{Duration, Instant};

use eframe::egui::{self, ColorImage};

use self::compare::Compare;
pub(super) use self::renderer_status::{LightCost, RendererActivity, RendererStatus};
use super::worker::mailbox::{FinishedFrame, RefinementHold, UpcomingSteps};
use super::worker::quality::QualityLevel;
use super::worker::render_thread::RenderThread;
use super::worker::request::{ComparedLooks, FrameRequest, RenderScene, VolumeFile};
use super::worker::response_times::PendingRequests;
pub(super) use super::worker::response_times::ResponseTimes;
pub(super) use chiaroscuro_render::LightVolumeStatistics;
use chiaroscuro_render::{GpuContext, GpuError, PictureDistance, Renderer, WindowPainter, WindowPicture};
use chiaroscuro_scene::Settings;
use chiaroscuro_volume::Dataset;

/// Longest time that a frame of the window waits for a preview: the rest of 1/60 s.
const PREVIEW_WAIT: Duration = Duration::from_millis(12);
/// Longest time that a frame of the window waits for a preview on a software driver, where drawing the window would
/// only take processor time from the preview. A window that is drawn beside its previews takes as long for a frame, and
/// shows them three frames late: while a light is dragged over a chair of 256³ voxels, on two cores, 330 … 460 ms after
/// the input with a wait of 40 ms, and 160 … 250 ms with this one.
const SOFTWARE_PREVIEW_WAIT: Duration = Duration::from_millis(150);

/// Duration of the cross-fade from a preview to the full-quality picture, in seconds.
const FADE_S: f64 = 0.12;

/// Pictures that are ready to be drawn.
#[derive(Debug, Clone)]
pub(super) struct ViewportPictures {
    /// The picture, or the left one of a comparison.
    pub left: Option<WindowPicture>,
    /// The previous preview during a cross-fade, and its remaining opacity, 0 to 255.
    pub fading: Option<(WindowPicture, u8)>,
    /// Right picture and difference, if two looks are compared.
    pub compared: Option<ComparedPicture>,
}

/// Right picture of a comparison, with the difference.
#[derive(Debug, Clone)]
pub(super) struct ComparedPicture {
    /// Picture of the right look.
    pub right: WindowPicture,
    /// Amplified difference of both pictures.
    pub difference: WindowPicture,
    /// Measured distance of both pictures.
    pub distance: PictureDistance,
}

/// State of the picture on screen, and the connection to the render thread.
#[derive(Debug)]
pub(super) struct Viewport {
    /// Time budget for a frame during interaction, in milliseconds; `None` for the adapter's default.
    pub frame_ms: Option<f64>,
    /// Time for drawing a time step while a series plays, in milliseconds, in place of the budget for a frame.
    pub step_ms: Option<f64>,
    /// Comparison of two looks in one picture.
    pub compare: Compare,
    context: GpuContext,
    /// Draws pictures into the window.
    window: WindowPainter,
    thread: RenderThread,
    /// Ticket of the balance measurement in progress.
    balance_ticket: Option<u64>,
    /// Last request that was sent to the render thread.
    frame_request: Option<FrameRequest>,
    pending_requests: PendingRequests<FrameRequest>,
    /// True if the last preview that a frame waited for did not arrive in time.
    last_wait_failed: bool,
    generation: u64,
    dataset: Option<Dataset>,
    /// File of the volume, by which other resolution levels of it are read.
    file: Option<VolumeFile>,
    /// Textures of the picture, or of the left and right picture of a comparison and their difference.
    textures: [Option<WindowPicture>; 3],
    /// The preview that fades into the full-quality picture, and the start of the fade in egui's seconds.
    fading: Option<(WindowPicture, f64)>,
    now_s: f64,
    /// Measured distance of the two compared pictures.
    difference: Option<PictureDistance>,
    displayed: Option<(FrameRequest, QualityLevel)>,
    /// Request that could not be rendered; the render thread does not retry it.
    failed_request: Option<FrameRequest>,
    is_device_lost: bool,
    /// Last full-quality picture that has not been taken yet.
    finished_image: Option<Arc<ColorImage>>,
}

impl Viewport {
    /// Creates an empty viewport. Pictures are rendered with `context`, which is separate from the window's own, and
    /// drawn with `window`, which belongs to it.
    pub(super) fn new(
        context: GpuContext,
        window: WindowPainter,
        ctx: &egui::Context,
    ) -> std::io::Result<Self> {
        let thread = RenderThread::start(context.clone(), ctx.clone())?;
        Ok(Self {
            frame_ms: None,
            step_ms: None,
            compare: Compare::default(),
            context,
            window,
            thread,
            balance_ticket: None,
            frame_request: None,
            pending_requests: PendingRequests::default(),
            last_wait_failed: false,
            generation: 0,
            dataset: None,
            file: None,
            textures: [None, None, None],
            fading: None,
            now_s: 0.0,
            difference: None,
            displayed: None,
            failed_request: None,
            is_device_lost: false,
            finished_image: None,
        })
    }

    /// Switches to another volume; its picture replaces the old one when it is complete.
    pub(super) fn set_scene(&mut self, renderer: Renderer, dataset: Dataset, file: Option<VolumeFile>) {
        self.generation += 1;
        self.dataset = Some(dataset.clone());
        self.file.clone_from(&file);
        self.thread.set_scene(RenderScene { renderer, dataset, file });
        (self.frame_request, self.displayed, self.failed_request, self.last_wait_failed) =
            (None, None, None, false);
        self.pending_requests.clear();
    }

    /// Returns the file of the volume, by which other resolution levels of it are read.
    pub(super) fn file(&self) -> Option<&VolumeFile> {
        self.file.as_ref()
    }

    /// Replaces the dataset of the current volume (another shown range or corrections), keeping its renderer.
    pub(super) fn set_dataset(&mut self, dataset: Dataset) {
        self.generation += 1;
        self.dataset = Some(dataset.clone());
        self.thread.set_dataset(dataset);
        (self.frame_request, self.displayed, self.failed_request, self.last_wait_failed) =
            (None, None, None, false);
        self.balance_ticket = None;
        self.pending_requests.clear();
    }

    /// Names the time steps that may be shown next, for the render thread to prepare.
    pub(super) fn prepare_steps(&self, upcoming: UpcomingSteps) {
        self.thread.prepare_steps(upcoming);
    }

    /// Delays the full-quality picture while the look is about to change automatically.
    pub(super) fn hold_refinement(&self, hold: RefinementHold) {
        self.thread.hold_refinement(hold);
    }

    /// Requests a measurement of a look's balance, which takes place once its light volumes are filled.
    pub(super) fn measure_balance(&mut self, settings: &Settings) {
        self.balance_ticket = Some(self.thread.measure_balance(settings));
    }

    /// Takes the result of the last balance measurement, if it is ready; returns it only once.
    pub(super) fn take_balance(&mut self) -> Option<Result<f64, GpuError>> {
        let balance = self.thread.take_balance(self.balance_ticket?)?;
        self.balance_ticket = None;
        Some(balance)
    }

    /// Returns the GPU context that renders the pictures.
    pub(super) fn context(&self) -> &GpuContext {
        &self.context
    }

    /// Returns the dataset, for workers with a renderer of their own.
    pub(super) fn dataset(&self) -> Option<Dataset> {
        self.dataset.clone()
    }

    /// Returns the pictures to be drawn in this frame.
    pub(super) fn pictures(&self) -> ViewportPictures {
        let [left, right, difference] = self.textures.clone();
        let other = right.zip(difference).zip(self.difference);
        let fading = self.fading.as_ref().map(|(picture, since_s)| {
            let left = 1.0 - (self.now_s - since_s) / FADE_S;
            (picture.clone(), (left.clamp(0.0, 1.0) * 255.0) as u8)
        });
        ViewportPictures {
            left,
            fading,
            compared: other.map(|((right, difference), distance)| ComparedPicture {
                right,
                difference,
                distance,
            }),
        }
    }

    /// Takes the last full-quality picture of a single look; returns it only once.
    pub(super) fn take_finished(&mut self) -> Option<Arc<ColorImage>> {
        self.finished_image.take()
    }

    /// Returns the response times that the user experienced with this volume.
    pub(super) fn response_times(&self) -> ResponseTimes {
        self.pending_requests.statistics()
    }

    /// Returns true if the device is lost and nothing can be rendered any more.
    pub(super) fn is_lost(&self) -> bool {
        self.is_device_lost
    }

    /// Returns true if the final picture of these looks is on screen and no cross-fade is running.
    pub(super) fn is_idle(&self, looks: &ComparedLooks) -> bool {
        let is_final =
            self.displayed.as_ref().is_some_and(|(shown, quality)| *quality == shown.final_quality());
        is_final && self.fading.is_none() && self.displays(looks)
    }

    /// Returns true if a picture of these looks is on screen, be it a preview.
    pub(super) fn displays(&self, looks: &ComparedLooks) -> bool {
        let (Some(dataset), Some((shown, _))) = (&self.dataset, &self.displayed) else { return false };
        let request = FrameRequest::new(self.generation, dataset, looks.clone(), shown.size);
        *shown == request && self.frame_request.as_ref().is_some_and(|requested| requested == shown)
    }

    /// Returns true if a full-quality picture of these looks is on screen, which may yet be antialiased.
    pub(super) fn displays_full_quality(&self, looks: &ComparedLooks) -> bool {
        self.displayed.as_ref().is_some_and(|(_, quality)| quality.is_full()) && self.displays(looks)
    }

    /// Requests a picture of the looks from the render thread and takes finished ones. To be called once per frame,
    /// before the picture is drawn. After a change it waits briefly for a preview, so that a quick one appears in the
    /// same frame as the movement that caused it.
    pub(super) fn update(
        &mut self,
        looks: ComparedLooks,
        size: [u32; 2],
        ctx: &egui::Context,
    ) -> Result<(), GpuError> {
        let Some(dataset) = self.dataset.as_ref().filter(|_| !self.is_device_lost) else { return Ok(()) };
        let frame_request = FrameRequest::new(self.generation, dataset, looks, size);
        self.now_s = ctx.input(|input| input.time);
        self.fading = self.fading.take().filter(|(_, since_s)| self.now_s - since_s < FADE_S);
        if self.fading.is_some() {
            ctx.request_repaint();
        }
        self.thread.set_frame_ms(self.step_ms.or(self.frame_ms));
        let mut longest_wait = Duration::ZERO;
        if self.frame_request.as_ref() != Some(&frame_request) {
            longest_wait = if self.context.is_software() { SOFTWARE_PREVIEW_WAIT } else { PREVIEW_WAIT };
            self.thread.post_request(frame_request.clone());
            if self.frame_request.is_some() {
                self.pending_requests.add(frame_request.clone(), Instant::now());
            }
            self.frame_request = Some(frame_request.clone());
        }
        // A preview that was too late for the last frame has been waited for long enough: it is taken before newer
        // ones.
        let newest = (!self.last_wait_failed).then_some(&frame_request);
        let frame = self.thread.take_frame(newest, longest_wait);
        if longest_wait > Duration::ZERO {
            let is_late = |frame: &FinishedFrame| newest.is_some_and(|newest| frame.request != *newest);
            self.last_wait_failed = frame.as_ref().is_none_or(is_late);
        }
        if let Some(frame) = frame.filter(|frame| frame.request.generation == self.generation) {
            self.display_frame(frame, ctx);
        }
        if let Some(err) = self.thread.take_error() {
            self.is_device_lost = matches!(err, GpuError::DeviceLost(_));
            self.failed_request.clone_from(&self.frame_request);
            return Err(err);
        }
        Ok(())
    }

    /// Puts a finished picture on screen.
    fn display_frame(&mut self, frame: FinishedFrame, ctx: &egui::Context) {
        let FinishedFrame { request: frame_request, quality, dataset, image, compared: other } = frame;
        self.dataset = Some(dataset);
        // Pixel for pixel if the sizes match.
        let exact = image.size == frame_request.size.map(|n| n as usize);
        // A preview of the same request fades out; any other picture is replaced at once. Antialiasing changes a
        // picture only at its edges, and leaves a preview that still fades out to fade.
        let before = self.displayed.as_ref().filter(|(shown, _)| *shown == frame_request);
        let before = before.map(|(_, before)| *before);
        let keeps_fading = other.is_none() && before.is_some_and(QualityLevel::is_full);
        let is_same = before.is_some_and(|before| before != quality);
        if !keeps_fading {
            self.fading =
                self.textures[0].take_if(|_| is_same && other.is_none()).map(|picture| (picture, self.now_s));
        }
        if self.fading.is_some() {
            ctx.request_repaint();
        }
        self.upload_texture(0, &image, exact);
        let is_final = quality == frame_request.final_quality();
        self.finished_image = (is_final && other.is_none()).then(|| Arc::new(image));
        match other {
            Some((right, difference)) => {
                self.difference = Some(difference.distance);
                self.upload_texture(1, &right, exact);
                self.upload_texture(2, &difference.image, exact);
            }
            None => self.difference = None,
        }
        self.pending_requests.complete(&frame_request, Instant::now());
        self.displayed = Some((frame_request, quality));
    }

    fn upload_texture(&mut self, at: usize, image: &ColorImage, is_exact: bool) {
        let size = image.size.map(|n| n as u32);
        let before = self.textures[at].take();
        self.textures[at] = Some(self.window.upload(before, size, image.as_raw(), is_exact));
    }
}
