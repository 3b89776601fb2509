//! Editing of the look: the document with its picture, the messages about it, and the tasks that change it.
//!
//! The document knows no GPU and no messages; the methods here give it the volume that is shown, take over what its
//! threads have made, and report what failed.

mod automatic_changes;
mod commands;
mod document_tasks;
mod steps;

use std::path::{Path, PathBuf};

use self::automatic_changes::LookTasks;
use crate::app::document::Document;
use crate::app::document::light_placement::SEARCH_LIMIT_S;
use crate::app::document::session::SessionFile;
use crate::app::persistence::PersistentState;
use crate::app::shell::messages::MessageLog;
use crate::app::text;
use crate::app::viewport::Viewport;
use crate::app::windows::export::{ExportScene, ReadableSeries};
use crate::app::windows::file_dialogs;
use crate::app::worker::request::ComparedLooks;
use chiaroscuro_scene::{LookRecord, Settings};
use chiaroscuro_volume::ValueRanges;

/// Look that is edited, with the picture of it, the messages to the user, and what is remembered of it.
pub(crate) struct LookEditor {
    /// Look that is edited, and the volume that it shows.
    pub document: Document,
    /// Picture on screen, and the connection to the render thread.
    pub viewport: Viewport,
    /// Messages that are shown to the user.
    pub messages: MessageLog,
    /// Tasks whose results change the look.
    pub look_tasks: LookTasks,
    /// Time series of which the open volume is one step, if it is.
    pub series: Option<ReadableSeries>,
    /// True while the series plays: pictures stay previews, and nothing about the look changes automatically.
    pub plays_steps: bool,
    /// Longest time from the first picture to the movement of its lights, in seconds.
    pub light_search_limit_s: f64,
    /// State that outlives a run.
    pub memory: PersistentState,
}

impl LookEditor {
    /// Creates the editor of an empty document.
    pub(crate) fn new(viewport: Viewport, memory: PersistentState) -> Self {
        Self {
            document: Document::default(),
            viewport,
            messages: MessageLog::default(),
            look_tasks: LookTasks::default(),
            series: None,
            plays_steps: false,
            light_search_limit_s: SEARCH_LIMIT_S,
            memory,
        }
    }

    /// Returns the looks that the picture shows: the current one, or the two of a comparison.
    pub(crate) fn shown_looks(&self) -> ComparedLooks {
        self.viewport.compare.looks(&self.document.shown_settings())
    }

    /// Returns true if the full-quality picture of the current settings is on screen, and the volume is corrected as
    /// they say.
    pub(crate) fn is_complete(&self) -> bool {
        !self.is_correcting() && self.viewport.is_idle(&self.shown_looks())
    }

    /// Returns true while the volume shown lacks the corrections of the settings.
    pub(crate) fn is_correcting(&self) -> bool {
        self.document.is_correcting(self.viewport.dataset().as_ref())
    }

    /// Returns true if the look is going to change without the user: its first look is unfinished, its balance is to
    /// be measured, or the outline of the object is being searched.
    pub(crate) fn is_changing(&self) -> bool {
        self.document.is_making_look()
            || self.document.first_lights.is_due()
            || !self.document.knows_outline(self.viewport.dataset().as_ref())
            || self.document.keep_balanced.is_due(&self.document.settings)
    }

    /// Returns the task beside the pictures that the user waits for, in words; the first that is running.
    pub(crate) fn background_task_name(&self) -> Option<&'static str> {
        [
            (self.is_correcting(), text::status::CORRECTING),
            (self.document.is_making_look(), text::status::PREPARING_LOOK),
            (self.look_tasks.light_search.is_running(), text::status::PLACING_LIGHTS),
            (self.look_tasks.balance.is_running(), text::status::BALANCING),
        ]
        .into_iter()
        .find_map(|(is_made, words)| is_made.then_some(words))
    }

    /// Identifier of the open file's volume.
    pub(crate) fn opened_id(&self) -> Option<u64> {
        self.viewport.dataset().map(|dataset| dataset.volume().opened_id())
    }

    /// Returns path and identifier of the open volume, for records.
    pub(crate) fn volume_record(&self) -> Option<(&Path, u64)> {
        Some((&self.document.volume.as_ref()?.source, self.opened_id()?))
    }

    /// Applies a record to the settings and returns true if it succeeded. Its corrections are applied only to the
    /// volume for which they were made.
    pub(crate) fn apply_record(
        &mut self,
        record: &LookRecord,
        ranges: &ValueRanges,
        opened_id: Option<u64>,
    ) -> bool {
        let note = self.document.apply_record(record, ranges, opened_id);
        let is_applied = note.is_ok();
        if let Some(note) = self.messages.report(text::opening::SETTINGS_NOT_LOADED, note) {
            self.messages.note(note);
        }
        is_applied
    }

    /// Applies a record to the open volume, as [`Self::apply_record`] does.
    pub(crate) fn apply_record_to_open(&mut self, record: &LookRecord) -> bool {
        self.apply_record(record, &self.document.value_ranges(), self.opened_id())
    }

    /// Returns the path to which Ctrl+S writes; if the file is protected, shows the reason and returns `None`.
    pub(crate) fn session_to_save(&mut self) -> Option<PathBuf> {
        let session = self.document.session.as_ref()?;
        let Some((path, why)) = session.protection() else { return Some(session.path().to_owned()) };
        self.messages.note(text::persistence::session_protected(path, why));
        None
    }

    /// Saves the look to a file, which becomes the session.
    pub(crate) fn save_settings(&mut self, path: &Path) {
        match self.document.save_session(path, self.opened_id()) {
            Ok(()) => self.messages.note(text::opening::session_saved(path)),
            Err(err) => self.messages.error(text::opening::SETTINGS_NOT_SAVED, err),
        }
    }

    /// Saves the look to the session's file if the command line asked for that at the end of the run.
    pub(crate) fn save_on_close(&mut self) {
        let path = self.document.session.as_ref().and_then(SessionFile::path_on_close).map(Path::to_owned);
        let Some(path) = path.filter(|_| self.document.volume.is_some()) else { return };
        if let Err(err) = self.document.save_session(&path, self.opened_id()) {
            log::error!("{}: {err}", text::opening::SETTINGS_NOT_SAVED);
        }
    }

    /// Writes the transfer function to a file for other programs.
    pub(crate) fn export_transfer(&mut self, path: &Path) {
        let (settings, ranges) = (self.document.with_selected_first(), self.document.selected_ranges());
        match file_dialogs::export_transfer_file(path, &settings, &ranges) {
            Ok(()) => self.messages.note(text::messages::written(path)),
            Err(err) => self.messages.error(text::messages::TRANSFER_NOT_WRITTEN, err),
        }
    }

    /// Autosaves the current look, so that nothing is lost however the run ends, and reports failures.
    pub(crate) fn autosave_look(&mut self) {
        let opened_id = self.opened_id().filter(|_| self.document.volume.is_some());
        if let Some(opened_id) = opened_id {
            self.memory.autosave(&self.document.settings, self.document.shown_volumes(opened_id));
            if let Some(picture) = self.viewport.take_finished() {
                self.memory.autosave_thumbnail(picture);
            }
            // Not before there is a volume, which clears the messages.
            self.report_notices();
        }
    }

    /// Reports the notices about the state that outlives a run, each once.
    pub(crate) fn report_notices(&mut self) {
        let notices = self.memory.take_notices();
        if !notices.is_empty() {
            self.messages.error(text::persistence::STARTUP_NOTICES, notices.join("\n\n"));
        }
    }

    /// Returns the subject of an export; shows a message if there is no picture.
    pub(crate) fn export_subject(&mut self) -> Option<ExportScene> {
        let Some(dataset) = self.viewport.dataset() else {
            self.messages.note(text::messages::NO_PICTURE);
            return None;
        };
        // Ignores a correction in progress: the picture shows the volume that is loaded.
        let settings = Settings { volume: *dataset.volume().corrections(), ..self.document.settings.clone() };
        Some(ExportScene {
            context: self.viewport.context().clone(),
            dataset,
            settings,
            first_look: self.document.defaults.clone(),
            source: self.document.volume.as_ref().map_or_else(PathBuf::new, |volume| volume.source.clone()),
            selected_light: self.document.selected_light,
            outline: self.document.outline(self.viewport.dataset().as_ref()),
            series: self.series.clone(),
            file: self.viewport.file().cloned(),
        })
    }
}
