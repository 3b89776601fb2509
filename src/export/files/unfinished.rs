//! Files that are being written: they are known while the process lives, and told by their lock from those of a process
//! that was killed.

use std::fs::{File, TryLockError};
use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

/// How their names begin and end.
const PREFIX: &str = ".chiaroscuro-";
const SUFFIX: &str = ".part";

/// Names of a folder that are looked at for files that were abandoned: what takes a hundredth of a second.
const MOST_NAMES: usize = 10_000;

/// Where locks are not to be had: a file that was not written to for so long is abandoned.
const ABANDONED_AFTER: Duration = Duration::from_hours(24);

/// How long a process that ends waits for the list.
const LAST_WAIT: Duration = Duration::from_millis(500);

/// Files that this process is writing.
static UNFINISHED: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// A file that has no name of its own yet. Dropping it removes it.
#[derive(Debug)]
pub(in crate::export) struct Unfinished {
    file: tempfile::NamedTempFile,
}

/// How such files are called.
pub(super) fn named() -> tempfile::Builder<'static, 'static> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(PREFIX).suffix(SUFFIX);
    builder
}

impl Unfinished {
    /// A new one in a folder. Those that were abandoned there go.
    pub(super) fn begin(folder: &Path) -> std::io::Result<Self> {
        remove_abandoned(folder);
        loop {
            let file = Self::make(folder)?;
            // Others lock for as long as they look whether a file is abandoned, so this waits for them. Windows keeps
            // what is locked from other writers of this process, too.
            let locked = cfg!(unix) && file.file.as_file().lock().is_ok();
            // What was not locked yet when they looked is gone. Where there are no locks, its age tells.
            if !locked || file.path().exists() {
                return Ok(file);
            }
        }
    }

    /// A new one, not locked.
    fn make(folder: &Path) -> std::io::Result<Self> {
        #[cfg_attr(not(unix), expect(unused_mut, reason = "modes are there on Unix alone"))]
        let mut builder = named();
        #[cfg(unix)]
        {
            use std::os::unix::fs::PermissionsExt as _;
            // As files are made that are no temporary ones: the user's mask takes away what it takes away.
            builder.permissions(std::fs::Permissions::from_mode(0o666));
        }
        let file = builder.tempfile_in(folder)?;
        UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner).push(file.path().to_owned());
        Ok(Self { file })
    }

    /// The file.
    pub(in crate::export) fn as_file(&self) -> &File {
        self.file.as_file()
    }

    /// Where it is until it has its name.
    pub(in crate::export) fn path(&self) -> &Path {
        self.file.path()
    }

    /// The file once more, for a writer that wants one of its own.
    pub(in crate::export) fn reopen(&self) -> std::io::Result<File> {
        self.file.reopen()
    }

    /// Gives it its name.
    pub(super) fn persist(self, path: &Path) -> std::io::Result<()> {
        let before = self.file.path().to_owned();
        let result = self.file.persist(path).map(drop).map_err(|err| err.error);
        forget(&before);
        result
    }
}

impl Write for Unfinished {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        self.file.write(bytes)
    }

    fn flush(&mut self) -> std::io::Result<()> {
        self.file.flush()
    }
}

/// A file without a name, which is gone when it is closed.
pub(in crate::export) fn scratch() -> std::io::Result<File> {
    tempfile::tempfile()
}

/// Takes a file off the list; one that was dropped stays there, which is harmless: its name is not used again.
fn forget(path: &Path) {
    UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner).retain(|known| known != path);
}

/// Removes what this process is writing: for a process that is told to end, or that panics.
pub fn remove_unfinished() {
    let begin = Instant::now();
    while begin.elapsed() < LAST_WAIT {
        match UNFINISHED.try_lock() {
            Ok(mut files) => return files.drain(..).for_each(|file| drop(std::fs::remove_file(file))),
            Err(std::sync::TryLockError::Poisoned(files)) => {
                return files.into_inner().drain(..).for_each(|file| drop(std::fs::remove_file(file)));
            }
            Err(std::sync::TryLockError::WouldBlock) => std::thread::sleep(Duration::from_millis(5)),
        }
    }
}

/// Removes what processes have left in a folder that were killed while they wrote.
pub fn remove_abandoned(folder: &Path) {
    let names = std::fs::read_dir(folder).into_iter().flatten().take(MOST_NAMES).flatten();
    for entry in names {
        let name = entry.file_name();
        let name = name.to_string_lossy();
        let is_one = name.starts_with(PREFIX) && name.ends_with(SUFFIX);
        if is_one && entry.file_type().is_ok_and(|kind| kind.is_file()) {
            remove_if_abandoned(&entry.path());
        }
    }
}

/// Removes a file to which nobody writes any more.
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
        // While it is locked: whoever has just made it waits, and finds that it is gone.
        std::fs::remove_file(path).ok();
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
        let first = Unfinished::begin(folder.path()).unwrap();
        assert_eq!(count(), 4, "the dead one is gone, the new one there");
        let second = Unfinished::begin(folder.path()).unwrap();
        assert!(first.path().exists() && second.path().exists(), "both are alive");
        second.persist(&folder.path().join("done")).unwrap();
        assert!(UNFINISHED.lock().unwrap().contains(&first.path().to_owned()));
        let path = first.path().to_owned();
        drop(first);
        assert!(!path.exists() && folder.path().join("done").exists());
    }

    #[test]
    fn nobody_takes_away_what_others_have_just_begun() {
        let folder = tempfile::tempdir().unwrap();
        let begin_many = || {
            for _ in 0..200 {
                let file = Unfinished::begin(folder.path()).unwrap();
                assert!(file.path().exists());
                file.persist(&folder.path().join("done")).unwrap();
            }
        };
        std::thread::scope(|threads| {
            for _ in 0..4 {
                threads.spawn(begin_many);
            }
        });
    }
}
