//! The window's end of the thread that renders its pictures: a mailbox in which orders and finished
//! pictures are left.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;
use std::time::Duration;

use eframe::egui::{self, ColorImage};

use super::difference::Difference;
use super::quality::QualityLevel;
use super::render_worker::RenderWorker;
use super::request::{FrameRequest, Scene};
use super::task::panic_message;
use crate::gpu::{Context, GpuError, LightFigures, Stage};

/// A finished picture.
pub(crate) struct Frame {
    pub(crate) wanted: FrameRequest,
    pub(crate) quality: QualityLevel,
    pub(crate) image: ColorImage,
    /// The picture that it is compared with, and what lies between them.
    pub(crate) other: Option<(ColorImage, Difference)>,
}

/// Figures about the work, for display.
#[derive(Debug, Clone, Default)]
pub(crate) struct Figures {
    /// Milliseconds of the last full-quality picture.
    pub(crate) full_ms: Option<f64>,
    /// Milliseconds of the last preview.
    pub(crate) preview_ms: Option<f64>,
    pub(crate) light_rebuilds: u64,
    pub(crate) cached_light_volumes: usize,
    pub(crate) gpu_bytes: u64,
    pub(crate) light_bytes: u64,
    /// The light volume of each light, if it has one.
    pub(crate) light_volumes: Vec<Option<LightFigures>>,
    /// Footprints that the last full-quality picture has splatted; 0 of one that gathers.
    pub(crate) splats: u64,
    /// Share of what the last full-quality picture shows that is nearly black.
    pub(crate) dark_share: Option<f64>,
    /// A refinement under way: what is done now, and the share that is done.
    pub(crate) refining: Option<(Stage, f32)>,
}

/// What passes between the window and its render thread.
#[derive(Default)]
pub(crate) struct Mailbox {
    pub(crate) scene: Option<Scene>,
    pub(crate) wanted: Option<FrameRequest>,
    pub(crate) closed: bool,
    /// Milliseconds per frame while something moves, if the user asked for other than usual.
    pub(crate) frame_ms: Option<f64>,
    pub(crate) frame: Option<Frame>,
    pub(crate) error: Option<GpuError>,
    pub(crate) figures: Figures,
}

impl Mailbox {
    /// Whether the window has left something that the thread has not read.
    pub(super) fn has_news(&self, is_frame_pending: bool) -> bool {
        let is_taken = is_frame_pending && self.frame.is_none();
        self.closed || self.scene.is_some() || self.wanted.is_some() || is_taken
    }
}

#[derive(Default)]
pub(crate) struct Shared {
    mailbox: Mutex<Mailbox>,
    /// The window has put something into the mailbox, or taken it away.
    pub(crate) changed: Condvar,
    /// The render thread has.
    pub(crate) finished: Condvar,
}

impl Shared {
    pub(crate) fn mailbox(&self) -> MutexGuard<'_, Mailbox> {
        self.mailbox.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// The window's end of the thread, which ends with it.
pub(crate) struct RenderThread {
    shared: Arc<Shared>,
    thread: Option<JoinHandle<()>>,
}

impl std::fmt::Debug for RenderThread {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("RenderThread").finish_non_exhaustive()
    }
}

impl Drop for RenderThread {
    fn drop(&mut self) {
        self.shared.mailbox().closed = true;
        self.shared.changed.notify_one();
        // A driver must not be unloaded while a thread is in it. Panics were caught.
        if let Some(thread) = self.thread.take() {
            drop(thread.join());
        }
    }
}

impl RenderThread {
    /// Starts the thread.
    pub(crate) fn start(context: Context, ctx: egui::Context) -> std::io::Result<Self> {
        let shared = Arc::<Shared>::default();
        let theirs = Arc::clone(&shared);
        let thread = std::thread::Builder::new().name("renderer".to_owned()).spawn(move || {
            let mut worker = RenderWorker::new(&context, ctx, theirs);
            // wgpu panics when a device is lost in the middle of a call.
            if let Err(panic) = catch_unwind(AssertUnwindSafe(|| worker.work())) {
                worker.tell(GpuError::Lost(panic_message(&*panic)));
            }
        })?;
        Ok(Self { shared, thread: Some(thread) })
    }

    /// Renders this from now on.
    pub(crate) fn set_scene(&self, scene: Scene) {
        let mut mailbox = self.shared.mailbox();
        (mailbox.scene, mailbox.wanted, mailbox.frame) = (Some(scene), None, None);
        self.shared.changed.notify_one();
    }

    /// Renders this way from now on.
    pub(crate) fn set_wanted(&self, wanted: FrameRequest) {
        self.shared.mailbox().wanted = Some(wanted);
        self.shared.changed.notify_one();
    }

    /// What previews may take from now on.
    pub(crate) fn set_frame_ms(&self, frame_ms: Option<f64>) {
        self.shared.mailbox().frame_ms = frame_ms;
    }

    /// The latest finished picture, once; waits at most so long for one, or for that of what is wanted.
    pub(crate) fn take_frame(&self, wanted: Option<&FrameRequest>, patience: Duration) -> Option<Frame> {
        let is_it = |frame: &Frame| wanted.is_none_or(|wanted| frame.wanted == *wanted);
        let is_due =
            |mailbox: &mut Mailbox| mailbox.error.is_none() && !mailbox.frame.as_ref().is_some_and(is_it);
        let (mut mailbox, _) = self
            .shared
            .finished
            .wait_timeout_while(self.shared.mailbox(), patience, is_due)
            .unwrap_or_else(PoisonError::into_inner);
        let frame = mailbox.frame.take();
        if frame.is_some() {
            self.shared.changed.notify_one();
        }
        frame
    }

    /// What went wrong, once.
    pub(crate) fn take_error(&self) -> Option<GpuError> {
        self.shared.mailbox().error.take()
    }

    /// Figures about the work.
    pub(crate) fn figures(&self) -> Figures {
        self.shared.mailbox().figures.clone()
    }
}
