//! Session file of Ctrl+S, and its protection from being overwritten.

use std::path::{Path, PathBuf};

use serde_json::Value;

use crate::app::text;
use crate::app::windows::files;
use crate::model::{Record, SCHEMA, Settings, VolumeRecord};

/// Session file to which the look is saved.
#[derive(Debug)]
pub(crate) struct Session {
    path: PathBuf,
    /// Fields of the file that this version does not know; they are written back.
    unknown: Value,
    /// Reason why the file must not be overwritten, if any.
    protected: Option<&'static str>,
}

impl Session {
    /// Creates a session named on the command line; an existing file is protected until it has been read.
    pub(crate) fn named(path: PathBuf) -> Self {
        let protected = path.symlink_metadata().is_ok().then_some(text::memory::NOT_READ_YET);
        Self { path, unknown: Value::Null, protected }
    }

    /// Creates the session of a file that was just written.
    fn written(path: &Path) -> Self {
        Self { path: path.to_owned(), unknown: Value::Null, protected: None }
    }

    /// Path of the session file.
    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// Path of the file and the reason for its protection, if it is protected.
    pub(crate) fn protection(&self) -> Option<(&Path, &'static str)> {
        Some((&self.path, self.protected?))
    }

    /// Decides on the protection by the record found in the file, and keeps its unknown fields.
    pub(crate) fn found(&mut self, record: Option<&Record>) {
        let Some(record) = record else {
            self.protected = Some(text::memory::NO_SESSION);
            return;
        };
        self.unknown = record.unknown();
        let is_json = self.path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("json"));
        self.protected = match record.schema() {
            Some(schema) if schema > u64::from(SCHEMA) => Some(text::memory::NEWER_SESSION),
            Some(_) if record.was_cut() => Some(text::memory::NOT_UNDERSTOOD),
            Some(_) if is_json => None,
            _ => Some(text::memory::NO_SESSION),
        };
    }

    /// Protects a file whose record cannot be applied to the settings.
    pub(crate) fn not_understood(&mut self) {
        self.protected = Some(text::memory::NOT_UNDERSTOOD);
    }

    /// Writes a look to a file. Over the session itself, its unknown fields are preserved.
    pub(crate) fn save(
        session: &mut Option<Self>,
        path: &Path,
        settings: &Settings,
        volume: Option<&VolumeRecord>,
    ) -> Result<(), String> {
        let unknown = session.as_ref().filter(|session| session.path == path).map(|session| &session.unknown);
        let text = Record::text_with(settings, volume, None, unknown.unwrap_or(&Value::Null));
        files::write_with_backup(path, text.as_bytes())?;
        match session {
            Some(session) if session.path == path => session.protected = None,
            _ => *session = Some(Self::written(path)),
        }
        Ok(())
    }
}
