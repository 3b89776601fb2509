//! Random access to the bytes of a TIFF file, and numbers in its byte order.

use std::fs::File;
use std::io::{self, Read as _, Seek as _, SeekFrom};

use crate::Endian;

/// Bytes that are read at a time around a small piece: related entries lie close together.
const WINDOW_BYTES: u64 = 1 << 13;

/// Content of a file with random access through a small window.
pub(crate) struct TiffBytes {
    file: File,
    len: u64,
    pub(crate) endian: Endian,
    window: Vec<u8>,
    window_at: u64,
}

impl TiffBytes {
    /// Wraps a file of `len` bytes; little-endian until the header has been read.
    pub(crate) fn new(file: File, len: u64) -> Self {
        Self { file, len, endian: Endian::Little, window: Vec::new(), window_at: 0 }
    }

    pub(crate) fn len(&self) -> u64 {
        self.len
    }

    /// Fills `out` with the bytes at offset `at`.
    ///
    /// # Errors
    /// `UnexpectedEof` where the file is shorter; nothing is read then.
    pub(crate) fn read(&mut self, at: u64, out: &mut [u8]) -> io::Result<()> {
        let wanted = out.len() as u64;
        if at.checked_add(wanted).is_none_or(|end| end > self.len) {
            return Err(io::ErrorKind::UnexpectedEof.into());
        }
        if wanted > WINDOW_BYTES {
            self.file.seek(SeekFrom::Start(at))?;
            return self.file.read_exact(out);
        }
        if at < self.window_at || at + wanted > self.window_at + self.window.len() as u64 {
            self.window.clear();
            self.file.seek(SeekFrom::Start(at))?;
            (&self.file).take(WINDOW_BYTES).read_to_end(&mut self.window)?;
            self.window_at = at;
        }
        let from = (at - self.window_at) as usize;
        let found = self.window.get(from..from + out.len()).ok_or(io::ErrorKind::UnexpectedEof)?;
        out.copy_from_slice(found);
        Ok(())
    }

    /// Reads an integer of 1, 2, 4 or 8 bytes.
    pub(crate) fn number(&mut self, at: u64, bytes: usize) -> io::Result<u64> {
        let mut found = [0; 8];
        let found = &mut found[..bytes.min(8)];
        self.read(at, found)?;
        Ok(decode_integer(found, self.endian))
    }
}

/// Decodes an integer of at most eight bytes.
pub(crate) fn decode_integer(bytes: &[u8], endian: Endian) -> u64 {
    let join = |number: u64, &byte: &u8| number << 8 | u64::from(byte);
    match endian {
        Endian::Big => bytes.iter().fold(0, join),
        Endian::Little => bytes.iter().rev().fold(0, join),
    }
}
