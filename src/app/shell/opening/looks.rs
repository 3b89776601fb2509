//! Looks that come from files: laid over what is open, or over the volume that they name, which is opened first.

use std::path::{Path, PathBuf};

use eframe::egui;

use super::{DEFAULT_SOURCE, PendingLook};
use crate::app::shell::file_tasks::Reason;
use crate::app::shell::session::Session;
use crate::app::windows::files::{self, Purpose};
use crate::app::windows::foreign_path::Answer;
use crate::app::{App, text};
use crate::data::ValueRanges;
use crate::model::{Record, Settings, VolumePlace, VolumeRecord};

impl App {
    /// Takes over the look of a session, a preset or a picture. If it is of another volume than the open one,
    /// that is opened first; a preset is of any volume.
    pub(crate) fn open_record(&mut self, path: &Path, ctx: &egui::Context) {
        let of = path.to_owned();
        self.read_file(Reason::Open, path, ctx, files::load_record, move |app, read, ctx| match read {
            Ok(record) => app.open_look(record, &of, ctx),
            Err(why) => app.say_not_read(text::opening::SETTINGS_NOT_LOADED, why),
        });
    }

    /// Opens a file that is a volume or carries a look, whichever it is.
    pub(super) fn open_either(&mut self, path: &Path, ctx: &egui::Context) {
        let of = path.to_owned();
        let read = |path: &Path| {
            if files::is_volume(path) { Ok(None) } else { files::load_record(path).map(Some) }
        };
        self.read_file(Reason::Open, path, ctx, read, move |app, read, ctx| match read {
            Ok(Some(record)) => app.open_look(record, &of, ctx),
            Ok(None) => app.open_volume(&of, ctx),
            Err(why) => app.say_not_read(text::opening::SETTINGS_NOT_LOADED, why),
        });
    }

    /// Opens a volume with the look of a file.
    pub(super) fn open_look_with(&mut self, look: &Path, volume: &Path, ctx: &egui::Context) {
        let volume = volume.to_owned();
        self.read_file(Reason::Open, look, ctx, files::load_record, move |app, read, ctx| match read {
            Ok(record) => app.open_with(&volume, record, ctx),
            Err(why) => app.say_not_read(text::opening::SETTINGS_NOT_LOADED, why),
        });
    }

    /// Takes over a look that was read from a file.
    fn open_look(&mut self, record: Record, path: &Path, ctx: &egui::Context) {
        let open = self.volume_record().map(|(_, content_id)| content_id);
        match record.volume.clone() {
            Some(volume) if open.is_none_or(|open| !volume.is_of(open)) => match self.place_of(&volume, path)
            {
                VolumePlace::Builtin(name) => self.open_with(Path::new(&name), record, ctx),
                VolumePlace::Beside(path) => self.open_with(&path, record, ctx),
                VolumePlace::Elsewhere(path) => self.foreign_path.ask(path, record),
                VolumePlace::Never(why) => self.foreign_path.refuse(&volume.source, why, record),
            },
            Some(_) => drop(self.apply_record(&record, &self.value_ranges(), self.opened_id())),
            None => self.use_look(record, ctx),
        }
    }

    /// Where the volume of a record is; beside it is also what may be opened without a question.
    pub(super) fn place_of(&self, volume: &VolumeRecord, record: &Path) -> VolumePlace {
        match volume.place(record.parent()) {
            VolumePlace::Elsewhere(path) if self.is_trusted(record, &path) => VolumePlace::Beside(path),
            place => place,
        }
    }

    /// Whether a record may open a file that is not beside it: the program's own may, and others what the user has
    /// opened before.
    fn is_trusted(&self, record: &Path, volume: &Path) -> bool {
        let is_known = || self.memory.recent().iter().any(|known| known.path == volume);
        self.trusts_paths || self.memory.is_own(record) || is_known()
    }

    /// Takes over a look for whichever volume is open, or is being opened.
    fn use_look(&mut self, record: Record, ctx: &egui::Context) {
        if self.loader.progress().is_some() {
            // What is being opened is what the user will see it on.
            self.pending = Some(PendingLook::Record(Box::new(record)));
        } else if self.volume_record().is_none() {
            self.open_with(Path::new(DEFAULT_SOURCE), record, ctx);
        } else {
            self.apply_record(&record, &self.value_ranges(), self.opened_id());
        }
    }

    /// Opens a volume with a look.
    pub(super) fn open_with(&mut self, source: &Path, record: Record, ctx: &egui::Context) {
        let choice = record.volume.as_ref().map(|volume| volume.choice.clone()).unwrap_or_default();
        if self.start_loading(source, self.reading_of(&choice), ctx) {
            self.pending = Some(PendingLook::Record(Box::new(record)));
        }
    }

    /// Shows the question whether a look may open its volume, and does what the user says.
    pub(crate) fn ask_for_volume(&mut self, frame: &eframe::Frame, ctx: &egui::Context) {
        let Some(answer) = self.foreign_path.ui(ctx) else { return };
        if answer == Answer::Choose {
            // It stays open: choosing may be cancelled.
            return self.files.ask(Purpose::VolumeOfLook, frame, ctx);
        }
        match self.foreign_path.take() {
            Some((record, Some(path))) if answer == Answer::Open => self.open_with(&path, record, ctx),
            Some((record, _)) => self.use_look(record, ctx),
            None => {}
        }
    }

    /// Opens what the user has chosen for the look that was asked about.
    pub(crate) fn open_for_look(&mut self, path: &Path, ctx: &egui::Context) {
        match self.foreign_path.take() {
            Some((record, _)) => self.open_with(path, record, ctx),
            None => self.open(path, ctx),
        }
    }

    /// Takes over a look for the open volume, whatever volume it was made for.
    pub(crate) fn load_settings(&mut self, path: &Path, ctx: &egui::Context) {
        self.read_file(Reason::Look, path, ctx, files::load_record, |app, read, _ctx| match read {
            Ok(record) => {
                let open = app.volume_record().map(|(_, content_id)| content_id);
                if record.volume.as_ref().zip(open).is_some_and(|(of, open)| !of.is_of(open)) {
                    app.messages.note(text::opening::OF_ANOTHER_VOLUME);
                }
                app.apply_record(&record, &app.value_ranges(), app.opened_id());
            }
            Err(why) => app.say_not_read(text::opening::SETTINGS_NOT_LOADED, why),
        });
    }

    /// Compares the look of the window with that of a file.
    pub(crate) fn compare_with_file(&mut self, path: &Path, ctx: &egui::Context) {
        self.read_file(Reason::Comparison, path, ctx, files::load_record, |app, read, _ctx| match read {
            Ok(record) => match app.with_record(&record, &app.value_ranges()) {
                Ok(look) => app.compare.with(look),
                Err(err) => app.messages.error(text::opening::SETTINGS_NOT_LOADED, err),
            },
            Err(why) => app.say_not_read(text::opening::SETTINGS_NOT_LOADED, why),
        });
    }

    /// The values of the open volume.
    pub(crate) fn value_ranges(&self) -> ValueRanges {
        self.volume.as_ref().map_or(ValueRanges::UNIT, |volume| volume.ranges)
    }

    /// The settings with a record laid over them, for a volume with these values.
    pub(crate) fn with_record(&mut self, record: &Record, ranges: &ValueRanges) -> Result<Settings, String> {
        let (settings, warnings) = record.apply(&self.settings, ranges).map_err(|err| err.to_string())?;
        if !warnings.is_empty() {
            self.messages.note(warnings.join("; "));
        }
        let mut settings = settings;
        // A look in which nothing is kept takes nothing away.
        if settings.kept.is_empty() {
            settings.kept.clone_from(&self.settings.kept);
        }
        Ok(settings)
    }

    /// Lays a record over the settings; whether that could be done. It corrects the volume, if that is the one that it is
    /// of.
    pub(super) fn apply_record(
        &mut self,
        record: &Record,
        ranges: &ValueRanges,
        opened_id: Option<u64>,
    ) -> bool {
        match self.with_record(record, ranges) {
            Ok(settings) => {
                self.settings = settings;
                if let Some(by) = opened_id.and_then(|open| record.corrections_of(open)) {
                    self.settings.volume = by;
                    self.corrected.accept(by);
                }
                if record.names_balance() {
                    self.keep_balanced.accept(&self.settings);
                }
                true
            }
            Err(err) => {
                self.messages.error(text::opening::SETTINGS_NOT_LOADED, err);
                false
            }
        }
    }

    /// The open volume, for records.
    pub(crate) fn volume_record(&self) -> Option<(&Path, u64)> {
        Some((&self.volume.as_ref()?.source, self.opened_id()?))
    }

    /// Where Ctrl+S writes, if it may; else why not is said.
    pub(crate) fn session_to_save(&mut self) -> Option<PathBuf> {
        let session = self.session.as_ref()?;
        let Some((path, why)) = session.protection() else { return Some(session.path().to_owned()) };
        self.messages.note(text::memory::protected(path, why));
        None
    }

    pub(crate) fn save_settings(&mut self, path: &Path) {
        let record = self.volume.as_ref().zip(self.opened_id()).map(|(volume, opened_id)| {
            VolumeRecord::new(&volume.source, opened_id, path.parent()).choosing(volume.held.choice())
        });
        match Session::save(&mut self.session, path, &self.settings, record.as_ref()) {
            Ok(()) => self.messages.note(text::opening::saved(path)),
            Err(err) => self.messages.error(text::opening::SETTINGS_NOT_SAVED, err),
        }
    }
}
