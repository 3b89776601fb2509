//! Looks from files, applied to the document, and its own look as a file.

use std::path::Path;

use super::Document;
use super::session::SessionFile;
use chiaroscuro_scene::{AppliedSettings, LookRecord, Settings, VolumeRecord};
use chiaroscuro_volume::{FieldOrigin, ValueRanges};

/// Settings with the look of a file, and notes about what could not be applied.
#[derive(Debug)]
pub(crate) struct AppliedLook {
    /// Settings with the look of the file.
    pub settings: Settings,
    /// Warnings for the user, if any.
    pub note: Option<String>,
}

impl Document {
    /// Applies a record to a copy of the settings, for a volume with these ranges of values.
    pub(crate) fn settings_with_record(
        &self,
        record: &LookRecord,
        ranges: &ValueRanges,
    ) -> Result<AppliedLook, String> {
        let AppliedSettings { mut settings, warnings } =
            record.apply(&self.settings, ranges).map_err(|err| err.to_string())?;
        // A look without saved views leaves the existing ones.
        if settings.kept.is_empty() {
            settings.kept.clone_from(&self.settings.kept);
        }
        let note = (!warnings.is_empty()).then(|| warnings.join("; "));
        Ok(AppliedLook { settings, note })
    }

    /// Applies a record to the settings, and returns a note about what could not be applied. Its corrections are
    /// applied only to the volume for which they were made.
    pub(crate) fn apply_record(
        &mut self,
        record: &LookRecord,
        ranges: &ValueRanges,
        opened_id: Option<u64>,
    ) -> Result<Option<String>, String> {
        let AppliedLook { settings, note } = self.settings_with_record(record, ranges)?;
        self.settings = settings;
        if let Some(by) = opened_id.and_then(|open| record.corrections_for(open)) {
            self.settings.volume = by;
            self.corrections.accept(by);
        }
        if record.has_balance() {
            self.keep_balanced.accept(&self.settings);
        }
        Ok(note)
    }

    /// Replaces all settings by others whose balance is part of them.
    pub(crate) fn replace_settings(&mut self, settings: Settings) {
        self.settings = settings;
        self.keep_balanced.accept(&self.settings);
    }

    /// Lists the open volume, which has the identifier `opened_id`, and those that are shown with it, or would be if
    /// they could be opened.
    pub(crate) fn shown_volumes(&self, opened_id: u64) -> Vec<FieldOrigin> {
        let Some(volume) = &self.volume else { return Vec::new() };
        let (source, choice) = (volume.source.clone(), volume.held.choice());
        let first = FieldOrigin { source, opened_id, choice };
        let further = self.further_volumes.iter().take(self.settings.layers.count() - 1);
        std::iter::once(first).chain(further.cloned()).collect()
    }

    /// Writes the look to a file, which becomes the session; `opened_id` is the identifier of the open file's volume.
    pub(crate) fn save_session(&mut self, path: &Path, opened_id: Option<u64>) -> Result<(), String> {
        let volumes = opened_id.map(|opened_id| self.shown_volumes(opened_id)).unwrap_or_default();
        let record = VolumeRecord::from_volumes(&volumes, path.parent());
        SessionFile::save(&mut self.session, path, &self.settings, record.as_ref())
    }
}
