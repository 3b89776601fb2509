//! Render thread: the window's handle to the thread that renders its pictures.

use std::cell::Cell;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Arc, PoisonError};
use std::thread::JoinHandle;
use std::time::Duration;

use eframe::egui;

use super::jobs::panic_message;
use super::mailbox::{
    BalanceRequest, FinishedFrame, Mailbox, RefinementHold, RenderStatistics, SharedMailbox, UpcomingSteps,
};
use super::render_worker::RenderWorker;
use super::request::{FrameRequest, RenderScene};
use chiaroscuro_render::{GpuContext, GpuError};
use chiaroscuro_scene::Settings;
use chiaroscuro_volume::Dataset;

/// Handle to the render thread, which ends when the handle is dropped.
pub(crate) struct RenderThread {
    shared: Arc<SharedMailbox>,
    thread: Option<JoinHandle<()>>,
    /// Number of balance measurements requested so far.
    balance_request_count: Cell<u64>,
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
        // A driver must not be unloaded while a thread executes in it. Panics have been caught.
        if let Some(thread) = self.thread.take() {
            drop(thread.join());
        }
    }
}

impl RenderThread {
    /// Starts the render thread.
    pub(crate) fn start(context: GpuContext, ctx: egui::Context) -> std::io::Result<Self> {
        let shared = Arc::<SharedMailbox>::default();
        let worker_shared = Arc::clone(&shared);
        let thread = std::thread::Builder::new().name("renderer".to_owned()).spawn(move || {
            let mut worker = RenderWorker::new(&context, ctx, worker_shared);
            // wgpu panics when a device is lost in the middle of a call.
            if let Err(panic) = catch_unwind(AssertUnwindSafe(|| worker.run())) {
                worker.report(GpuError::DeviceLost(panic_message(&*panic)));
            }
        })?;
        Ok(Self { shared, thread: Some(thread), balance_request_count: Cell::new(0) })
    }

    /// Replaces the scene, and discards requests and results of the previous one.
    pub(crate) fn set_scene(&self, scene: RenderScene) {
        let mut mailbox = self.shared.mailbox();
        mailbox.dataset = None;
        (mailbox.scene, mailbox.frame_request, mailbox.frame) = (Some(scene), None, None);
        (mailbox.balance_request, mailbox.balance_result) = (None, None);
        self.shared.changed.notify_one();
    }

    /// Replaces the dataset, keeping the renderer, and discards requests and results of the previous one.
    pub(crate) fn set_dataset(&self, dataset: Dataset) {
        let mut mailbox = self.shared.mailbox();
        (mailbox.dataset, mailbox.frame_request, mailbox.frame) = (Some(dataset), None, None);
        (mailbox.balance_request, mailbox.balance_result) = (None, None);
        self.shared.changed.notify_one();
    }

    /// Names the time steps that may be shown next, which are prepared while nothing is to be drawn.
    pub(crate) fn prepare_steps(&self, upcoming: UpcomingSteps) {
        self.shared.mailbox().upcoming = Some(upcoming);
        self.shared.changed.notify_one();
    }

    /// Posts a request, which replaces the previous one.
    pub(crate) fn post_request(&self, frame_request: FrameRequest) {
        self.shared.mailbox().frame_request = Some(frame_request);
        self.shared.changed.notify_one();
    }

    /// Requests the balance of a look, measured with its light volumes once its picture is finished; it replaces a
    /// pending measurement. Returns the number of the measurement.
    pub(crate) fn measure_balance(&self, settings: &Settings) -> u64 {
        let mut mailbox = self.shared.mailbox();
        self.balance_request_count.set(self.balance_request_count.get() + 1);
        let id = self.balance_request_count.get();
        mailbox.balance_request = Some(BalanceRequest { id, settings: Box::new(settings.clone()) });
        self.shared.changed.notify_one();
        id
    }

    /// Holds full-quality pictures, since the look is about to change automatically, or releases them.
    pub(crate) fn hold_refinement(&self, hold: RefinementHold) {
        let mut mailbox = self.shared.mailbox();
        if mailbox.refinement_hold != hold {
            mailbox.refinement_hold = hold;
            self.shared.changed.notify_one();
        }
    }

    /// Takes the result of a measurement; returns it only once.
    pub(crate) fn take_balance(&self, id: u64) -> Option<Result<f64, GpuError>> {
        let measured = self.shared.mailbox().balance_result.take_if(|(measured, _)| *measured == id);
        measured.map(|(_, balance)| balance)
    }

    /// Sets the time budget of a frame with a preview, in milliseconds.
    pub(crate) fn set_frame_ms(&self, frame_ms: Option<f64>) {
        self.shared.mailbox().frame_ms = frame_ms;
    }

    /// Takes the latest finished picture. Waits for at most `longest_wait` until there is one, or one of the request
    /// `awaited`.
    pub(crate) fn take_frame(
        &self,
        awaited: Option<&FrameRequest>,
        longest_wait: Duration,
    ) -> Option<FinishedFrame> {
        let is_it = |frame: &FinishedFrame| awaited.is_none_or(|awaited| frame.request == *awaited);
        let is_due =
            |mailbox: &mut Mailbox| mailbox.error.is_none() && !mailbox.frame.as_ref().is_some_and(is_it);
        let (mut mailbox, _) = self
            .shared
            .finished
            .wait_timeout_while(self.shared.mailbox(), longest_wait, is_due)
            .unwrap_or_else(PoisonError::into_inner);
        let frame = mailbox.frame.take();
        if frame.is_some() {
            self.shared.changed.notify_one();
        }
        frame
    }

    /// Takes the last error; returns it only once.
    pub(crate) fn take_error(&self) -> Option<GpuError> {
        self.shared.mailbox().error.take()
    }

    /// Returns a copy of the render thread's statistics.
    pub(crate) fn statistics(&self) -> RenderStatistics {
        self.shared.mailbox().figures.clone()
    }
}
