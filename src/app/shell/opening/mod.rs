//! Opening of volumes and looks: precedence between requests, and the settings with which a volume is shown.

mod alternatives;
mod dropped_and_neighbours;
mod look_files;
mod opened;
mod plan;
mod similarity;
mod state;

use std::path::Path;

use eframe::egui;

use crate::app::shell::file_tasks::ReadPurpose;
use crate::app::windows::file_dialogs;
use crate::app::windows::raw_dialog::RawDialogResult;
use crate::app::worker::loader::{ReadChoices, RememberedFileSettings};
use crate::app::{App, text};
use chiaroscuro_files::provenance_mark;
use chiaroscuro_scene::{OpacityLength, VolumeLocation};
use chiaroscuro_volume::{Downsampling, Portion, VolumeChoice};

use self::plan::PendingLook;
pub use self::state::SettingsAdjustment;
pub(crate) use self::state::{OpenRequests, OpeningState};

/// Volume that is opened when none is named.
const DEFAULT_SOURCE: &str = "builtin:chair";

impl App {
    /// Opens a file or a built-in volume, or the volume of a session or exported picture with the look stored there.
    /// The open volume stays until the new one is ready.
    pub fn open(&mut self, source: impl AsRef<Path>, ctx: &egui::Context) {
        let source = source.as_ref();
        // The message was about another file.
        self.editor.messages.dismiss();
        if file_dialogs::may_be_look_file(source) {
            self.open_volume_or_look(source, ctx);
        } else {
            self.open_volume(source, ctx);
        }
    }

    /// Opens a volume with its own first look.
    pub(super) fn open_volume(&mut self, source: &Path, ctx: &egui::Context) {
        if self.start_loading(source, ReadChoices::default(), ctx) {
            self.opening.requests.pending_look = None;
        }
    }

    /// Opens one of several volumes of a file; a choice on the command line has precedence over a remembered one.
    pub(crate) fn open_chosen(&mut self, source: &Path, choice: &VolumeChoice, ctx: &egui::Context) {
        if self.start_loading(source, self.reading_options(choice), ctx) {
            self.opening.requests.pending_look = None;
        }
    }

    /// Opens a file that was open before, with the volume chosen then.
    pub(crate) fn open_again(&mut self, source: &Path, choice: &VolumeChoice, ctx: &egui::Context) {
        if choice.is_empty() {
            self.open(source, ctx);
        } else {
            self.open_chosen(source, choice, ctx);
        }
    }

    /// Returns the options for reading a volume that was chosen before.
    fn reading_options(&self, choice: &VolumeChoice) -> ReadChoices {
        let said = self.loader.options().choice.clone();
        ReadChoices { choice: Some(said.with_fallback(choice)), ..ReadChoices::default() }
    }

    /// Opens the file, look or session named at the start. If a look cannot be used, the default volume is opened.
    pub(crate) fn open_first(&mut self, source: Option<&Path>, volume: Option<&Path>, ctx: &egui::Context) {
        match (source, volume) {
            (Some(look), Some(volume)) => self.open_look_with(look, volume, ctx),
            (Some(source), None) | (None, Some(source)) => self.open(source, ctx),
            (None, None) => self.open_volume_of_session(ctx),
        }
        self.open_default_if_empty(ReadPurpose::Open, ctx);
    }

    /// Opens the default volume if reading a file to open has led to nothing and no volume is open.
    pub(crate) fn open_default_if_empty(&mut self, reason: ReadPurpose, ctx: &egui::Context) {
        let is_empty = self.editor.document.volume.is_none() && self.editor.viewport.dataset().is_none();
        let is_busy =
            self.loader.progress().is_some() || self.opening.file_tasks.is_reading(ReadPurpose::Open);
        if reason == ReadPurpose::Open && is_empty && !is_busy {
            self.start_loading(Path::new(DEFAULT_SOURCE), ReadChoices::default(), ctx);
        }
    }

    /// Opens the first volume, which has waited for the user's answer about the last session, unless a volume is open
    /// or being opened.
    pub(crate) fn open_deferred(&mut self, ctx: &egui::Context) {
        let is_free = self.editor.document.volume.is_none()
            && self.loader.progress().is_none()
            && !self.dialogs.untrusted_path.is_open();
        if std::mem::take(&mut self.opening.default_open_waits) && is_free {
            self.open_first(None, None, ctx);
        }
    }

    /// Opens the volume that the session names. The look of the session is applied to the first volume in any case.
    fn open_volume_of_session(&mut self, ctx: &egui::Context) {
        let session = self.editor.document.session.as_ref().map(|session| session.path().to_owned());
        let Some(session) = session.filter(|path| path.exists()) else { return };
        let path = session.clone();
        self.read_file(ReadPurpose::Open, &path, ctx, file_dialogs::load_record, move |app, read, ctx| {
            // An unreadable session is reported when it is applied.
            let Ok(record) = read else { return };
            let Some(volume) = record.volume.clone() else { return };
            match app.locate_volume(&volume, &session) {
                VolumeLocation::Builtin(name) => app.open_chosen(Path::new(&name), &volume.choice, ctx),
                VolumeLocation::InRecordFolder(path) => app.open_chosen(&path, &volume.choice, ctx),
                VolumeLocation::OtherFolder(path) => app.dialogs.untrusted_path.open(path, record),
                VolumeLocation::Refused(why) => {
                    app.dialogs.untrusted_path.open_refused(&volume.source, why, record);
                }
            }
        });
    }

    /// Opens a raw volume with the layout that the user has entered.
    pub(crate) fn open_raw(&mut self, described: &RawDialogResult, ctx: &egui::Context) {
        // A look that is pending for this volume stays pending.
        let RawDialogResult { path, layout, header, is_gzip } = described;
        if let Some(header) = header {
            let data_file = path.file_name().unwrap_or_default().to_string_lossy();
            // Comments of a NRRD header follow its first line.
            let content = layout.nrrd_header(&data_file, *is_gzip);
            let content = content.replacen('\n', &format!("\n# {}\n", provenance_mark()), 1);
            match chiaroscuro_files::write_atomically(header, content.as_bytes()) {
                Ok(()) => {
                    self.start_loading(header, ReadChoices::default(), ctx);
                    return;
                }
                // The volume is shown nevertheless.
                Err(err) => self.editor.messages.error(text::opening::HEADER_NOT_WRITTEN, err.to_string()),
            }
        }
        let reading = ReadChoices { raw: Some(layout.to_format()), ..ReadChoices::default() };
        self.start_loading(path, reading, ctx);
    }

    /// Reads the open volume again with another subsampling; the look stays.
    pub(crate) fn reload_subsampled(&mut self, thinning: Downsampling, ctx: &egui::Context) {
        let Some(volume) = &self.editor.document.volume else { return };
        let mut settings = self.editor.document.settings.clone();
        // The opacity unit keeps its thickness, whatever the number of voxels.
        if let OpacityLength::Voxels(_) = settings.opacity_unit {
            let unit = settings.opacity_unit.scene_units(&volume.scene) * volume.scene.mm_per_unit;
            settings.opacity_unit = OpacityLength::Mm(unit);
        }
        // The memory estimate is checked again.
        let portion = Some(Portion { thinning, ..volume.held.portion }).filter(|portion| !portion.is_whole());
        let choice = Some(VolumeChoice { portion, ..volume.held.choice() });
        let reading = ReadChoices { choice, takes_all_memory: false, ..volume.reading.clone() };
        let source = volume.source.clone();
        if self.start_loading(&source, reading, ctx) {
            self.opening.requests.pending_look = Some(PendingLook::Settings(Box::new(settings)));
        }
    }

    pub(crate) fn start_loading(&mut self, source: &Path, reading: ReadChoices, ctx: &egui::Context) -> bool {
        // Requests and dialogs for the previous file are obsolete, and so is a file to open.
        self.opening.file_tasks.drop_purpose(ReadPurpose::Open);
        self.opening.file_tasks.drop_purpose(ReadPurpose::Session);
        self.dialogs.raw.close();
        self.dialogs.large_volume.close();
        let known = RememberedFileSettings {
            up: self.editor.memory.up_of(source),
            corrections: self.editor.memory.corrections_of(source),
        };
        let started = self.loader.open_on_thread(source, reading, known, ctx);
        if let Err(err) = &started {
            self.editor.messages.error(text::opening::NOT_OPENED, err.clone());
        }
        started.is_ok()
    }
}
