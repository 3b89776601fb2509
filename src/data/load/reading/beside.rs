//! Where a file is that another file names: below that one's folder, or nowhere.
//!
//! A header comes from anywhere and names a path. Following it without a check would open private
//! files, devices, or, on Windows, a foreign server that then learns the user's password hash.

use std::path::{Path, PathBuf};

use super::LoadError;
use crate::data::attempt::{Attempt, quoted};

/// Longest name that is looked for, and its longest part between slashes: as long as files' names can be (`NAME_MAX`),
/// and four of those.
const MOST_PART_BYTES: usize = 255;
const MOST_NAME_BYTES: usize = 1024;

/// The path of the file that the header in `attempt` names in a field.
///
/// # Errors
/// `BadInput` for every name that leads out of the header's folder, by its text or over symbolic links; `Io` when there
/// is no such file.
pub(in crate::data::load) fn resolve(
    attempt: Attempt<'_>,
    field: &str,
    name: &str,
) -> Result<PathBuf, LoadError> {
    if let Some(why) = leaves_by_text(name) {
        return Err(attempt.bad_input(
            field,
            format!("{} {why}", quoted(name)),
            "put the data file beside the header and write its bare name",
        ));
    }
    let parent = attempt.path.parent().filter(|parent| !parent.as_os_str().is_empty());
    let folder = parent.unwrap_or(Path::new(".")).canonicalize().map_err(|error| attempt.io(error))?;
    let beside = folder.join(name);
    let what = format!("find the volume's data file {}", quoted(name));
    let of_data = Attempt { what: &what, path: &beside };
    let path = beside.canonicalize().map_err(|error| of_data.io(error))?;
    // By component: as strings, /data would also contain /database.
    if path.starts_with(&folder) {
        if path.is_dir() {
            let why = format!("{} is a folder", quoted(name));
            return Err(attempt.bad_input(field, why, "write the name of the data file"));
        }
        Ok(path)
    } else {
        Err(attempt.bad_input(
            field,
            format!("{} is a link that leads out of the header's folder", quoted(name)),
            "copy the data file beside the header",
        ))
    }
}

/// How a name leaves the header's folder, as far as its text shows.
///
/// Windows paths are refused on every system: a header means the same everywhere.
fn leaves_by_text(name: &str) -> Option<&'static str> {
    let bytes = name.as_bytes();
    if name.is_empty() {
        Some("is empty")
    } else if name.len() > MOST_NAME_BYTES || name.split(['/', '\\']).any(|part| part.len() > MOST_PART_BYTES)
    {
        Some("is too long for a name")
    } else if name.contains('\0') {
        Some("contains a zero byte")
    } else if name.contains("://") {
        Some("is an address, and nothing is fetched from the network")
    } else if name.starts_with(['/', '\\']) || Path::new(name).is_absolute() {
        Some("is an absolute path")
    } else if bytes.len() >= 2 && bytes[0].is_ascii_alphabetic() && bytes[1] == b':' {
        Some("names a drive")
    } else if name.split(['/', '\\']).any(|component| component.trim() == "..") {
        Some("leads out of the header's folder")
    } else {
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_that_leave_the_folder_are_seen() {
        for name in [
            "",
            "/etc/passwd",
            "\\\\host\\share\\x",
            "\\\\?\\C:\\x",
            "\\x",
            "C:\\x",
            "c:x",
            "..",
            "../x",
            "a/../../x",
            "a\\..\\x",
            "http://host/x",
            "file:///etc/passwd",
            "a\0b",
            "a/.. /x",
            &"x".repeat(256),
            &"x/".repeat(600),
        ] {
            assert!(leaves_by_text(name).is_some(), "{name:?}");
        }
        for name in ["x.raw", "./x.raw", "a/b/x.raw", "..x", "x..raw", "a b.raw", "50%.raw"] {
            assert!(leaves_by_text(name).is_none(), "{name:?}");
        }
    }
}
