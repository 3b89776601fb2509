//! Listing of the files in a folder, and in the folders within it.

use std::path::{Path, PathBuf};

use chiaroscuro_files::natural_sort_key;
use chiaroscuro_volume::{LoadContext, LoadControl, LoadError};

/// Maximum number of files: eight times the slices of the longest scans.
const MAX_FILES: usize = 1 << 16;

/// Maximum number of entries in nested folders, folders included: some exports have a folder for each slice.
const MAX_ENTRIES: usize = 2 * MAX_FILES;

/// Maximum nesting depth of folders: media have patients, studies, series and parts of these.
const MAX_DEPTH: usize = 12;

/// Lists the regular files of a folder, following links, in natural order: `slice 9` before `slice 10`. Hidden files
/// are left out.
///
/// # Errors
/// `Io` where the folder cannot be read, `Limit` where it has more files than any volume has slices.
pub(super) fn list_files(context: LoadContext<'_>, control: &LoadControl) -> Result<Vec<PathBuf>, LoadError> {
    let mut files = Vec::new();
    for entry in std::fs::read_dir(context.path).map_err(|error| context.io_error(error))? {
        control.check()?;
        let entry = entry.map_err(|error| context.io_error(error))?;
        let is_hidden = entry.file_name().to_string_lossy().starts_with('.');
        if is_hidden || !entry.path().is_file() {
            continue;
        }
        if files.len() == MAX_FILES {
            return Err(context.limit_error(
                "files",
                format!("there are more than {MAX_FILES} files in it"),
                "put the slices of one volume into a folder of their own",
            ));
        }
        files.push(entry.path());
    }
    sort_naturally(&mut files);
    Ok(files)
}

/// Files in the folders within a folder.
#[derive(Debug, Default)]
pub(super) struct NestedFiles {
    /// Paths of the files, folder by folder, in natural order.
    pub(super) files: Vec<PathBuf>,
    /// True if the limits on number or depth left files out.
    is_truncated: bool,
    /// Number of folders that could not be read.
    unreadable: usize,
}

impl NestedFiles {
    /// Remarks for the user on files that were left out.
    pub(super) fn remarks(&self) -> Vec<String> {
        let cut = self.is_truncated.then(|| {
            format!(
                "only {} files in its subfolders were examined, and there are more: open one of the subfolders",
                self.files.len()
            )
        });
        let unreadable = (self.unreadable > 0)
            .then(|| format!("{} subfolders cannot be read: they are left out", self.unreadable));
        cut.into_iter().chain(unreadable).collect()
    }
}

/// Lists the regular files of all folders within a folder, within the limits on number and depth; hidden ones are
/// left out. Links to folders are not followed: they may form cycles.
///
/// # Errors
/// `Cancelled` only: unreadable folders are counted.
pub(super) fn list_nested_files(path: &Path, control: &LoadControl) -> Result<NestedFiles, LoadError> {
    let mut nested = NestedFiles::default();
    let mut entries_left = MAX_ENTRIES;
    // Stack of folders to visit.
    let mut open = vec![(path.to_owned(), 0)];
    while let Some((folder, depth)) = open.pop() {
        control.check()?;
        let Ok(entries) = std::fs::read_dir(&folder) else {
            nested.unreadable += usize::from(depth > 0);
            continue;
        };
        let (mut files, mut folders) = (Vec::new(), Vec::new());
        for entry in entries.flatten() {
            control.check()?;
            let Ok(kind) = entry.file_type() else { continue };
            if entry.file_name().to_string_lossy().starts_with('.') || depth == 0 && !kind.is_dir() {
                continue;
            }
            if entries_left == 0 {
                nested.is_truncated = true;
                break;
            }
            entries_left -= 1;
            if kind.is_dir() {
                folders.push(entry.path());
            } else if entry.path().is_file() {
                files.push(entry.path());
            }
        }
        sort_naturally(&mut files);
        let room = MAX_FILES - nested.files.len();
        nested.is_truncated |= files.len() > room;
        nested.files.extend(files.into_iter().take(room));
        if depth == MAX_DEPTH {
            nested.is_truncated |= !folders.is_empty();
            continue;
        }
        sort_naturally(&mut folders);
        open.extend(folders.into_iter().rev().map(|folder| (folder, depth + 1)));
    }
    Ok(nested)
}

/// Sorts the paths of one folder in natural order.
fn sort_naturally(paths: &mut [PathBuf]) {
    paths
        .sort_by_cached_key(|path| natural_sort_key(&path.file_name().unwrap_or_default().to_string_lossy()));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn folders_within_are_looked_through() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path();
        for name in ["b10/c", "b9", ".hidden"] {
            std::fs::create_dir_all(path.join(name)).unwrap();
        }
        for name in ["a", "b9/2", "b10/x10", "b10/x9", "b10/.y", "b10/c/z", ".hidden/a"] {
            std::fs::write(path.join(name), "x").unwrap();
        }
        let found = list_nested_files(path, &LoadControl::new()).unwrap();
        let names: Vec<&Path> = found.files.iter().map(|file| file.strip_prefix(path).unwrap()).collect();
        assert_eq!(names, ["b9/2", "b10/x9", "b10/x10", "b10/c/z"].map(Path::new));
        assert!(found.remarks().is_empty());
    }

    #[cfg(unix)]
    #[test]
    fn links_that_lead_back_are_not_followed() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path();
        std::fs::create_dir(path.join("a")).unwrap();
        std::os::unix::fs::symlink(path, path.join("a/back")).unwrap();
        std::fs::write(path.join("file"), "x").unwrap();
        std::os::unix::fs::symlink(path.join("file"), path.join("a/file")).unwrap();
        let found = list_nested_files(path, &LoadControl::new()).unwrap();
        assert_eq!(found.files, [path.join("a/file")], "links to files are files");
    }

    #[test]
    fn depth_is_bounded_and_said() {
        let folder = tempfile::tempdir().unwrap();
        let deep: PathBuf = (0..=MAX_DEPTH).map(|_| "d").collect();
        std::fs::create_dir_all(folder.path().join(&deep)).unwrap();
        std::fs::write(folder.path().join(deep).join("file"), "x").unwrap();
        let found = list_nested_files(folder.path(), &LoadControl::new()).unwrap();
        assert_eq!(found.files.len(), 0);
        assert!(found.remarks()[0].contains("open one of the subfolders"));
    }
}
