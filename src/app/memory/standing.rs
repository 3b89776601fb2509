//! Which way up things stood that were opened from a folder, in all windows of this user: the next file from there
//! stands the same way.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::kept_list;
use super::recent::{path_of, text_of};
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

/// The list of a folder, the latest first; with a notice if it was damaged and has been put aside.
pub(super) fn read(folder: &Path) -> (Vec<Standing>, Option<String>) {
    let (list, notice) = kept_list::read::<Written>(&path(folder));
    (list.into_iter().take(MOST).map(Standing::from).collect(), notice)
}

fn path(folder: &Path) -> PathBuf {
    folder.join("standing.json")
}

/// A list with what was chosen last at its head.
pub(super) fn put_first(list: &mut Vec<Standing>, latest: Standing) {
    list.retain(|known| known.folder != latest.folder);
    list.insert(0, latest);
    list.truncate(MOST);
}

/// Adds to the list of a folder, the latest last. What another window has added stays.
pub(super) fn add(folder: &Path, chosen: Vec<Standing>) -> Result<(), String> {
    kept_list::change::<Written>(&path(folder), |list| {
        let mut list: Vec<_> = list.into_iter().map(Standing::from).collect();
        for latest in chosen {
            put_first(&mut list, latest);
        }
        list.iter().map(Written::from).collect()
    })
}
