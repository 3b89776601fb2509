//! Random access to the bytes of a raw file: any part of an uncompressed file, or the beginning of a compressed one.

use std::fs::File;
use std::io::{self, BufReader, Read as _, Seek as _, SeekFrom};
use std::path::Path;
use std::sync::Arc;

use super::super::content::members::GzipMembers;
use super::super::input::is_gzip;

/// Bytes of a compressed file that are inflated: at about 300 MB/s they take a tenth of a second, and hold about 100
/// slices of 512 × 512 voxels of one byte.
const MAX_INFLATED_BYTES: u64 = 24 << 20;

/// Maximum length of files that are read as a whole, in bytes: less work than a few hundred small reads.
const SMALL_FILE_BYTES: u64 = 8 << 20;

/// Bytes at the end of a compressed file that are searched for its length, after padding: blocks of tapes mostly have
/// 64 KiB.
const PADDING_BYTES: u64 = 1 << 18;

/// Source of the bytes: the file, or a buffer in memory.
#[derive(Debug)]
enum RawBytesSource {
    File(File),
    Start(Arc<[u8]>),
}

/// Bytes of a raw file, inflated where it is compressed.
#[derive(Debug)]
pub struct RawBytes {
    source: RawBytesSource,
    readable: u64,
    length: u64,
    is_exact: bool,
}

impl RawBytes {
    /// Opens a file, and inflates the beginning of a compressed one.
    ///
    /// # Errors
    /// When it cannot be read, or is not a regular file.
    pub fn open(path: &Path) -> io::Result<Self> {
        let mut file = File::open(path)?;
        let metadata = file.metadata()?;
        if !metadata.is_file() {
            return Err(io::Error::from(io::ErrorKind::InvalidInput));
        }
        let file_bytes = metadata.len();
        let mut magic = [0; 3];
        let begins = read_full(&mut file, &mut magic)?;
        file.seek(SeekFrom::Start(0))?;
        if is_gzip(&magic[..begins]) {
            return Self::inflate(file, file_bytes);
        }
        if file_bytes > SMALL_FILE_BYTES {
            return Ok(Self {
                source: RawBytesSource::File(file),
                readable: file_bytes,
                length: file_bytes,
                is_exact: true,
            });
        }
        let mut all = Vec::new();
        file.take(SMALL_FILE_BYTES).read_to_end(&mut all)?;
        Ok(Self::from(all))
    }

    /// Inflates the beginning of a compressed file. Its last four bytes give the uncompressed length modulo 2^32 (RFC
    /// 1952). Zero padding after them is skipped: for so long a file their last byte is hardly zero itself.
    fn inflate(mut file: File, file_bytes: u64) -> io::Result<Self> {
        let mut end = vec![0; PADDING_BYTES.min(file_bytes) as usize];
        file.seek(SeekFrom::Start(file_bytes - end.len() as u64))?;
        read_full(&mut file, &mut end)?;
        end.truncate(end.iter().rposition(|&byte| byte != 0).map_or(0, |last| last + 1));
        let said = end.last_chunk::<4>().copied().unwrap_or_default();
        file.seek(SeekFrom::Start(0))?;
        let mut start = Vec::new();
        let mut inflated = GzipMembers::new(BufReader::with_capacity(1 << 18, file)).take(MAX_INFLATED_BYTES);
        // Bytes before a damaged part are still useful.
        let is_whole = inflated.read_to_end(&mut start).is_ok() && (start.len() as u64) < MAX_INFLATED_BYTES;
        let readable = start.len() as u64;
        if is_whole {
            return Ok(Self::from(start));
        }
        let said = u64::from(u32::from_le_bytes(said));
        let wraps = readable.saturating_sub(said).div_ceil(1 << 32);
        Ok(Self {
            source: RawBytesSource::Start(start.into()),
            readable,
            length: said + (wraps << 32),
            is_exact: false,
        })
    }

    /// Returns true if no byte can be read.
    pub fn is_empty(&self) -> bool {
        self.readable == 0
    }

    /// Returns true if all readable bytes are in memory.
    pub(super) fn is_in_memory(&self) -> bool {
        matches!(self.source, RawBytesSource::Start(_))
    }

    /// Number of bytes that can be read: all, or the beginning of a compressed file.
    pub fn readable(&self) -> u64 {
        self.readable
    }

    /// Uncompressed length in bytes; for a long compressed file as its trailer gives it.
    pub fn length(&self) -> u64 {
        self.length
    }

    /// Returns true if the length was counted, not taken from the gzip trailer.
    pub fn is_exact(&self) -> bool {
        self.is_exact
    }

    /// Reads from an offset; returns the number of bytes read before the end.
    ///
    /// # Errors
    /// When the file cannot be read.
    pub fn read_at(&mut self, at: u64, buffer: &mut [u8]) -> io::Result<usize> {
        match &mut self.source {
            RawBytesSource::File(file) => {
                file.seek(SeekFrom::Start(at))?;
                read_full(file, buffer)
            }
            RawBytesSource::Start(start) => {
                let rest = usize::try_from(at).ok().and_then(|at| start.get(at..)).unwrap_or_default();
                let count = rest.len().min(buffer.len());
                buffer[..count].copy_from_slice(&rest[..count]);
                Ok(count)
            }
        }
    }
}

impl From<Vec<u8>> for RawBytes {
    fn from(all: Vec<u8>) -> Self {
        let length = all.len() as u64;
        Self { source: RawBytesSource::Start(all.into()), readable: length, length, is_exact: true }
    }
}

/// Reads until the buffer is full or the file ends.
fn read_full(file: &mut File, buffer: &mut [u8]) -> io::Result<usize> {
    let mut count = 0;
    while count < buffer.len() {
        match file.read(&mut buffer[count..]) {
            Ok(0) => break,
            Ok(read) => count += read,
            Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
            Err(error) => return Err(error),
        }
    }
    Ok(count)
}
