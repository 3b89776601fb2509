//! Where the volume of a record is, and whether it may be opened without a question.
//!
//! A record comes from anywhere and names a path. Merely looking whether something is there would tell a foreign
//! Windows server the user's password hash, or wake a device; so a path is judged by its text first.

use std::path::{Component, Path, PathBuf};

/// Characters of the longest path.
const MAX_PATH: usize = 4096;

/// Prefix of the names of built-in volumes.
const BUILTIN: &str = "builtin:";

/// Names that Windows takes for devices, in every folder and with every ending.
const DEVICES: [&str; 7] = ["con", "prn", "aux", "nul", "clock$", "conin$", "conout$"];

/// Folders of a Unix system that hold no files.
const NO_FILES: [&str; 3] = ["/dev", "/proc", "/sys"];

/// Where the volume of a record is.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum VolumePlace {
    /// `builtin:NAME`, made by the program.
    Builtin(String),
    /// In the folder of the record, or below it.
    Beside(PathBuf),
    /// Anywhere else: to be opened if the user has opened it before, or says so.
    Elsewhere(PathBuf),
    /// Not to be opened, nor looked for; why.
    Never(&'static str),
}

impl VolumePlace {
    /// Judges what a record says that was read from a folder.
    pub(super) fn of(source: &Path, folder: Option<&Path>) -> Self {
        // What has a meaning is text.
        let text = source.to_string_lossy();
        if text.starts_with(BUILTIN) {
            return Self::Builtin(text.into_owned());
        }
        if let Some(why) = never(&text) {
            return Self::Never(why);
        }
        let folder = folder.and_then(whole);
        let path = normal(&folder.as_deref().unwrap_or(Path::new("")).join(source));
        if is_no_file(&path) {
            return Self::Never("it leads to a device or into the system");
        }
        match folder {
            Some(folder) if path.starts_with(&folder) => beside(path, &folder),
            _ => Self::Elsewhere(path),
        }
    }
}

/// A folder's path from the root; that of a bare name is the current one.
fn whole(folder: &Path) -> Option<PathBuf> {
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    std::path::absolute(folder).ok().map(|folder| normal(&folder))
}

/// A path without `.` and `..`, by its text alone.
fn normal(path: &Path) -> PathBuf {
    path.components().fold(PathBuf::new(), |mut normal, part| {
        match part {
            Component::CurDir => {}
            Component::ParentDir => {
                normal.pop();
            }
            part => normal.push(part),
        }
        normal
    })
}

/// A path in a folder, unless a link leads out of it.
fn beside(path: PathBuf, folder: &Path) -> VolumePlace {
    match (path.canonicalize(), folder.canonicalize()) {
        // By component: as strings, /data would also contain /database.
        (Ok(real), Ok(folder)) if !real.starts_with(&folder) => {
            if is_no_file(&real) {
                VolumePlace::Never("a link leads to a device or into the system")
            } else {
                VolumePlace::Elsewhere(real)
            }
        }
        // What is not there is said when it is opened.
        _ => VolumePlace::Beside(path),
    }
}

fn is_no_file(path: &Path) -> bool {
    NO_FILES.iter().any(|root| path.starts_with(root))
}

/// Why a path is never followed, as far as its text shows. What means something on one system is refused on all: a
/// record means the same everywhere.
fn never(source: &str) -> Option<&'static str> {
    let is_slash = |c: char| matches!(c, '/' | '\\');
    let is_device = |name: &str| {
        let stem = name.split(['.', ':']).next().unwrap_or_default().trim().to_lowercase();
        let numbered = |port: &str| {
            stem.strip_prefix(port).is_some_and(|number| {
                let mut digits = number.chars();
                matches!((digits.next(), digits.next()), (Some('0'..='9' | '¹' | '²' | '³'), None))
            })
        };
        DEVICES.contains(&stem.as_str()) || numbered("com") || numbered("lpt")
    };
    let mut start = source.chars();
    if source.is_empty() || source.contains('\0') || source.chars().count() > MAX_PATH {
        Some("it is no path")
    } else if source.contains("://") {
        Some("it is an address, and nothing is fetched from the network")
    } else if start.next().is_some_and(is_slash) && start.next().is_some_and(is_slash) {
        Some("it names a server or a device")
    } else if source.starts_with("\\??\\") {
        Some("it names a device")
    } else if source.split(is_slash).any(is_device) {
        Some("it has the name of a device")
    } else {
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn servers_devices_and_addresses_are_never_looked_for() {
        for source in [
            "",
            "a\0b",
            "\\\\host\\share\\x.nrrd",
            "//host/share/x.nrrd",
            "/\\host\\x",
            "\\\\?\\C:\\x.nrrd",
            "\\\\.\\PhysicalDrive0",
            "\\??\\C:\\x",
            "http://host/x.nrrd",
            "file:///etc/passwd",
            "CON",
            "nul.nrrd",
            "data/Com1.raw",
            "data\\LPT9 .raw",
            "/dev/zero",
            "/proc/self/mem",
            "/sys/kernel",
            "/tmp/../dev/zero",
            "../../../../../../../../../../../../dev/zero",
        ] {
            let place = VolumePlace::of(Path::new(source), Some(Path::new("/no/such/folder")));
            assert!(matches!(place, VolumePlace::Never(_)), "{source:?}: {place:?}");
        }
        for source in ["console.nrrd", "null/a.raw", "com10.raw", "devices/a", "a.con"] {
            let place = VolumePlace::of(Path::new(source), Some(Path::new("/no/such/folder")));
            assert_eq!(place, VolumePlace::Beside(Path::new("/no/such/folder").join(source)));
        }
        let long = "a/".repeat(MAX_PATH);
        assert!(matches!(VolumePlace::of(Path::new(&long), None), VolumePlace::Never(_)));
    }

    #[test]
    fn what_lies_in_the_folder_of_the_record_is_told_from_the_rest() {
        let folder = tempfile::tempdir().unwrap();
        let inside = folder.path().join("inside");
        std::fs::create_dir(&inside).unwrap();
        let of = |source: &str| VolumePlace::of(Path::new(source), Some(&inside));
        for (source, path) in [
            ("a.raw", "a.raw"),
            ("./b/a.raw", "b/a.raw"),
            ("b/../a.raw", "a.raw"),
            ("../inside/a.raw", "a.raw"),
        ] {
            assert_eq!(of(source), VolumePlace::Beside(inside.join(path)), "{source}");
        }
        let whole = inside.join("a.raw").display().to_string();
        assert_eq!(of(&whole), VolumePlace::Beside(inside.join("a.raw")));
        assert_eq!(VolumePlace::of(Path::new(&whole), None), VolumePlace::Elsewhere(inside.join("a.raw")));
        for (source, path) in
            [("../a.raw", folder.path().join("a.raw")), ("/no/such/a.raw", "/no/such/a.raw".into())]
        {
            assert_eq!(of(source), VolumePlace::Elsewhere(path), "{source}");
        }
        // Its name begins alike.
        assert!(matches!(of("../inside2/a.raw"), VolumePlace::Elsewhere(_)));
        assert_eq!(of("builtin:chair:64"), VolumePlace::Builtin("builtin:chair:64".to_owned()));
        // A bare name of a record is in the current folder.
        let here = std::env::current_dir().unwrap().join("a.raw");
        assert_eq!(VolumePlace::of(Path::new("a.raw"), Some(Path::new(""))), VolumePlace::Beside(here));
    }

    #[cfg(unix)]
    #[test]
    fn links_that_lead_out_are_seen() {
        let folder = tempfile::tempdir().unwrap();
        let (inside, outside) = (folder.path().join("inside"), folder.path().join("outside.raw"));
        std::fs::create_dir(&inside).unwrap();
        std::fs::write(&outside, "x").unwrap();
        std::os::unix::fs::symlink(&outside, inside.join("link.raw")).unwrap();
        std::os::unix::fs::symlink("/dev/zero", inside.join("zero.raw")).unwrap();
        let place = VolumePlace::of(Path::new("link.raw"), Some(&inside));
        assert_eq!(place, VolumePlace::Elsewhere(outside.canonicalize().unwrap()));
        assert!(matches!(VolumePlace::of(Path::new("zero.raw"), Some(&inside)), VolumePlace::Never(_)));
    }
}
