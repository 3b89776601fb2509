//! Sequential reader of a file's bytes with its position; inflates a deflated data set.

use std::fs::File;
use std::io::{self, BufReader, Read};

use flate2::bufread::DeflateDecoder;

use super::tags::DicomTag;
use crate::Endian;
use crate::reading::input::InputFile;

/// Maximum size of a value that is read: of the values in use, only offset tables grow, by 8 bytes per frame.
pub(crate) const MAX_VALUE_BYTES: u64 = 4 << 20;

/// Sequential reader of a DICOM file, from its beginning.
pub(crate) struct DicomReader {
    source: DicomSource,
    /// Number of bytes read so far, after inflating.
    pub(crate) position: u64,
    /// Total number of bytes; `u64::MAX` for deflated data, whose size is unknown before all of them are inflated.
    pub(crate) len: u64,
}

enum DicomSource {
    File(BufReader<File>),
    Deflated(DeflateDecoder<BufReader<File>>),
}

impl DicomReader {
    pub(crate) fn new(input: InputFile) -> Self {
        Self { source: DicomSource::File(input.reader), position: 0, len: input.len }
    }

    /// Inflates the rest of the bytes.
    pub(crate) fn into_inflated(self) -> Self {
        match self.source {
            DicomSource::File(reader) => Self {
                source: DicomSource::Deflated(DeflateDecoder::new(reader)),
                position: 0,
                len: u64::MAX,
            },
            DicomSource::Deflated(_) => self,
        }
    }

    /// True if the data are deflated, so that positions are no offsets in the file.
    pub(crate) fn is_deflated(&self) -> bool {
        matches!(self.source, DicomSource::Deflated(_))
    }

    /// Reads the next `N` bytes.
    ///
    /// # Errors
    /// `UnexpectedEof` if fewer remain.
    pub(crate) fn read_array<const N: usize>(&mut self) -> io::Result<[u8; N]> {
        let mut bytes = [0; N];
        self.read_exact(&mut bytes)?;
        Ok(bytes)
    }

    /// Returns the next bytes without consuming them; fewer at the end, and none of deflated data.
    pub(crate) fn peek<const N: usize>(&mut self) -> io::Result<Vec<u8>> {
        let mut bytes = Vec::with_capacity(N);
        let DicomSource::File(reader) = &mut self.source else { return Ok(bytes) };
        reader.by_ref().take(N as u64).read_to_end(&mut bytes)?;
        reader.seek_relative(-(bytes.len() as i64))?;
        Ok(bytes)
    }

    pub(crate) fn u16(&mut self, endian: Endian) -> io::Result<u16> {
        self.read_array().map(|bytes| match endian {
            Endian::Little => u16::from_le_bytes(bytes),
            Endian::Big => u16::from_be_bytes(bytes),
        })
    }

    pub(crate) fn u32(&mut self, endian: Endian) -> io::Result<u32> {
        self.read_array().map(|bytes| match endian {
            Endian::Little => u32::from_le_bytes(bytes),
            Endian::Big => u32::from_be_bytes(bytes),
        })
    }

    /// Reads the next tag; `None` if the bytes end before a whole one.
    pub(crate) fn tag(&mut self, endian: Endian) -> io::Result<Option<DicomTag>> {
        match self.u16(endian).and_then(|group| Ok((group, self.u16(endian)?))) {
            Ok((group, element)) => Ok(Some(DicomTag::from(group) << 16 | DicomTag::from(element))),
            Err(error) if error.kind() == io::ErrorKind::UnexpectedEof => Ok(None),
            Err(error) => Err(error),
        }
    }

    /// Reads a value of `length` bytes, which must not exceed [`MAX_VALUE_BYTES`].
    pub(crate) fn value(&mut self, length: u64) -> io::Result<Vec<u8>> {
        let mut value = Vec::new();
        self.by_ref().take(length.min(MAX_VALUE_BYTES)).read_to_end(&mut value)?;
        if (value.len() as u64) < length { Err(io::ErrorKind::UnexpectedEof.into()) } else { Ok(value) }
    }

    /// Skips forward by `count` bytes.
    pub(crate) fn skip(&mut self, count: u64) -> io::Result<()> {
        if let DicomSource::File(reader) = &mut self.source {
            // Seeking beyond the end of the file would not fail.
            let is_within = self.position.checked_add(count).is_some_and(|end| end <= self.len);
            let step = i64::try_from(count).ok().filter(|_| is_within);
            reader.seek_relative(step.ok_or(io::ErrorKind::UnexpectedEof)?)?;
            self.position += count;
            return Ok(());
        }
        match io::copy(&mut self.by_ref().take(count), &mut io::sink())? {
            skipped if skipped < count => Err(io::ErrorKind::UnexpectedEof.into()),
            _ => Ok(()),
        }
    }
}

impl Read for DicomReader {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        let read = match &mut self.source {
            DicomSource::File(reader) => reader.read(into),
            DicomSource::Deflated(reader) => reader.read(into),
        }?;
        self.position += read as u64;
        Ok(read)
    }
}
