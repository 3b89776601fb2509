//! Opens volumes and looks: what takes the place of what, and which settings a volume is shown with.

mod choosing;
mod folders;
mod looks;

use std::path::Path;
use std::sync::Arc;

use eframe::egui;

use crate::app::common::volume_facts::VolumeFacts;
use crate::app::shell::file_tasks::{NotRead, Reason};
use crate::app::shell::first_lights::FirstLights;
use crate::app::shell::history::{History, Step};
use crate::app::shell::keep_balanced::KeepBalanced;
use crate::app::shell::object::corrected::Corrected;
use crate::app::shell::object::treat_as::Treated;
use crate::app::shell::object::upright::Upright;
use crate::app::windows::files;
use crate::app::windows::raw_dialog::Described;
use crate::app::worker::loader::{Known, Opened, Reading};
use crate::app::{App, text};
use crate::data::load::{Choice, Portion, Thinning};
use crate::data::{Corrections, Volume};
use crate::model::{Length, ObjectTurn, Record, Settings, VolumePlace, made_by};

use self::folders::Likeness;
pub(in crate::app) use self::folders::Neighbour;

/// What is opened when nothing is named.
const DEFAULT_SOURCE: &str = "builtin:chair";

/// A look that waits for the volume that is being opened.
#[derive(Debug)]
pub(in crate::app) enum PendingLook {
    /// A file's: laid over the volume's first look.
    Record(Box<Record>),
    /// Every setting, whatever the first look is.
    Settings(Box<Settings>),
    /// The look as it is when the volume is there.
    Current,
    /// That look, as far as the volume is like the one before.
    IfAlike,
}

impl App {
    /// Opens a file or a built-in volume, or the volume of a session or of an exported picture with the look
    /// that is kept there. What is open stays until it is there.
    pub fn open(&mut self, source: impl AsRef<Path>, ctx: &egui::Context) {
        let source = source.as_ref();
        // It was said of another file.
        self.messages.dismiss();
        if files::is_record(source) {
            self.open_either(source, ctx);
        } else {
            self.open_volume(source, ctx);
        }
    }

    /// Opens a volume with its own first look.
    pub(super) fn open_volume(&mut self, source: &Path, ctx: &egui::Context) {
        if self.start_loading(source, Reading::default(), ctx) {
            self.pending = None;
        }
    }

    /// Opens one of several volumes of a file; what the command line says of which counts more than what was remembered.
    pub(crate) fn open_chosen(&mut self, source: &Path, choice: &Choice, ctx: &egui::Context) {
        if self.start_loading(source, self.reading_of(choice), ctx) {
            self.pending = None;
        }
    }

    /// Opens a file that was open before, as it was then.
    pub(crate) fn open_again(&mut self, source: &Path, choice: &Choice, ctx: &egui::Context) {
        if choice.is_empty() {
            self.open(source, ctx);
        } else {
            self.open_chosen(source, choice, ctx);
        }
    }

    /// How a volume is read that was chosen before.
    fn reading_of(&self, choice: &Choice) -> Reading {
        let said = self.loader.options().choice.clone();
        Reading { choice: Some(said.or(choice)), ..Reading::default() }
    }

    /// Opens what was named at the start. A look that cannot be used leaves the default volume.
    pub(crate) fn open_first(&mut self, source: Option<&Path>, volume: Option<&Path>, ctx: &egui::Context) {
        match (source, volume) {
            (Some(look), Some(volume)) => self.open_look_with(look, volume, ctx),
            (Some(source), None) | (None, Some(source)) => self.open(source, ctx),
            (None, None) => self.open_volume_of_session(ctx),
        }
        self.open_something(Reason::Open, ctx);
    }

    /// Opens the default volume where nothing is open, and what was read for that reason has led to nothing.
    pub(in crate::app) fn open_something(&mut self, reason: Reason, ctx: &egui::Context) {
        let is_empty = self.volume.is_none() && self.viewport.dataset().is_none();
        let is_busy = self.loader.progress().is_some() || self.file_tasks.is_reading(Reason::Open);
        if reason == Reason::Open && is_empty && !is_busy {
            self.start_loading(Path::new(DEFAULT_SOURCE), Reading::default(), ctx);
        }
    }

    /// Opens what has waited for the answer whether to reopen the last session, unless something is open or being opened.
    pub(crate) fn open_what_waits(&mut self, ctx: &egui::Context) {
        let is_free = self.volume.is_none() && self.loader.progress().is_none() && !self.foreign_path.asks();
        if std::mem::take(&mut self.first_waits) && is_free {
            self.open_first(None, None, ctx);
        }
    }

    /// Opens the volume that the session is of, where it says so. Its look is laid over whatever volume is the first.
    fn open_volume_of_session(&mut self, ctx: &egui::Context) {
        let session = self.session.as_ref().map(|session| session.path().to_owned());
        let Some(session) = session.filter(|path| path.exists()) else { return };
        let path = session.clone();
        self.read_file(Reason::Open, &path, ctx, files::load_record, move |app, read, ctx| {
            // That the session cannot be read is said when it is due.
            let Ok(record) = read else { return };
            let Some(volume) = record.volume.clone() else { return };
            match app.place_of(&volume, &session) {
                VolumePlace::Builtin(name) => app.open_chosen(Path::new(&name), &volume.choice, ctx),
                VolumePlace::Beside(path) => app.open_chosen(&path, &volume.choice, ctx),
                VolumePlace::Elsewhere(path) => app.foreign_path.ask(path, record),
                VolumePlace::Never(why) => app.foreign_path.refuse(&volume.source, why, record),
            }
        });
    }

    /// Opens a file of bare voxels of which the user has said how it is stored.
    pub(crate) fn open_described(&mut self, described: &Described, ctx: &egui::Context) {
        // A look that waits for this volume goes on waiting.
        let Described { path, layout, header, is_gzip } = described;
        if let Some(header) = header {
            let data_file = path.file_name().unwrap_or_default().to_string_lossy();
            // Comments of a header follow its first line.
            let content = layout.header(&data_file, *is_gzip);
            let content = content.replacen('\n', &format!("\n# {}\n", made_by()), 1);
            match crate::export::write_atomically(header, content.as_bytes()) {
                Ok(()) => {
                    self.start_loading(header, Reading::default(), ctx);
                    return;
                }
                // It is shown all the same.
                Err(err) => self.messages.error(text::opening::HEADER_NOT_WRITTEN, err.to_string()),
            }
        }
        let reading = Reading { raw: Some(layout.format()), ..Reading::default() };
        self.start_loading(path, reading, ctx);
    }

    /// Reads the open volume again with more or fewer of its voxels; the look stays.
    pub(crate) fn thin(&mut self, thinning: Thinning, ctx: &egui::Context) {
        let Some(volume) = &self.volume else { return };
        let mut settings = self.settings.clone();
        // Opacities refer to the same thickness, however many voxels that has.
        if let Length::Voxels(_) = settings.opacity_unit {
            let unit = settings.opacity_unit.in_scene(&volume.scene) * volume.scene.mm_per_unit;
            settings.opacity_unit = Length::Mm(unit);
        }
        // Whether all of it has room is asked.
        let portion = Some(Portion { thinning, ..volume.held.portion }).filter(|portion| !portion.is_whole());
        let choice = Some(Choice { portion, ..volume.held.choice() });
        let reading = Reading { choice, takes_all_memory: false, ..volume.reading.clone() };
        let source = volume.source.clone();
        if self.start_loading(&source, reading, ctx) {
            self.pending = Some(PendingLook::Settings(Box::new(settings)));
        }
    }

    pub(crate) fn start_loading(&mut self, source: &Path, reading: Reading, ctx: &egui::Context) -> bool {
        // What was asked or said of the file before is over, and so is what was to be opened.
        self.file_tasks.forget(Reason::Open);
        self.file_tasks.forget(Reason::Session);
        self.raw_dialog.close();
        self.roomy.close();
        let known = Known { up: self.memory.up_of(source), corrected: self.memory.corrections_of(source) };
        let started = self.loader.open(source, reading, known, ctx);
        if let Err(err) = &started {
            self.messages.error(text::opening::NOT_OPENED, err.clone());
        }
        started.is_ok()
    }

    /// What can be undone of a volume that has just been opened: that it was corrected as the last time.
    fn history_of(&self, volume: &Volume) -> History {
        let by = self.settings.volume;
        if by.is_none() || by != *volume.corrections() {
            return History::default();
        }
        let mut settings = self.settings.clone();
        settings.correct(Corrections::default(), volume);
        History::after(&Step { settings, treated_as: None })
    }

    /// Identifies the file that is open.
    pub(super) fn opened_id(&self) -> Option<u64> {
        self.viewport.dataset().map(|dataset| dataset.volume().opened_id())
    }

    /// Something was found before there was a window to say it.
    pub(crate) fn remember_to_say(&mut self, found: Option<String>) {
        if let Some(notice) = found {
            self.memory.add_notice(notice);
        }
    }

    /// Keeps the look as it is now, so that nothing is lost however this run ends; and says what could not be kept.
    pub(crate) fn keep_look(&mut self) {
        if let Some((volume, opened_id)) = self.volume.as_ref().zip(self.opened_id()) {
            self.memory.keep(&self.settings, &volume.source, opened_id, &volume.held.choice());
            if let Some(picture) = self.viewport.take_finished() {
                self.memory.show(picture);
            }
            // Not before there is a volume, which clears what was said.
            let notices = self.memory.take_notices();
            if !notices.is_empty() {
                self.messages.error(text::memory::WORTH_KNOWING, notices.join("\n\n"));
            }
        }
    }

    /// A volume is ready: it replaces the one before, once the session has been read that is due with the first.
    pub(crate) fn take_in_with_session(&mut self, opened: Opened, ctx: &egui::Context) {
        let session = self.session.as_ref().filter(|_| self.session_is_due);
        match session.map(|session| session.path().to_owned()).filter(|path| path.exists()) {
            Some(path) => {
                self.read_file(Reason::Session, &path, ctx, files::load_record, |app, read, ctx| {
                    app.take_in(opened, Some(read), ctx);
                });
            }
            None => self.take_in(opened, None, ctx),
        }
    }

    /// A volume is ready, and so is the session that was to be read with it.
    fn take_in(
        &mut self,
        opened: Opened,
        session_read: Option<Result<Record, NotRead>>,
        ctx: &egui::Context,
    ) {
        let Opened { source, reading, dataset, too_many, renderer, settings, stamp } = opened;
        let volume = Arc::clone(dataset.volume());
        self.messages.clear();
        self.strip.forget();
        // What is kept is worth looking at on other volumes, too.
        let kept = self.settings.kept.clone();
        let likeness = match (&self.pending, &self.volume) {
            (Some(PendingLook::IfAlike), Some(open)) => Likeness::of(open, &volume),
            _ => Likeness::Nothing,
        };
        if let Some(PendingLook::IfAlike) = self.pending {
            self.pending = (likeness == Likeness::Grid).then_some(PendingLook::Current);
        }
        // Another file has corrections of its own.
        let by = if likeness == Likeness::Grid { settings.volume } else { self.settings.volume };
        let is_current = matches!(self.pending, Some(PendingLook::Current));
        let current = is_current.then(|| Settings { volume: by, ..self.settings.clone() });
        let selected_light = if current.is_some() { self.selected_light } else { 0 };
        if let Some(before) = too_many {
            self.messages.note(text::opening::averaged(before, volume.dims()));
        }
        for remark in volume.remarks() {
            self.messages.note(remark.clone());
        }
        if !volume.corrections().is_none() {
            self.messages.note(text::corrections::as_last_time(&volume.corrections().in_words()));
        }
        self.defaults = settings.clone();
        let is_kept = (self.keeps_look || likeness == Likeness::Kind) && self.volume.is_some();
        if is_kept {
            // As it was, but for where the object is: that is another one, and may stand another way up.
            let mut before = std::mem::take(&mut self.settings);
            before.turn_object(ObjectTurn::Upright(settings.camera.up));
            let mut kept = Settings { camera: settings.camera.clone(), volume: settings.volume, ..before };
            kept.floor.height = settings.floor.height;
            self.settings = kept;
        } else {
            self.settings = settings;
        }
        // What is measured is of the volume before; a first look is balanced, a look from there is not.
        self.keep_balanced = KeepBalanced::new(&self.settings, !is_kept);
        let is_named = is_kept || session_read.is_some() || self.pending.is_some() || self.adjust.is_some();
        let (ranges, opened_id) = (volume.ranges(), Some(volume.opened_id()));
        // Session and command line speak of the first volume.
        self.session_is_due = false;
        if let Some(read) = session_read
            && let Some(mut session) = self.session.take()
        {
            session.found(read.as_ref().ok());
            match read {
                Ok(record) if !self.apply_record(&record, &ranges, opened_id) => session.not_understood(),
                Ok(_) => {}
                Err(why) => self.say_not_read(text::opening::SESSION_NOT_LOADED, why),
            }
            self.session = Some(session);
        }
        self.memory.opened(&source, &volume.held().choice());
        self.recent_pictures.forget();
        match self.pending.take() {
            None => {}
            Some(PendingLook::Settings(settings)) => {
                self.settings = *settings;
                self.keep_balanced.accept(&self.settings);
            }
            Some(PendingLook::Current | PendingLook::IfAlike) => {
                self.settings = current.unwrap_or_default();
                self.keep_balanced.accept(&self.settings);
            }
            Some(PendingLook::Record(record)) => {
                if record.volume.as_ref().is_some_and(|of| !of.is_of(volume.opened_id())) {
                    self.messages.note(text::opening::OF_OTHER_VALUES);
                }
                self.apply_record(&record, &ranges, opened_id);
            }
        }
        if let Some(adjust) = self.adjust.take() {
            self.settings = adjust(std::mem::take(&mut self.settings));
            self.settings.sanitise();
        }
        if self.settings.kept.is_empty() {
            self.settings.kept = kept;
        }
        // What somebody has chosen stays.
        self.first_lights = if is_named { FirstLights::default() } else { FirstLights::of(&self.settings) };
        self.light_search = None;
        self.contact_sheet.forget();
        self.volume = Some(VolumeFacts::of(source, reading, &dataset));
        // With its own look, as it stands there.
        (self.treated, self.upright) = (Treated::default(), Upright::default());
        self.viewport.set_scene(renderer, dataset);
        self.history = self.history_of(&volume);
        self.corrected = Corrected::new(stamp, self.settings.volume);
        self.selected_light = selected_light;
        let title = text::opening::title(self.volume_name().unwrap_or_default());
        ctx.send_viewport_cmd(egui::ViewportCommand::Title(title));
    }
}
