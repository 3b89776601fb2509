//! Sequential reader of a file's bytes with its position; inflates a deflated data set.

use std::fs::File;
use std::io::{self, BufReader, Read};

use flate2::bufread::DeflateDecoder;

use super::tags::Tag;
use crate::data::load::Endian;
use crate::data::load::reading::input::Input;

/// Maximum size of a value that is read: of the values in use, only offset tables grow, by 8 bytes per frame.
pub(in crate::data::load::formats::dicom) const LONGEST_VALUE: u64 = 4 << 20;

/// Sequential reader of a DICOM file, from its beginning.
pub(in crate::data::load::formats::dicom) struct Bytes {
    from: From,
    /// Number of bytes read so far, after inflating.
    pub(in crate::data::load::formats::dicom) at: u64,
    /// Total number of bytes; `u64::MAX` for deflated data, whose size is unknown before all of them are inflated.
    pub(in crate::data::load::formats::dicom) len: u64,
}

enum From {
    File(BufReader<File>),
    Deflated(DeflateDecoder<BufReader<File>>),
}

impl Bytes {
    pub(in crate::data::load::formats::dicom) fn of(input: Input) -> Self {
        Self { from: From::File(input.reader), at: 0, len: input.len }
    }

    /// Inflates the rest of the bytes.
    pub(in crate::data::load::formats::dicom) fn inflated(self) -> Self {
        match self.from {
            From::File(reader) => {
                Self { from: From::Deflated(DeflateDecoder::new(reader)), at: 0, len: u64::MAX }
            }
            From::Deflated(_) => self,
        }
    }

    /// True if the data are deflated, so that positions are no offsets in the file.
    pub(in crate::data::load::formats::dicom) fn is_deflated(&self) -> bool {
        matches!(self.from, From::Deflated(_))
    }

    /// Reads the next `N` bytes.
    ///
    /// # Errors
    /// `UnexpectedEof` if fewer remain.
    pub(in crate::data::load::formats::dicom) fn next<const N: usize>(&mut self) -> io::Result<[u8; N]> {
        let mut bytes = [0; N];
        self.read_exact(&mut bytes)?;
        Ok(bytes)
    }

    /// Returns the next bytes without consuming them; fewer at the end, and none of deflated data.
    pub(in crate::data::load::formats::dicom) fn peek<const N: usize>(&mut self) -> io::Result<Vec<u8>> {
        let mut bytes = Vec::with_capacity(N);
        let From::File(reader) = &mut self.from else { return Ok(bytes) };
        reader.by_ref().take(N as u64).read_to_end(&mut bytes)?;
        reader.seek_relative(-(bytes.len() as i64))?;
        Ok(bytes)
    }

    pub(in crate::data::load::formats::dicom) fn u16(&mut self, endian: Endian) -> io::Result<u16> {
        self.next().map(|bytes| match endian {
            Endian::Little => u16::from_le_bytes(bytes),
            Endian::Big => u16::from_be_bytes(bytes),
        })
    }

    pub(in crate::data::load::formats::dicom) fn u32(&mut self, endian: Endian) -> io::Result<u32> {
        self.next().map(|bytes| match endian {
            Endian::Little => u32::from_le_bytes(bytes),
            Endian::Big => u32::from_be_bytes(bytes),
        })
    }

    /// Reads the next tag; `None` if the bytes end before a whole one.
    pub(in crate::data::load::formats::dicom) fn tag(&mut self, endian: Endian) -> io::Result<Option<Tag>> {
        match self.u16(endian).and_then(|group| Ok((group, self.u16(endian)?))) {
            Ok((group, element)) => Ok(Some(Tag::from(group) << 16 | Tag::from(element))),
            Err(error) if error.kind() == io::ErrorKind::UnexpectedEof => Ok(None),
            Err(error) => Err(error),
        }
    }

    /// Reads a value of `length` bytes, which must not exceed [`LONGEST_VALUE`].
    pub(in crate::data::load::formats::dicom) fn value(&mut self, length: u64) -> io::Result<Vec<u8>> {
        let mut value = Vec::new();
        self.by_ref().take(length.min(LONGEST_VALUE)).read_to_end(&mut value)?;
        if (value.len() as u64) < length { Err(io::ErrorKind::UnexpectedEof.into()) } else { Ok(value) }
    }

    /// Skips forward by `count` bytes.
    pub(in crate::data::load::formats::dicom) fn skip(&mut self, count: u64) -> io::Result<()> {
        if let From::File(reader) = &mut self.from {
            // Seeking beyond the end of the file would not fail.
            let is_within = self.at.checked_add(count).is_some_and(|end| end <= self.len);
            let step = i64::try_from(count).ok().filter(|_| is_within);
            reader.seek_relative(step.ok_or(io::ErrorKind::UnexpectedEof)?)?;
            self.at += count;
            return Ok(());
        }
        match io::copy(&mut self.by_ref().take(count), &mut io::sink())? {
            skipped if skipped < count => Err(io::ErrorKind::UnexpectedEof.into()),
            _ => Ok(()),
        }
    }
}

impl Read for Bytes {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        let read = match &mut self.from {
            From::File(reader) => reader.read(into),
            From::Deflated(reader) => reader.read(into),
        }?;
        self.at += read as u64;
        Ok(read)
    }
}
