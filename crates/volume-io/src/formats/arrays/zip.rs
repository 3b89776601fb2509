//! Reader of ZIP archives in the variants that NumPy and Zarr write: entries that are stored or deflated.
//!
//! After PKWARE's APPNOTE 6.3, <https://pkware.cachefly.net/webdocs/casestudies/APPNOTE.TXT>; its sections are named
//! below. Only the central directory counts. Sizes before the entries, or after them, may be missing.

use std::io::{self, Read, Seek as _, SeekFrom};

use flate2::bufread::DeflateDecoder;

use super::LoadError;
use super::input::InputFile;
use chiaroscuro_volume::{LoadContext, quoted};

/// Signature of a local file header (4.3.7).
const LOCAL_HEADER: &[u8] = b"PK\x03\x04";
/// Signature of a central directory header (4.3.12).
const CENTRAL_HEADER: &[u8] = b"PK\x01\x02";
/// Signature of the end of central directory record (4.3.16), and its length without the comment.
const END_OF_DIRECTORY: &[u8] = b"PK\x05\x06";
const END_BYTES: usize = 22;
/// Signatures of the ZIP64 end of central directory record (4.3.14), and of its locator before [`END_OF_DIRECTORY`]
/// (4.3.15).
const ZIP64_END: &[u8] = b"PK\x06\x06";
const ZIP64_LOCATOR: &[u8] = b"PK\x06\x07";
const LARGE_NOTE_BYTES: usize = 20;
/// Placeholder for numbers that need 64 bits, and the id of the extra field that has them (4.5.3).
const IN_ZIP64_FIELD: u64 = u32::MAX as u64;
const ZIP64_FIELD: u64 = 1;

/// Maximum length of the central directory, in bytes: a hundred thousand entries.
const MAX_DIRECTORY: u64 = 16 << 20;
/// Maximum expansion by deflate, which makes at most 1032 bytes of one; the caller adds some for its headers.
const MAX_INFLATION: u64 = 1032;

const HELP: &str = "save the archive again, or copy the file again";

/// File in an archive, by its central directory header.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct ZipEntry {
    pub(super) name: String,
    /// Uncompressed length, in bytes.
    pub(super) bytes: u64,
    /// CRC-32 of the uncompressed content.
    pub(super) checksum: u32,
    is_deflated: bool,
    /// Compressed length, in bytes.
    stored_bytes: u64,
    /// Offset of its local header in the archive.
    at: u64,
}

/// Returns the name of the entry with which a file begins; `None` if it begins with none.
pub(super) fn first_entry(start: &[u8]) -> Option<&str> {
    let length = read_le(start, 26, 2) as usize;
    let name = start.get(30..30 + length).filter(|_| start.starts_with(LOCAL_HEADER))?;
    std::str::from_utf8(name).ok()
}

/// Files in an archive, by its central directory.
#[derive(Debug, Default)]
pub(super) struct ZipDirectory {
    pub(super) entries: Vec<ZipEntry>,
    /// Names of entries that are encrypted.
    pub(super) encrypted: Vec<String>,
    /// Names of entries whose compression is not supported.
    pub(super) unsupported: Vec<String>,
}

/// Reads the central directory.
///
/// # Errors
/// `BadInput` where the directory is missing, or inconsistent.
pub(super) fn read_central_directory(
    context: LoadContext<'_>,
    input: &mut InputFile,
) -> Result<ZipDirectory, LoadError> {
    let bad = |why: &str| context.bad_input_error("directory", why, HELP);
    let (at, length) = find_central_directory(context, input)?;
    if length > MAX_DIRECTORY || at.saturating_add(length) > input.len {
        return Err(bad("the directory of the archive is too long, or reaches beyond the file"));
    }
    let bytes = read_at(input, at, length).map_err(|error| context.io_error(error))?;
    let mut directory = ZipDirectory::default();
    let mut rest = &bytes[..];
    while rest.starts_with(CENTRAL_HEADER) && rest.len() >= 46 {
        let [name, extra, comment] = [28, 30, 32].map(|at| read_le(rest, at, 2) as usize);
        let Some(line) = rest.get(..46 + name + extra + comment) else {
            return Err(bad("the directory of the archive is truncated"));
        };
        rest = &rest[line.len()..];
        let [mut bytes, mut stored_bytes, mut at] = [24, 20, 42].map(|at| read_le(line, at, 4));
        let mut large = zip64_numbers(&line[46 + name..46 + name + extra]);
        for value in [&mut bytes, &mut stored_bytes, &mut at] {
            if *value == IN_ZIP64_FIELD {
                *value = large.next().ok_or_else(|| bad("an entry does not state its size"))?;
            }
        }
        let (flags, method) = (read_le(line, 8, 2), read_le(line, 10, 2));
        let name = String::from_utf8_lossy(&line[46..46 + name]).into_owned();
        // Bit 0: encrypted.
        if flags & 1 != 0 {
            directory.encrypted.push(name);
            continue;
        }
        let most = match method {
            0 => stored_bytes,
            8 => stored_bytes.saturating_add(64).saturating_mul(MAX_INFLATION),
            _ => {
                directory.unsupported.push(name);
                continue;
            }
        };
        if stored_bytes > input.len || bytes > most {
            return Err(bad(&format!("{bytes} bytes cannot be the size of {}", quoted(&name))));
        }
        let checksum = read_le(line, 16, 4) as u32;
        let is_deflated = method == 8;
        directory.entries.push(ZipEntry { name, bytes, checksum, is_deflated, stored_bytes, at });
    }
    Ok(directory)
}

/// Opens an entry for reading, inflated; it yields at most its announced length.
pub(super) fn open_entry<'a>(
    context: LoadContext<'_>,
    input: &'a mut InputFile,
    entry: &ZipEntry,
) -> Result<Box<dyn Read + 'a>, LoadError> {
    open_entry_at(context, input, entry, 0)
}

/// Opens the content of an entry from an offset; of entries that are not compressed, nothing before it is read.
fn open_entry_at<'a>(
    context: LoadContext<'_>,
    input: &'a mut InputFile,
    entry: &ZipEntry,
    start: u64,
) -> Result<Box<dyn Read + 'a>, LoadError> {
    let io = |error| context.io_error(error);
    let head = read_at(input, entry.at, 30).map_err(io)?;
    if !head.starts_with(LOCAL_HEADER) || head.len() < 30 {
        let why = format!("{} is not where the directory of the archive says", quoted(&entry.name));
        return Err(context.bad_input_error("directory", why, HELP));
    }
    // The file name, and an extra field whose length may differ from that in the directory.
    let content = entry.at.saturating_add(30 + read_le(&head, 26, 2) + read_le(&head, 28, 2));
    if !entry.is_deflated {
        input.seek(content.saturating_add(start)).map_err(io)?;
        let rest = entry.bytes.min(entry.stored_bytes).saturating_sub(start);
        return Ok(Box::new(io::Read::by_ref(&mut input.reader).take(rest)));
    }
    input.seek(content).map_err(io)?;
    let stored = io::Read::by_ref(&mut input.reader).take(entry.stored_bytes);
    let mut inflated = DeflateDecoder::new(stored).take(entry.bytes);
    io::copy(&mut io::Read::by_ref(&mut inflated).take(start), &mut io::sink())
        .map_err(|error| broken_data_error(context, entry, &error))?;
    Ok(Box::new(inflated))
}

/// Reads a part of an entry: `count` bytes from an offset in its content, fewer where it ends before.
pub(super) fn read_entry_range(
    context: LoadContext<'_>,
    input: &mut InputFile,
    entry: &ZipEntry,
    start: u64,
    count: u64,
) -> Result<Vec<u8>, LoadError> {
    let content = open_entry_at(context, input, entry, start)?;
    let mut bytes = Vec::new();
    let read = content.take(count).read_to_end(&mut bytes);
    read.map_err(|error| broken_data_error(context, entry, &error))?;
    Ok(bytes)
}

fn broken_data_error(context: LoadContext<'_>, entry: &ZipEntry, error: &io::Error) -> LoadError {
    context.bad_input_error("data", format!("the data of {} are broken: {error}", quoted(&entry.name)), HELP)
}

/// Finds the central directory; returns its offset and its length.
fn find_central_directory(context: LoadContext<'_>, input: &mut InputFile) -> Result<(u64, u64), LoadError> {
    // A comment after the record has at most 65535 bytes.
    let most = (END_BYTES + LARGE_NOTE_BYTES) as u64 + 0xffff;
    let from = input.len.saturating_sub(most);
    let tail = read_at(input, from, most).map_err(|error| context.io_error(error))?;
    let Some(end) = tail.windows(END_BYTES).rposition(|window| window.starts_with(END_OF_DIRECTORY)) else {
        return Err(context.bad_input_error(
            "directory",
            "the archive is truncated: it has no directory",
            HELP,
        ));
    };
    let (length, at) = (read_le(&tail, end + 12, 4), read_le(&tail, end + 16, 4));
    let note = end.checked_sub(LARGE_NOTE_BYTES).and_then(|at| tail.get(at..end));
    let note = note.filter(|note| note.starts_with(ZIP64_LOCATOR));
    if let Some(note) = note.filter(|_| at == IN_ZIP64_FIELD || length == IN_ZIP64_FIELD) {
        let end = read_at(input, read_le(note, 8, 8), 56).map_err(|error| context.io_error(error))?;
        if end.starts_with(ZIP64_END) {
            return Ok((read_le(&end, 48, 8), read_le(&end, 40, 8)));
        }
    }
    Ok((at, length))
}

/// Numbers in the ZIP64 extra field, in the order of the fields that they replace.
fn zip64_numbers(mut extra: &[u8]) -> impl Iterator<Item = u64> + use<> {
    let mut found = Vec::new();
    while extra.len() >= 4 {
        let length = read_le(extra, 2, 2) as usize;
        let field = extra.get(4..4 + length).unwrap_or_default();
        if read_le(extra, 0, 2) == ZIP64_FIELD {
            found = field.chunks_exact(8).map(|bytes| read_le(bytes, 0, 8)).collect();
        }
        extra = extra.get(4 + length..).unwrap_or_default();
    }
    found.into_iter()
}

/// Decodes a little-endian number of `width` bytes; 0 where the slice is too short.
fn read_le(bytes: &[u8], at: usize, width: usize) -> u64 {
    let bytes = bytes.get(at..at + width).unwrap_or_default();
    bytes.iter().rev().fold(0, |sum, &byte| sum << 8 | u64::from(byte))
}

/// Reads up to `count` bytes from an offset.
fn read_at(input: &mut InputFile, at: u64, count: u64) -> io::Result<Vec<u8>> {
    input.reader.seek(SeekFrom::Start(at))?;
    let mut bytes = Vec::new();
    io::Read::by_ref(&mut input.reader).take(count).read_to_end(&mut bytes)?;
    Ok(bytes)
}
