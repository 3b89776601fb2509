//! State of opening: requests for the next volume, and what is still to be opened or read.

use std::path::PathBuf;

use super::plan::PendingLook;
use crate::app::shell::file_tasks::FileTasks;
use crate::app::worker::jobs::JobSlot;
use chiaroscuro_scene::Settings;

/// Function that changes settings once.
pub type SettingsAdjustment = Box<dyn FnOnce(Settings) -> Settings + Send>;

/// Requests for the next volumes, which a successor window takes over.
#[derive(Debug, Default)]
pub(crate) struct OpenRequests {
    /// True if the next volume keeps the current look instead of getting its own first look.
    pub keeps_look: bool,
    /// Look for the volume that is being opened, applied when the volume arrives.
    pub pending_look: Option<PendingLook>,
    /// True until the session's look has been applied over the first look.
    pub session_is_due: bool,
    /// True if volumes named by looks from outside are opened without asking the user.
    pub trusts_paths: bool,
}

/// State of opening volumes and looks.
#[derive(Default)]
pub(crate) struct OpeningState {
    /// Requests for the next volumes.
    pub requests: OpenRequests,
    /// Change of the first volume's settings, from the command line or by a safe start.
    pub adjust_first_look: Option<SettingsAdjustment>,
    /// True while the default volume waits for the user's answer about reopening the last session.
    pub default_open_waits: bool,
    /// Search for the next file in the folder (true) or the one before (false).
    pub next_file_search: JobSlot<Option<PathBuf>, bool>,
    /// Files other than volumes that are being read.
    pub file_tasks: FileTasks,
}
