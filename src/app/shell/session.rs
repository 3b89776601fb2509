//! The session file: what Ctrl+S writes, and what it does not overwrite.

use std::path::{Path, PathBuf};

use serde_json::Value;

use crate::app::text;
use crate::app::windows::files;
use crate::model::{Record, SCHEMA, Settings, VolumeRecord};

/// A file that the look is saved to.
#[derive(Debug)]
pub(crate) struct Session {
    path: PathBuf,
    /// What it says that this version does not know, which is written again.
    unknown: Value,
    /// Why it is not overwritten.
    protected: Option<&'static str>,
}

impl Session {
    /// A file that was named when the program was started: what is there has to be read first.
    pub(crate) fn named(path: PathBuf) -> Self {
        let protected = path.symlink_metadata().is_ok().then_some(text::memory::NOT_READ_YET);
        Self { path, unknown: Value::Null, protected }
    }

    /// A file that was just written.
    fn written(path: &Path) -> Self {
        Self { path: path.to_owned(), unknown: Value::Null, protected: None }
    }

    /// Where it is.
    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// Where it is and why it must stay as it is, if it must.
    pub(crate) fn protection(&self) -> Option<(&Path, &'static str)> {
        Some((&self.path, self.protected?))
    }

    /// What was found there.
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

    /// A record was read there, but cannot be laid over the settings.
    pub(crate) fn not_understood(&mut self) {
        self.protected = Some(text::memory::NOT_UNDERSTOOD);
    }

    /// Writes a look to a file: over the session itself with what that says beside the settings.
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
