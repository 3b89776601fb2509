//! Stores of a Zarr hierarchy: values by keys, from a folder or from an archive.

mod folder;
mod zip_archive;

use std::io;

use super::{LoadError, input, zip};
use chiaroscuro_volume::{LoadContext, quoted};

pub(super) use folder::FolderStore;
pub(super) use zip_archive::ZipStore;

/// Names of the documents of metadata, of which a hierarchy has one or two at its root.
pub(super) const DOCUMENT_NAMES: [&str; 5] = ["zarr.json", ".zattrs", ".zgroup", ".zarray", ".zmetadata"];

/// Returns true if an entry of an archive is a document of metadata.
pub(super) fn is_document(entry: &str) -> bool {
    DOCUMENT_NAMES.contains(&entry.rsplit('/').next().unwrap_or_default())
}

/// Part of a value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum ByteRange {
    /// The whole value, of at most this many bytes.
    AtMost(u64),
    /// Bytes from an offset, exactly so many.
    From(u64, u64),
    /// The last bytes, exactly so many.
    Last(u64),
}

/// Failure to read a value of a store.
#[derive(Debug)]
pub(super) enum StoreError {
    /// The operating system could not read it.
    Io(io::Error),
    /// The value is not what was expected; holds the cause and what helps.
    Unusable(String, &'static str),
    /// Reading was cancelled, or the archive is broken.
    Load(LoadError),
}

impl From<io::Error> for StoreError {
    fn from(error: io::Error) -> Self {
        Self::Io(error)
    }
}

impl StoreError {
    /// Converts to an error about the value of a key.
    pub(super) fn into_load_error(self, context: LoadContext<'_>, key: &str) -> LoadError {
        match self {
            Self::Load(error) => error,
            Self::Unusable(why, help) => context.bad_input_error(key, why, help),
            Self::Io(error) => context.bad_input_error(
                key,
                format!("it cannot be read: {error}"),
                "check the disk or the network, and open the folder again",
            ),
        }
    }
}

/// Source of values by their keys: paths of slashes below the root of the hierarchy.
pub(super) trait Store: Sync {
    /// Reads a part of a value; `None` if there is no such value.
    fn read(&self, key: &str, range: ByteRange) -> Result<Option<Vec<u8>>, StoreError>;

    /// Returns the names directly below a key, sorted; at most [`MAX_CHILDREN`].
    fn children(&self, key: &str) -> Result<Vec<String>, StoreError>;
}

/// Maximum number of names below a key: arrays of a group, not chunks.
pub(super) const MAX_CHILDREN: usize = 4096;

/// Joins a path of the hierarchy, which may be empty, and a name below it.
pub(super) fn join(path: &str, name: &str) -> String {
    if path.is_empty() { name.to_owned() } else { format!("{path}/{name}") }
}

/// Returns a path that metadata name, if it stays within the hierarchy.
///
/// # Errors
/// `BadInput` for a path that leads elsewhere.
pub(super) fn checked_path(context: LoadContext<'_>, field: &str, path: &str) -> Result<String, LoadError> {
    let trimmed = path.trim_matches('/');
    let is_name =
        |part: &str| !part.is_empty() && part != "." && part != ".." && !part.contains(['\\', ':', '\0']);
    if trimmed.split('/').all(is_name) && !path.starts_with('/') {
        return Ok(trimmed.to_owned());
    }
    Err(context.bad_input_error(
        field,
        format!("the path {} leads out of the folder", quoted(path)),
        "check the metadata; paths are relative, without ..",
    ))
}

/// Error for a value that is shorter or longer than expected.
fn length_error(found: u64, range: ByteRange) -> StoreError {
    let why = match range {
        ByteRange::AtMost(most) => format!("it has {found} bytes, {most} are allowed"),
        ByteRange::From(start, count) => {
            format!("bytes {start} to {} were expected, it has {found}", start.saturating_add(count))
        }
        ByteRange::Last(count) => format!("at least {count} bytes were expected, it has {found}"),
    };
    StoreError::Unusable(why, "copy or download the file again")
}

/// Resolves a range for a value of `length` bytes, to an offset and a count.
fn resolve_range(length: u64, range: ByteRange) -> Result<(u64, u64), StoreError> {
    let resolved = match range {
        ByteRange::AtMost(most) => (length <= most).then_some((0, length)),
        ByteRange::From(start, count) => {
            start.checked_add(count).filter(|&end| end <= length).map(|_| (start, count))
        }
        ByteRange::Last(count) => length.checked_sub(count).map(|start| (start, count)),
    };
    resolved.ok_or_else(|| length_error(length, range))
}
