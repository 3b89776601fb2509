//! Presets and sessions named by arguments; all are read before any is applied.

use std::path::Path;

use crate::cli::CliError;
use chiaroscuro_files::read_small_file;
use chiaroscuro_media::{may_carry_record, read_record};
use chiaroscuro_scene::{AppliedSettings, LookRecord, Preset, SceneAxis, Settings};
use chiaroscuro_volume::{Corrections, ValueRanges};

/// Preset or session that is applied to settings.
#[derive(Debug, Clone)]
pub(super) struct PresetOrSession {
    kind: &'static str,
    /// Name of a built-in preset, or path of a file or exported picture.
    name: String,
    record: LookRecord,
}

impl PresetOrSession {
    /// Reads a preset or session from a built-in, a file, or an exported picture.
    pub(super) fn read(what: &'static str, path: &Path) -> Result<Self, CliError> {
        let name = path.display().to_string();
        let builtin = Preset::find(&name).filter(|_| what == "preset");
        let text = match builtin {
            Some(preset) => preset.json().as_bytes().to_vec(),
            None if may_carry_record(path) => {
                let unusable =
                    || CliError::Replay { path: name.clone(), why: "it carries no settings".to_owned() };
                read_record(path)?.ok_or_else(unusable)?.into_bytes()
            }
            None => {
                read_small_file(path).map_err(|source| CliError::Read { what, path: name.clone(), source })?
            }
        };
        let record = LookRecord::from_bytes(&text).map_err(|source| CliError::Preset {
            what,
            path: name.clone(),
            source,
        })?;
        Ok(Self { kind: what, name, record })
    }

    /// Returns true if it contains the setting with this path.
    pub(super) fn contains_setting(&self, path: &str) -> bool {
        self.record.has_setting(path)
    }

    /// Returns the corrections of its volume, if that is the opened one.
    pub(super) fn corrections_of(&self, opened_id: u64) -> Option<Corrections> {
        self.record.corrections_for(opened_id)
    }

    /// Returns the scene axis that points up, if it contains that setting.
    pub(super) fn up(&self, ranges: &ValueRanges) -> Option<SceneAxis> {
        // Errors are reported when the overlay is applied to the look.
        let settings = self.record.apply(&Settings::default(), ranges).ok()?.settings;
        self.contains_setting("camera.up").then_some(settings.camera.up)
    }

    /// Applies it to settings, for a volume with these ranges of values.
    pub(super) fn apply_to(
        &self,
        settings: &Settings,
        ranges: &ValueRanges,
        warn: impl Fn(&str),
    ) -> Result<Settings, CliError> {
        let Self { kind: what, name, record } = self;
        let AppliedSettings { settings: next, warnings } = record
            .apply(settings, ranges)
            .map_err(|source| CliError::Preset { what, path: name.clone(), source })?;
        for warning in warnings {
            warn(&format!("warning: {what}: {warning} ({name})"));
        }
        Ok(next)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_points_up_is_known_where_it_is_named() {
        let folder = tempfile::tempdir().unwrap();
        let up = |text: &str| {
            let path = folder.path().join("a.json");
            std::fs::write(&path, text).unwrap();
            PresetOrSession::read("session", &path).unwrap().up(&ValueRanges::UNIT)
        };
        assert_eq!(up(r#"{"camera": {"up": "minus_y"}}"#), Some(SceneAxis::MinusY));
        assert_eq!(up(r#"{"camera": {"distance": 3.0}}"#), None);
        // Written by a version that had no choice of axis.
        assert_eq!(up(r#"{"schema": 1, "camera": {"azimuth_deg": 3.0}}"#), Some(SceneAxis::PlusZ));
        assert_eq!(up(r#"{"camera": {"up": "sideways"}}"#), None);
    }
}
