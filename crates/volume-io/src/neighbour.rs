//! Neighbours of a volume on disk: the next or previous file of its folder, or for a folder of slices the next
//! folder.

use std::path::{Path, PathBuf};

use super::formats::{dicom, reader_of};
use super::reading::input::InputFile;
use super::reading::reader::FileStart;
use chiaroscuro_files::natural_sort_key;
use chiaroscuro_volume::{LoadContext, LoadControl};

/// Maximum number of entries of a folder: as many as a folder of slices may have.
const MAX_ENTRIES: usize = 1 << 16;

/// Extensions of raw data that a header beside them may describe.
const DATA_EXTENSIONS: [&str; 8] = [".raw.gz", ".raw", ".zraw", ".img.gz", ".img", ".bin", ".data", ".tri"];

/// Extensions of headers of raw data.
const HEADER_EXTENSIONS: [&str; 6] = [".nhdr", ".mhd", ".hdr", ".dat", ".ini", ".ivf"];

/// Next or previous volume in natural order; `None` after the last.
///
/// It is the nearest file of the same folder that a reader recognises by content or extension; for a folder, the
/// nearest sibling that contains such a file. Data that a header describes, and slices of the series that is open, do
/// not count; `is_wanted` can exclude further files.
pub fn neighbour_volume(
    path: &Path,
    is_forward: bool,
    is_wanted: impl Fn(&Path) -> bool,
    control: &LoadControl,
) -> Option<PathBuf> {
    let path = std::path::absolute(path).ok()?;
    let is_folder = path.is_dir();
    let entries = entries(path.parent()?, is_folder);
    let at = entries.iter().position(|entry| entry.file_name() == path.file_name())?;
    let series = if is_folder { None } else { dicom::series_uid(&path, control) };
    let is_next = |candidate: &&PathBuf| {
        if is_folder {
            // A few files are enough to judge a folder.
            const EXAMINED_FILES: usize = 100;
            return self::entries(candidate, false).iter().take(EXAMINED_FILES).any(|file| is_known(file));
        }
        is_known(candidate)
            && !is_described(candidate, &entries)
            && (series.is_none() || dicom::series_uid(candidate, control) != series)
            && is_wanted(candidate)
    };
    let is_going_on = |_: &&PathBuf| !control.is_cancelled();
    if is_forward {
        entries[at + 1..].iter().take_while(is_going_on).find(is_next).cloned()
    } else {
        entries[..at].iter().rev().take_while(is_going_on).find(is_next).cloned()
    }
}

/// Lists the files of a folder in natural order; hidden ones are left out.
pub(super) fn files_of_folder(folder: &Path) -> Vec<PathBuf> {
    entries(folder, false)
}

/// Lists the files of a folder, or its folders, in natural order; hidden ones are left out.
fn entries(folder: &Path, are_folders: bool) -> Vec<PathBuf> {
    let found = std::fs::read_dir(folder).into_iter().flatten().flatten().take(MAX_ENTRIES);
    let name = |path: &Path| path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let mut paths: Vec<PathBuf> = found
        .map(|entry| entry.path())
        .filter(|path| !name(path).starts_with('.'))
        .filter(|path| if are_folders { path.is_dir() } else { path.is_file() })
        .collect();
    paths.sort_by_cached_key(|path| (natural_sort_key(&name(path)), path.clone()));
    paths
}

/// Returns true if a reader recognises the file.
fn is_known(path: &Path) -> bool {
    let context = LoadContext { operation: "look at the file", path };
    let Ok(mut input) = InputFile::open(context) else { return false };
    FileStart::read(&mut input).is_ok_and(|start| reader_of(path, &start).is_some())
}

/// Returns true if a file holds the voxels of a header of the same name.
fn is_described(path: &Path, entries: &[PathBuf]) -> bool {
    let lower = |path: &Path| path.file_name().unwrap_or_default().to_string_lossy().to_lowercase();
    let name = lower(path);
    let Some(stem) = DATA_EXTENSIONS.iter().find_map(|ending| name.strip_suffix(ending)) else {
        return false;
    };
    entries.iter().any(|entry| {
        let other = lower(entry);
        HEADER_EXTENSIONS.iter().any(|ending| other.strip_suffix(ending) == Some(stem))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn next(path: &Path, is_forward: bool) -> Option<String> {
        let found = neighbour_volume(path, is_forward, |_| true, &LoadControl::new());
        found.map(|path| path.file_name().unwrap().to_string_lossy().into_owned())
    }

    #[test]
    fn files_that_readers_know_come_in_natural_order() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        for name in ["a2.nrrd", "a10.nrrd", "a3.txt", "b.nhdr", "b.raw", "c.raw", ".hidden.nrrd"] {
            std::fs::write(path(name), "x").unwrap();
        }
        // Recognised only by its content.
        std::fs::write(path("a9"), "NRRD0004\n").unwrap();
        let mut seen = vec!["a2.nrrd".to_owned()];
        while let Some(name) = next(&path(seen.last().unwrap()), true) {
            seen.push(name);
        }
        assert_eq!(seen, ["a2.nrrd", "a9", "a10.nrrd", "b.nhdr", "c.raw"]);
        assert_eq!(next(&path("a10.nrrd"), false).as_deref(), Some("a9"));
        assert_eq!((next(&path("a2.nrrd"), false), next(&path("gone.nrrd"), true)), (None, None));
        let other =
            neighbour_volume(&path("a2.nrrd"), true, |path| !path.ends_with("a9"), &LoadControl::new());
        assert_eq!(other, Some(path("a10.nrrd")), "what is not wanted is passed over");
        let stopped = LoadControl::new();
        stopped.cancel();
        assert_eq!(neighbour_volume(&path("a2.nrrd"), true, |_| true, &stopped), None);
    }

    #[test]
    fn a_folder_is_followed_by_a_folder_with_something_in_it() {
        let folder = tempfile::tempdir().unwrap();
        for name in ["s1", "s2", "s10", "s3.png"] {
            std::fs::create_dir(folder.path().join(name)).unwrap();
        }
        for name in ["s1/a.png", "s10/a.png", "s2/notes.txt"] {
            std::fs::write(folder.path().join(name), "x").unwrap();
        }
        assert_eq!(next(&folder.path().join("s1"), true).as_deref(), Some("s10"));
        assert_eq!(next(&folder.path().join("s10"), true), None);
    }
}
