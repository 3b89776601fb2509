//! Opening of volumes and looks: precedence between requests, and the settings with which a volume is shown.

mod alternatives;
mod base_volume;
mod dropped_and_neighbours;
pub(crate) mod file_tasks;
mod layers;
mod look_files;
mod opened;
mod other_files;
mod plan;
mod second_volume;
mod similarity;
mod volumes;

use std::path::{Path, PathBuf};

use eframe::egui;

use self::file_tasks::{FileTasks, ReadPurpose};
use self::layers::LayerFile;
use self::plan::PendingLook;
use self::second_volume::SecondVolumeQuestion;
use crate::app::shell::look_editor::LookEditor;
use crate::app::text;
use crate::app::windows::large_volume::{LargeVolumeAnswer, LargeVolumeDialog};
use crate::app::windows::raw_dialog::RawDialog;
use crate::app::windows::untrusted_path::UntrustedPathDialog;
use crate::app::worker::jobs::JobSlot;
use crate::app::worker::loader::{LoadOutcome, Loader, ReadChoices, RememberedFileSettings};
use crate::app::worker::request::VolumeFile;
use chiaroscuro_scene::Settings;
use chiaroscuro_volume::Dataset;
use chiaroscuro_volume_io::LoadOptions;

/// Volume on which a look is shown that names none, if none is open.
const DEFAULT_SOURCE: &str = "builtin:chair";

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
    /// Volumes that are shown as layers over the next volume.
    layers_over: Vec<LayerFile>,
}

/// State of opening volumes and looks.
pub(crate) struct OpeningState {
    /// Requests for the next volumes.
    pub requests: OpenRequests,
    /// Change of the first volume's settings, from the command line or by a safe start.
    pub adjust_first_look: Option<SettingsAdjustment>,
    /// Reader of volumes, on threads of its own.
    pub loader: Loader,
    /// Search for the next file in the folder (true) or the one before (false).
    next_file_search: JobSlot<Option<PathBuf>, bool>,
    /// Files other than volumes that are being read.
    pub file_tasks: FileTasks,
    /// Layout of a file of bare voxels.
    raw: RawDialog,
    /// Portion of a volume that does not fit into memory.
    large_volume: LargeVolumeDialog,
    /// Question before a look opens its volume.
    untrusted_path: UntrustedPathDialog,
    /// Question whether a dropped volume is shown over the open one.
    second_volume: SecondVolumeQuestion,
    /// True once a volume has replaced the one before, until [`Self::take_opened`].
    has_opened: bool,
}

impl OpeningState {
    /// Creates the state of a window without a volume.
    pub(crate) fn new(loader: Loader) -> Self {
        Self {
            requests: OpenRequests::default(),
            adjust_first_look: None,
            loader,
            next_file_search: JobSlot::default(),
            file_tasks: FileTasks::default(),
            raw: RawDialog::default(),
            large_volume: LargeVolumeDialog::default(),
            untrusted_path: UntrustedPathDialog::default(),
            second_volume: SecondVolumeQuestion::default(),
            has_opened: false,
        }
    }

    /// Returns true while a volume is being opened, or another file is being read.
    pub(crate) fn is_opening(&self) -> bool {
        self.loader.progress().is_some() || self.file_tasks.path().is_some()
    }

    /// Returns true, once, if a volume has replaced the one before.
    pub(crate) fn take_opened(&mut self) -> bool {
        std::mem::take(&mut self.has_opened)
    }
}

/// Opening of volumes and looks into an editor, at the request of the user.
pub(crate) struct VolumeOpener<'a> {
    /// Requests, and files that are being read.
    pub state: &'a mut OpeningState,
    /// Editor that gets the volumes and looks.
    pub editor: &'a mut LookEditor,
    /// Window that is woken when a file has been read.
    pub ctx: &'a egui::Context,
}

impl VolumeOpener<'_> {
    /// Starts to read a volume on a thread and returns true if that was possible. Requests for the previous file end.
    pub(crate) fn start_loading(&mut self, source: &Path, reading: ReadChoices) -> bool {
        // Requests and dialogs for the previous file are obsolete, and so is a file to open.
        self.state.file_tasks.drop_purpose(ReadPurpose::Open);
        self.state.file_tasks.drop_purpose(ReadPurpose::Session);
        self.state.raw.close();
        self.state.large_volume.close();
        self.state.second_volume.close();
        self.state.requests.layers_over.clear();
        let known = RememberedFileSettings {
            up: self.editor.memory.up_of(source),
            corrections: self.editor.memory.corrections_of(source),
        };
        let started = self.state.loader.open_on_thread(source, reading, known, self.ctx);
        if let Err(err) = &started {
            self.editor.messages.error(text::opening::NOT_OPENED, err.clone());
        }
        started.is_ok()
    }

    /// Returns the file of the open volume, whose dataset is given, by which other resolution levels of it are read.
    fn volume_file(&self, dataset: &Dataset) -> Option<VolumeFile> {
        let volume = self.editor.document.volume.as_ref()?;
        let options = self.state.loader.options();
        let options = LoadOptions {
            raw: volume.reading.raw.unwrap_or(options.raw),
            only_files: volume.reading.subset.clone(),
            ..options.clone()
        };
        Some(VolumeFile { path: volume.source.clone(), options, opened_id: dataset.volume().opened_id() })
    }

    /// Takes the volume that has been read, or the reason why it was not.
    pub(crate) fn take_outcome(&mut self) {
        match self.state.loader.take_outcome() {
            None => {}
            Some(LoadOutcome::Opened(opened)) => self.show_or_ask(opened),
            Some(LoadOutcome::Uploaded { renderer, dataset }) => {
                let file = self.volume_file(&dataset);
                self.editor.viewport.set_scene(*renderer, dataset, file);
            }
            Some(LoadOutcome::Cancelled) => {
                self.state.requests.pending_look = None;
                self.editor.messages.note(text::messages::OPENING_CANCELLED);
            }
            Some(LoadOutcome::UnknownRawFormat { path, why, guess }) => {
                self.state.raw.open(&path, why, guess, self.ctx);
            }
            // A look that is pending for this volume stays pending.
            Some(LoadOutcome::NeedsMemoryDecision { source, reading, weighed }) => {
                self.state.large_volume.open(source, *reading, weighed);
            }
            Some(LoadOutcome::Failed { short, details }) => {
                self.state.requests.pending_look = None;
                self.editor.messages.error(short, details);
            }
        }
    }

    /// Shows the questions about a volume that is to be read, and reads it as the user answers.
    pub(crate) fn show_questions(&mut self) {
        if let Some(raw_description) = self.state.raw.ui(self.ctx) {
            self.open_raw(&raw_description);
        }
        self.show_second_volume_question();
        match self.state.large_volume.ui(self.ctx) {
            None => {}
            Some(LargeVolumeAnswer::Cancel) => self.state.requests.pending_look = None,
            Some(LargeVolumeAnswer::Read { source, reading }) => {
                self.start_loading(&source, *reading);
            }
        }
    }

    /// Shows a volume again that an earlier window had open.
    pub(crate) fn restore(&mut self, dataset: Option<Dataset>) {
        if let Some(dataset) = dataset
            && let Err(err) = self.state.loader.upload(dataset, self.ctx)
        {
            self.editor.messages.error(text::messages::NOT_RENDERED, err);
        }
    }
}
