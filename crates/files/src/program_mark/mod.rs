//! Detection of files written by this program, by a mark in their metadata.
//!
//! The mark counts only where the writers of a format put it: files of other programs may mention this one anywhere.

mod pictures;
mod video;
mod volumes;
mod zarr;

use std::fs::File;
use std::io::{BufReader, Read as _, Seek as _, SeekFrom};
use std::path::Path;

use serde::Deserialize;
use serde::de::IgnoredAny;

pub(super) use zarr::other_file_in_hierarchy;

use super::open_regular;
use crate::provenance::{MAX_LOOK_BYTES, PROVENANCE_MARK};

/// Length of the longest text with the program mark, in bytes: a version follows the mark.
const MAX_MARK_BYTES: u64 = 256;

/// Maximum number of parts of a file that are skipped in search of the mark: a record in EXR has a hundred times
/// fewer.
const MAX_PARTS: usize = 1 << 16;

/// Length of the longest JSON that is examined, in bytes: reports and looks are shorter.
const MAX_JSON_BYTES: u64 = 2 * MAX_LOOK_BYTES as u64;

/// Returns true if a file was written by this program or is empty, so that nothing is lost by replacing it.
///
/// A file that cannot be read counts as another program's. Of folders, those of Zarr are known, to which nobody has
/// added anything.
pub fn is_written_by_us(path: &Path) -> bool {
    if path.is_dir() {
        return zarr::is_own_folder(path);
    }
    open_regular(path).is_ok_and(|file| has_mark(BufReader::new(file)).unwrap_or(false))
}

/// Searches for the mark in the place where the format, recognised by its magic bytes, has it. A truncated file has
/// none.
fn has_mark(mut file: BufReader<File>) -> std::io::Result<bool> {
    let mut first = Vec::new();
    file.by_ref().take(16).read_to_end(&mut first)?;
    if first.is_empty() {
        return Ok(true);
    }
    file.seek(SeekFrom::Start(0))?;
    match &first[..] {
        [0x89, b'P', b'N', b'G', ..] => pictures::png(file),
        [b'G', b'I', b'F', b'8', ..] => pictures::gif(file),
        [0x76, 0x2f, 0x31, 0x01, ..] => pictures::exr(file),
        [_, _, _, _, b'f', b't', b'y', b'p', ..] => video::mp4(file),
        [b'N', b'R', b'R', b'D', ..] => volumes::nrrd(file),
        [b'O', b'b', b'j', b'e', b'c', b't', b'T', ..] => volumes::metaimage(file),
        [b'<', b'?', b'x', b'm', b'l', ..] => volumes::vti(file),
        // Header sizes (348 and 540), with which NIfTI-1 and NIfTI-2 headers begin.
        [0x5c, 1, 0, 0, ..] | [0x1c, 2, 0, 0, ..] => volumes::nifti(file),
        [0x1f, 0x8b, ..] => volumes::gzip(file),
        [b'I', b'I', 42 | 43, 0, ..] => volumes::tiff(file),
        [b'P', b'K', 3, 4, ..] => zarr::archive(file),
        _ => has_json_mark(file),
    }
}

/// Returns true if a text is the program mark, optionally followed by a version.
fn is_mark(text: &[u8]) -> bool {
    text.strip_prefix(PROVENANCE_MARK.as_bytes())
        .is_some_and(|rest| rest.is_empty() || rest.starts_with(b", "))
}

/// Fields that identify a look or a report; all others are ignored.
#[derive(Deserialize)]
struct MarkFields {
    #[serde(rename = "_made_by")]
    made_by: Option<String>,
    // Sessions and presets of versions without the mark have all three fields.
    schema: Option<IgnoredAny>,
    camera: Option<IgnoredAny>,
    shadows: Option<IgnoredAny>,
}

/// Searches for the mark in the `_made_by` field of a JSON object.
fn has_json_mark(file: BufReader<File>) -> std::io::Result<bool> {
    let mut bytes = Vec::new();
    file.take(MAX_JSON_BYTES + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > MAX_JSON_BYTES {
        return Ok(false);
    }
    let Ok(told) = serde_json::from_slice::<MarkFields>(&bytes) else { return Ok(false) };
    let is_told = told.made_by.is_some_and(|text| is_mark(text.as_bytes()));
    let is_earlier = [told.schema, told.camera, told.shadows].iter().all(Option::is_some);
    Ok(is_told || is_earlier)
}
