//! Management of the program's own files besides writing: folders, quarantine, locks, removal.

use std::fs::File;
use std::path::{Path, PathBuf};
use std::time::{SystemTime, UNIX_EPOCH};

/// Creates a folder and its missing parents.
///
/// # Errors
/// When the file system refuses, or something else has that name.
pub fn make_folder(path: &Path) -> std::io::Result<()> {
    std::fs::create_dir_all(path)
}

/// Quarantines a file: renames it within its folder, with the time in milliseconds, so that it can be examined.
/// Returns the new path.
///
/// # Errors
/// When the file system refuses.
pub fn quarantine(path: &Path) -> std::io::Result<PathBuf> {
    let millis = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default().as_millis();
    let mut name = path.file_name().unwrap_or_default().to_owned();
    name.push(format!(".damaged-{millis}"));
    let aside = path.with_file_name(name);
    std::fs::rename(path, &aside)?;
    Ok(aside)
}

/// Renames one of the program's files within its storage folder.
///
/// # Errors
/// When the file system refuses.
pub fn rename_own_file(from: &Path, to: &Path) -> std::io::Result<()> {
    std::fs::rename(from, to)
}

/// Removes one of the program's files; a missing file is not an error.
pub fn remove_own_file(path: &Path) {
    std::fs::remove_file(path).ok();
}

/// Creates a lock file, which is locked while it is open, however the process ends; waits for other holders.
///
/// # Errors
/// When the file cannot be created. On file systems without locks it is created unlocked.
pub fn hold_lock(path: &Path) -> std::io::Result<File> {
    let file = File::options().create(true).truncate(false).write(true).open(path)?;
    file.lock().ok();
    Ok(file)
}

/// Creates a lock file that must not exist yet, and holds its lock as [`hold_lock`] does.
///
/// # Errors
/// `AlreadyExists` if the file exists; otherwise when it cannot be created.
pub fn create_lock(path: &Path) -> std::io::Result<File> {
    let file = File::options().create_new(true).write(true).open(path)?;
    file.lock().ok();
    Ok(file)
}
