//! Scheduling of the render thread: a preview at once, full quality when nothing has changed for a moment.

use std::time::{Duration, Instant};

use super::mailbox::Mailbox;
use super::quality::QualityLevel;
use super::request::{FrameRequest, Scene};
use crate::data::Dataset;

/// Debounce interval: time without changes after which the picture is refined.
const REST: Duration = Duration::from_millis(150);

/// Reason for rendering a picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Purpose {
    /// Response to a change in progress; it is finished in any case.
    Preview,
    /// Full quality at rest; it is dropped when something else is requested.
    Refinement,
}

/// Time at which the next picture is due.
#[derive(Debug)]
pub(super) enum Due {
    /// Immediately, with its purpose and request.
    Now(Purpose, Box<FrameRequest>),
    /// Once nothing has changed for this time.
    After(Duration),
    /// Not before the window changes the mailbox.
    WithNews,
}

/// Schedule of the render thread: the window's requests, and what of them is already on screen.
#[derive(Debug)]
pub(super) struct Agenda {
    /// New scene that replaces the present one.
    pub next_scene: Option<Scene>,
    /// New dataset that replaces the present one.
    pub next_dataset: Option<Dataset>,
    /// True if the window has closed.
    pub is_closed: bool,
    frame_request: Option<FrameRequest>,
    changed: Instant,
    /// True while the look is about to change automatically.
    holds_refinement: bool,
    /// Request whose light volumes were filled while refinement was held.
    prepared: Option<FrameRequest>,
    /// True if a picture was published that the window had not taken when the mailbox was last read.
    is_frame_pending: bool,
    /// Request and quality of the last published picture.
    shown: Option<(FrameRequest, QualityLevel)>,
    /// Request that could not be rendered and is not retried.
    failed: Option<FrameRequest>,
}

impl Agenda {
    /// Creates an empty schedule.
    pub(super) fn new() -> Self {
        Self {
            next_scene: None,
            next_dataset: None,
            is_closed: false,
            frame_request: None,
            changed: Instant::now(),
            holds_refinement: false,
            prepared: None,
            is_frame_pending: false,
            shown: None,
            failed: None,
        }
    }

    /// Takes the window's new requests out of the mailbox.
    pub(super) fn read(&mut self, mailbox: &mut Mailbox) {
        self.is_closed = mailbox.closed;
        self.holds_refinement = mailbox.holds_refinement;
        if let Some(scene) = mailbox.scene.take() {
            (self.next_scene, self.next_dataset) = (Some(scene), None);
            self.frame_request = None;
        }
        if let Some(dataset) = mailbox.dataset.take() {
            self.next_dataset = Some(dataset);
            self.frame_request = None;
        }
        if let Some(frame_request) = mailbox.frame_request.take() {
            self.changed = Instant::now();
            self.frame_request = Some(frame_request);
        }
        // Until the window takes a picture, its next request is unknown: refining might only delay it.
        if self.is_frame_pending {
            self.changed = Instant::now();
            self.is_frame_pending = mailbox.frame.is_some();
        }
    }

    /// Returns true if the mailbox contains anything that was not read yet.
    pub(super) fn has_news(&self, mailbox: &Mailbox) -> bool {
        mailbox.has_news(self.is_frame_pending) || mailbox.holds_refinement != self.holds_refinement
    }

    /// Takes the scene that replaces the present one, and resets what is on screen.
    pub(super) fn take_scene(&mut self) -> Option<Scene> {
        let scene = self.next_scene.take()?;
        (self.shown, self.failed, self.prepared) = (None, None, None);
        Some(scene)
    }

    /// Takes the dataset that replaces the present one, and resets what is on screen.
    pub(super) fn take_dataset(&mut self) -> Option<Dataset> {
        let dataset = self.next_dataset.take()?;
        (self.shown, self.failed, self.prepared) = (None, None, None);
        Some(dataset)
    }

    /// Returns true if a picture must be dropped: the window has closed or shows another volume, or a refinement
    /// belongs to an outdated request.
    pub(super) fn is_obsolete(&self, purpose: Purpose, frame_request: &FrameRequest) -> bool {
        let is_other = purpose == Purpose::Refinement && Some(frame_request) != self.frame_request.as_ref();
        self.is_closed || self.next_scene.is_some() || self.next_dataset.is_some() || is_other
    }

    /// Returns true if a picture waits until the look has changed; its light volumes are filled meanwhile.
    pub(super) fn is_held(&self, purpose: Purpose) -> bool {
        purpose == Purpose::Refinement && self.holds_refinement
    }

    /// Records that everything a picture needs before it is drawn is complete.
    pub(super) fn prepare(&mut self, frame_request: FrameRequest) {
        self.prepared = Some(frame_request);
    }

    /// Returns the time at which the next picture is due.
    pub(super) fn due(&self) -> Due {
        let Some(frame_request) = &self.frame_request else { return Due::WithNews };
        let shown = self.shown.as_ref().filter(|(shown, _)| shown == frame_request);
        let is_finished = shown.is_some_and(|(_, quality)| *quality == QualityLevel::FULL);
        let waits = shown.is_some() && self.holds_refinement && self.prepared.as_ref() == Some(frame_request);
        if is_finished || waits || self.failed.as_ref() == Some(frame_request) {
            return Due::WithNews;
        }
        let rest = REST.saturating_sub(self.changed.elapsed());
        if shown.is_none() {
            // A first picture takes precedence over the pause.
            Due::Now(Purpose::Preview, Box::new(frame_request.clone()))
        } else if rest.is_zero() {
            Due::Now(Purpose::Refinement, Box::new(frame_request.clone()))
        } else if self.is_frame_pending {
            Due::WithNews
        } else {
            Due::After(rest)
        }
    }

    /// Returns true if nothing is to be drawn, now or soon.
    pub(super) fn is_at_rest(&self) -> bool {
        matches!(self.due(), Due::WithNews)
            && !self.is_frame_pending
            && self.next_scene.is_none()
            && self.next_dataset.is_none()
    }

    /// Records that a picture was published to the window.
    pub(super) fn publish(&mut self, frame_request: FrameRequest, quality: QualityLevel) {
        self.shown = Some((frame_request, quality));
        self.is_frame_pending = true;
    }

    /// Records that the present request cannot be rendered.
    pub(super) fn give_up(&mut self) {
        self.failed.clone_from(&self.frame_request);
    }
}
