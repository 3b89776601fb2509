//! Lists that all windows of this user share, in files of their own, the latest entry first.

use std::io::ErrorKind;
use std::path::Path;

use serde::Serialize;
use serde::de::DeserializeOwned;

use super::damaged;
use crate::data::read_small;
use crate::export::{hold_lock, write_atomically};

/// The list of a file; with a notice if it was damaged and has been put aside.
pub(super) fn read<T: DeserializeOwned>(path: &Path) -> (Vec<T>, Option<String>) {
    let found = match read_small(path) {
        // Also where the folder is none: that is said when the run begins.
        Err(err) if matches!(err.kind(), ErrorKind::NotFound | ErrorKind::NotADirectory) => {
            return (Vec::new(), None);
        }
        found => found.ok(),
    };
    match found.and_then(|bytes| serde_json::from_slice::<Vec<T>>(&bytes).ok()) {
        Some(list) => (list, None),
        None => (Vec::new(), Some(damaged::put_aside(path))),
    }
}

/// Changes the list of a file, while no other window does.
pub(super) fn change<T: DeserializeOwned + Serialize>(
    path: &Path,
    change: impl FnOnce(Vec<T>) -> Vec<T>,
) -> Result<(), String> {
    // Without locks, two windows must be quick to lose an entry.
    let _lock = hold_lock(&path.with_extension("lock")).map_err(|err| err.to_string())?;
    let (list, _) = read(path);
    let text = serde_json::to_string_pretty(&change(list)).map_err(|err| err.to_string())?;
    write_atomically(path, text.as_bytes()).map_err(|err| err.to_string())
}
