//! List of recent files, shared by all windows of this user.

use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::quarantine;
use chiaroscuro_files::{hold_lock, read_small_file, write_atomically};
use chiaroscuro_scene::{decode_path, encode_path};
use chiaroscuro_volume::VolumeChoice;

/// Prefix of paths that are not valid text, all bytes of which are encoded after it. Other entries are absolute
/// paths, which never begin with it.
const ENCODED_PREFIX: &str = "file://";

/// File that was opened, and the volume chosen in it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct RecentFile {
    /// Absolute path of the file.
    pub path: PathBuf,
    /// Choice among the volumes of the file.
    pub choice: VolumeChoice,
}

/// Choice of a volume as JSON: in a file beside the list, since earlier versions read the list, too.
#[derive(Debug, Serialize, Deserialize)]
struct RecentChoiceJson {
    file: String,
    choice: VolumeChoice,
}

impl RecentChoiceJson {
    fn from_recent_file(file: &RecentFile) -> Self {
        Self { file: encode_entry(&file.path), choice: file.choice.clone() }
    }
}

/// File with the choices of files that hold several volumes.
const CHOICES_FILE: &str = "chosen.json";

/// Maximum number of recent files in the menu.
pub(super) const MAX_RECENT_FILES: usize = 12;

/// Reads the list from a folder, the latest first; returns a notice if it was corrupt and was quarantined.
pub(super) fn read(folder: &Path) -> (Vec<RecentFile>, Option<String>) {
    let path = folder.join("recent.json");
    let found = match read_small_file(&path) {
        // A folder that is none is reported when the run begins.
        Err(err) if matches!(err.kind(), ErrorKind::NotFound | ErrorKind::NotADirectory) => {
            return (Vec::new(), None);
        }
        found => found.ok(),
    };
    match found.and_then(|bytes| serde_json::from_slice::<Vec<String>>(&bytes).ok()) {
        Some(list) => {
            let chosen = read_small_file(&folder.join(CHOICES_FILE)).ok();
            // Without it, the first volume of each file is opened.
            let chosen =
                chosen.and_then(|bytes| serde_json::from_slice::<Vec<RecentChoiceJson>>(&bytes).ok());
            let chosen = chosen.unwrap_or_default();
            let choice_of = |text: &String| {
                let known = chosen.iter().find(|known| known.file == *text);
                known.map(|known| known.choice.clone()).unwrap_or_default()
            };
            let file = |text: &String| RecentFile { path: decode_entry(text), choice: choice_of(text) };
            (list.iter().map(file).collect(), None)
        }
        None => (Vec::new(), Some(quarantine::quarantine(&path))),
    }
}

/// Encodes a path as an entry of the list.
pub(super) fn encode_entry(path: &Path) -> String {
    match encode_path(path) {
        Some(bytes) => format!("{ENCODED_PREFIX}{bytes}"),
        None => path.display().to_string(),
    }
}

/// Decodes an entry of the list to a path.
pub(super) fn decode_entry(text: &str) -> PathBuf {
    text.strip_prefix(ENCODED_PREFIX).and_then(decode_path).unwrap_or_else(|| text.into())
}

/// Puts a file at the head of a list, which is cut at [`MAX_RECENT_FILES`].
pub(super) fn put_first(list: &mut Vec<RecentFile>, latest: RecentFile) {
    list.retain(|known| known.path != latest.path);
    list.insert(0, latest);
    list.truncate(MAX_RECENT_FILES);
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
    let chosen: Vec<_> =
        list.iter().filter(|file| !file.choice.is_empty()).map(RecentChoiceJson::from_recent_file).collect();
    let paths: Vec<_> = list.iter().map(|file| encode_entry(&file.path)).collect();
    let text = serde_json::to_string_pretty(&paths).map_err(|err| err.to_string())?;
    write_atomically(&folder.join("recent.json"), text.as_bytes()).map_err(|err| err.to_string())?;
    let text = serde_json::to_string_pretty(&chosen).map_err(|err| err.to_string())?;
    write_atomically(&folder.join(CHOICES_FILE), text.as_bytes()).map_err(|err| err.to_string())?;
    Ok(list)
}
