//! Image file directories of a TIFF file: the metadata of each page, as numbered entries.

use std::collections::HashSet;
use std::io;

use super::super::messages::unreadable_error;
use super::bytes::{TiffBytes, decode_integer};
use crate::Endian;
use chiaroscuro_volume::{LoadContext, LoadControl, LoadError};

/// Maximum number of pages: a hundred times those of long recordings.
pub(crate) const MAX_PAGES: usize = 1 << 20;

/// Maximum number of entries of a directory: real ones have some tens.
const MAX_ENTRIES: u64 = 4096;

/// Entry of a directory: type, count and location of its values.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct TiffDirectoryEntry {
    tag: u16,
    /// Type of the values (TIFF 6.0, section 2).
    value_type: u16,
    pub(crate) count: u64,
    offset: u64,
}

/// Size of a value by its type, in bytes; `None` for an unknown type.
const fn value_bytes(kind: u16) -> Option<u64> {
    match kind {
        // BYTE, ASCII, SBYTE, UNDEFINED
        1 | 2 | 6 | 7 => Some(1),
        // SHORT, SSHORT
        3 | 8 => Some(2),
        // LONG, SLONG, FLOAT, IFD
        4 | 9 | 11 | 13 => Some(4),
        // RATIONAL, SRATIONAL, DOUBLE, and in BigTIFF LONG8, SLONG8, IFD8
        5 | 10 | 12 | 16 | 17 | 18 => Some(8),
        _ => None,
    }
}

impl TiffDirectoryEntry {
    /// Reads the bytes of the values, at most `most`.
    fn bytes(self, file: &mut TiffBytes, most: u64) -> io::Result<Vec<u8>> {
        let size = value_bytes(self.value_type).and_then(|size| size.checked_mul(self.count));
        let size = size.filter(|&size| size <= file.len()).ok_or(io::ErrorKind::UnexpectedEof)?;
        let mut bytes = vec![0; size.min(most) as usize];
        file.read(self.offset, &mut bytes)?;
        Ok(bytes)
    }

    /// Reads the values as non-negative integers, at most `most` of them.
    pub(crate) fn numbers(self, file: &mut TiffBytes, most: u64) -> io::Result<Vec<u64>> {
        let is_whole = matches!(self.value_type, 1 | 3 | 4 | 13 | 16 | 18);
        let size =
            value_bytes(self.value_type).filter(|_| is_whole).ok_or(io::ErrorKind::InvalidData)? as usize;
        let endian = file.endian;
        let bytes = self.bytes(file, most.saturating_mul(size as u64))?;
        Ok(bytes.chunks_exact(size).map(|number| decode_integer(number, endian)).collect())
    }

    /// Reads the first value as a floating-point number, whatever its numeric type.
    pub(crate) fn first_number(self, file: &mut TiffBytes) -> Option<f64> {
        let endian = file.endian;
        let bytes = self.bytes(file, 8).ok()?;
        let bytes = bytes.get(..value_bytes(self.value_type)? as usize)?;
        Some(match self.value_type {
            5 => {
                let (over, under) = bytes.split_at(4);
                decode_integer(over, endian) as f64 / decode_integer(under, endian) as f64
            }
            11 => f64::from(f32::from_bits(decode_integer(bytes, endian) as u32)),
            12 => f64::from_bits(decode_integer(bytes, endian)),
            1 | 3 | 4 | 16 => decode_integer(bytes, endian) as f64,
            _ => return None,
        })
    }

    /// Reads the first value as an integer.
    pub(crate) fn first_integer(self, file: &mut TiffBytes) -> io::Result<u64> {
        let one = Self { count: self.count.min(1), ..self };
        one.numbers(file, 1)?.first().copied().ok_or_else(|| io::ErrorKind::InvalidData.into())
    }

    /// Reads the text up to a zero byte, at most `most` bytes. Text that is not UTF-8 is taken for Latin-1, as older
    /// programs write it.
    pub(crate) fn text(self, file: &mut TiffBytes, most: u64) -> io::Result<String> {
        let mut bytes = self.bytes(file, most)?;
        bytes.truncate(bytes.iter().position(|&byte| byte == 0).unwrap_or(bytes.len()));
        Ok(String::from_utf8(bytes)
            .unwrap_or_else(|error| error.as_bytes().iter().map(|&byte| char::from(byte)).collect()))
    }

    /// Reads the raw bytes of the values, at most `most`.
    pub(crate) fn raw(self, file: &mut TiffBytes, most: u64) -> io::Result<Vec<u8>> {
        self.bytes(file, most)
    }
}

/// Image file directory: the entries of a page.
#[derive(Debug, Default)]
pub(crate) struct TiffDirectory {
    entries: Vec<TiffDirectoryEntry>,
}

impl TiffDirectory {
    pub(crate) fn get(&self, tag: u16) -> Option<TiffDirectoryEntry> {
        self.entries.iter().find(|entry| entry.tag == tag).copied()
    }

    /// Returns all entries of a tag that may occur more than once.
    pub(crate) fn all(&self, tag: u16) -> impl Iterator<Item = TiffDirectoryEntry> {
        self.entries.iter().filter(move |entry| entry.tag == tag).copied()
    }

    /// Reads the directory at an offset, and the offset of the next one, which is 0 after the last.
    fn read(file: &mut TiffBytes, is_big: bool, at: u64) -> io::Result<(Self, u64)> {
        // Sizes of the entry count, of an entry and of an offset, in bytes.
        let (counted, size, place) = if is_big { (8, 20, 8) } else { (2, 12, 4) };
        let count = file.number(at, counted)?;
        if count > MAX_ENTRIES {
            return Err(io::ErrorKind::InvalidData.into());
        }
        let mut bytes = vec![0; count as usize * size + place];
        let start = at + counted as u64;
        file.read(start, &mut bytes)?;
        let endian = file.endian;
        let (listed, next) = bytes.split_at(count as usize * size);
        let entries = listed.chunks_exact(size).enumerate().filter_map(|(number, entry)| {
            let (kind, count) =
                (decode_integer(&entry[2..4], endian) as u16, decode_integer(&entry[4..4 + place], endian));
            let is_inside = value_bytes(kind)?.saturating_mul(count) <= place as u64;
            let inside = start + (number * size + 4 + place) as u64;
            let at = if is_inside { inside } else { decode_integer(&entry[4 + place..], endian) };
            Some(TiffDirectoryEntry {
                tag: decode_integer(&entry[..2], endian) as u16,
                value_type: kind,
                count,
                offset: at,
            })
        });
        Ok((Self { entries: entries.collect() }, decode_integer(next, endian)))
    }
}

/// Calls `each` with all directories of a file, in their order.
///
/// # Errors
/// `BadInput` for a file that is not TIFF or whose list of pages is corrupt, `Limit` for more pages than any
/// recording has; errors of `each`.
pub(crate) fn for_each_directory(
    context: LoadContext<'_>,
    file: &mut TiffBytes,
    control: &LoadControl,
    mut each: impl FnMut(&mut TiffBytes, TiffDirectory) -> Result<(), LoadError>,
) -> Result<(), LoadError> {
    let fault = |error| unreadable_error(context, "header", error);
    let mut magic = [0; 2];
    file.read(0, &mut magic).map_err(fault)?;
    file.endian = if magic == *b"MM" { Endian::Big } else { Endian::Little };
    let version = file.number(2, 2).map_err(fault)?;
    // BigTIFF: version 43, the size of an offset (8 bytes), and a zero.
    let is_big = version == 43;
    if is_big && file.number(4, 4).map_err(fault)? != if magic == *b"MM" { 8 << 16 } else { 8 } {
        return Err(unreadable_error(context, "header", io::ErrorKind::InvalidData.into()));
    }
    let mut next = if is_big { file.number(8, 8) } else { file.number(4, 4) }.map_err(fault)?;
    let mut seen = HashSet::new();
    while next != 0 {
        control.check()?;
        let field = format!("directory of page {}", seen.len());
        if seen.len() == MAX_PAGES {
            return Err(context.limit_error(
                &field,
                format!("there are more than {MAX_PAGES} pages"),
                "split the file into several",
            ));
        }
        if !seen.insert(next) {
            return Err(context.bad_input_error(
                &field,
                "the list of pages is circular: it leads back to an earlier page",
                "copy the file again, or save it anew",
            ));
        }
        let (directory, after) = TiffDirectory::read(file, is_big, next)
            .map_err(|error| unreadable_error(context, &field, error))?;
        each(file, directory)?;
        next = after;
    }
    if seen.is_empty() {
        return Err(context.bad_input_error("header", "the file has no pages", "copy the file again"));
    }
    Ok(())
}
