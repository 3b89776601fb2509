//! Files that are written whole or not at all.

use std::io::Write as _;
use std::path::Path;

use super::{ExportError, ReadPictureError};

/// Writes a file whole or not at all: to a temporary file beside it, which then takes its name.
///
/// # Errors
/// When the folder cannot be written to or the disk is full; an older file of that name stays.
pub fn write_atomically(path: &Path, contents: &[u8]) -> Result<(), ExportError> {
    let mut file = temporary_beside(path)?;
    file.write_all(contents).map_err(ExportError::writing(path))?;
    place(file, path)
}

/// Whether something can be written under a name: said before the work that is to be written.
///
/// # Errors
/// As [`write_atomically`].
pub fn check_writable(path: &Path) -> Result<(), ExportError> {
    temporary_beside(path).map(drop)
}

/// A file for what will take a name when it is complete.
pub(super) fn temporary_beside(path: &Path) -> Result<tempfile::NamedTempFile, ExportError> {
    if path.is_dir() {
        // Known before anything has been made, and not when it is to take its name.
        return Err(ExportError::Unfit { what: "there is a folder of that name", path: path.to_owned() });
    }
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    // The temporary file's own name means nothing to the user: keep the kind of error alone.
    tempfile::Builder::new()
        .prefix(".chiaroscuro-")
        .suffix(".part")
        .tempfile_in(folder)
        .map_err(|err| ExportError::Write { path: path.to_owned(), source: err.kind().into() })
}

/// Opens a file that is one: reading from a pipe or a device might never end.
pub(super) fn open_regular(path: &Path) -> Result<std::fs::File, ReadPictureError> {
    let failed = |why: &dyn std::fmt::Display| ReadPictureError::new(path, why);
    if !std::fs::metadata(path).map_err(|err| failed(&err))?.is_file() {
        return Err(failed(&"it is not a regular file"));
    }
    std::fs::File::open(path).map_err(|err| failed(&err))
}

/// Gives a complete file its name.
pub(super) fn place(file: tempfile::NamedTempFile, path: &Path) -> Result<(), ExportError> {
    let failed = ExportError::writing(path);
    // Otherwise a crash just after the rename could leave an empty file under the old name.
    file.as_file().sync_all().map_err(&failed)?;
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt as _;
        // Temporary files are private; an ordinary file is readable by everyone.
        let mode = std::fs::metadata(path).map_or(0o644, |old| old.permissions().mode());
        file.as_file().set_permissions(std::fs::Permissions::from_mode(mode)).map_err(&failed)?;
    }
    file.persist(path).map_err(|err| failed(err.error))?;
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
}
