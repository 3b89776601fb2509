//! The mailbox in which the window leaves requests and its render thread finished pictures; the latest counts.

use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};

use eframe::egui::ColorImage;

use super::difference::Difference;
use super::quality::QualityLevel;
use super::request::{FrameRequest, Scene};
use crate::data::Dataset;
use crate::gpu::{GpuError, LightFigures, Stage};
use crate::model::Settings;

/// A finished picture.
pub(crate) struct Frame {
    /// What it shows.
    pub(crate) request: FrameRequest,
    pub(crate) quality: QualityLevel,
    /// The volume, with the values at densities 0 and 1 that it shows.
    pub(crate) dataset: Dataset,
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
    /// The volume of the sky, if there is one.
    pub(crate) sky: Option<LightFigures>,
    /// That of light that has bounced.
    pub(crate) bounces: Option<LightFigures>,
    /// Footprints that the last full-quality picture has splatted; 0 of one that gathers.
    pub(crate) splats: u64,
    /// Share of what the last full-quality picture shows that is nearly black.
    pub(crate) dark_share: Option<f64>,
    /// The last picture, or the left one of two, shows nothing of the volume.
    pub(crate) shows_nothing: bool,
    /// Pictures at full quality that were made after previews.
    pub(crate) refinements: u64,
    /// A refinement under way: what is done now, and the share that is done.
    pub(crate) refining: Option<(Stage, f32)>,
}

/// A balance that the window wants to know.
#[derive(Debug, Clone)]
pub(crate) struct Measurement {
    /// Counts up.
    pub(crate) id: u64,
    pub(crate) settings: Box<Settings>,
}

/// What passes between the window and its render thread.
#[derive(Default)]
pub(crate) struct Mailbox {
    pub(crate) scene: Option<Scene>,
    /// Takes the place of the volume, and leaves the renderer.
    pub(crate) dataset: Option<Dataset>,
    pub(crate) frame_request: Option<FrameRequest>,
    pub(crate) closed: bool,
    /// Milliseconds per frame while something moves, if the user asked for other than usual.
    pub(crate) frame_ms: Option<f64>,
    pub(crate) frame: Option<Frame>,
    pub(crate) error: Option<GpuError>,
    pub(crate) figures: Figures,
    /// The look is about to change by itself: refinements stop when light volumes are filled, before the picture is drawn.
    pub(crate) holds_refinement: bool,
    /// Waits until pictures leave time for it.
    pub(crate) measurement: Option<Measurement>,
    /// The balance of the last measurement, and which one that was.
    pub(crate) measured: Option<(u64, Result<f64, GpuError>)>,
}

impl Mailbox {
    /// Whether the window has left something that the thread has not read.
    pub(super) fn has_news(&self, is_frame_pending: bool) -> bool {
        let is_taken = is_frame_pending && self.frame.is_none();
        self.closed
            || self.scene.is_some()
            || self.dataset.is_some()
            || self.frame_request.is_some()
            || is_taken
    }
}

/// The mailbox, and how each side hears of the other.
#[derive(Default)]
pub(crate) struct Shared {
    mailbox: Mutex<Mailbox>,
    /// The window has put something into the mailbox, or taken it away.
    pub(crate) changed: Condvar,
    /// The render thread has put something into the mailbox.
    pub(crate) finished: Condvar,
}

impl Shared {
    pub(crate) fn mailbox(&self) -> MutexGuard<'_, Mailbox> {
        self.mailbox.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
