//! Resolution of the files that a header names: only inside the header's folder.
//!
//! A header may come from anywhere, and it names a path. Following it without a check would open private files,
//! devices, or, on Windows, a foreign server that then learns the user's password hash. An archive can contain links
//! as well as headers, so that links are followed only within the folder, within the folder of the target where the
//! header itself is a link, and to where git-annex, `DataLad` and DVC store the files of the repository that contains
//! the folder.

use std::path::{Path, PathBuf};

use super::LoadError;
use chiaroscuro_volume::{LoadContext, quoted};

/// Maximum length of a name, and of its parts between slashes: `NAME_MAX` of file systems, and four times that.
const MAX_PART_BYTES: usize = 255;
const MAX_NAME_BYTES: usize = 1024;

/// Path of the file that a header names in a field; `context` is that of the header.
///
/// # Errors
/// `BadInput` for every name that leads out of the header's folder, by its text or through symbolic links; `Io` when
/// there is no such file.
///
/// The path goes through the header's folder, so that a link keeps the name that the header has for it.
pub(crate) fn resolve(context: LoadContext<'_>, field: &str, name: &str) -> Result<PathBuf, LoadError> {
    if let Some(why) = path_escape_reason(name) {
        return Err(context.bad_input_error(
            field,
            format!("{} {why}", quoted(name)),
            "put the data file beside the header and write its bare name",
        ));
    }
    let folder = parent_folder(context.path).canonicalize().map_err(|error| context.io_error(error))?;
    // If the header is a link, its data may lie beside the link or beside its target.
    let header = context.path.canonicalize().ok();
    let own = header.as_deref().map_or(folder.as_path(), parent_folder);
    let is_there = |folder: &&Path| folder.join(name).symlink_metadata().is_ok();
    let from = [folder.as_path(), own].into_iter().find(is_there).unwrap_or(&folder);
    let beside = from.join(name);
    let what = format!("find the volume's data file {}", quoted(name));
    let of_data = LoadContext { operation: &what, path: &beside };
    let path = beside.canonicalize().map_err(|error| match beside.symlink_metadata() {
        Ok(_) if error.kind() == std::io::ErrorKind::NotFound => {
            of_data.not_a_file_error(DANGLING_LINK, DANGLING_LINK_HELP)
        }
        _ => of_data.io_error(error),
    })?;
    // By component: as strings, /data would also contain /database.
    let is_inside = |folder: &Path| path.starts_with(folder);
    if !is_inside(&folder) && !is_inside(own) && !is_in_annex_store(&path, &folder) {
        return Err(context.bad_input_error(
            field,
            format!("{} is a link that leads out of the header's folder", quoted(name)),
            "copy the data file beside the header, or open the header that lies beside it",
        ));
    }
    if path.is_dir() {
        let why = format!("{} is a folder", quoted(name));
        return Err(context.bad_input_error(field, why, "write the name of the data file"));
    }
    Ok(beside)
}

/// Message for a dangling link, as git-annex leaves it before the file is fetched.
pub(crate) const DANGLING_LINK: &str = "it is a link to a file that is not there";
pub(crate) const DANGLING_LINK_HELP: &str =
    "fetch the file that it leads to (datalad get, git annex get, dvc pull), or copy it here";

/// Folder that contains a file.
fn parent_folder(path: &Path) -> &Path {
    path.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// True if a file, given by its canonical path, lies in the git-annex (`DataLad`) or DVC store of a repository that
/// contains a folder.
///
/// See <https://git-annex.branchable.com/internals/> and
/// <https://dvc.org/doc/user-guide/project-structure/internal-files>.
fn is_in_annex_store(path: &Path, folder: &Path) -> bool {
    let within = |root: &Path| {
        let Ok(rest) = path.strip_prefix(root) else { return false };
        // The store of a submodule is below `.git/modules` of the outer repository.
        let names: Vec<_> = rest.iter().collect();
        let has_objects = names.windows(2).any(|pair| pair[0] == "annex" && pair[1] == "objects");
        (rest.starts_with(".git") && has_objects) || rest.starts_with(".dvc/cache")
    };
    folder.ancestors().any(within)
}

/// Reason why a name leads out of the header's folder, judged by its text alone.
///
/// Windows paths are refused on every system, so that a header means the same everywhere.
fn path_escape_reason(name: &str) -> Option<&'static str> {
    let bytes = name.as_bytes();
    if name.is_empty() {
        Some("is empty")
    } else if name.len() > MAX_NAME_BYTES || name.split(['/', '\\']).any(|part| part.len() > MAX_PART_BYTES) {
        Some("is too long for a name")
    } else if name.contains('\0') {
        Some("contains a zero byte")
    } else if name.contains("://") {
        Some("is a network address, and nothing is fetched from the network")
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
            assert!(path_escape_reason(name).is_some(), "{name:?}");
        }
        for name in ["x.raw", "./x.raw", "a/b/x.raw", "..x", "x..raw", "a b.raw", "50%.raw"] {
            assert!(path_escape_reason(name).is_none(), "{name:?}");
        }
    }
}
