//! Quarantine of corrupt state files, so that they cannot block a start.

use std::collections::HashMap;
use std::path::Path;

use crate::app::text;
use chiaroscuro_files::read_small_file;

/// Quarantines a file by renaming it, with the time in its name, so that it can be examined. Returns a notice.
pub(super) fn quarantine(path: &Path) -> String {
    match chiaroscuro_files::quarantine(path) {
        Ok(aside) => text::persistence::quarantined(path, &aside),
        Err(err) => text::persistence::quarantine_failed(path, err),
    }
}

/// Quarantines the toolkit's window state in a folder if it is unreadable, or would block the reader indefinitely. The
/// toolkit reads it before any code of this program runs; it only holds the positions of windows and panels.
pub(crate) fn check_window_state(folder: &Path) -> Option<String> {
    let path = folder.join("app.ron");
    if super::starts_have_failed(folder) && path.exists() {
        return Some(quarantine(&path));
    }
    let bytes = match read_small_file(&path) {
        Err(err) if err.kind() == std::io::ErrorKind::NotFound => return None,
        Err(_) => return Some(quarantine(&path)),
        Ok(bytes) => bytes,
    };
    ron::de::from_bytes::<HashMap<String, String>>(&bytes).is_err().then(|| quarantine(&path))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_damaged_is_put_aside_and_what_is_not_stays() {
        let folder = tempfile::tempdir().unwrap();
        let names = || {
            let files = std::fs::read_dir(folder.path()).unwrap();
            let mut names: Vec<_> =
                files.map(|file| file.unwrap().file_name().into_string().unwrap()).collect();
            names.sort();
            names
        };
        let path = folder.path().join("app.ron");
        assert!(check_window_state(folder.path()).is_none(), "nothing there, nothing said");
        std::fs::write(&path, "{ \"window\": \"(x: 1)\" }").unwrap();
        assert!(check_window_state(folder.path()).is_none());
        assert_eq!(names(), ["app.ron"]);
        std::fs::write(&path, "{ \"window\": ").unwrap();
        assert!(check_window_state(folder.path()).unwrap().contains("app.ron"));
        assert!(names()[0].starts_with("app.ron.damaged-") && names().len() == 1);
        std::thread::sleep(std::time::Duration::from_millis(2));
        std::fs::create_dir(&path).unwrap();
        assert!(check_window_state(folder.path()).is_some(), "a folder");
        assert!(!path.exists());
    }
}
