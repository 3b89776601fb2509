//! Temporary folders that are being written, under the rules of temporary files: listed while the process lives, locked
//! against removal by other processes, and renamed when they are complete.

use std::fs::File;
use std::io::{Error, ErrorKind, Result, Write as _};
use std::path::{Component, Path};

use super::temporary_file::{self, FOLDER_SUFFIX};

/// Temporary folder that does not have its final name yet. Dropping it removes it with all that is in it.
#[derive(Debug)]
pub struct TemporaryFolder {
    folder: tempfile::TempDir,
    /// Open folder, which holds the lock.
    _lock: Option<File>,
}

impl TemporaryFolder {
    /// Creates a temporary folder in a folder, and removes abandoned files and folders there.
    pub(super) fn create_locked(parent: &Path) -> Result<Self> {
        temporary_file::remove_abandoned_temporary_files(parent);
        loop {
            let mut builder = temporary_file::name_builder();
            builder.suffix(FOLDER_SUFFIX);
            #[cfg(unix)]
            {
                use std::os::unix::fs::PermissionsExt as _;
                // The default mode of ordinary folders, from which the user's umask is subtracted.
                builder.permissions(std::fs::Permissions::from_mode(0o777));
            }
            let folder = builder.tempdir_in(parent)?;
            temporary_file::list(folder.path());
            // Other processes hold the lock while they check whether a folder is abandoned, as for files.
            let lock = if cfg!(unix) { File::open(folder.path()).ok() } else { None };
            let is_locked = lock.as_ref().is_some_and(|open| open.lock().is_ok());
            if !is_locked || folder.path().exists() {
                return Ok(Self { folder, _lock: lock });
            }
        }
    }

    /// Path of the temporary folder.
    pub fn path(&self) -> &Path {
        self.folder.path()
    }

    /// Appends bytes to a file in the folder, which is created with the folders above it if it does not exist.
    ///
    /// # Errors
    /// When the file system refuses, or the path leads out of the folder.
    pub fn append(&self, relative: &str, bytes: &[u8]) -> Result<()> {
        let relative = Path::new(relative);
        if !relative.components().all(|part| matches!(part, Component::Normal(_))) {
            return Err(Error::new(ErrorKind::InvalidInput, "the path leads out of the folder"));
        }
        let path = self.path().join(relative);
        let mut options = File::options();
        options.append(true).create(true);
        let mut file = match options.open(&path) {
            Err(error) if error.kind() == ErrorKind::NotFound => {
                self.make_folders_above(relative)?;
                options.open(&path)?
            }
            opened => opened?,
        };
        file.write_all(bytes)
    }

    /// Creates the folders above a file; never the temporary folder itself, which a terminating process has removed.
    fn make_folders_above(&self, relative: &Path) -> Result<()> {
        let mut path = self.path().to_owned();
        for part in relative.parent().into_iter().flat_map(Path::components) {
            path.push(part);
            match std::fs::create_dir(&path) {
                Err(error) if error.kind() != ErrorKind::AlreadyExists => return Err(error),
                _ => {}
            }
        }
        Ok(())
    }

    /// Writes all files through to the disk.
    pub(super) fn sync(&self) -> Result<()> {
        sync_files(self.path())
    }

    /// Renames the folder to its final name, which nothing must have.
    pub(super) fn rename_to(self, path: &Path) -> Result<()> {
        std::fs::rename(self.path(), path)?;
        temporary_file::unlist(self.path());
        // There is nothing left to be removed.
        drop(self.folder.keep());
        Ok(())
    }
}

fn sync_files(folder: &Path) -> Result<()> {
    for entry in std::fs::read_dir(folder)? {
        let entry = entry?;
        if entry.file_type()?.is_dir() {
            sync_files(&entry.path())?;
        } else {
            // Some systems sync only what is open for writing.
            File::options().append(true).open(entry.path())?.sync_all()?;
        }
    }
    // Some systems cannot sync folders, and the files are there all the same.
    File::open(folder).and_then(|open| open.sync_all()).ok();
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn folders_fill_and_vanish_or_stay() {
        let parent = tempfile::tempdir().unwrap();
        let count = || std::fs::read_dir(parent.path()).unwrap().count();
        std::fs::create_dir(parent.path().join(".chiaroscuro-dead.folder.part")).unwrap();
        std::fs::write(parent.path().join(".chiaroscuro-dead.folder.part/a"), "half").unwrap();
        let first = TemporaryFolder::create_locked(parent.path()).unwrap();
        let second = TemporaryFolder::create_locked(parent.path()).unwrap();
        assert_eq!(count(), 2, "the dead one is gone, and both that live are there");
        first.append("a/b/c", b"one").unwrap();
        first.append("a/b/c", b", two").unwrap();
        for path in ["../x", "/x", "a/../../x"] {
            assert!(first.append(path, b"x").is_err(), "{path}");
        }
        first.sync().unwrap();
        let whole = parent.path().join("whole");
        first.rename_to(&whole).unwrap();
        assert_eq!(std::fs::read(whole.join("a/b/c")).unwrap(), b"one, two");
        std::fs::remove_dir_all(second.path()).unwrap();
        assert!(second.append("a/b", b"late").is_err() && !second.path().exists());
        drop(second);
        assert_eq!(count(), 1);
    }
}
