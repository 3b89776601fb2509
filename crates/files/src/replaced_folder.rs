//! Writing of folders under their final names, which replaces nothing but hierarchies of Zarr.
//!
//! A folder of that name is first moved aside, and removed after the new one is in its place.

use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use super::atomic_write::parent_folder;
use super::temporary_file::{self, FOLDER_SUFFIX};
use super::temporary_folder::TemporaryFolder;
use crate::error::WriteError;
use crate::fault::{self, InjectedFault};
use crate::program_mark::{is_written_by_us, other_file_in_hierarchy};

/// Suffix of the name of a folder that is being replaced: it is removed by nothing else, in case that the program ends
/// at that moment.
const REPLACED_SUFFIX: &str = ".replaced";

/// Checks that a folder can be written under a name, before the work that is to be written begins.
///
/// A folder of that name is replaced if this program wrote all of it; with `replaces_others` any hierarchy of Zarr is.
///
/// # Errors
/// When the name belongs to something that must not be replaced, or the folder above it cannot be written to.
pub fn check_folder_writable(path: &Path, replaces_others: bool) -> Result<(), WriteError> {
    check_replaceable(path, replaces_others)?;
    temporary_folder_for(path).map(drop)
}

/// Creates a temporary folder for `path`, beside it.
///
/// # Errors
/// When the folder above cannot be written to.
pub fn temporary_folder_for(path: &Path) -> Result<TemporaryFolder, WriteError> {
    let failed = |kind: ErrorKind| WriteError::Io { path: path.to_owned(), source: kind.into() };
    if fault::is_on(InjectedFault::FullDisk) {
        return Err(failed(ErrorKind::StorageFull));
    }
    TemporaryFolder::create_locked(parent_folder(path)).map_err(|error| failed(error.kind()))
}

/// Gives a complete temporary folder its final name, in place of a folder that may be replaced.
///
/// # Errors
/// Under the conditions of [`check_folder_writable`]; then the folder of that name is still there.
pub fn rename_folder_into_place(
    folder: TemporaryFolder,
    path: &Path,
    replaces_others: bool,
) -> Result<(), WriteError> {
    let failed = WriteError::io_error_for(path);
    folder.sync().map_err(&failed)?;
    let is_there = check_replaceable(path, replaces_others)?;
    let aside = if is_there { Some(move_aside(path)?) } else { None };
    if let Err(error) = folder.rename_to(path) {
        if let Some(aside) = aside {
            // If even that fails, the folder stays beside its place, under a name that tells it.
            std::fs::rename(aside, path).ok();
        }
        return Err(failed(error));
    }
    std::fs::File::open(parent_folder(path)).and_then(|parent| parent.sync_all()).ok();
    if let Some(aside) = aside {
        remove_replaced(&aside);
    }
    Ok(())
}

/// Returns true if there is a folder of that name, which may be replaced, and false if there is nothing.
fn check_replaceable(path: &Path, replaces_others: bool) -> Result<bool, WriteError> {
    let unfit = |what| Err(WriteError::Unsupported { what, path: path.to_owned() });
    // Problems of the folder above show when a folder is created in it.
    let Ok(found) = std::fs::symlink_metadata(path) else { return Ok(false) };
    if found.is_symlink() {
        return unfit("it is a link; choose the name of the folder itself");
    }
    if !found.is_dir() {
        return unfit("there is a file of that name, where a folder is written; choose another name");
    }
    if is_written_by_us(path) {
        return Ok(true);
    }
    if !replaces_others {
        return unfit(
            "there is a folder of that name, not written by this program alone; choose another name",
        );
    }
    match other_file_in_hierarchy(path) {
        Ok(None) => Ok(true),
        Ok(Some(_)) => {
            unfit("there is a folder of that name with other files than those of Zarr; choose another name")
        }
        Err(error) => Err(WriteError::io_error_for(path)(error)),
    }
}

/// Renames a folder to a name beside it, which nothing has, and returns its path.
fn move_aside(path: &Path) -> Result<PathBuf, WriteError> {
    let mut builder = temporary_file::name_builder();
    builder.suffix(REPLACED_SUFFIX);
    // Folders can be renamed to the name of an empty one.
    let renamed = builder.tempdir_in(parent_folder(path)).and_then(|place| {
        std::fs::remove_dir(place.path()).and_then(|()| std::fs::rename(path, place.path()))?;
        Ok(place.keep())
    });
    renamed.map_err(WriteError::io_error_for(path))
}

/// Removes a folder that was replaced. Its name is that of an abandoned one meanwhile, so that it goes in any case.
fn remove_replaced(aside: &Path) {
    let mut name = aside.file_name().unwrap_or_default().to_owned();
    name.push(FOLDER_SUFFIX);
    let doomed = aside.with_file_name(name);
    if std::fs::rename(aside, &doomed).is_ok() {
        std::fs::remove_dir_all(&doomed).ok();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::provenance::provenance_mark;

    fn write(path: &Path, replaces_others: bool) -> Result<(), WriteError> {
        check_folder_writable(path, replaces_others)?;
        let folder = temporary_folder_for(path)?;
        let root = format!(r#"{{"attributes":{{"chiaroscuro":"{}"}}}}"#, provenance_mark());
        folder.append("zarr.json", root.as_bytes()).unwrap();
        rename_folder_into_place(folder, path, replaces_others)
    }

    #[test]
    fn only_hierarchies_are_replaced() {
        let parent = tempfile::tempdir().unwrap();
        let count = || std::fs::read_dir(parent.path()).unwrap().count();
        let path = parent.path().join("a.ome.zarr");
        write(&path, false).unwrap();
        write(&path, false).unwrap();
        assert_eq!(count(), 1, "neither the old one nor a temporary one is left");
        // Somebody has added labels.
        std::fs::create_dir(path.join("labels")).unwrap();
        std::fs::write(path.join("labels/zarr.json"), "{}").unwrap();
        let said = write(&path, false).unwrap_err().to_string();
        assert!(said.contains("not written by this program alone"), "{said}");
        std::fs::write(path.join("notes.txt"), "mine").unwrap();
        assert!(write(&path, true).unwrap_err().to_string().contains("other files than those of Zarr"));
        assert!(path.join("labels/zarr.json").exists() && path.join("notes.txt").exists());
        std::fs::remove_file(path.join("notes.txt")).unwrap();
        write(&path, true).unwrap();
        assert!(!path.join("labels").exists() && count() == 1);
        let file = parent.path().join("b.ome.zarr");
        std::fs::write(&file, "a file").unwrap();
        assert!(write(&file, true).unwrap_err().to_string().contains("there is a file"));
        assert!(write(&parent.path().join("no/such/c.zarr"), true).is_err());
        #[cfg(unix)]
        {
            let link = parent.path().join("link");
            std::os::unix::fs::symlink(&path, &link).unwrap();
            assert!(write(&link, true).unwrap_err().to_string().contains("it is a link"));
        }
    }

    #[test]
    fn unfinished_folders_leave_nothing() {
        let parent = tempfile::tempdir().unwrap();
        let folder = temporary_folder_for(&parent.path().join("a.zarr")).unwrap();
        folder.append("0/c/0/0/0", b"half").unwrap();
        drop(folder);
        assert_eq!(std::fs::read_dir(parent.path()).unwrap().count(), 0);
    }
}
