//! Program mark in OME-Zarr: an attribute of the root. A folder of this program holds nothing but what it has written.

use std::fs::File;
use std::io::{BufReader, Error, Read as _, Result};
use std::path::{Path, PathBuf};

use serde::Deserialize;

use super::{MAX_JSON_BYTES, is_mark};
use crate::open_regular;

/// Document of metadata of version 3, and those of version 2.
const DOCUMENT: &str = "zarr.json";
const EARLIER_DOCUMENTS: [&str; 4] = [".zgroup", ".zattrs", ".zarray", ".zmetadata"];

/// Document that converters of microscopes' files add.
const MICROSCOPE_DOCUMENT: &str = "METADATA.ome.xml";

/// Length of a local file header in a ZIP archive before the name.
const ZIP_HEADER_BYTES: usize = 30;

/// Maximum depth of folders that are looked into.
const MAX_DEPTH: usize = 16;

/// Root of a hierarchy; all other fields are ignored.
#[derive(Deserialize)]
struct RootDocument {
    attributes: RootAttributes,
}

/// Attributes of the root.
#[derive(Deserialize)]
struct RootAttributes {
    #[serde(rename = "chiaroscuro")]
    made_by: Option<String>,
}

/// Returns true if a document has the mark among the attributes of the root.
fn has_root_mark(json: &[u8]) -> bool {
    serde_json::from_slice::<RootDocument>(json)
        .is_ok_and(|root| root.attributes.made_by.is_some_and(|text| is_mark(text.as_bytes())))
}

/// Searches for the mark in the first entry of an archive, which is stored uncompressed.
pub(super) fn archive(mut file: BufReader<File>) -> Result<bool> {
    let mut head = [0; ZIP_HEADER_BYTES];
    file.read_exact(&mut head)?;
    let number = |at: usize| u16::from_le_bytes([head[at], head[at + 1]]);
    let length = u32::from_le_bytes([head[22], head[23], head[24], head[25]]);
    let (method, name, extra) = (number(8), number(26), number(28));
    if method != 0 || usize::from(name) != DOCUMENT.len() || u64::from(length) > MAX_JSON_BYTES {
        return Ok(false);
    }
    let mut name = [0; DOCUMENT.len()];
    file.read_exact(&mut name)?;
    file.seek_relative(extra.into())?;
    let mut json = Vec::new();
    file.take(length.into()).read_to_end(&mut json)?;
    Ok(name == DOCUMENT.as_bytes() && has_root_mark(&json))
}

/// Returns true if a folder is empty, or holds an image of this program and nothing else.
pub(super) fn is_own_folder(path: &Path) -> bool {
    let Ok(mut entries) = std::fs::read_dir(path) else { return false };
    if entries.next().is_none() {
        return true;
    }
    let is_marked = open_regular(&path.join(DOCUMENT)).is_ok_and(|file| {
        let mut json = Vec::new();
        file.take(MAX_JSON_BYTES).read_to_end(&mut json).is_ok() && has_root_mark(&json)
    });
    // Paths of our files: zarr.json, 0/zarr.json, 0/c/1/2/3.
    let is_ours = |parts: &[String]| match parts {
        [document] => document == DOCUMENT,
        [level, document] if document == DOCUMENT => is_number(level),
        [level, c, indices @ ..] => {
            is_number(level) && c == "c" && indices.len() == 3 && indices.iter().all(|index| is_number(index))
        }
        [] => false,
    };
    is_marked && matches!(find_other_file(path, &is_ours), Ok(None))
}

/// Finds a file in a folder that is no part of a Zarr hierarchy; all that is in the folder if it is none.
///
/// # Errors
/// When the folder cannot be read, or is too deep.
pub(crate) fn other_file_in_hierarchy(path: &Path) -> Result<Option<PathBuf>> {
    let is_root = |name: &&str| path.join(name).is_file();
    let has_root = std::iter::once(DOCUMENT).chain(EARLIER_DOCUMENTS).any(|name| is_root(&name));
    let is_chunk_part = |name: &str| {
        let numbers = name.strip_prefix("c.").unwrap_or(name);
        numbers.split('.').all(is_number)
    };
    find_other_file(path, &|parts| {
        let is_known = |name: &String| {
            [DOCUMENT, MICROSCOPE_DOCUMENT, "c"].contains(&name.as_str())
                || EARLIER_DOCUMENTS.contains(&name.as_str())
                || is_chunk_part(name)
        };
        has_root && parts.last().is_some_and(is_known)
    })
}

fn is_number(text: &str) -> bool {
    !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit())
}

/// Finds a file, or a link, of whose path in the folder a predicate says no; and folders without anything in them.
fn find_other_file(root: &Path, is_fit: &dyn Fn(&[String]) -> bool) -> Result<Option<PathBuf>> {
    find_other_below(root, &mut Vec::new(), is_fit)
}

fn find_other_below(
    folder: &Path,
    parts: &mut Vec<String>,
    is_fit: &dyn Fn(&[String]) -> bool,
) -> Result<Option<PathBuf>> {
    if parts.len() >= MAX_DEPTH {
        return Err(Error::other("its folders are nested too deeply"));
    }
    for entry in std::fs::read_dir(folder)? {
        let entry = entry?;
        parts.push(entry.file_name().to_string_lossy().into_owned());
        let kind = entry.file_type()?;
        let other = if kind.is_dir() {
            find_other_below(&entry.path(), parts, is_fit)?
        } else {
            (!kind.is_file() || !is_fit(parts)).then(|| entry.path())
        };
        parts.pop();
        if other.is_some() {
            return Ok(other);
        }
    }
    Ok(None)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::provenance::provenance_mark;

    fn write(folder: &Path, key: &str, text: &str) {
        let path = folder.join(key);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, text).unwrap();
    }

    #[test]
    fn folders_of_ours_hold_nothing_else() {
        let folder = tempfile::tempdir().unwrap();
        let root = folder.path();
        assert!(is_own_folder(root), "nothing is lost with it");
        write(root, "0/c/0/12/0", "chunk");
        assert!(!is_own_folder(root) && other_file_in_hierarchy(root).unwrap().is_some());
        let mark = provenance_mark();
        write(root, "zarr.json", &format!(r#"{{"attributes":{{"chiaroscuro":"{mark}"}}}}"#));
        write(root, "0/zarr.json", "{}");
        assert!(is_own_folder(root) && other_file_in_hierarchy(root).unwrap().is_none());
        for other in ["notes.txt", "0/c/0/12/x", "labels/zarr.json", "0/c/0/1/2/3"] {
            write(root, other, "theirs");
            assert!(!is_own_folder(root), "{other}");
            std::fs::remove_file(root.join(other)).unwrap();
        }
        write(root, "0/.zarray", "{}");
        write(root, "OME/METADATA.ome.xml", "<OME/>");
        write(root, "0/1.2.3", "chunk");
        assert!(!is_own_folder(root) && other_file_in_hierarchy(root).unwrap().is_none());
        write(root, "0/1.2.tif", "a picture");
        assert_eq!(other_file_in_hierarchy(root).unwrap(), Some(root.join("0/1.2.tif")));
        std::fs::remove_file(root.join("0/1.2.tif")).unwrap();
        write(root, "zarr.json", r#"{"attributes":{"chiaroscuro":"by hand"}}"#);
        assert!(!is_own_folder(root));
        #[cfg(unix)]
        {
            std::os::unix::fs::symlink("/", root.join("0/7")).unwrap();
            assert_eq!(other_file_in_hierarchy(root).unwrap(), Some(root.join("0/7")));
        }
    }
}
