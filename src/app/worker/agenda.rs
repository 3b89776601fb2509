//! What the render thread does next: a preview at once, full quality when nothing has changed for a moment.

use std::time::{Duration, Instant};

use super::mailbox::Mailbox;
use super::quality::QualityLevel;
use super::request::{FrameRequest, Scene};
use crate::data::Dataset;

/// A change this long ago is over: time to refine.
const REST: Duration = Duration::from_millis(150);

/// Why a picture is made.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Purpose {
    /// To show something while the user moves something: it is finished whatever happens.
    Preview,
    /// To show full quality: it is dropped when something else is requested.
    Refinement,
}

/// When the next picture is to be made.
#[derive(Debug)]
pub(super) enum Due {
    /// At once.
    Now(Purpose, Box<FrameRequest>),
    /// When nothing has changed for so long.
    After(Duration),
    /// When the window changes the mailbox.
    WithNews,
}

/// What the window requests, and how much of it is on screen.
#[derive(Debug)]
pub(super) struct Agenda {
    /// A scene has come that replaces the one that is worked on.
    pub next_scene: Option<Scene>,
    /// A volume has come that replaces the one that is worked on.
    pub next_dataset: Option<Dataset>,
    /// The window has closed.
    pub is_closed: bool,
    frame_request: Option<FrameRequest>,
    changed: Instant,
    /// The look is about to change by itself.
    holds_refinement: bool,
    /// What was refined as far as light volumes go, while that was so.
    prepared: Option<FrameRequest>,
    /// A picture was published, and the window had not taken it when the mailbox was looked at last.
    is_frame_pending: bool,
    /// What is on screen, or on its way there.
    shown: Option<(FrameRequest, QualityLevel)>,
    /// What could not be rendered and is not tried again.
    failed: Option<FrameRequest>,
}

impl Agenda {
    /// Nothing to do.
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

    /// Takes note of what the window requests now.
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
        // Until the window takes a picture nobody knows what it requests next: refining might only delay it.
        if self.is_frame_pending {
            self.changed = Instant::now();
            self.is_frame_pending = mailbox.frame.is_some();
        }
    }

    /// Whether the window has left something that was not read.
    pub(super) fn has_news(&self, mailbox: &Mailbox) -> bool {
        mailbox.has_news(self.is_frame_pending) || mailbox.holds_refinement != self.holds_refinement
    }

    /// The scene that replaces the one that is worked on, once: nothing of it is on screen.
    pub(super) fn take_scene(&mut self) -> Option<Scene> {
        let scene = self.next_scene.take()?;
        (self.shown, self.failed, self.prepared) = (None, None, None);
        Some(scene)
    }

    /// The volume that replaces the one that is worked on, once: nothing of it is on screen.
    pub(super) fn take_dataset(&mut self) -> Option<Dataset> {
        let dataset = self.next_dataset.take()?;
        (self.shown, self.failed, self.prepared) = (None, None, None);
        Some(dataset)
    }

    /// Whether a picture must be dropped: the window closed or shows another volume, or a refinement is of something
    /// that is no longer requested.
    pub(super) fn is_obsolete(&self, purpose: Purpose, frame_request: &FrameRequest) -> bool {
        let is_other = purpose == Purpose::Refinement && Some(frame_request) != self.frame_request.as_ref();
        self.is_closed || self.next_scene.is_some() || self.next_dataset.is_some() || is_other
    }

    /// Whether a picture is to wait until the look has changed: its light volumes are filled meanwhile.
    pub(super) fn is_held(&self, purpose: Purpose) -> bool {
        purpose == Purpose::Refinement && self.holds_refinement
    }

    /// All is there that a picture needs before it is drawn.
    pub(super) fn prepare(&mut self, frame_request: FrameRequest) {
        self.prepared = Some(frame_request);
    }

    /// When the next picture is to be made.
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
            // Something to look at comes first.
            Due::Now(Purpose::Preview, Box::new(frame_request.clone()))
        } else if rest.is_zero() {
            Due::Now(Purpose::Refinement, Box::new(frame_request.clone()))
        } else if self.is_frame_pending {
            Due::WithNews
        } else {
            Due::After(rest)
        }
    }

    /// Whether nothing is to be drawn, now or soon.
    pub(super) fn is_at_rest(&self) -> bool {
        matches!(self.due(), Due::WithNews)
            && !self.is_frame_pending
            && self.next_scene.is_none()
            && self.next_dataset.is_none()
    }

    /// A picture is on its way to the screen.
    pub(super) fn publish(&mut self, frame_request: FrameRequest, quality: QualityLevel) {
        self.shown = Some((frame_request, quality));
        self.is_frame_pending = true;
    }

    /// What is requested cannot be rendered.
    pub(super) fn give_up(&mut self) {
        self.failed.clone_from(&self.frame_request);
    }
}
