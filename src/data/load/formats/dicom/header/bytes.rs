//! The bytes of a file in order, with the place that has been reached; those of a deflated data set inflated.

use std::fs::File;
use std::io::{self, BufReader, Read};

use flate2::bufread::DeflateDecoder;

use super::tags::Tag;
use crate::data::load::Endian;
use crate::data::load::reading::input::Input;

/// Longer values are not read: of those that are, only tables of offsets grow, by 8 bytes for each frame.
pub(in crate::data::load::formats::dicom) const LONGEST_VALUE: u64 = 4 << 20;

/// The bytes of a file, read from its beginning on.
pub(in crate::data::load::formats::dicom) struct Bytes {
    from: From,
    /// How many have been read, after inflating.
    pub(in crate::data::load::formats::dicom) at: u64,
    /// How many there are; `u64::MAX` where only inflating them all would tell.
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

    /// The rest, inflated.
    pub(in crate::data::load::formats::dicom) fn inflated(self) -> Self {
        match self.from {
            From::File(reader) => {
                Self { from: From::Deflated(DeflateDecoder::new(reader)), at: 0, len: u64::MAX }
            }
            From::Deflated(_) => self,
        }
    }

    /// Whether the place can be found again in the file itself.
    pub(in crate::data::load::formats::dicom) fn is_deflated(&self) -> bool {
        matches!(self.from, From::Deflated(_))
    }

    /// The next bytes.
    ///
    /// # Errors
    /// `UnexpectedEof` where there are not so many.
    pub(in crate::data::load::formats::dicom) fn next<const N: usize>(&mut self) -> io::Result<[u8; N]> {
        let mut bytes = [0; N];
        self.read_exact(&mut bytes)?;
        Ok(bytes)
    }

    /// The next bytes, without going on; fewer at the end. Not of what is deflated.
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

    /// The next tag; `None` where the bytes end before one.
    pub(in crate::data::load::formats::dicom) fn tag(&mut self, endian: Endian) -> io::Result<Option<Tag>> {
        match self.u16(endian).and_then(|group| Ok((group, self.u16(endian)?))) {
            Ok((group, element)) => Ok(Some(Tag::from(group) << 16 | Tag::from(element))),
            Err(error) if error.kind() == io::ErrorKind::UnexpectedEof => Ok(None),
            Err(error) => Err(error),
        }
    }

    /// A value of so many bytes, at most [`LONGEST_VALUE`] of them.
    pub(in crate::data::load::formats::dicom) fn value(&mut self, length: u64) -> io::Result<Vec<u8>> {
        let mut value = Vec::new();
        self.by_ref().take(length.min(LONGEST_VALUE)).read_to_end(&mut value)?;
        if (value.len() as u64) < length { Err(io::ErrorKind::UnexpectedEof.into()) } else { Ok(value) }
    }

    /// Goes on by so many bytes.
    pub(in crate::data::load::formats::dicom) fn skip(&mut self, count: u64) -> io::Result<()> {
        if let From::File(reader) = &mut self.from {
            // Beyond the end would be no error.
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
