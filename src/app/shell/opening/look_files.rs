//! Opening of looks from files: applied to the open volume, or to the volume that they name, which is opened first.

use std::path::Path;

use super::file_tasks::ReadPurpose;
use super::plan::PendingLook;
use super::{DEFAULT_SOURCE, VolumeOpener};
use crate::app::document::looks::AppliedLook;
use crate::app::shell::look_editor::LookEditor;
use crate::app::text;
use crate::app::windows::file_dialogs::{self, FileDialogPurpose, FileDialogs};
use crate::app::windows::untrusted_path::UntrustedPathAnswer;
use chiaroscuro_scene::{LookRecord, VolumeLocation, VolumeRecord};

impl VolumeOpener<'_> {
    /// Opens the look of a session, a preset or a picture. A volume that it names is opened first, unless it is open;
    /// a preset fits any volume.
    pub(crate) fn open_record(&mut self, path: &Path) {
        let of = path.to_owned();
        self.read_record(ReadPurpose::Open, path, move |opener, record| opener.open_look(record, &of));
    }

    /// Opens a file that is either a volume or a look.
    pub(super) fn open_volume_or_look(&mut self, path: &Path) {
        let of = path.to_owned();
        let read = |path: &Path| {
            if file_dialogs::is_volume_path(path) {
                Ok(None)
            } else {
                file_dialogs::load_record(path).map(Some)
            }
        };
        self.read_file(ReadPurpose::Open, path, read, move |opener, read| match read {
            Ok(Some(record)) => opener.open_look(record, &of),
            Ok(None) => opener.open_volume(&of),
            Err(why) => why.report(text::opening::SETTINGS_NOT_LOADED, &mut opener.editor.messages),
        });
    }

    /// Opens a volume with the look of a file.
    pub(super) fn open_look_with(&mut self, look: &Path, volume: &Path) {
        let volume = volume.to_owned();
        self.read_record(ReadPurpose::Open, look, move |opener, record| opener.open_with(&volume, record));
    }

    /// Applies a look that was read from a file.
    fn open_look(&mut self, record: LookRecord, path: &Path) {
        let open = self.editor.volume_record().map(|(_, content_id)| content_id);
        match record.volume.clone() {
            Some(volume) if open.is_none_or(|open| !volume.matches_content(open)) => {
                match self.locate_volume(&volume, path) {
                    VolumeLocation::Builtin(name) => self.open_with(Path::new(&name), record),
                    VolumeLocation::InRecordFolder(path) => self.open_with(&path, record),
                    VolumeLocation::OtherFolder(path) => self.state.untrusted_path.open(path, record),
                    VolumeLocation::Refused(why) => {
                        self.state.untrusted_path.open_refused(&volume.source, why, record);
                    }
                }
            }
            Some(_) => self.apply_record_to_open(&record),
            None => self.apply_look(record),
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
        self.state.requests.trusts_paths || self.editor.memory.is_autosaved_look(record) || is_known()
    }

    /// Applies a look to the volume that is open or being opened.
    fn apply_look(&mut self, record: LookRecord) {
        if self.state.loader.progress().is_some() {
            // The user will see it on the volume that is being opened.
            self.state.requests.pending_look = Some(PendingLook::Record(Box::new(record)));
        } else if self.editor.volume_record().is_none() {
            self.open_with(Path::new(DEFAULT_SOURCE), record);
        } else {
            self.apply_record_to_open(&record);
        }
    }

    /// Applies a look to the open volume, and opens the further volumes that it names.
    fn apply_record_to_open(&mut self, record: &LookRecord) {
        if self.editor.apply_record_to_open(record) {
            self.add_recorded_layers(record);
        }
    }

    /// Opens a volume with a look.
    pub(super) fn open_with(&mut self, source: &Path, record: LookRecord) {
        let choice = record.volume.as_ref().map(|volume| volume.choice.clone()).unwrap_or_default();
        if self.start_loading(source, self.reading_options(&choice)) {
            self.state.requests.pending_look = Some(PendingLook::Record(Box::new(record)));
        }
    }

    /// Asks for confirmation before a look opens its volume, and handles the answer; `files` asks for another file.
    pub(crate) fn ask_for_volume(&mut self, files: &mut FileDialogs, frame: &eframe::Frame) {
        let Some(answer) = self.state.untrusted_path.ui(self.ctx) else { return };
        if answer == UntrustedPathAnswer::ChooseOther {
            // The dialog stays open, since choosing may be cancelled.
            return files.open_dialog(FileDialogPurpose::VolumeOfLook, frame, self.ctx);
        }
        match self.state.untrusted_path.close() {
            Some((record, Some(path))) if answer == UntrustedPathAnswer::Open => {
                self.open_with(&path, record);
            }
            Some((record, _)) => self.apply_look(record),
            None => {}
        }
    }

    /// Opens the file that the user has chosen for the look in question.
    pub(crate) fn open_for_look(&mut self, path: &Path) {
        match self.state.untrusted_path.close() {
            Some((record, _)) => self.open_with(path, record),
            None => self.open(path),
        }
    }

    /// Applies the look of a file to the open volume, even if it was made for another one.
    pub(crate) fn load_settings(&mut self, path: &Path) {
        self.read_record(ReadPurpose::Look, path, |opener, record| {
            let open = opener.editor.volume_record().map(|(_, content_id)| content_id);
            if record.volume.as_ref().zip(open).is_some_and(|(of, open)| !of.matches_content(open)) {
                opener.editor.messages.note(text::opening::OTHER_VOLUME);
            }
            opener.editor.apply_record_to_open(&record);
        });
    }

    /// Compares the look of the window with that of a file.
    pub(crate) fn compare_with_file(&mut self, path: &Path) {
        self.read_record(ReadPurpose::Comparison, path, |opener, record| {
            let LookEditor { document, viewport, messages, .. } = &mut *opener.editor;
            match document.settings_with_record(&record, &document.value_ranges()) {
                Ok(AppliedLook { settings, note }) => {
                    if let Some(note) = note {
                        messages.note(note);
                    }
                    viewport.compare.start_with(settings);
                }
                Err(err) => messages.error(text::opening::SETTINGS_NOT_LOADED, err),
            }
        });
    }

    /// Reopens the volume with the look of the previous run.
    pub(crate) fn reopen_last(&mut self) {
        match self.editor.memory.previous_look() {
            Some(path) => self.open_record(&path),
            None => self.editor.messages.note(text::messages::NO_SESSION_TO_REOPEN),
        }
    }

    /// Reads the look of a file on a thread; `then` gets it, and a failure is reported.
    fn read_record(
        &mut self,
        purpose: ReadPurpose,
        path: &Path,
        then: impl FnOnce(&mut VolumeOpener<'_>, LookRecord) + 'static,
    ) {
        self.read_file(purpose, path, file_dialogs::load_record, move |opener, read| match read {
            Ok(record) => then(opener, record),
            Err(why) => why.report(text::opening::SETTINGS_NOT_LOADED, &mut opener.editor.messages),
        });
    }
}
