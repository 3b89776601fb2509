//! Names of streams in OLE 2 compound files, which are file systems within a file.
//!
//! After MS-CFB of Microsoft, version 11: section 2.2 for the header, 2.6 for the directory.

use std::io::{Read as _, Seek as _, SeekFrom};

use super::super::reading::input::InputFile;

/// First bytes of a compound file.
pub(super) const SIGNATURE: &[u8] = b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1";

/// Bytes of a directory entry.
const ENTRY_BYTES: usize = 128;

/// Bytes of the directory that are read: the names that identify a format are among the first.
const DIRECTORY_BYTES: u64 = 16 << 10;

/// Names of the first streams and storages of a compound file; empty for any other file.
///
/// The directory is assumed to be contiguous, which holds at its beginning.
pub(super) fn names(start: &[u8], input: &mut InputFile) -> Vec<String> {
    let word = |at: usize| {
        let bytes = start.get(at..at + 4).and_then(|bytes| bytes.try_into().ok());
        u64::from(u32::from_le_bytes(bytes.unwrap_or_default()))
    };
    // Sectors have 512 to 4096 bytes; the header takes the first.
    let shift = word(30) & 0xffff;
    if !start.starts_with(SIGNATURE) || !(9..=12).contains(&shift) {
        return Vec::new();
    }
    let at = (word(48) + 1) << shift;
    let mut directory = Vec::new();
    let found = input.reader.seek(SeekFrom::Start(at));
    let read = found.and_then(|_| input.reader.by_ref().take(DIRECTORY_BYTES).read_to_end(&mut directory));
    if read.is_err() {
        return Vec::new();
    }
    directory.chunks_exact(ENTRY_BYTES).map(name).filter(|name| !name.is_empty()).collect()
}

/// Decodes the name of an entry: up to 31 UTF-16 code units and a zero.
fn name(entry: &[u8]) -> String {
    let letters = entry[..64].chunks_exact(2).map(|pair| u16::from_le_bytes([pair[0], pair[1]]));
    char::decode_utf16(letters.take_while(|&letter| letter != 0)).filter_map(Result::ok).collect()
}
