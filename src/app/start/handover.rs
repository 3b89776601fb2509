//! State that a window hands over to its successor after the loss of its graphics device.

use std::path::PathBuf;
use std::sync::{Arc, Mutex};

use crate::app::document::Document;
use crate::app::layout::WindowLayout;
use crate::app::persistence::PersistentState;
use crate::app::shell::messages::MessageLog;
use crate::app::shell::opening::OpenRequests;
use crate::app::viewport::compare::Compare;
use crate::app::windows::export::ExportWindow;
use crate::app::worker::jobs::Jobs;
use crate::app::worker::loader::ReadChoices;
use chiaroscuro_volume::Dataset;
use chiaroscuro_volume_io::LoadOptions;

/// State of the user's work: the document with its volume in host memory, and what is being opened or exported.
#[derive(Debug)]
pub(crate) struct WindowHandover {
    pub(super) document: Document,
    pub(super) dataset: Option<Dataset>,
    pub(super) requests: OpenRequests,
    /// File that was being opened, with its options.
    pub(super) opening: Option<(PathBuf, ReadChoices)>,
    pub(super) memory: PersistentState,
    /// All messages since the start.
    pub(super) messages: MessageLog,
    pub(super) layout: WindowLayout,
    pub(super) compare: Compare,
    /// True while the probe is on.
    pub(super) probe_on: bool,
    /// Running export, which goes on: it has a device of its own.
    pub(super) export: ExportWindow,
    /// Running jobs, for which the last window waits.
    pub(super) jobs: Jobs,
    pub load: LoadOptions,
    pub storage: Option<PathBuf>,
    /// True if the user has chosen the software adapter (CPU).
    pub on_cpu: bool,
}

/// Slot in which a window leaves its state for a successor.
pub(crate) type HandoverSlot = Arc<Mutex<Option<WindowHandover>>>;
