//! JSON lists that all windows of this user share, one file each, the latest entry first.

use std::io::ErrorKind;
use std::path::Path;

use serde::Serialize;
use serde::de::DeserializeOwned;

use super::quarantine;
use chiaroscuro_files::{hold_lock, read_small_file, write_atomically};

/// Reads the list in a file; returns a notice if it was corrupt and was quarantined.
pub(super) fn read<T: DeserializeOwned>(path: &Path) -> (Vec<T>, Option<String>) {
    let found = match read_small_file(path) {
        // A folder that is none is reported when the run begins.
        Err(err) if matches!(err.kind(), ErrorKind::NotFound | ErrorKind::NotADirectory) => {
            return (Vec::new(), None);
        }
        found => found.ok(),
    };
    match found.and_then(|bytes| serde_json::from_slice::<Vec<T>>(&bytes).ok()) {
        Some(list) => (list, None),
        None => (Vec::new(), Some(quarantine::quarantine(path))),
    }
}

/// Changes the list in a file, while a lock keeps other windows from changing it.
pub(super) fn change<T: DeserializeOwned + Serialize>(
    path: &Path,
    change: impl FnOnce(Vec<T>) -> Vec<T>,
) -> Result<(), String> {
    // Without locks, two windows lose an entry only if they write at nearly the same time.
    let _lock = hold_lock(&path.with_extension("lock")).map_err(|err| err.to_string())?;
    let (list, _) = read(path);
    let text = serde_json::to_string_pretty(&change(list)).map_err(|err| err.to_string())?;
    write_atomically(path, text.as_bytes()).map_err(|err| err.to_string())
}
