//! List of recent files, shared by all windows of this user.

use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::damaged;
use crate::data::load::Choice;
use crate::data::read_small;
use crate::export::{hold_lock, write_atomically};
use crate::model::{decode_path, encode_path};

/// Prefix of paths that are not valid text, all bytes of which are encoded after it. Other entries are absolute
/// paths, which never begin with it.
const IN_BYTES: &str = "file://";

/// File that was opened, and the volume chosen in it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct RecentFile {
    /// Absolute path of the file.
    pub path: PathBuf,
    /// Choice among the volumes of the file.
    pub choice: Choice,
}

/// Choice of a volume as JSON: in a file beside the list, since earlier versions read the list, too.
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

/// File with the choices of files that hold several volumes.
const CHOSEN: &str = "chosen.json";

/// Maximum number of recent files in the menu.
pub(super) const MOST: usize = 12;

/// Reads the list from a folder, the latest first; returns a notice if it was corrupt and was quarantined.
pub(super) fn read(folder: &Path) -> (Vec<RecentFile>, Option<String>) {
    let path = folder.join("recent.json");
    let found = match read_small(&path) {
        // A folder that is none is reported when the run begins.
        Err(err) if matches!(err.kind(), ErrorKind::NotFound | ErrorKind::NotADirectory) => {
            return (Vec::new(), None);
        }
        found => found.ok(),
    };
    match found.and_then(|bytes| serde_json::from_slice::<Vec<String>>(&bytes).ok()) {
        Some(list) => {
            let chosen = read_small(&folder.join(CHOSEN)).ok();
            // Without it, the first volume of each file is opened.
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

/// Encodes a path as an entry of the list.
pub(super) fn text_of(path: &Path) -> String {
    match encode_path(path) {
        Some(bytes) => format!("{IN_BYTES}{bytes}"),
        None => path.display().to_string(),
    }
}

/// Decodes an entry of the list to a path.
pub(super) fn path_of(text: &str) -> PathBuf {
    text.strip_prefix(IN_BYTES).and_then(decode_path).unwrap_or_else(|| text.into())
}

/// Puts a file at the head of a list, which is cut at [`MOST`].
pub(super) fn put_first(list: &mut Vec<RecentFile>, latest: RecentFile) {
    list.retain(|known| known.path != latest.path);
    list.insert(0, latest);
    list.truncate(MOST);
}

/// Adds files to the list in a folder, the latest last, and returns the list. Entries of other windows stay.
pub(super) fn add(folder: &Path, opened: &[RecentFile]) -> Result<Vec<RecentFile>, String> {
    // The lock keeps other windows from writing in between. Without locks, two windows lose an entry only if they
    // write at nearly the same time.
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
