//! The picture in the middle of the window: previews while something moves, full quality at rest.
//!
//! The window's thread only requests and takes finished pictures; a thread of its own
//! renders them, on a device of its own. Whatever the GPU does, the window stays alive: long work
//! never stands in the queue of its frames, and a driver that loses the one device keeps the other.

pub(super) mod canvas;
pub(super) mod compare;
pub(super) mod cut_handles;
mod facts;
pub(super) mod hints;
pub(super) mod light_chips;
pub(super) mod light_handles;
pub(super) mod light_probe;
pub(super) mod nothing_seen;
pub(super) mod orbit;
pub(super) mod overlay;
pub(super) mod paint_callback;
pub(super) mod turning;
pub(super) mod view_projection;

use std::sync::Arc;
use std::time::{Duration, Instant};

use eframe::egui::{self, ColorImage};

pub(super) use self::facts::{Doing, Facts, LightCost};
use super::worker::mailbox::Frame;
use super::worker::quality::QualityLevel;
use super::worker::render_thread::RenderThread;
use super::worker::request::{FrameRequest, Looks, Scene};
pub(super) use super::worker::response::Response;
use super::worker::response::Waiting;
use crate::data::Dataset;
pub(super) use crate::gpu::LightFigures;
use crate::gpu::{Context, Distance, GpuError, Renderer, WindowPainter, WindowPicture};
use crate::model::Settings;

/// How long a frame of the window waits for a preview: what is left of 1/60 s.
const PREVIEW_WAIT: Duration = Duration::from_millis(12);
/// How long a frame of the window waits for a preview where the window is drawn by the processors that make the
/// preview, which would only delay it: what is left of the 50 ms that a window may be without answer.
const SOFTWARE_PREVIEW_WAIT: Duration = Duration::from_millis(40);

/// How long a preview takes to fade into the picture at full quality.
const FADE_S: f64 = 0.12;

/// What can be drawn.
#[derive(Debug, Clone)]
pub(super) struct Pictures {
    /// The picture, or the left one of two.
    pub left: Option<WindowPicture>,
    /// The preview that was shown before, and what is left of its opacity.
    pub fading: Option<(WindowPicture, u8)>,
    /// Where two looks are compared.
    pub other: Option<Other>,
}

/// The second picture of a comparison.
#[derive(Debug, Clone)]
pub(super) struct Other {
    /// The right one.
    pub right: WindowPicture,
    /// What lies between them, amplified.
    pub difference: WindowPicture,
    /// How far they are apart.
    pub distance: Distance,
}

/// The picture on screen, and the way to the thread that renders it.
#[derive(Debug)]
pub(super) struct Viewport {
    /// What a frame may take while something moves, in milliseconds; `None` for what suits the adapter.
    pub frame_ms: Option<f64>,
    context: Context,
    /// Draws pictures into the window.
    window: WindowPainter,
    thread: RenderThread,
    /// The balance that is being measured.
    measurement: Option<u64>,
    /// What the render thread was asked for last.
    frame_request: Option<FrameRequest>,
    waiting: Waiting<FrameRequest>,
    /// The last picture that was waited for was not there in time.
    waited_in_vain: bool,
    generation: u64,
    dataset: Option<Dataset>,
    /// The picture, or of a comparison left, right and their difference.
    placed: [Option<WindowPicture>; 3],
    /// The preview that fades into the picture at full quality, and since when (egui's seconds).
    fading: Option<(WindowPicture, f64)>,
    now_s: f64,
    /// How far the two are apart.
    differs: Option<Distance>,
    shown: Option<(FrameRequest, QualityLevel)>,
    /// The request that could not be rendered; the render thread does not try it again.
    failed: Option<FrameRequest>,
    lost: bool,
    /// The last picture at full quality that nobody has taken yet.
    finished: Option<Arc<ColorImage>>,
}

impl Viewport {
    /// An empty viewport; pictures will be rendered with `context`, which is not the window's own, and drawn with
    /// `window`, which is.
    pub(super) fn new(context: Context, window: WindowPainter, ctx: &egui::Context) -> std::io::Result<Self> {
        let thread = RenderThread::start(context.clone(), ctx.clone())?;
        Ok(Self {
            frame_ms: None,
            context,
            window,
            thread,
            measurement: None,
            frame_request: None,
            waiting: Waiting::default(),
            waited_in_vain: false,
            generation: 0,
            dataset: None,
            placed: [None, None, None],
            fading: None,
            now_s: 0.0,
            differs: None,
            shown: None,
            failed: None,
            lost: false,
            finished: None,
        })
    }

    /// Shows another volume from now on; its picture replaces the old one when it is complete.
    pub(super) fn set_scene(&mut self, renderer: Renderer, dataset: Dataset) {
        self.generation += 1;
        self.dataset = Some(dataset.clone());
        self.thread.set_scene(Scene { renderer, dataset });
        (self.frame_request, self.shown, self.failed, self.waited_in_vain) = (None, None, None, false);
        self.waiting.clear();
    }

    /// Shows the same volume otherwise from now on, with the renderer that there is.
    pub(super) fn set_dataset(&mut self, dataset: Dataset) {
        self.generation += 1;
        self.dataset = Some(dataset.clone());
        self.thread.set_dataset(dataset);
        (self.frame_request, self.shown, self.failed, self.waited_in_vain) = (None, None, None, false);
        self.measurement = None;
        self.waiting.clear();
    }

    /// Lets the picture at full quality wait while the look is about to change by itself.
    pub(super) fn hold_refinement(&self, holds: bool) {
        self.thread.hold_refinement(holds);
    }

    /// Asks for the balance of a look of the volume, which is measured when its light volumes are filled.
    pub(super) fn measure_balance(&mut self, settings: &Settings) {
        self.measurement = Some(self.thread.measure_balance(settings));
    }

    /// The balance that was asked for last, once.
    pub(super) fn take_balance(&mut self) -> Option<Result<f64, GpuError>> {
        let balance = self.thread.take_balance(self.measurement?)?;
        self.measurement = None;
        Some(balance)
    }

    /// The device of the pictures.
    pub(super) fn context(&self) -> &Context {
        &self.context
    }

    /// The volume, for workers with a renderer of their own.
    pub(super) fn dataset(&self) -> Option<Dataset> {
        self.dataset.clone()
    }

    /// The picture to be drawn, or several.
    pub(super) fn pictures(&self) -> Pictures {
        let [left, right, difference] = self.placed.clone();
        let other = right.zip(difference).zip(self.differs);
        let fading = self.fading.as_ref().map(|(picture, since_s)| {
            let left = 1.0 - (self.now_s - since_s) / FADE_S;
            (picture.clone(), (left.clamp(0.0, 1.0) * 255.0) as u8)
        });
        Pictures {
            left,
            fading,
            other: other.map(|((right, difference), distance)| Other { right, difference, distance }),
        }
    }

    /// The last picture at full quality of one look, once.
    pub(super) fn take_finished(&mut self) -> Option<Arc<ColorImage>> {
        self.finished.take()
    }

    /// How long the user has waited for pictures of this volume.
    pub(super) fn response(&self) -> Response {
        self.waiting.answers()
    }

    /// Whether the device is gone and nothing will be rendered any more.
    pub(super) fn is_lost(&self) -> bool {
        self.lost
    }

    /// Whether the full-quality picture of these settings is on screen, and that of those they are compared with.
    pub(super) fn is_idle(&self, looks: &Looks) -> bool {
        let is_full = self.shown.as_ref().is_some_and(|(_, quality)| *quality == QualityLevel::FULL);
        is_full && self.fading.is_none() && self.shows(looks)
    }

    /// Whether a picture of these settings is on screen, a preview or not.
    pub(super) fn shows(&self, looks: &Looks) -> bool {
        let (Some(dataset), Some((shown, _))) = (&self.dataset, &self.shown) else { return false };
        let request = FrameRequest::new(self.generation, dataset, looks.clone(), shown.size);
        *shown == request && self.frame_request.as_ref().is_some_and(|requested| requested == shown)
    }

    /// Asks the render thread for looks and takes what it has finished. To be called once per frame
    /// before the picture is drawn. While something moves it waits a little for a preview: one that
    /// is quick enough is seen in the frame of the movement itself.
    pub(super) fn advance(
        &mut self,
        looks: Looks,
        size: [u32; 2],
        ctx: &egui::Context,
    ) -> Result<(), GpuError> {
        let Some(dataset) = self.dataset.as_ref().filter(|_| !self.lost) else { return Ok(()) };
        let frame_request = FrameRequest::new(self.generation, dataset, looks, size);
        self.now_s = ctx.input(|input| input.time);
        self.fading = self.fading.take().filter(|(_, since_s)| self.now_s - since_s < FADE_S);
        if self.fading.is_some() {
            ctx.request_repaint();
        }
        self.thread.set_frame_ms(self.frame_ms);
        let mut longest_wait = Duration::ZERO;
        if self.frame_request.as_ref() != Some(&frame_request) {
            longest_wait = if self.context.is_software() { SOFTWARE_PREVIEW_WAIT } else { PREVIEW_WAIT };
            self.thread.set_request(frame_request.clone());
            if self.frame_request.is_some() {
                self.waiting.ask(frame_request.clone(), Instant::now());
            }
            self.frame_request = Some(frame_request.clone());
        }
        // What was too late for the last frame has been waited for long enough: it comes before what is newer.
        let newest = (!self.waited_in_vain).then_some(&frame_request);
        let frame = self.thread.take_frame(newest, longest_wait);
        if longest_wait > Duration::ZERO {
            let is_late = |frame: &Frame| newest.is_some_and(|newest| frame.request != *newest);
            self.waited_in_vain = frame.as_ref().is_none_or(is_late);
        }
        if let Some(frame) = frame.filter(|frame| frame.request.generation == self.generation) {
            self.show(frame, ctx);
        }
        if let Some(err) = self.thread.take_error() {
            self.lost = matches!(err, GpuError::Lost(_));
            self.failed.clone_from(&self.frame_request);
            return Err(err);
        }
        Ok(())
    }

    /// Puts a finished picture on screen.
    fn show(&mut self, frame: Frame, ctx: &egui::Context) {
        let Frame { request: frame_request, quality, dataset, image, other } = frame;
        self.dataset = Some(dataset);
        // Pixel for pixel where there are enough of them.
        let exact = image.size == frame_request.size.map(|n| n as usize);
        // A preview of the same fades away; anything else is replaced at once.
        let is_same =
            self.shown.as_ref().is_some_and(|(shown, before)| *shown == frame_request && *before != quality);
        self.fading =
            self.placed[0].take_if(|_| is_same && other.is_none()).map(|picture| (picture, self.now_s));
        if self.fading.is_some() {
            ctx.request_repaint();
        }
        self.place(0, &image, exact);
        self.finished = (quality == QualityLevel::FULL && other.is_none()).then(|| Arc::new(image));
        match other {
            Some((right, difference)) => {
                self.differs = Some(difference.distance);
                self.place(1, &right, exact);
                self.place(2, &difference.image, exact);
            }
            None => self.differs = None,
        }
        self.waiting.answer(&frame_request, Instant::now());
        self.shown = Some((frame_request, quality));
    }

    fn place(&mut self, at: usize, image: &ColorImage, is_exact: bool) {
        let size = image.size.map(|n| n as u32);
        let before = self.placed[at].take();
        self.placed[at] = Some(self.window.place(before, size, image.as_raw(), is_exact));
    }
}
