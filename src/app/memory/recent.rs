//! Files that were opened, in all windows of this user.

use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::damaged;
use crate::data::load::Choice;
use crate::data::read_small;
use crate::export::{hold_lock, write_atomically};
use crate::model::{decode_path, encode_path};

/// What names that are no text begin with in the file, all bytes of which are written after it. No other entry does:
/// they are paths from the root.
const IN_BYTES: &str = "file://";

/// A file that was opened, and which of its volumes was, where it holds several.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct RecentFile {
    /// Where it is.
    pub path: PathBuf,
    /// What was opened of it last.
    pub choice: Choice,
}

/// What of a file of several volumes was opened, as it is written: beside the list, which earlier versions read too.
#[derive(Debug, Serialize, Deserialize)]
struct Chosen {
    file: String,
    choice: Choice,
}

impl Chosen {
    fn of(file: &RecentFile) -> Self {
        Self { file: text_of(&file.path), choice: file.choice.clone() }
    }
}

/// The file of what was opened of files that hold several volumes.
const CHOSEN: &str = "chosen.json";

/// Files that the menu offers.
pub(super) const MOST: usize = 12;

/// The list of a folder, the latest first; with a notice if it was damaged and has been put aside.
pub(super) fn read(folder: &Path) -> (Vec<RecentFile>, Option<String>) {
    let path = folder.join("recent.json");
    let found = match read_small(&path) {
        // Also where the folder is none: that is said when the run begins.
        Err(err) if matches!(err.kind(), ErrorKind::NotFound | ErrorKind::NotADirectory) => {
            return (Vec::new(), None);
        }
        found => found.ok(),
    };
    match found.and_then(|bytes| serde_json::from_slice::<Vec<String>>(&bytes).ok()) {
        Some(list) => {
            let chosen = read_small(&folder.join(CHOSEN)).ok();
            // Without it, the first volume of each is opened.
            let chosen = chosen.and_then(|bytes| serde_json::from_slice::<Vec<Chosen>>(&bytes).ok());
            let chosen = chosen.unwrap_or_default();
            let choice_of = |text: &String| {
                let known = chosen.iter().find(|known| known.file == *text);
                known.map(|known| known.choice.clone()).unwrap_or_default()
            };
            let file = |text: &String| RecentFile { path: path_of(text), choice: choice_of(text) };
            (list.iter().map(file).collect(), None)
        }
        None => (Vec::new(), Some(damaged::put_aside(&path))),
    }
}

/// An entry as it is written.
pub(super) fn text_of(path: &Path) -> String {
    match encode_path(path) {
        Some(bytes) => format!("{IN_BYTES}{bytes}"),
        None => path.display().to_string(),
    }
}

/// What an entry stands for.
pub(super) fn path_of(text: &str) -> PathBuf {
    text.strip_prefix(IN_BYTES).and_then(decode_path).unwrap_or_else(|| text.into())
}

/// A list with a file at its head.
pub(super) fn put_first(list: &mut Vec<RecentFile>, latest: RecentFile) {
    list.retain(|known| known.path != latest.path);
    list.insert(0, latest);
    list.truncate(MOST);
}

/// Adds files to the list of a folder, the latest last, and gives it. What another window has added stays.
pub(super) fn add(folder: &Path, opened: &[RecentFile]) -> Result<Vec<RecentFile>, String> {
    // Between reading and writing nobody else writes. Without locks, two windows must be quick to lose an entry.
    let _lock = hold_lock(&folder.join("recent.lock")).map_err(|err| err.to_string())?;
    let (mut list, _) = read(folder);
    for latest in opened {
        put_first(&mut list, latest.clone());
    }
    let chosen: Vec<_> = list.iter().filter(|file| !file.choice.is_empty()).map(Chosen::of).collect();
    let paths: Vec<_> = list.iter().map(|file| text_of(&file.path)).collect();
    let text = serde_json::to_string_pretty(&paths).map_err(|err| err.to_string())?;
    write_atomically(&folder.join("recent.json"), text.as_bytes()).map_err(|err| err.to_string())?;
    let text = serde_json::to_string_pretty(&chosen).map_err(|err| err.to_string())?;
    write_atomically(&folder.join(CHOSEN), text.as_bytes()).map_err(|err| err.to_string())?;
    Ok(list)
}
