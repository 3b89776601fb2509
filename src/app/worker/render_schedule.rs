//! Scheduling of the render thread: a preview at once, full quality when nothing has changed for a moment, and
//! antialiased edges after another one.

use std::time::{Duration, Instant};

use super::mailbox::{Mailbox, RefinementHold};
use super::quality::QualityLevel;
use super::request::{FrameRequest, RenderScene};
use chiaroscuro_volume::Dataset;

/// Debounce interval: time without changes after which the picture is refined.
const REFINEMENT_DELAY: Duration = Duration::from_millis(150);

/// Reason for rendering a picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum RenderPurpose {
    /// Response to a change in progress; it is finished in any case.
    Preview,
    /// Full quality at rest; it is dropped when something else is requested.
    Refinement,
    /// Antialiased edges of the full-quality picture; dropped likewise.
    Antialiasing,
}

/// Time at which the next picture is due.
#[derive(Debug)]
pub(super) enum NextRender {
    /// Immediately, with its purpose and request.
    Now(RenderPurpose, Box<FrameRequest>),
    /// Once nothing has changed for this time.
    After(Duration),
    /// Not before the window changes the mailbox.
    OnMailboxChange,
}

/// Schedule of the render thread: the window's requests, and what of them is already on screen.
#[derive(Debug)]
pub(super) struct RenderSchedule {
    /// New scene that replaces the present one.
    pub next_scene: Option<RenderScene>,
    /// New dataset that replaces the present one.
    pub next_dataset: Option<Dataset>,
    /// True if the window has closed.
    pub is_closed: bool,
    frame_request: Option<FrameRequest>,
    last_change: Instant,
    /// Hold while the look is about to change automatically.
    refinement_hold: RefinementHold,
    /// Request whose light volumes were filled while refinement was held.
    prepared_request: Option<FrameRequest>,
    /// True if a picture was published that the window had not taken when the mailbox was last read.
    is_frame_pending: bool,
    /// Request and quality of the last published picture.
    published: Option<(FrameRequest, QualityLevel)>,
    /// Request that could not be rendered and is not retried.
    failed_request: Option<FrameRequest>,
}

impl RenderSchedule {
    /// Creates an empty schedule.
    pub(super) fn new() -> Self {
        Self {
            next_scene: None,
            next_dataset: None,
            is_closed: false,
            frame_request: None,
            last_change: Instant::now(),
            refinement_hold: RefinementHold::Off,
            prepared_request: None,
            is_frame_pending: false,
            published: None,
            failed_request: None,
        }
    }

    /// Takes the window's new requests out of the mailbox.
    pub(super) fn read(&mut self, mailbox: &mut Mailbox) {
        self.is_closed = mailbox.closed;
        self.refinement_hold = mailbox.refinement_hold;
        if let Some(scene) = mailbox.scene.take() {
            (self.next_scene, self.next_dataset) = (Some(scene), None);
            self.frame_request = None;
        }
        if let Some(dataset) = mailbox.dataset.take() {
            self.next_dataset = Some(dataset);
            self.frame_request = None;
        }
        if let Some(frame_request) = mailbox.frame_request.take() {
            self.last_change = Instant::now();
            self.frame_request = Some(frame_request);
        }
        // Until the window takes a picture, its next request is unknown: refining might only delay it.
        if self.is_frame_pending {
            self.last_change = Instant::now();
            self.is_frame_pending = mailbox.frame.is_some();
        }
    }

    /// Returns true if the mailbox contains anything that was not read yet.
    pub(super) fn has_news(&self, mailbox: &Mailbox) -> bool {
        mailbox.has_changes(self.is_frame_pending) || mailbox.refinement_hold != self.refinement_hold
    }

    /// Takes the scene that replaces the present one, and resets what is on screen.
    pub(super) fn take_scene(&mut self) -> Option<RenderScene> {
        let scene = self.next_scene.take()?;
        (self.published, self.failed_request, self.prepared_request) = (None, None, None);
        Some(scene)
    }

    /// Takes the dataset that replaces the present one, and resets what is on screen.
    pub(super) fn take_dataset(&mut self) -> Option<Dataset> {
        let dataset = self.next_dataset.take()?;
        (self.published, self.failed_request, self.prepared_request) = (None, None, None);
        Some(dataset)
    }

    /// Returns true if a scene or dataset was read that has yet to take the place of the present one.
    pub(super) fn has_other_volume(&self) -> bool {
        self.next_scene.is_some() || self.next_dataset.is_some()
    }

    /// Returns true if a picture must be dropped: the window has closed or shows another volume, or a refinement
    /// belongs to an outdated request.
    pub(super) fn is_obsolete(&self, purpose: RenderPurpose, frame_request: &FrameRequest) -> bool {
        let is_other =
            purpose != RenderPurpose::Preview && Some(frame_request) != self.frame_request.as_ref();
        self.is_closed || self.has_other_volume() || is_other
    }

    /// Returns true if a picture waits until the look has changed; its light volumes are filled meanwhile.
    pub(super) fn is_on_hold(&self, purpose: RenderPurpose) -> bool {
        purpose != RenderPurpose::Preview && self.refinement_hold == RefinementHold::BeforeDrawing
    }

    /// Returns true if a picture is dropped until the look has changed.
    pub(super) fn is_stopped(&self, purpose: RenderPurpose) -> bool {
        purpose != RenderPurpose::Preview && self.refinement_hold == RefinementHold::AtOnce
    }

    /// Records that everything a picture needs before it is drawn is complete.
    pub(super) fn mark_prepared(&mut self, frame_request: FrameRequest) {
        self.prepared_request = Some(frame_request);
    }

    /// Returns the time at which the next picture is due.
    pub(super) fn due(&self) -> NextRender {
        let Some(frame_request) = &self.frame_request else { return NextRender::OnMailboxChange };
        let shown = self.published.as_ref().filter(|(shown, _)| shown == frame_request);
        let is_finished = shown.is_some_and(|(shown, quality)| *quality == shown.final_quality());
        let waits = shown.is_some()
            && match self.refinement_hold {
                RefinementHold::Off => false,
                RefinementHold::BeforeDrawing => self.prepared_request.as_ref() == Some(frame_request),
                RefinementHold::AtOnce => true,
            };
        if is_finished || waits || self.failed_request.as_ref() == Some(frame_request) {
            return NextRender::OnMailboxChange;
        }
        let rest = REFINEMENT_DELAY.saturating_sub(self.last_change.elapsed());
        if shown.is_none() {
            // A first picture takes precedence over the pause.
            NextRender::Now(RenderPurpose::Preview, Box::new(frame_request.clone()))
        } else if rest.is_zero() {
            let is_full = shown.is_some_and(|(_, quality)| quality.is_full());
            let purpose = if is_full { RenderPurpose::Antialiasing } else { RenderPurpose::Refinement };
            NextRender::Now(purpose, Box::new(frame_request.clone()))
        } else if self.is_frame_pending {
            NextRender::OnMailboxChange
        } else {
            NextRender::After(rest)
        }
    }

    /// Returns the last request, if nothing is to be drawn now.
    pub(super) fn request_at_rest(&self) -> Option<&FrameRequest> {
        let is_at_rest = matches!(self.due(), NextRender::OnMailboxChange)
            && self.next_scene.is_none()
            && self.next_dataset.is_none()
            && !self.is_closed;
        self.frame_request.as_ref().filter(|_| is_at_rest)
    }

    /// Returns true if nothing is to be drawn, now or soon.
    pub(super) fn is_idle(&self) -> bool {
        matches!(self.due(), NextRender::OnMailboxChange)
            && !self.is_frame_pending
            && self.next_scene.is_none()
            && self.next_dataset.is_none()
    }

    /// Records that a picture was published to the window.
    pub(super) fn publish(&mut self, frame_request: FrameRequest, quality: QualityLevel) {
        self.published = Some((frame_request, quality));
        self.is_frame_pending = true;
    }

    /// Records that the present request cannot be rendered.
    pub(super) fn mark_failed(&mut self) {
        self.failed_request.clone_from(&self.frame_request);
    }
}
