//! List of corrected files, shared by all windows of this user.
//!
//! A file is opened again with its last corrections.

use std::path::{Path, PathBuf};
use std::time::UNIX_EPOCH;

use serde::{Deserialize, Serialize};

use super::recent_files::{decode_entry, encode_entry};
use super::shared_list;
use chiaroscuro_volume::Corrections;

/// Maximum number of remembered files: some hundred bytes each, and more than a user corrects in a year.
pub(super) const MAX_CORRECTED_FILES: usize = 500;

/// Size and modification time of a file, which are known without reading it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub(crate) struct FileStamp {
    bytes: Option<u64>,
    modified_ns: Option<u64>,
}

impl FileStamp {
    /// Returns the stamp of a file as it is now.
    pub(crate) fn read(file: &Path) -> Self {
        let Ok(facts) = std::fs::metadata(file) else { return Self::default() };
        let modified = facts.modified().ok().and_then(|time| time.duration_since(UNIX_EPOCH).ok());
        let modified_ns = modified.and_then(|since| u64::try_from(since.as_nanos()).ok());
        Self { bytes: Some(facts.len()), modified_ns }
    }

    /// Returns true if both stamps are complete and equal.
    fn is_same(self, other: Self) -> bool {
        self.bytes.is_some() && self.modified_ns.is_some() && self == other
    }
}

/// File with its last corrections.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct CorrectedFile {
    file: PathBuf,
    stamp: FileStamp,
    opened_id: u64,
    corrections: Corrections,
}

impl CorrectedFile {
    /// Creates an entry for a file, given by its absolute path.
    pub(super) fn new(file: PathBuf, stamp: FileStamp, opened_id: u64, by: Corrections) -> Self {
        Self { file, stamp, opened_id, corrections: by }
    }

    /// Returns the corrections for an opened volume, if its file is unmodified or holds the same volume nevertheless.
    pub(crate) fn corrections_for(&self, stamp: FileStamp, opened_id: u64) -> Option<Corrections> {
        (self.stamp.is_same(stamp) || self.opened_id == opened_id).then_some(self.corrections)
    }

    /// Returns true if the entry is of this file.
    pub(super) fn is_of_file(&self, file: &Path) -> bool {
        self.file == file
    }
}

/// Entry of the list as JSON.
#[derive(Debug, Serialize, Deserialize)]
struct CorrectedFileJson {
    file: String,
    #[serde(flatten)]
    stamp: FileStamp,
    content_id: String,
    corrections: Corrections,
}

impl From<&CorrectedFile> for CorrectedFileJson {
    fn from(known: &CorrectedFile) -> Self {
        let CorrectedFile { file, stamp, opened_id, corrections: by } = known;
        let content_id = format!("{opened_id:016x}");
        Self { file: encode_entry(file), stamp: *stamp, content_id, corrections: *by }
    }
}

impl From<CorrectedFileJson> for CorrectedFile {
    fn from(written: CorrectedFileJson) -> Self {
        let CorrectedFileJson { file, stamp, content_id, corrections: mut by } = written;
        by.sanitise();
        // An invalid identifier becomes 0, which is that of no volume.
        let opened_id = u64::from_str_radix(&content_id, 16).unwrap_or_default();
        Self { file: decode_entry(&file), stamp, opened_id, corrections: by }
    }
}

/// Reads the list from a folder, the latest first; returns a notice if it was corrupt and was quarantined.
pub(super) fn read(folder: &Path) -> (Vec<CorrectedFile>, Option<String>) {
    let (list, notice) = shared_list::read::<CorrectedFileJson>(&path(folder));
    (list.into_iter().take(MAX_CORRECTED_FILES).map(CorrectedFile::from).collect(), notice)
}

fn path(folder: &Path) -> PathBuf {
    folder.join("corrected.json")
}

/// Puts the latest corrections of a file at the head of a list; removes the file if it has none.
pub(super) fn put_first(list: &mut Vec<CorrectedFile>, latest: CorrectedFile) {
    list.retain(|known| known.file != latest.file);
    if !latest.corrections.is_none() {
        list.insert(0, latest);
    }
    list.truncate(MAX_CORRECTED_FILES);
}

/// Adds entries to the list in a folder, the latest last. Entries of other windows stay.
pub(super) fn add(folder: &Path, chosen: Vec<CorrectedFile>) -> Result<(), String> {
    shared_list::change::<CorrectedFileJson>(&path(folder), |list| {
        let mut list: Vec<_> = list.into_iter().map(CorrectedFile::from).collect();
        for latest in chosen {
            put_first(&mut list, latest);
        }
        list.iter().map(CorrectedFileJson::from).collect()
    })
}
