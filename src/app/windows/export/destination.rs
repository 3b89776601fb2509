//! Destination of exported files: default name and folder, and showing the folder in the desktop's file manager.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// Longest part of a volume's name used in a file name, in characters.
const MAX_NAME_CHARS: usize = 80;

/// File name without extension for a picture of a volume; characters that some system forbids in names are left out.
pub(super) fn default_file_name(volume: &str) -> String {
    let is_allowed = |c: &char| c.is_alphanumeric() || " -_.()+".contains(*c);
    let name: String = volume.chars().filter(is_allowed).take(MAX_NAME_CHARS).collect();
    // Dots would make extensions of volumes look like those of pictures.
    let name = name.trim().trim_matches('.').replace('.', "-");
    if name.is_empty() { "picture".to_owned() } else { name }
}

/// Default folder for exports: that of the last export, or the working directory.
pub(super) fn default_folder(last: Option<&Path>) -> PathBuf {
    if let Some(last) = last.filter(|last| last.is_dir()) {
        return last.to_owned();
    }
    let here = std::env::current_dir().ok().filter(|here| here.parent().is_some());
    // Desktops start programs in the root directory; the home directory is used instead.
    here.or_else(std::env::home_dir).unwrap_or_default()
}

/// Absolute path of a typed path.
pub(super) fn absolute_path(path: &str) -> PathBuf {
    let path = Path::new(path.trim());
    std::path::absolute(path).unwrap_or_else(|_| path.to_owned())
}

/// Opens the folder of a file in the desktop's file manager.
///
/// # Errors
/// If no file manager can be started.
pub(super) fn show_in_folder(file: &Path) -> std::io::Result<()> {
    let file = &absolute_path(&file.to_string_lossy());
    let folder = if file.is_dir() { file } else { file.parent().unwrap_or(file) };
    let mut command = if cfg!(target_os = "macos") {
        let mut open = Command::new("open");
        open.arg("-R").arg(file);
        open
    } else if cfg!(windows) {
        let mut explorer = Command::new("explorer");
        explorer.arg(folder);
        explorer
    } else {
        let mut open = Command::new("xdg-open");
        open.arg(folder);
        open
    };
    let quiet = command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    let mut child = quiet.spawn()?;
    // Waits on a thread of its own, so that no zombie process remains.
    std::thread::Builder::new().name("folder".to_owned()).spawn(move || child.wait())?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pictures_have_the_names_of_their_volumes() {
        assert_eq!(default_file_name("lobster"), "lobster");
        assert_eq!(default_file_name("scan.nii.gz"), "scan-nii-gz");
        assert_eq!(default_file_name("../../a/b\\c:d*?"), "abcd");
        assert_eq!(default_file_name("頭 1"), "頭 1");
        assert_eq!(default_file_name("///"), "picture");
        assert_eq!(default_file_name(&"x".repeat(500)).len(), MAX_NAME_CHARS);
    }

    #[test]
    fn pictures_go_where_the_last_one_went() {
        let last = tempfile::tempdir().unwrap();
        assert_eq!(default_folder(Some(last.path())), last.path());
        let gone = last.path().join("gone");
        assert!(default_folder(Some(&gone)).is_dir());
        assert!(absolute_path("a.png").is_absolute());
    }
}
