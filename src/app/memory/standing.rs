//! List of the up axes of folders, shared by all windows of this user.
//!
//! The next file of a folder gets the same up axis.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::kept_list;
use super::recent::{path_of, text_of};
use crate::model::SceneAxis;

/// Maximum number of remembered folders: more than a user works in at a time.
pub(super) const MOST: usize = 100;

/// Folder with the axis that pointed up last.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Standing {
    pub folder: PathBuf,
    pub up: SceneAxis,
}

/// Entry of the list as JSON.
#[derive(Debug, Serialize, Deserialize)]
struct Written {
    folder: String,
    up: SceneAxis,
}

impl From<&Standing> for Written {
    fn from(Standing { folder, up }: &Standing) -> Self {
        Self { folder: text_of(folder), up: *up }
    }
}

impl From<Written> for Standing {
    fn from(Written { folder, up }: Written) -> Self {
        Self { folder: path_of(&folder), up }
    }
}

/// Reads the list from a folder, the latest first; returns a notice if it was corrupt and was quarantined.
pub(super) fn read(folder: &Path) -> (Vec<Standing>, Option<String>) {
    let (list, notice) = kept_list::read::<Written>(&path(folder));
    (list.into_iter().take(MOST).map(Standing::from).collect(), notice)
}

fn path(folder: &Path) -> PathBuf {
    folder.join("standing.json")
}

/// Puts an entry at the head of a list, which is cut at [`MOST`].
pub(super) fn put_first(list: &mut Vec<Standing>, latest: Standing) {
    list.retain(|known| known.folder != latest.folder);
    list.insert(0, latest);
    list.truncate(MOST);
}

/// Adds entries to the list in a folder, the latest last. Entries of other windows stay.
pub(super) fn add(folder: &Path, chosen: Vec<Standing>) -> Result<(), String> {
    kept_list::change::<Written>(&path(folder), |list| {
        let mut list: Vec<_> = list.into_iter().map(Standing::from).collect();
        for latest in chosen {
            put_first(&mut list, latest);
        }
        list.iter().map(Written::from).collect()
    })
}
