//! Temporary files that are being written: listed while the process lives, and distinguished by a lock from those of
//! a killed process.

use std::fs::{File, TryLockError};
use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

/// Prefix and suffix of the names of temporary files and folders.
const PREFIX: &str = ".chiaroscuro-";
const SUFFIX: &str = ".part";

/// Suffix of the names of temporary folders, which ends in that of files.
pub(super) const FOLDER_SUFFIX: &str = ".folder.part";

/// Maximum number of directory entries that are searched for abandoned files: takes a hundredth of a second.
const MAX_ENTRIES: usize = 10_000;

/// Age since the last write at which a temporary file counts as abandoned, on systems without file locks.
const ABANDONED_AFTER: Duration = Duration::from_hours(24);

/// Number of attempts to remove a folder to which another thread adds files.
const MAX_REMOVALS: usize = 16;

/// Longest wait of a terminating process for the list of files.
const TERMINATION_WAIT: Duration = Duration::from_millis(500);

/// Temporary files that this process is writing. They stay static: the panic hook and the handler of termination remove
/// those of all threads.
static TEMPORARY_FILES: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// Temporary file that does not have its final name yet. Dropping it removes it.
#[derive(Debug)]
pub struct TemporaryFile {
    file: tempfile::NamedTempFile,
}

/// Returns a builder for the names of temporary files.
pub(super) fn name_builder() -> tempfile::Builder<'static, 'static> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(PREFIX).suffix(SUFFIX);
    builder
}

impl TemporaryFile {
    /// Creates a temporary file in a folder, and removes abandoned ones there.
    pub(super) fn create_locked(folder: &Path) -> std::io::Result<Self> {
        remove_abandoned_temporary_files(folder);
        loop {
            let file = Self::create(folder)?;
            // Other processes hold the lock while they check whether a file is abandoned, so this waits for them. On
            // Windows, a lock would also exclude other writers of this process.
            let locked = cfg!(unix) && file.file.as_file().lock().is_ok();
            // A file that was checked before it was locked has been removed. Without locks, its age protects it.
            if !locked || file.path().exists() {
                return Ok(file);
            }
        }
    }

    /// Creates a temporary file, not yet locked.
    fn create(folder: &Path) -> std::io::Result<Self> {
        #[cfg_attr(not(unix), expect(unused_mut, reason = "modes are there on Unix alone"))]
        let mut builder = name_builder();
        #[cfg(unix)]
        {
            use std::os::unix::fs::PermissionsExt as _;
            // The default mode of ordinary files, from which the user's umask is subtracted.
            builder.permissions(std::fs::Permissions::from_mode(0o666));
        }
        let file = builder.tempfile_in(folder)?;
        list(file.path());
        Ok(Self { file })
    }

    /// Returns the open file.
    pub fn as_file(&self) -> &File {
        self.file.as_file()
    }

    /// Returns the path of the temporary file.
    pub fn path(&self) -> &Path {
        self.file.path()
    }

    /// Opens the file again, for a writer that needs its own handle.
    pub fn reopen(&self) -> std::io::Result<File> {
        self.file.reopen()
    }

    /// Renames the file to its final name.
    pub(super) fn rename_to(self, path: &Path) -> std::io::Result<()> {
        let before = self.file.path().to_owned();
        let result = self.file.persist(path).map(drop).map_err(|err| err.error);
        unlist(&before);
        result
    }
}

impl Write for TemporaryFile {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        self.file.write(bytes)
    }

    fn flush(&mut self) -> std::io::Result<()> {
        self.file.flush()
    }
}

/// Creates an unnamed file, which is deleted when it is closed.
pub fn unnamed_file() -> std::io::Result<File> {
    tempfile::tempfile()
}

/// Adds a file or folder to the list.
pub(super) fn list(path: &Path) {
    TEMPORARY_FILES.lock().unwrap_or_else(PoisonError::into_inner).push(path.to_owned());
}

/// Removes a file from the list. Dropped files stay in it, which is harmless, since their names are not reused.
pub(super) fn unlist(path: &Path) {
    TEMPORARY_FILES.lock().unwrap_or_else(PoisonError::into_inner).retain(|known| known != path);
}

/// Removes a temporary file, or a temporary folder with its files, to which other threads may still add some.
fn remove_file_or_folder(path: &Path) {
    if std::fs::remove_file(path).is_ok() || !is_temporary_folder(path) {
        return;
    }
    for _ in 0..MAX_REMOVALS {
        if std::fs::remove_dir_all(path).is_ok() {
            return;
        }
    }
}

/// Returns true for a folder, none behind a link, of a name that only temporary folders have.
fn is_temporary_folder(path: &Path) -> bool {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let is_named = name.starts_with(PREFIX) && name.ends_with(FOLDER_SUFFIX);
    is_named && std::fs::symlink_metadata(path).is_ok_and(|found| found.is_dir())
}

/// Removes the temporary files of this process: for termination and panics.
pub fn remove_own_temporary_files() {
    let begin = Instant::now();
    while begin.elapsed() < TERMINATION_WAIT {
        match TEMPORARY_FILES.try_lock() {
            Ok(mut files) => return files.drain(..).for_each(|file| remove_file_or_folder(&file)),
            Err(std::sync::TryLockError::Poisoned(files)) => {
                return files.into_inner().drain(..).for_each(|file| remove_file_or_folder(&file));
            }
            Err(std::sync::TryLockError::WouldBlock) => std::thread::sleep(Duration::from_millis(5)),
        }
    }
}

/// Removes the temporary files that killed processes have left in a folder.
pub fn remove_abandoned_temporary_files(folder: &Path) {
    let names = std::fs::read_dir(folder).into_iter().flatten().take(MAX_ENTRIES).flatten();
    for entry in names {
        let name = entry.file_name();
        let name = name.to_string_lossy();
        let is_one = name.starts_with(PREFIX) && name.ends_with(SUFFIX);
        let is_fit = |kind: std::fs::FileType| kind.is_file() || is_temporary_folder(&entry.path());
        if is_one && entry.file_type().is_ok_and(is_fit) {
            remove_if_abandoned(&entry.path());
        }
    }
}

/// Removes a file or folder if no process is writing it any more.
fn remove_if_abandoned(path: &Path) {
    let Ok(file) = File::open(path) else { return };
    let locked =
        if cfg!(unix) { file.try_lock() } else { Err(TryLockError::Error(ErrorKind::Unsupported.into())) };
    let is_abandoned = match locked {
        Ok(()) => true,
        Err(TryLockError::WouldBlock) => false,
        Err(TryLockError::Error(_)) => {
            let age =
                file.metadata().and_then(|found| found.modified()).ok().and_then(|when| when.elapsed().ok());
            age.is_some_and(|age| age > ABANDONED_AFTER)
        }
    };
    if is_abandoned {
        // Removed while it is locked: a process that has just created it is waiting, and will find it gone.
        remove_file_or_folder(path);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_was_abandoned_goes() {
        let folder = tempfile::tempdir().unwrap();
        let count = || std::fs::read_dir(folder.path()).unwrap().count();
        std::fs::write(folder.path().join(".chiaroscuro-dead.part"), "half").unwrap();
        std::fs::write(folder.path().join(".other-dead.part"), "somebody else's").unwrap();
        std::fs::write(folder.path().join(".chiaroscuro-notes.txt"), "no part").unwrap();
        std::fs::create_dir(folder.path().join(".chiaroscuro-folder.part")).unwrap();
        let first = TemporaryFile::create_locked(folder.path()).unwrap();
        assert_eq!(count(), 4, "the dead one is gone, the new one there");
        let second = TemporaryFile::create_locked(folder.path()).unwrap();
        assert!(first.path().exists() && second.path().exists(), "both are alive");
        second.rename_to(&folder.path().join("done")).unwrap();
        assert!(TEMPORARY_FILES.lock().unwrap().contains(&first.path().to_owned()));
        let path = first.path().to_owned();
        drop(first);
        assert!(!path.exists() && folder.path().join("done").exists());
    }

    #[test]
    fn nobody_takes_away_what_others_have_just_begun() {
        let folder = tempfile::tempdir().unwrap();
        let begin_many = || {
            for _ in 0..200 {
                let file = TemporaryFile::create_locked(folder.path()).unwrap();
                assert!(file.path().exists());
                file.rename_to(&folder.path().join("done")).unwrap();
            }
        };
        std::thread::scope(|threads| {
            for _ in 0..4 {
                threads.spawn(begin_many);
            }
        });
    }
}
