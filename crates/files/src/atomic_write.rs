//! Atomic writing of files, which never replaces anything but regular files.

use std::io::{ErrorKind, Write as _};
use std::path::{Path, PathBuf};

use super::temporary_file::{self, TemporaryFile};
use crate::error::{OpenFileError, WriteError};
use crate::fault::{self, InjectedFault};

/// Writes a file atomically: to a temporary file in the same folder, which is then renamed.
///
/// # Errors
/// When the folder cannot be written to or the disk is full; an older file of that name stays. Also when the name
/// belongs to something that must not be replaced: a folder, device, pipe, socket or read-only file.
pub fn write_atomically(path: &Path, contents: &[u8]) -> Result<(), WriteError> {
    let mut file = temporary_file_for(path)?;
    file.write_all(contents).map_err(WriteError::io_error_for(path))?;
    rename_into_place(file, path)
}

/// Keeps the present file, if there is one, under its name with `.bak` appended, replacing an older backup: to be
/// called before the file is rewritten.
///
/// # Errors
/// When the file or the backup's name belongs to something that must not be replaced, or the folder cannot be written
/// to; then nothing has changed.
pub fn keep_backup(path: &Path) -> Result<(), WriteError> {
    let failed = WriteError::io_error_for(path);
    let place = final_path(path)?;
    if !place.exists() {
        return Ok(());
    }
    // A hard link takes no time, whatever the size; not all file systems support it.
    let second =
        |name: &Path| std::fs::hard_link(&place, name).or_else(|_| std::fs::copy(&place, name).map(drop));
    let mut name = path.file_name().unwrap_or_default().to_owned();
    name.push(".bak");
    let backup = path.with_file_name(name);
    final_path(&backup)?;
    let kept = temporary_file::name_builder().make_in(parent_folder(&backup), second).map_err(&failed)?;
    kept.into_temp_path().persist(&backup).map_err(|err| failed(err.error))
}

/// Checks that a file has one of the given extensions; under another one it would be taken for a different format,
/// and might replace such a file.
///
/// # Errors
/// Returns `what`, which lists the supported formats, if it has none of them.
pub fn check_extension(path: &Path, endings: &[&str], what: &'static str) -> Result<(), WriteError> {
    let is_one = |found: &std::ffi::OsStr| endings.iter().any(|ending| found.eq_ignore_ascii_case(ending));
    if path.extension().is_some_and(is_one) {
        return Ok(());
    }
    Err(WriteError::Unsupported { what, path: path.to_owned() })
}

/// Checks that a file can be written under a name, before the work that is to be written begins.
///
/// # Errors
/// Under the conditions of [`write_atomically`].
pub fn check_writable(path: &Path) -> Result<(), WriteError> {
    temporary_file_for(path).map(drop)
}

/// Returns the path that writing to a name replaces: the name itself, or the target of a symbolic link.
///
/// # Errors
/// When the name belongs to something that must not be replaced.
fn final_path(path: &Path) -> Result<PathBuf, WriteError> {
    let unfit = |what| Err(WriteError::Unsupported { what, path: path.to_owned() });
    let link = match std::fs::symlink_metadata(path) {
        Ok(found) if found.is_symlink() => {
            std::fs::read_link(path).map_err(WriteError::io_error_for(path))?
        }
        Ok(found) => return check_replaceable(&found).map_or_else(unfit, |()| Ok(path.to_owned())),
        // Problems of the folder show when a file is created in it.
        Err(_) => return Ok(path.to_owned()),
    };
    // A link's target is relative to the link's folder.
    let target = path.parent().unwrap_or(Path::new("")).join(link);
    match std::fs::symlink_metadata(&target) {
        Ok(found) if found.is_symlink() => {
            unfit("it is a link to a link; choose the name of the file itself")
        }
        Ok(found) => check_replaceable(&found).map_or_else(unfit, |()| Ok(target)),
        Err(err) if err.kind() == ErrorKind::NotFound => Ok(target),
        Err(err) => Err(WriteError::io_error_for(path)(err)),
    }
}

/// Checks that a file may be replaced; otherwise returns the reason why not.
fn check_replaceable(found: &std::fs::Metadata) -> Result<(), &'static str> {
    let kind = found.file_type();
    if kind.is_dir() {
        return Err("there is a folder of that name");
    }
    if !kind.is_file() {
        return Err("it is a device, a pipe or a socket; choose the name of a file");
    }
    if found.permissions().readonly() {
        return Err("the file of that name is read-only; choose another name, or make it writable");
    }
    Ok(())
}

/// Returns the folder that contains a file or folder.
pub(super) fn parent_folder(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// Creates a temporary file for `path`, in the folder of the final file.
pub fn temporary_file_for(path: &Path) -> Result<TemporaryFile, WriteError> {
    // Checked before anything is created, rather than at the final renaming.
    let place = final_path(path)?;
    let failed = |kind: ErrorKind| WriteError::Io { path: path.to_owned(), source: kind.into() };
    if fault::is_on(InjectedFault::FullDisk) {
        return Err(failed(ErrorKind::StorageFull));
    }
    // The temporary file's name means nothing to the user, so only the kind of error is kept.
    TemporaryFile::create_locked(parent_folder(&place)).map_err(|err| failed(err.kind()))
}

/// Opens a regular file; reading from a pipe or a device might never end.
pub fn open_regular(path: &Path) -> Result<std::fs::File, OpenFileError> {
    let failed = |why: &dyn std::fmt::Display| OpenFileError::new(path, why);
    if !std::fs::metadata(path).map_err(|err| failed(&err))?.is_file() {
        return Err(failed(&"it is not a regular file"));
    }
    std::fs::File::open(path).map_err(|err| failed(&err))
}

/// Gives a complete temporary file its final name.
pub fn rename_into_place(file: TemporaryFile, path: &Path) -> Result<(), WriteError> {
    let failed = WriteError::io_error_for(path);
    let place = final_path(path)?;
    // Without this, a crash just after the rename could leave an empty file under the old name.
    file.as_file().sync_all().map_err(&failed)?;
    if let Ok(old) = std::fs::metadata(&place) {
        // Network shares may not support permissions, but hold files all the same.
        file.as_file()
            .set_permissions(old.permissions())
            .inspect_err(|err| log::warn!("{}: its permissions could not be kept: {err}", place.display()))
            .ok();
    }
    file.rename_to(&place).map_err(&failed)?;
    // Syncing the folder makes the new name durable. Some systems cannot do that, and the name is there all the same.
    std::fs::File::open(parent_folder(&place)).and_then(|folder| folder.sync_all()).ok();
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_failed_write_leaves_the_old_file() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.txt");
        write_atomically(&path, b"first").unwrap();
        write_atomically(&path, b"second").unwrap();
        assert_eq!(std::fs::read(&path).unwrap(), b"second");
        let nowhere = folder.path().join("no/such/folder/a.txt");
        assert!(write_atomically(&nowhere, b"x").is_err() && check_writable(&nowhere).is_err());
        check_writable(&path).unwrap();
        assert!(write_atomically(folder.path(), b"x").unwrap_err().to_string().contains("folder"));
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1, "no temporary file is left");
    }

    #[test]
    fn what_was_there_stays_beside_it() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.json");
        keep_backup(&path).unwrap();
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0, "there was nothing");
        for (at, contents) in [b"1", b"2", b"3"].into_iter().enumerate() {
            keep_backup(&path).unwrap();
            write_atomically(&path, contents).unwrap();
            assert_eq!(std::fs::read(folder.path().join("a.json.bak")).is_ok(), at > 0);
        }
        assert_eq!(std::fs::read(folder.path().join("a.json.bak")).unwrap(), b"2");
        assert!(keep_backup(folder.path()).is_err(), "a folder is no file");
    }

    #[cfg(unix)]
    #[test]
    fn only_files_are_replaced() {
        use std::os::unix::fs::{FileTypeExt as _, PermissionsExt as _};
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        let _socket = std::os::unix::net::UnixListener::bind(path("socket")).unwrap();
        std::os::unix::fs::symlink("socket", path("to socket")).unwrap();
        std::fs::write(path("kept.txt"), b"kept").unwrap();
        std::fs::set_permissions(path("kept.txt"), std::fs::Permissions::from_mode(0o444)).unwrap();
        std::os::unix::fs::symlink("to socket", path("to link")).unwrap();
        for name in ["socket", "to socket", "to link", "kept.txt"] {
            assert!(check_writable(&path(name)).is_err(), "{name}");
            let refused = write_atomically(&path(name), b"x").unwrap_err();
            assert!(matches!(refused, WriteError::Unsupported { .. }), "{name}: {refused}");
        }
        assert!(std::fs::symlink_metadata(path("socket")).unwrap().file_type().is_socket());
        assert_eq!(std::fs::read(path("kept.txt")).unwrap(), b"kept");
        // A real device on every Unix system; the test does nothing that could replace it.
        assert!(final_path(Path::new("/dev/null")).is_err());
    }

    #[cfg(unix)]
    #[test]
    fn links_stay_links_and_modes_stay_modes() {
        use std::os::unix::fs::PermissionsExt as _;
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        std::fs::create_dir(path("sub")).unwrap();
        std::os::unix::fs::symlink("sub/file", path("link")).unwrap();
        for contents in [b"new", b"old"] {
            write_atomically(&path("link"), contents).unwrap();
            assert!(std::fs::symlink_metadata(path("link")).unwrap().is_symlink());
            assert_eq!(std::fs::read(path("sub/file")).unwrap(), contents);
        }
        let mode = |name: &str| std::fs::metadata(path(name)).unwrap().permissions().mode() & 0o777;
        std::fs::File::create(path("plain")).unwrap();
        assert_eq!(mode("sub/file"), mode("plain"), "as the user's mask has new files");
        std::fs::set_permissions(path("plain"), std::fs::Permissions::from_mode(0o640)).unwrap();
        write_atomically(&path("plain"), b"x").unwrap();
        assert_eq!(mode("plain"), 0o640);
    }
}
