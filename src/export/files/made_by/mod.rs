//! Files of this program, told from files of others by the mark that they carry.
//!
//! The mark counts only where the writers of a format put it: others may write of this program wherever they like.

mod film;
mod pictures;
mod volumes;

use std::fs::File;
use std::io::{BufReader, Read as _, Seek as _, SeekFrom};
use std::path::Path;

use serde::Deserialize;
use serde::de::IgnoredAny;

use super::open_regular;
use crate::model::{MADE_BY, MAX_LOOK_BYTES};

/// Bytes of the longest text that says who made a file: a version stands after the mark.
const LONGEST_MARK: u64 = 256;

/// Most parts of a file that are stepped over before its mark is given up: a look in EXR has a hundred times fewer.
const MOST_PARTS: usize = 1 << 16;

/// Bytes of the longest JSON that is looked at: reports and looks are shorter.
const MOST_JSON: u64 = 2 * MAX_LOOK_BYTES as u64;

/// Whether this program has made a file, or nobody: an empty one holds nothing that could be lost. A file that cannot
/// be read counts as somebody else's.
pub fn is_ours(path: &Path) -> bool {
    open_regular(path).is_ok_and(|file| has_mark(BufReader::new(file)).unwrap_or(false))
}

/// Looks for the mark where the format has it, which the first bytes tell. A file that ends too early has none.
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
        [_, _, _, _, b'f', b't', b'y', b'p', ..] => film::mp4(file),
        [b'N', b'R', b'R', b'D', ..] => volumes::nrrd(file),
        [b'O', b'b', b'j', b'e', b'c', b't', b'T', ..] => volumes::metaimage(file),
        [b'<', b'?', b'x', b'm', b'l', ..] => volumes::vti(file),
        // Their lengths, with which headers of NIfTI begin.
        [0x5c, 1, 0, 0, ..] | [0x1c, 2, 0, 0, ..] => volumes::nifti(file),
        [0x1f, 0x8b, ..] => volumes::gzip(file),
        [b'I', b'I', 42 | 43, 0, ..] => volumes::tiff(file),
        _ => json(file),
    }
}

/// Whether a text says that this program made what it stands in.
fn is_mark(text: &[u8]) -> bool {
    text.strip_prefix(MADE_BY.as_bytes()).is_some_and(|rest| rest.is_empty() || rest.starts_with(b", "))
}

/// What tells a look or a report; nothing else of it is kept.
#[derive(Deserialize)]
struct Told {
    #[serde(rename = "_made_by")]
    made_by: Option<String>,
    // Sessions and presets of versions without the mark have all of these.
    schema: Option<IgnoredAny>,
    camera: Option<IgnoredAny>,
    shadows: Option<IgnoredAny>,
}

/// The field of an object that says it.
fn json(file: BufReader<File>) -> std::io::Result<bool> {
    let mut bytes = Vec::new();
    file.take(MOST_JSON + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > MOST_JSON {
        return Ok(false);
    }
    let Ok(told) = serde_json::from_slice::<Told>(&bytes) else { return Ok(false) };
    let is_told = told.made_by.is_some_and(|text| is_mark(text.as_bytes()));
    let is_earlier = [told.schema, told.camera, told.shadows].iter().all(Option::is_some);
    Ok(is_told || is_earlier)
}

#[cfg(test)]
mod tests;
