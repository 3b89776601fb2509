//! The mark in volumes: a comment of NRRD, of `NIfTI` and of VTK's XML, a field of `MetaImage`, a text of TIFF. `NumPy`'s
//! arrays have no place for one.

use std::fs::File;
use std::io::{BufRead as _, BufReader, Error, Read, Result, Seek as _, SeekFrom};

use flate2::bufread::MultiGzDecoder;

use super::{LONGEST_MARK, MOST_PARTS, is_mark};

/// The field of `MetaImage` that says it: Software Versions of DICOM.
const FIELD: &[u8] = b"0018|1020 = ";

/// What stands before and behind the comment of VTK's XML.
const AROUND_COMMENT: [&[u8]; 2] = [b"<?xml version=\"1.0\"?>\n<!-- ", b" -->\n"];

/// Bytes of the headers of NIfTI-1 and NIfTI-2, with which they begin.
const NIFTI_1: usize = 348;
const NIFTI_2: usize = 540;

/// Bytes between a header of `NIfTI` and its first extension; the first of them says that there is one.
const EXTENDER: usize = 4;

/// Bytes of an extension before its text: its length, and its kind.
const BEFORE_TEXT: usize = 8;

/// The kind of an extension that is text (`NIFTI_ECODE_COMMENT`).
const COMMENT: u32 = 6;

/// TIFF's tag of the text that says which program made a file.
const SOFTWARE: u16 = 305;

/// The comment that follows the first line.
pub(super) fn nrrd(file: BufReader<File>) -> Result<bool> {
    let mut lines = file.take(2 * LONGEST_MARK);
    let mut line = Vec::new();
    lines.read_until(b'\n', &mut line)?;
    line.clear();
    lines.read_until(b'\n', &mut line)?;
    let text = line.strip_prefix(b"# ").unwrap_or_default();
    Ok(is_mark(text.trim_ascii_end()))
}

/// A field of the first ones.
pub(super) fn metaimage(file: BufReader<File>) -> Result<bool> {
    for line in file.take(2 * LONGEST_MARK).split(b'\n') {
        let line = line?;
        if let Some(text) = line.strip_prefix(FIELD) {
            return Ok(is_mark(text.trim_ascii_end()));
        }
        if !line.contains(&b'=') {
            break;
        }
    }
    Ok(false)
}

/// The comment behind the declaration.
pub(super) fn vti(file: BufReader<File>) -> Result<bool> {
    let mut bytes = Vec::new();
    file.take(2 * LONGEST_MARK).read_to_end(&mut bytes)?;
    let [before, after] = AROUND_COMMENT;
    let Some(rest) = bytes.strip_prefix(before) else { return Ok(false) };
    let end = rest.windows(after.len()).position(|bytes| bytes == after);
    Ok(end.is_some_and(|end| is_mark(&rest[..end])))
}

/// The first extension.
pub(super) fn nifti(file: impl Read) -> Result<bool> {
    let most = (NIFTI_2 + EXTENDER + BEFORE_TEXT) as u64 + LONGEST_MARK;
    let mut bytes = Vec::new();
    file.take(most).read_to_end(&mut bytes)?;
    let word = |at: usize| bytes.get(at..)?.first_chunk().map(|word| u32::from_le_bytes(*word));
    let is_one = |header: usize, mark: &[u8], at: usize| {
        word(0) == Some(header as u32) && bytes.get(at..).is_some_and(|rest| rest.starts_with(mark))
    };
    let header = if is_one(NIFTI_1, b"n+1\0", 344) {
        NIFTI_1
    } else if is_one(NIFTI_2, b"n+2\0", 4) {
        NIFTI_2
    } else {
        return Ok(false);
    };
    let extension = header + EXTENDER;
    let has_one = bytes.get(header).is_some_and(|&has| has != 0);
    let (length, kind) = (word(extension), word(extension + 4));
    let (Some(length), true, Some(COMMENT)) = (length, has_one, kind) else { return Ok(false) };
    let text = bytes.get(extension + BEFORE_TEXT..).unwrap_or_default();
    let text = &text[..text.len().min((length as usize).saturating_sub(BEFORE_TEXT))];
    // Zeros fill it up.
    Ok(is_mark(text.split(|&byte| byte == 0).next().unwrap_or_default()))
}

/// As [`nifti`], of a file that is compressed as a whole.
pub(super) fn gzip(file: BufReader<File>) -> Result<bool> {
    nifti(MultiGzDecoder::new(file))
}

/// A text of the first page.
pub(super) fn tiff(mut file: BufReader<File>) -> Result<bool> {
    let mut head = [0; 4];
    file.read_exact(&mut head)?;
    let is_big = head[2] == 43;
    if is_big {
        file.seek_relative(4)?;
    }
    let at = word(&mut file, is_big)?;
    file.seek(SeekFrom::Start(at))?;
    let count =
        if is_big { word(&mut file, true)? } else { u64::from(u16::from_le_bytes(array(&mut file)?)) };
    if count > MOST_PARTS as u64 {
        return Err(Error::other("a page has more entries than there are tags"));
    }
    for _ in 0..count {
        let tag = u16::from_le_bytes(array(&mut file)?);
        array::<2>(&mut file)?;
        let [length, at] = [word(&mut file, is_big)?, word(&mut file, is_big)?];
        if tag == SOFTWARE {
            file.seek(SeekFrom::Start(at))?;
            let mut text = Vec::new();
            file.take(length.min(LONGEST_MARK)).read_to_end(&mut text)?;
            return Ok(is_mark(text.strip_suffix(b"\0").unwrap_or_default()));
        }
    }
    Ok(false)
}

fn array<const N: usize>(file: &mut BufReader<File>) -> Result<[u8; N]> {
    let mut bytes = [0; N];
    file.read_exact(&mut bytes)?;
    Ok(bytes)
}

/// A place, in as many bytes as the file counts with.
fn word(file: &mut BufReader<File>, is_big: bool) -> Result<u64> {
    if is_big { Ok(u64::from_le_bytes(array(file)?)) } else { Ok(u32::from_le_bytes(array(file)?).into()) }
}
