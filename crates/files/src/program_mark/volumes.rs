//! Program mark in volumes: a comment in NRRD, `NIfTI` and VTK's XML, a field of `MetaImage`, a text of TIFF. `NumPy`
//! arrays have no metadata for it.

use std::fs::File;
use std::io::{BufRead as _, BufReader, Error, Read, Result, Seek as _, SeekFrom};

use flate2::bufread::MultiGzDecoder;

use super::{MAX_MARK_BYTES, MAX_PARTS, is_mark};

/// `MetaImage` field with the mark, named by the tag of DICOM's Software Versions.
const METAIMAGE_FIELD: &[u8] = b"0018|1020 = ";

/// Bytes before and after the comment in VTK's XML.
const COMMENT_DELIMITERS: [&[u8]; 2] = [b"<?xml version=\"1.0\"?>\n<!-- ", b" -->\n"];

/// Sizes of the NIfTI-1 and NIfTI-2 headers in bytes, which are also their first field.
const NIFTI_1_HEADER_BYTES: usize = 348;
const NIFTI_2_HEADER_BYTES: usize = 540;

/// Bytes between a `NIfTI` header and its first extension; the first byte is non-zero if there is one.
const EXTENDER_BYTES: usize = 4;

/// Bytes before the text of an extension: its size and its code.
const EXTENSION_HEADER_BYTES: usize = 8;

/// Extension code of plain text (`NIFTI_ECODE_COMMENT`).
const COMMENT: u32 = 6;

/// TIFF tag of the text that names the writing program.
const SOFTWARE: u16 = 305;

/// Searches for the mark in the comment after the first line of an NRRD.
pub(super) fn nrrd(file: BufReader<File>) -> Result<bool> {
    let mut lines = file.take(2 * MAX_MARK_BYTES);
    let mut line = Vec::new();
    lines.read_until(b'\n', &mut line)?;
    line.clear();
    lines.read_until(b'\n', &mut line)?;
    let text = line.strip_prefix(b"# ").unwrap_or_default();
    Ok(is_mark(text.trim_ascii_end()))
}

/// Searches for the mark among the first fields of a `MetaImage`.
pub(super) fn metaimage(file: BufReader<File>) -> Result<bool> {
    for line in file.take(2 * MAX_MARK_BYTES).split(b'\n') {
        let line = line?;
        if let Some(text) = line.strip_prefix(METAIMAGE_FIELD) {
            return Ok(is_mark(text.trim_ascii_end()));
        }
        if !line.contains(&b'=') {
            break;
        }
    }
    Ok(false)
}

/// Searches for the mark in the comment after the XML declaration.
pub(super) fn vti(file: BufReader<File>) -> Result<bool> {
    let mut bytes = Vec::new();
    file.take(2 * MAX_MARK_BYTES).read_to_end(&mut bytes)?;
    let [before, after] = COMMENT_DELIMITERS;
    let Some(rest) = bytes.strip_prefix(before) else { return Ok(false) };
    let end = rest.windows(after.len()).position(|bytes| bytes == after);
    Ok(end.is_some_and(|end| is_mark(&rest[..end])))
}

/// Searches for the mark in the first extension of a `NIfTI` file.
pub(super) fn nifti(file: impl Read) -> Result<bool> {
    let most = (NIFTI_2_HEADER_BYTES + EXTENDER_BYTES + EXTENSION_HEADER_BYTES) as u64 + MAX_MARK_BYTES;
    let mut bytes = Vec::new();
    file.take(most).read_to_end(&mut bytes)?;
    let word = |at: usize| bytes.get(at..)?.first_chunk().map(|word| u32::from_le_bytes(*word));
    let is_one = |header: usize, mark: &[u8], at: usize| {
        word(0) == Some(header as u32) && bytes.get(at..).is_some_and(|rest| rest.starts_with(mark))
    };
    let header = if is_one(NIFTI_1_HEADER_BYTES, b"n+1\0", 344) {
        NIFTI_1_HEADER_BYTES
    } else if is_one(NIFTI_2_HEADER_BYTES, b"n+2\0", 4) {
        NIFTI_2_HEADER_BYTES
    } else {
        return Ok(false);
    };
    let extension = header + EXTENDER_BYTES;
    let has_one = bytes.get(header).is_some_and(|&has| has != 0);
    let (length, kind) = (word(extension), word(extension + 4));
    let (Some(length), true, Some(COMMENT)) = (length, has_one, kind) else { return Ok(false) };
    let text = bytes.get(extension + EXTENSION_HEADER_BYTES..).unwrap_or_default();
    let text = &text[..text.len().min((length as usize).saturating_sub(EXTENSION_HEADER_BYTES))];
    // The text is padded with zeros.
    Ok(is_mark(text.split(|&byte| byte == 0).next().unwrap_or_default()))
}

/// Decompresses a gzip file and continues like [`nifti`].
pub(super) fn gzip(file: BufReader<File>) -> Result<bool> {
    nifti(MultiGzDecoder::new(file))
}

/// Searches for the mark in the Software tag of the first page of a TIFF.
pub(super) fn tiff(mut file: BufReader<File>) -> Result<bool> {
    let mut head = [0; 4];
    file.read_exact(&mut head)?;
    let is_big = head[2] == 43;
    if is_big {
        file.seek_relative(4)?;
    }
    let at = read_offset(&mut file, is_big)?;
    file.seek(SeekFrom::Start(at))?;
    let count =
        if is_big { read_offset(&mut file, true)? } else { u64::from(u16::from_le_bytes(array(&mut file)?)) };
    if count > MAX_PARTS as u64 {
        return Err(Error::other("a page has more entries than there are tags"));
    }
    for _ in 0..count {
        let tag = u16::from_le_bytes(array(&mut file)?);
        array::<2>(&mut file)?;
        let [length, at] = [read_offset(&mut file, is_big)?, read_offset(&mut file, is_big)?];
        if tag == SOFTWARE {
            file.seek(SeekFrom::Start(at))?;
            let mut text = Vec::new();
            file.take(length.min(MAX_MARK_BYTES)).read_to_end(&mut text)?;
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

/// Reads an offset of 4 bytes, or of 8 in a `BigTIFF`.
fn read_offset(file: &mut BufReader<File>, is_big: bool) -> Result<u64> {
    if is_big { Ok(u64::from_le_bytes(array(file)?)) } else { Ok(u32::from_le_bytes(array(file)?).into()) }
}
