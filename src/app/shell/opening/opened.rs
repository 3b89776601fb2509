//! Replacement of the open volume by one that is ready, with the look that the [plan](super::plan) gives it.

use std::sync::Arc;

use eframe::egui;

use super::VolumeOpener;
use super::file_tasks::{FileReadFailure, ReadPurpose};
use super::plan::{CorrectionsOrigin, LookChange, OpenPlan, OpenRequest, StartingLook};
use super::similarity::VolumeSimilarity;
use crate::app::common::volume_facts::VolumeFacts;
use crate::app::document::auto_balance::AutoBalance;
use crate::app::document::corrections::CorrectionState;
use crate::app::document::data_kind::KindOverride;
use crate::app::document::light_placement::LightPlacement;
use crate::app::text;
use crate::app::windows::file_dialogs;
use crate::app::worker::loader::OpenedVolume;
use chiaroscuro_scene::{LookRecord, ObjectRotation, Settings};
use chiaroscuro_volume::Volume;

/// Session that was read for a volume, or the reason why it is missing.
type SessionRead = Result<LookRecord, FileReadFailure>;

/// Returns a look for another volume, whose first look gives the position of the object: it may have another up axis.
fn kept_look(mut look: Settings, first: &Settings) -> Settings {
    look.rotate_object(ObjectRotation::MakeUpright(first.camera.up));
    look.camera.clone_from(&first.camera);
    look.volume = first.volume;
    look.floor.height = first.floor.height;
    look
}

impl VolumeOpener<'_> {
    /// Replaces the open volume by one that is ready; the first one waits until the session has been read.
    pub(crate) fn show_opened_with_session(&mut self, opened: OpenedVolume) {
        let session = self.editor.document.session.as_ref().filter(|_| self.state.requests.session_is_due);
        match session.map(|session| session.path().to_owned()).filter(|path| path.exists()) {
            Some(path) => {
                let read = file_dialogs::load_record;
                self.read_file(ReadPurpose::Session, &path, read, |opener, read| {
                    opener.show_opened(opened, Some(read));
                });
            }
            None => self.show_opened(opened, None),
        }
    }

    /// Replaces the open volume by one that is ready, with the session that was read for it.
    fn show_opened(&mut self, opened: OpenedVolume, session: Option<SessionRead>) {
        let OpenedVolume { source, reading, dataset, original_dims, renderer, settings, stamp } = opened;
        let volume = Arc::clone(dataset.volume());
        self.report_opened(&volume, original_dims);
        let open = self.editor.document.volume.as_ref();
        let plan = OpenPlan::new(OpenRequest {
            requested: self.state.requests.pending_look.take(),
            keeps_look: self.state.requests.keeps_look,
            similarity: open.map(|open| VolumeSimilarity::between(open, &volume)),
            has_session: session.is_some(),
            has_adjustment: self.state.adjust_first_look.is_some(),
        });
        // Session and adjustment apply to the first volume only.
        self.state.requests.session_is_due = false;
        let applied = self.apply_plan(plan, settings, session, &volume);
        self.editor.memory.add_recent(&source, &volume.contents().choice());
        self.editor.look_tasks.light_search.discard();
        let document = &mut self.editor.document;
        document.volume = Some(VolumeFacts::new(source, reading, &dataset));
        document.start_layers(&dataset);
        // Treated as its own kind of data, with its own up axis.
        document.kind_override = KindOverride::default();
        document.drop_turns();
        document.corrections = CorrectionState::new(stamp, document.settings.volume);
        let title = text::opening::title(document.volume_name());
        let file = self.volume_file(&dataset);
        self.editor.viewport.set_scene(renderer, dataset, file);
        self.state.has_opened = true;
        self.ctx.send_viewport_cmd(egui::ViewportCommand::Title(title));
        if let Some(record) = applied {
            self.add_recorded_layers(&record);
        }
        // Volumes that a record names belong to its first step.
        self.editor.document.start_history(&volume);
        self.add_layers_over();
    }

    /// Replaces the messages by notes about a volume; `original_dims` are its dimensions if it was averaged.
    fn report_opened(&mut self, volume: &Volume, original_dims: Option<[usize; 3]>) {
        self.editor.messages.clear();
        if let Some(before) = original_dims {
            self.editor.messages.note(text::opening::downsampled(before, volume.dims()));
        }
        for remark in volume.remarks() {
            self.editor.messages.note(remark.clone());
        }
        if !volume.corrections().is_none() {
            self.editor.messages.note(text::corrections::restored(&volume.corrections().in_words()));
        }
    }

    /// Applies the plan for a volume to the document; `first` is the first look of the volume. Returns the record that
    /// was applied last, if one was.
    fn apply_plan(
        &mut self,
        plan: OpenPlan,
        first: Settings,
        mut session: Option<SessionRead>,
        volume: &Volume,
    ) -> Option<LookRecord> {
        let mut applied = None;
        let OpenPlan { start, changes, keeps_selection, places_lights } = plan;
        let before = std::mem::take(&mut self.editor.document.settings);
        self.editor.document.settings = match start {
            StartingLook::FirstLook => first.clone(),
            StartingLook::KeptLook => kept_look(before.clone(), &first),
        };
        // Measurements belong to the volume before; a first look is balanced, a kept look is not.
        let is_balanced = start == StartingLook::FirstLook;
        self.editor.document.keep_balanced = AutoBalance::new(&self.editor.document.settings, is_balanced);
        for change in changes {
            match change {
                LookChange::Session => {
                    if let Some(read) = session.take() {
                        applied = self.apply_session(read, volume);
                    }
                }
                LookChange::Record(record) => {
                    let of = record.volume.as_ref();
                    if of.is_some_and(|of| !of.matches_content(volume.opened_id())) {
                        self.editor.messages.note(text::opening::OTHER_VALUES);
                    }
                    if self.editor.apply_record(&record, &volume.ranges(), Some(volume.opened_id())) {
                        applied = Some(*record);
                    }
                }
                LookChange::Settings(settings) => self.editor.document.replace_settings(*settings),
                LookChange::Current(corrections) => {
                    let volume = match corrections {
                        CorrectionsOrigin::OpenedFile => first.volume,
                        CorrectionsOrigin::CurrentLook => before.volume,
                    };
                    self.editor.document.replace_settings(Settings { volume, ..before.clone() });
                }
                LookChange::Adjustment => {
                    if let Some(adjust) = self.state.adjust_first_look.take() {
                        self.editor.document.settings =
                            adjust(std::mem::take(&mut self.editor.document.settings));
                        self.editor.document.settings.sanitise();
                    }
                }
            }
        }
        let document = &mut self.editor.document;
        // Saved views are useful on other volumes, too.
        if document.settings.kept.is_empty() {
            document.settings.kept = before.kept;
        }
        let placement =
            if places_lights { LightPlacement::new(&document.settings) } else { LightPlacement::default() };
        (document.defaults, document.first_lights) = (first, placement);
        if !keeps_selection {
            (document.selected_light, document.selected_layer) = (0, 0);
        }
        applied
    }

    /// Applies the session that was read for a volume, and returns its record, or reports why it was not read.
    fn apply_session(&mut self, read: SessionRead, volume: &Volume) -> Option<LookRecord> {
        let mut session = self.editor.document.session.take()?;
        session.set_record(read.as_ref().ok());
        let mut applied = None;
        match read {
            Ok(record) => {
                if self.editor.apply_record(&record, &volume.ranges(), Some(volume.opened_id())) {
                    applied = Some(record);
                } else {
                    session.protect_invalid();
                }
            }
            Err(why) => why.report(text::opening::SESSION_NOT_LOADED, &mut self.editor.messages),
        }
        self.editor.document.session = Some(session);
        applied
    }
}
