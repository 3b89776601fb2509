//! List of the up axes of folders, shared by all windows of this user.
//!
//! The next file of a folder gets the same up axis.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::recent_files::{decode_entry, encode_entry};
use super::shared_list;
use chiaroscuro_scene::SceneAxis;

/// Maximum number of remembered folders: more than a user works in at a time.
pub(super) const MAX_FOLDERS: usize = 100;

/// Folder with the axis that pointed up last.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct FolderOrientation {
    pub folder: PathBuf,
    pub up: SceneAxis,
}

/// Entry of the list as JSON.
#[derive(Debug, Serialize, Deserialize)]
struct FolderOrientationJson {
    folder: String,
    up: SceneAxis,
}

impl From<&FolderOrientation> for FolderOrientationJson {
    fn from(FolderOrientation { folder, up }: &FolderOrientation) -> Self {
        Self { folder: encode_entry(folder), up: *up }
    }
}

impl From<FolderOrientationJson> for FolderOrientation {
    fn from(FolderOrientationJson { folder, up }: FolderOrientationJson) -> Self {
        Self { folder: decode_entry(&folder), up }
    }
}

/// Reads the list from a folder, the latest first; returns a notice if it was corrupt and was quarantined.
pub(super) fn read(folder: &Path) -> (Vec<FolderOrientation>, Option<String>) {
    let (list, notice) = shared_list::read::<FolderOrientationJson>(&path(folder));
    (list.into_iter().take(MAX_FOLDERS).map(FolderOrientation::from).collect(), notice)
}

fn path(folder: &Path) -> PathBuf {
    folder.join("standing.json")
}

/// Puts an entry at the head of a list, which is cut at [`MAX_FOLDERS`].
pub(super) fn put_first(list: &mut Vec<FolderOrientation>, latest: FolderOrientation) {
    list.retain(|known| known.folder != latest.folder);
    list.insert(0, latest);
    list.truncate(MAX_FOLDERS);
}

/// Adds entries to the list in a folder, the latest last. Entries of other windows stay.
pub(super) fn add(folder: &Path, chosen: Vec<FolderOrientation>) -> Result<(), String> {
    shared_list::change::<FolderOrientationJson>(&path(folder), |list| {
        let mut list: Vec<_> = list.into_iter().map(FolderOrientation::from).collect();
        for latest in chosen {
            put_first(&mut list, latest);
        }
        list.iter().map(FolderOrientationJson::from).collect()
    })
}
