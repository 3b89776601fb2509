//! What the program does to its own files beside writing them.

use std::fs::File;
use std::path::{Path, PathBuf};
use std::time::{SystemTime, UNIX_EPOCH};

/// Makes a folder, and those that it is in.
///
/// # Errors
/// When the disk refuses, or something else has that name.
pub fn make_folder(path: &Path) -> std::io::Result<()> {
    std::fs::create_dir_all(path)
}

/// Gives a file another name in its folder, with the time in milliseconds, so that somebody can look at it. Returns the
/// name.
///
/// # Errors
/// When the disk refuses.
pub fn put_aside(path: &Path) -> std::io::Result<PathBuf> {
    let millis = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default().as_millis();
    let mut name = path.file_name().unwrap_or_default().to_owned();
    name.push(format!(".damaged-{millis}"));
    let aside = path.with_file_name(name);
    std::fs::rename(path, &aside)?;
    Ok(aside)
}

/// Moves a file of ours within the folder of what is remembered.
///
/// # Errors
/// When the disk refuses.
pub fn rename(from: &Path, to: &Path) -> std::io::Result<()> {
    std::fs::rename(from, to)
}

/// Removes a file of ours; that there is none is no error.
pub fn remove(path: &Path) {
    std::fs::remove_file(path).ok();
}

/// Makes a file that is locked for as long as it is open, whatever ends the process; waits for others that hold it.
///
/// # Errors
/// When the file cannot be made. On file systems without locks it is made all the same.
pub fn hold_lock(path: &Path) -> std::io::Result<File> {
    let file = File::options().create(true).truncate(false).write(true).open(path)?;
    file.lock().ok();
    Ok(file)
}
