//! Presets and sessions that arguments name, read before anything is laid over anything.

use std::path::Path;

use crate::cli::CliError;
use crate::data::{Corrections, ValueRanges, read_small};
use crate::export::{may_carry_record, read_record};
use crate::model::{Preset, Record, SceneAxis, Settings};

/// A preset or session.
#[derive(Debug, Clone)]
pub(super) struct Overlay {
    what: &'static str,
    /// A built-in's name, a file, or an exported picture that carries it.
    name: String,
    record: Record,
}

impl Overlay {
    /// Reads one.
    pub(super) fn read(what: &'static str, path: &Path) -> Result<Self, CliError> {
        let name = path.display().to_string();
        let builtin = Preset::find(&name).filter(|_| what == "preset");
        let text = match builtin {
            Some(preset) => preset.text().as_bytes().to_vec(),
            None if may_carry_record(path) => {
                let unusable =
                    || CliError::Replay { path: name.clone(), why: "it carries no settings".to_owned() };
                read_record(path)?.ok_or_else(unusable)?.into_bytes()
            }
            None => read_small(path).map_err(|source| CliError::Read { what, path: name.clone(), source })?,
        };
        let record = Record::from_bytes(&text).map_err(|source| CliError::Preset {
            what,
            path: name.clone(),
            source,
        })?;
        Ok(Self { what, name, record })
    }

    /// Whether it says something of a setting, by its path.
    pub(super) fn names(&self, path: &str) -> bool {
        self.record.names(path)
    }

    /// How the volume was corrected that it is of, if that is what was opened.
    pub(super) fn corrections_of(&self, opened_id: u64) -> Option<Corrections> {
        self.record.corrections_of(opened_id)
    }

    /// The axis that points up, if it names one.
    pub(super) fn up(&self, ranges: &ValueRanges) -> Option<SceneAxis> {
        // What cannot be understood is said when it is laid over the look.
        let (settings, _) = self.record.apply(&Settings::default(), ranges).ok()?;
        self.names("camera.up").then_some(settings.camera.up)
    }

    /// Lays it over settings, for a volume with these values.
    pub(super) fn over(
        &self,
        settings: &Settings,
        ranges: &ValueRanges,
        warn: impl Fn(&str),
    ) -> Result<Settings, CliError> {
        let Self { what, name, record } = self;
        let (next, warnings) = record.apply(settings, ranges).map_err(|source| CliError::Preset {
            what,
            path: name.clone(),
            source,
        })?;
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
            Overlay::read("session", &path).unwrap().up(&ValueRanges::UNIT)
        };
        assert_eq!(up(r#"{"camera": {"up": "minus_y"}}"#), Some(SceneAxis::MinusY));
        assert_eq!(up(r#"{"camera": {"distance": 3.0}}"#), None);
        // Of a time when there was no choice.
        assert_eq!(up(r#"{"schema": 1, "camera": {"azimuth_deg": 3.0}}"#), Some(SceneAxis::PlusZ));
        assert_eq!(up(r#"{"camera": {"up": "sideways"}}"#), None);
    }
}
