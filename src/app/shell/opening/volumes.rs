//! Opening of volumes: named, chosen among those of a file, described by the user, or at the start of the program.

use std::path::Path;

use super::VolumeOpener;
use super::file_tasks::ReadPurpose;
use super::plan::PendingLook;
use crate::app::text;
use crate::app::windows::file_dialogs;
use crate::app::windows::raw_dialog::RawDialogResult;
use crate::app::worker::loader::ReadChoices;
use chiaroscuro_files::provenance_mark;
use chiaroscuro_scene::{LookRecord, OpacityLength, Preset, VolumeLocation};
use chiaroscuro_volume::{Downsampling, Portion, VolumeChoice};

impl VolumeOpener<'_> {
    /// Opens a file or a built-in volume, or the volume of a session or exported picture with the look stored there.
    /// The open volume stays until the new one is ready.
    pub(crate) fn open(&mut self, source: &Path) {
        // The message was about another file.
        self.editor.messages.dismiss();
        if file_dialogs::may_be_look_file(source) {
            self.open_volume_or_look(source);
        } else {
            self.open_volume(source);
        }
    }

    /// Opens a volume with its own first look.
    pub(super) fn open_volume(&mut self, source: &Path) {
        if self.start_loading(source, ReadChoices::default()) {
            self.state.requests.pending_look = None;
        }
    }

    /// Opens a built-in volume with its scene.
    pub(crate) fn open_scene(&mut self, scene: &Preset) {
        let Some(volume) = scene.scene_volume() else { return };
        self.editor.messages.dismiss();
        match LookRecord::parse(scene.json()) {
            Ok(record) => self.open_with(Path::new(&format!("builtin:{volume}")), record),
            Err(err) => self.editor.messages.error(text::opening::SETTINGS_NOT_LOADED, err.to_string()),
        }
    }

    /// Opens one of several volumes of a file; a choice on the command line has precedence over a remembered one.
    pub(crate) fn open_chosen(&mut self, source: &Path, choice: &VolumeChoice) {
        if self.start_loading(source, self.reading_options(choice)) {
            self.state.requests.pending_look = None;
        }
    }

    /// Opens a file that was open before, with the volume chosen then.
    pub(crate) fn open_again(&mut self, source: &Path, choice: &VolumeChoice) {
        if choice.is_empty() {
            self.open(source);
        } else {
            self.open_chosen(source, choice);
        }
    }

    /// Returns the options for reading a volume that was chosen before.
    pub(super) fn reading_options(&self, choice: &VolumeChoice) -> ReadChoices {
        let said = self.state.loader.options().choice.clone();
        ReadChoices { choice: Some(said.with_fallback(choice)), ..ReadChoices::default() }
    }

    /// Opens the file, look or session named at the start, if one is; without a volume the start screen is shown.
    pub(crate) fn open_first(&mut self, source: Option<&Path>, volume: Option<&Path>) {
        match (source, volume) {
            (Some(look), Some(volume)) => self.open_look_with(look, volume),
            (Some(source), None) | (None, Some(source)) => self.open(source),
            (None, None) => self.open_volume_of_session(),
        }
    }

    /// Opens the volume that the session names. The look of the session is applied to the first volume in any case.
    fn open_volume_of_session(&mut self) {
        let session = self.editor.document.session.as_ref().map(|session| session.path().to_owned());
        let Some(session) = session.filter(|path| path.exists()) else { return };
        let path = session.clone();
        self.read_file(ReadPurpose::Open, &path, file_dialogs::load_record, move |opener, read| {
            // An unreadable session is reported when it is applied.
            let Ok(record) = read else { return };
            let Some(volume) = record.volume.clone() else { return };
            match opener.locate_volume(&volume, &session) {
                VolumeLocation::Builtin(name) => opener.open_chosen(Path::new(&name), &volume.choice),
                VolumeLocation::InRecordFolder(path) => opener.open_chosen(&path, &volume.choice),
                VolumeLocation::OtherFolder(path) => opener.state.untrusted_path.open(path, record),
                VolumeLocation::Refused(why) => {
                    opener.state.untrusted_path.open_refused(&volume.source, why, record);
                }
            }
        });
    }

    /// Opens a raw volume with the layout that the user has entered.
    pub(crate) fn open_raw(&mut self, described: &RawDialogResult) {
        // A look that is pending for this volume stays pending.
        let RawDialogResult { path, layout, header, is_gzip } = described;
        if let Some(header) = header {
            let data_file = path.file_name().unwrap_or_default().to_string_lossy();
            // Comments of a NRRD header follow its first line.
            let content = layout.nrrd_header(&data_file, *is_gzip);
            let content = content.replacen('\n', &format!("\n# {}\n", provenance_mark()), 1);
            match chiaroscuro_files::write_atomically(header, content.as_bytes()) {
                Ok(()) => {
                    self.start_loading(header, ReadChoices::default());
                    return;
                }
                // The volume is shown nevertheless.
                Err(err) => self.editor.messages.error(text::opening::HEADER_NOT_WRITTEN, err.to_string()),
            }
        }
        let reading = ReadChoices { raw: Some(layout.to_format()), ..ReadChoices::default() };
        self.start_loading(path, reading);
    }

    /// Reads the open volume again with another subsampling; the look stays.
    pub(crate) fn reload_subsampled(&mut self, thinning: Downsampling) {
        let Some(volume) = &self.editor.document.volume else { return };
        let mut settings = self.editor.document.settings.clone();
        // The opacity unit keeps its thickness, whatever the number of voxels.
        if let OpacityLength::Voxels(_) = settings.layer().opacity_unit {
            let unit = settings.layer().opacity_unit.scene_units(&volume.scene) * volume.scene.mm_per_unit;
            settings.layer_mut().opacity_unit = OpacityLength::Mm(unit);
        }
        // The memory estimate is checked again.
        let portion = Some(Portion { thinning, ..volume.held.portion }).filter(|portion| !portion.is_whole());
        let choice = Some(VolumeChoice { portion, ..volume.held.choice() });
        let reading = ReadChoices { choice, takes_all_memory: false, ..volume.reading.clone() };
        let source = volume.source.clone();
        if self.start_loading(&source, reading) {
            self.state.requests.pending_look = Some(PendingLook::Settings(Box::new(settings)));
        }
    }
}
