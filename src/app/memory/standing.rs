//! Which way up things stood that were opened from a folder, in all windows of this user: the next file from there
//! stands the same way.

use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::damaged;
use super::recent::{path_of, text_of};
use crate::data::read_small;
use crate::export::{hold_lock, write_atomically};
use crate::model::SceneAxis;

/// Folders that are remembered: more than anybody works in at a time.
pub(super) const MOST: usize = 100;

/// A folder, and the axis that pointed up last.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Standing {
    pub folder: PathBuf,
    pub up: SceneAxis,
}

/// How it is written.
#[derive(Debug, Serialize, Deserialize)]
struct Written {
    folder: String,
    up: SceneAxis,
}

/// The list of a folder, the latest first; with a notice if it was damaged and has been put aside.
pub(super) fn read(folder: &Path) -> (Vec<Standing>, Option<String>) {
    let path = folder.join("standing.json");
    let found = match read_small(&path) {
        // Also where the folder is none: that is said when the run begins.
        Err(err) if matches!(err.kind(), ErrorKind::NotFound | ErrorKind::NotADirectory) => {
            return (Vec::new(), None);
        }
        found => found.ok(),
    };
    match found.and_then(|bytes| serde_json::from_slice::<Vec<Written>>(&bytes).ok()) {
        Some(list) => {
            let standing = |Written { folder, up }: Written| Standing { folder: path_of(&folder), up };
            (list.into_iter().take(MOST).map(standing).collect(), None)
        }
        None => (Vec::new(), Some(damaged::put_aside(&path))),
    }
}

/// A list with what was chosen last at its head.
pub(super) fn put_first(list: &mut Vec<Standing>, latest: Standing) {
    list.retain(|known| known.folder != latest.folder);
    list.insert(0, latest);
    list.truncate(MOST);
}

/// Adds to the list of a folder, the latest last. What another window has added stays.
pub(super) fn add(folder: &Path, chosen: Vec<Standing>) -> Result<(), String> {
    // Between reading and writing nobody else writes. Without locks, two windows must be quick to lose an entry.
    let _lock = hold_lock(&folder.join("standing.lock")).map_err(|err| err.to_string())?;
    let (mut list, _) = read(folder);
    for latest in chosen {
        put_first(&mut list, latest);
    }
    let written = |Standing { folder, up }: &Standing| Written { folder: text_of(folder), up: *up };
    let list: Vec<_> = list.iter().map(written).collect();
    let text = serde_json::to_string_pretty(&list).map_err(|err| err.to_string())?;
    write_atomically(&folder.join("standing.json"), text.as_bytes()).map_err(|err| err.to_string())
}
