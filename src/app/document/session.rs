//! Session file of Ctrl+S, and its protection from being overwritten.

use std::path::{Path, PathBuf};

use serde_json::Value;

use crate::app::text;
use crate::app::windows::file_dialogs;
use chiaroscuro_scene::{LookRecord, SCHEMA, Settings, VolumeRecord};

/// Session file to which the look is saved.
#[derive(Debug)]
pub(crate) struct SessionFile {
    path: PathBuf,
    /// Fields of the file that this version does not know; they are written back.
    unknown: Value,
    /// Reason why the file must not be overwritten, if any.
    protection: Option<&'static str>,
    /// True if the look is saved when the window is closed.
    saves_on_close: bool,
}

impl SessionFile {
    /// Creates a session named on the command line; an existing file is protected until it has been read.
    pub(crate) fn from_command_line(path: PathBuf, saves_on_close: bool) -> Self {
        let protected = path.symlink_metadata().is_ok().then_some(text::persistence::NOT_READ_YET);
        Self { path, unknown: Value::Null, protection: protected, saves_on_close }
    }

    /// Creates the session of a file that was just written.
    fn just_written(path: &Path) -> Self {
        Self { path: path.to_owned(), unknown: Value::Null, protection: None, saves_on_close: false }
    }

    /// Path of the session file.
    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// Path of the file if it is to be written when the window is closed, and may be.
    pub(crate) fn path_on_close(&self) -> Option<&Path> {
        (self.saves_on_close && self.protection.is_none()).then_some(&*self.path)
    }

    /// Path of the file and the reason for its protection, if it is protected.
    pub(crate) fn protection(&self) -> Option<(&Path, &'static str)> {
        Some((&self.path, self.protection?))
    }

    /// Decides on the protection by the record found in the file, and keeps its unknown fields.
    pub(crate) fn set_record(&mut self, record: Option<&LookRecord>) {
        let Some(record) = record else {
            self.protection = Some(text::persistence::NOT_A_SESSION);
            return;
        };
        self.unknown = record.unknown_content();
        let is_json = self.path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("json"));
        self.protection = match record.schema() {
            Some(schema) if schema > u64::from(SCHEMA) => Some(text::persistence::NEWER_SESSION),
            Some(_) if record.was_cut() => Some(text::persistence::UNKNOWN_CONTENT),
            Some(_) if is_json => None,
            _ => Some(text::persistence::NOT_A_SESSION),
        };
    }

    /// Protects a file whose record cannot be applied to the settings.
    pub(crate) fn protect_invalid(&mut self) {
        self.protection = Some(text::persistence::UNKNOWN_CONTENT);
    }

    /// Writes a look to a file. Over the session itself, its unknown fields are preserved.
    pub(crate) fn save(
        session: &mut Option<Self>,
        path: &Path,
        settings: &Settings,
        volume: Option<&VolumeRecord>,
    ) -> Result<(), String> {
        let unknown = session.as_ref().filter(|session| session.path == path).map(|session| &session.unknown);
        let text = LookRecord::to_json_with_unknown(settings, volume, None, unknown.unwrap_or(&Value::Null));
        file_dialogs::write_with_backup(path, text.as_bytes())?;
        match session {
            Some(session) if session.path == path => session.protection = None,
            _ => *session = Some(Self::just_written(path)),
        }
        Ok(())
    }
}
