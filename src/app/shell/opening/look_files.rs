//! Opening of looks from files: applied to the open volume, or to the volume that they name, which is opened first.

use std::path::Path;

use eframe::egui;

use super::DEFAULT_SOURCE;
use super::plan::PendingLook;
use crate::app::document::looks::AppliedLook;
use crate::app::shell::file_tasks::ReadPurpose;
use crate::app::windows::file_dialogs::{self, FileDialogPurpose};
use crate::app::windows::untrusted_path::UntrustedPathAnswer;
use crate::app::{App, text};
use chiaroscuro_scene::{LookRecord, VolumeLocation, VolumeRecord};

impl App {
    /// Opens the look of a session, a preset or a picture. A volume that it names is opened first, unless it is open;
    /// a preset fits any volume.
    pub(crate) fn open_record(&mut self, path: &Path, ctx: &egui::Context) {
        let of = path.to_owned();
        self.read_file(ReadPurpose::Open, path, ctx, file_dialogs::load_record, move |app, read, ctx| {
            match read {
                Ok(record) => app.open_look(record, &of, ctx),
                Err(why) => app.report_read_failure(text::opening::SETTINGS_NOT_LOADED, why),
            }
        });
    }

    /// Opens a file that is either a volume or a look.
    pub(super) fn open_volume_or_look(&mut self, path: &Path, ctx: &egui::Context) {
        let of = path.to_owned();
        let read = |path: &Path| {
            if file_dialogs::is_volume_path(path) {
                Ok(None)
            } else {
                file_dialogs::load_record(path).map(Some)
            }
        };
        self.read_file(ReadPurpose::Open, path, ctx, read, move |app, read, ctx| match read {
            Ok(Some(record)) => app.open_look(record, &of, ctx),
            Ok(None) => app.open_volume(&of, ctx),
            Err(why) => app.report_read_failure(text::opening::SETTINGS_NOT_LOADED, why),
        });
    }

    /// Opens a volume with the look of a file.
    pub(super) fn open_look_with(&mut self, look: &Path, volume: &Path, ctx: &egui::Context) {
        let volume = volume.to_owned();
        self.read_file(ReadPurpose::Open, look, ctx, file_dialogs::load_record, move |app, read, ctx| {
            match read {
                Ok(record) => app.open_with(&volume, record, ctx),
                Err(why) => app.report_read_failure(text::opening::SETTINGS_NOT_LOADED, why),
            }
        });
    }

    /// Applies a look that was read from a file.
    fn open_look(&mut self, record: LookRecord, path: &Path, ctx: &egui::Context) {
        let open = self.editor.volume_record().map(|(_, content_id)| content_id);
        match record.volume.clone() {
            Some(volume) if open.is_none_or(|open| !volume.matches_content(open)) => {
                match self.locate_volume(&volume, path) {
                    VolumeLocation::Builtin(name) => self.open_with(Path::new(&name), record, ctx),
                    VolumeLocation::InRecordFolder(path) => self.open_with(&path, record, ctx),
                    VolumeLocation::OtherFolder(path) => self.dialogs.untrusted_path.open(path, record),
                    VolumeLocation::Refused(why) => {
                        self.dialogs.untrusted_path.open_refused(&volume.source, why, record);
                    }
                }
            }
            Some(_) => drop(self.editor.apply_record_to_open(&record)),
            None => self.apply_look(record, ctx),
        }
    }

    /// Returns the location of a record's volume; `InRecordFolder` includes files that may be opened without a
    /// confirmation.
    pub(super) fn locate_volume(&self, volume: &VolumeRecord, record: &Path) -> VolumeLocation {
        match volume.location(record.parent()) {
            VolumeLocation::OtherFolder(path) if self.is_trusted(record, &path) => {
                VolumeLocation::InRecordFolder(path)
            }
            place => place,
        }
    }

    /// Returns true if a record may open a file outside its own folder: records of this program may, and others may
    /// open what the user has opened before.
    fn is_trusted(&self, record: &Path, volume: &Path) -> bool {
        let is_known = || self.editor.memory.recent().iter().any(|known| known.path == volume);
        self.opening.requests.trusts_paths || self.editor.memory.is_autosaved_look(record) || is_known()
    }

    /// Applies a look to the volume that is open or being opened.
    fn apply_look(&mut self, record: LookRecord, ctx: &egui::Context) {
        if self.loader.progress().is_some() {
            // The user will see it on the volume that is being opened.
            self.opening.requests.pending_look = Some(PendingLook::Record(Box::new(record)));
        } else if self.editor.volume_record().is_none() {
            self.open_with(Path::new(DEFAULT_SOURCE), record, ctx);
        } else {
            self.editor.apply_record_to_open(&record);
        }
    }

    /// Opens a volume with a look.
    pub(super) fn open_with(&mut self, source: &Path, record: LookRecord, ctx: &egui::Context) {
        let choice = record.volume.as_ref().map(|volume| volume.choice.clone()).unwrap_or_default();
        if self.start_loading(source, self.reading_options(&choice), ctx) {
            self.opening.requests.pending_look = Some(PendingLook::Record(Box::new(record)));
        }
    }

    /// Asks for confirmation before a look opens its volume, and handles the answer.
    pub(crate) fn ask_for_volume(&mut self, frame: &eframe::Frame, ctx: &egui::Context) {
        let Some(answer) = self.dialogs.untrusted_path.ui(ctx) else { return };
        if answer == UntrustedPathAnswer::ChooseOther {
            // The dialog stays open, since choosing may be cancelled.
            return self.dialogs.files.open_dialog(FileDialogPurpose::VolumeOfLook, frame, ctx);
        }
        match self.dialogs.untrusted_path.close() {
            Some((record, Some(path))) if answer == UntrustedPathAnswer::Open => {
                self.open_with(&path, record, ctx);
            }
            Some((record, _)) => self.apply_look(record, ctx),
            None => {}
        }
    }

    /// Opens the file that the user has chosen for the look in question.
    pub(crate) fn open_for_look(&mut self, path: &Path, ctx: &egui::Context) {
        match self.dialogs.untrusted_path.close() {
            Some((record, _)) => self.open_with(path, record, ctx),
            None => self.open(path, ctx),
        }
    }

    /// Applies the look of a file to the open volume, even if it was made for another one.
    pub(crate) fn load_settings(&mut self, path: &Path, ctx: &egui::Context) {
        self.read_file(
            ReadPurpose::Look,
            path,
            ctx,
            file_dialogs::load_record,
            |app, read, _ctx| match read {
                Ok(record) => {
                    let open = app.editor.volume_record().map(|(_, content_id)| content_id);
                    if record.volume.as_ref().zip(open).is_some_and(|(of, open)| !of.matches_content(open)) {
                        app.editor.messages.note(text::opening::OTHER_VOLUME);
                    }
                    app.editor.apply_record_to_open(&record);
                }
                Err(why) => app.report_read_failure(text::opening::SETTINGS_NOT_LOADED, why),
            },
        );
    }

    /// Compares the look of the window with that of a file.
    pub(crate) fn compare_with_file(&mut self, path: &Path, ctx: &egui::Context) {
        self.read_file(ReadPurpose::Comparison, path, ctx, file_dialogs::load_record, |app, read, _ctx| {
            match read {
                Ok(record) => {
                    match app
                        .editor
                        .document
                        .settings_with_record(&record, &app.editor.document.value_ranges())
                    {
                        Ok(AppliedLook { settings, note }) => {
                            if let Some(note) = note {
                                app.editor.messages.note(note);
                            }
                            app.editor.viewport.compare.start_with(settings);
                        }
                        Err(err) => app.editor.messages.error(text::opening::SETTINGS_NOT_LOADED, err),
                    }
                }
                Err(why) => app.report_read_failure(text::opening::SETTINGS_NOT_LOADED, why),
            }
        });
    }
}
