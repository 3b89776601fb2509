//! Mailbox in which the window leaves requests and the render thread finished pictures; only the latest of each
//! counts.

use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};

use eframe::egui::ColorImage;

use super::difference::PictureDifference;
use super::quality::QualityLevel;
use super::request::{FrameRequest, RenderScene};
use chiaroscuro_render::{GpuError, LightVolumeStatistics, RenderStage};
use chiaroscuro_scene::Settings;
use chiaroscuro_volume::Dataset;

/// Finished picture, with its request and quality.
pub(crate) struct FinishedFrame {
    /// Request that the picture answers.
    pub(crate) request: FrameRequest,
    pub(crate) quality: QualityLevel,
    /// Dataset that the picture shows, with its range of values for densities 0 to 1.
    pub(crate) dataset: Dataset,
    pub(crate) image: ColorImage,
    /// Right picture of a comparison, and the difference of both.
    pub(crate) compared: Option<(ColorImage, PictureDifference)>,
}

/// Statistics of the render thread, for display.
#[derive(Debug, Clone, Default)]
pub(crate) struct RenderStatistics {
    /// Time of the last full-quality picture, in milliseconds.
    pub(crate) full_ms: Option<f64>,
    /// Time of the last preview, in milliseconds.
    pub(crate) preview_ms: Option<f64>,
    pub(crate) light_rebuilds: u64,
    pub(crate) cached_light_volumes: usize,
    pub(crate) gpu_bytes: u64,
    pub(crate) light_bytes: u64,
    /// Statistics of each light's volume; `None` for lights without one.
    pub(crate) light_volumes: Vec<Option<LightVolumeStatistics>>,
    /// Statistics of the sky-visibility volume, if there is one.
    pub(crate) sky: Option<LightVolumeStatistics>,
    /// Statistics of the volume of multiply scattered light, if there is one.
    pub(crate) bounces: Option<LightVolumeStatistics>,
    /// Number of footprints splatted for the last full-quality picture; 0 if it was gathered.
    pub(crate) splats: u64,
    /// Share of the visible part of the last full-quality picture that is nearly black, 0 to 1.
    pub(crate) dark_share: Option<f64>,
    /// True if nothing of the volume is visible in the last picture, or in the left one of a comparison.
    pub(crate) shows_nothing: bool,
    /// Number of full-quality pictures that followed previews.
    pub(crate) refinements: u64,
    /// Refinement in progress: its current stage, and the completed fraction.
    pub(crate) refinement_progress: Option<(RenderStage, f32)>,
    /// Finer resolution levels of the picture, if the one in memory is too coarse for it.
    pub(crate) finer_levels: Option<FinerLevelStatus>,
}

/// Finer resolution levels of a picture.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct FinerLevelStatus {
    /// Key of the finest level that is shown.
    pub(crate) finest: String,
    /// Number of parts that have yet to be read.
    pub(crate) missing: usize,
    /// True if a finer level is called for that does not fit into memory.
    pub(crate) is_substituted: bool,
    /// Message of the error at which reading ended.
    pub(crate) error: Option<String>,
}

/// Request to measure the balance of a look.
#[derive(Debug, Clone)]
pub(crate) struct BalanceRequest {
    /// Number of the measurement, counting up.
    pub(crate) id: u64,
    pub(crate) settings: Box<Settings>,
}

/// Hold on refinements while the look is about to change automatically.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) enum RefinementHold {
    /// Refinements go on.
    #[default]
    Off,
    /// Refinements stop after filling light volumes, before drawing: brightness is about to change.
    BeforeDrawing,
    /// Refinements stop at once: lights are about to move.
    AtOnce,
}

/// Time steps that may be shown next, in the order in which they are prepared.
#[derive(Debug, Clone, Default)]
pub(crate) struct UpcomingSteps {
    /// Datasets of the steps.
    pub(crate) datasets: Vec<Dataset>,
    /// True if the volume is one of several time steps that are shown one after the other.
    pub(crate) is_series: bool,
    /// True while the series plays: steps get the light that there is time for, and otherwise that of full quality.
    pub(crate) is_playing: bool,
}

/// Messages between the window and the render thread.
#[derive(Default)]
pub(crate) struct Mailbox {
    pub(crate) scene: Option<RenderScene>,
    /// New dataset, for the renderer of the present scene.
    pub(crate) dataset: Option<Dataset>,
    pub(crate) frame_request: Option<FrameRequest>,
    /// True if a thread has read pages of finer levels that the render thread has not taken.
    pub(crate) pages_arrived: bool,
    /// Time steps that may be shown next, if others are than before.
    pub(crate) upcoming: Option<UpcomingSteps>,
    pub(crate) closed: bool,
    /// Time budget per frame during interaction, in milliseconds; `None` for the adapter's default.
    pub(crate) frame_ms: Option<f64>,
    pub(crate) frame: Option<FinishedFrame>,
    pub(crate) error: Option<GpuError>,
    pub(crate) figures: RenderStatistics,
    /// Hold on refinements while the look is about to change automatically.
    pub(crate) refinement_hold: RefinementHold,
    /// Pending measurement, which starts when no picture is due.
    pub(crate) balance_request: Option<BalanceRequest>,
    /// Result of the last measurement, with its number.
    pub(crate) balance_result: Option<(u64, Result<f64, GpuError>)>,
}

impl Mailbox {
    /// Returns true if the window has left something that the render thread has not read.
    pub(super) fn has_changes(&self, is_frame_pending: bool) -> bool {
        let is_taken = is_frame_pending && self.frame.is_none();
        self.closed
            || self.scene.is_some()
            || self.dataset.is_some()
            || self.frame_request.is_some()
            || self.upcoming.is_some()
            || self.pages_arrived
            || is_taken
    }
}

/// Mailbox with the condition variables that signal changes to either side.
#[derive(Default)]
pub(crate) struct SharedMailbox {
    mailbox: Mutex<Mailbox>,
    /// Signalled after the window has put something into the mailbox or taken it out.
    pub(crate) changed: Condvar,
    /// Signalled after the render thread has put something into the mailbox.
    pub(crate) finished: Condvar,
}

impl SharedMailbox {
    pub(crate) fn mailbox(&self) -> MutexGuard<'_, Mailbox> {
        self.mailbox.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
