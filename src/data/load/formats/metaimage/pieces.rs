//! Stream of a volume's voxel bytes, out of one file or many, of which one is open at a time.

use std::io::{self, BufReader, Read};
use std::path::{Path, PathBuf};
use std::vec;

use flate2::bufread::ZlibDecoder;

use super::super::content::members::GzipMembers;
use super::super::input::{Input, Witness, is_gzip};
use super::super::samples::{Fault, fill, skip_bytes};
use super::super::text_numbers::TextNumbers;
use super::super::{LoadControl, LoadError, beside};
use super::files::Files;
use super::header::DATA_FILE;
use super::layout::{Grid, Storage};
use crate::data::attempt::{Attempt, quoted};

/// Action that error messages name for a data file.
const WHAT: &str = "read the MetaImage volume's data file";

/// Header data that locate the voxels: grid, storage, files, offset.
#[derive(Clone, Copy)]
pub(super) struct Described<'a> {
    pub(super) grid: &'a Grid,
    pub(super) storage: &'a Storage,
    pub(super) files: &'a Files,
    /// Byte offset of the end of the header.
    pub(super) data_start: u64,
}

/// Reader that concatenates the voxels of all data files.
pub(super) struct Pieces {
    storage: Storage,
    /// Size of the voxels in each file, in bytes, before compression or conversion to text.
    piece_bytes: u64,
    /// Data files that have not been opened yet.
    rest: vec::IntoIter<PathBuf>,
    open: Option<Piece>,
    /// Reason why a data file could not be used.
    failed: Option<LoadError>,
}

/// Data file that is open for reading.
struct Piece {
    path: PathBuf,
    /// Detects changes of the file while it is read; `None` for the header's own file, which the caller watches.
    witness: Option<Witness>,
    reader: Box<dyn Read>,
    /// Bytes of voxels that remain to be read from the file.
    left: u64,
}

impl Pieces {
    /// Finds the data files of a time step, and skips to the first of its voxels.
    pub(super) fn of(
        attempt: Attempt<'_>,
        input: Input,
        described: Described<'_>,
        frame: usize,
        control: &LoadControl,
    ) -> Result<Self, LoadError> {
        let Described { grid, storage, files, data_start } = described;
        let too_large =
            || attempt.limit("DimSize", "there are more bytes than a file can have", "check the dimensions");
        let volume_bytes =
            grid.voxels().checked_mul(storage.stored.bytes_of_voxel()).ok_or_else(too_large)?;
        let all_bytes = volume_bytes.checked_mul(grid.frames as u64).ok_or_else(too_large)?;
        let count = if let Files::Named(names) = files { names.len() as u64 } else { 1 };
        let piece_bytes = all_bytes / count.max(1);
        if piece_bytes == 0 || piece_bytes.checked_mul(count) != Some(all_bytes) {
            return Err(attempt.bad_input(
                DATA_FILE,
                format!("{all_bytes} bytes of voxels are not the same in each of {count} files"),
                "write a file for each slice",
            ));
        }
        let start = volume_bytes * frame as u64;
        let (first, last) = (start / piece_bytes, (start + volume_bytes - 1) / piece_bytes);
        let mut pieces =
            Self { storage: *storage, piece_bytes, rest: Vec::new().into_iter(), open: None, failed: None };
        match files {
            Files::Local => {
                let begin = match storage.header_bytes {
                    Some(0) => Some(data_start),
                    given => given,
                };
                pieces.check_length(attempt, input.len, begin)?;
                pieces.open = Some(pieces.piece(attempt, input, begin, None)?);
            }
            Files::Named(names) => {
                let mut paths = Vec::new();
                for name in &names[first as usize..=last as usize] {
                    control.check()?;
                    let path = beside::resolve(attempt, DATA_FILE, name)?;
                    if path.canonicalize().ok() == attempt.path.canonicalize().ok() {
                        return Err(attempt.bad_input(
                            DATA_FILE,
                            format!("{} is the header itself", quoted(name)),
                            "write LOCAL where the voxels follow the header",
                        ));
                    }
                    let of_data = Attempt { what: WHAT, path: &path };
                    // All files are checked before memory for any of them is allocated.
                    pieces.check_length(of_data, Input::open(of_data)?.len, storage.header_bytes)?;
                    paths.push(path);
                }
                pieces.rest = paths.into_iter();
            }
        }
        let skip = start - first * piece_bytes;
        match skip_bytes(&mut pieces, skip, control) {
            Ok(skipped) if skipped == skip => Ok(pieces),
            Err(Fault::Stopped(error)) => Err(error),
            other => Err(pieces.failure().unwrap_or_else(|| {
                let why = match other {
                    Err(Fault::Io(error)) => error.to_string(),
                    _ => "they end before it".to_owned(),
                };
                attempt.bad_input(
                    "data",
                    format!("no data for time step {frame}: {why}"),
                    "copy the file again",
                )
            })),
        }
    }

    /// Checks that a file of `len` bytes can hold its share of the voxels.
    fn check_length(&self, attempt: Attempt<'_>, len: u64, begin: Option<u64>) -> Result<(), LoadError> {
        let found = len.saturating_sub(begin.unwrap_or(0));
        let expected = match self.storage {
            // Compressed data take at least one byte.
            Storage { is_compressed: true, .. } => 1,
            // Minimum size of text: a digit per number, and a space between two.
            Storage { is_text: true, stored, .. } => {
                (self.piece_bytes / stored.number.bytes() as u64) * 2 - 1
            }
            _ => self.piece_bytes,
        };
        if found < expected {
            return Err(attempt.bad_input(
                "data",
                format!("the data are truncated: {expected} bytes expected, {found} found"),
                "check DimSize, ElementType and HeaderSize, or copy the file again",
            ));
        }
        if found > expected && begin.is_some() && !self.storage.is_compressed && !self.storage.is_text {
            attempt.warn(format_args!("{} bytes after the voxels are ignored", found - expected));
        }
        Ok(())
    }

    /// Opens a data file at offset `begin`; `None` means that the voxels are its last bytes.
    fn piece(
        &self,
        attempt: Attempt<'_>,
        mut input: Input,
        begin: Option<u64>,
        witness: Option<Witness>,
    ) -> Result<Piece, LoadError> {
        let begin = begin.unwrap_or(input.len.saturating_sub(self.piece_bytes));
        input.seek(begin).map_err(|error| attempt.io(error))?;
        let mut reader: Box<dyn Read> = Box::new(input.reader);
        if self.storage.is_compressed {
            let mut magic = Vec::new();
            let mut source = reader;
            source.by_ref().take(3).read_to_end(&mut magic).map_err(|error| attempt.io(error))?;
            let is_gzip = is_gzip(&magic);
            let source = BufReader::new(io::Cursor::new(magic).chain(source));
            // The definition says zlib; the decoders in common use accept gzip as well.
            reader =
                if is_gzip { Box::new(GzipMembers::new(source)) } else { Box::new(ZlibDecoder::new(source)) };
        }
        if self.storage.is_text {
            let number = self.storage.stored.number;
            let count = self.piece_bytes / number.bytes() as u64;
            reader = Box::new(TextNumbers::new(BufReader::new(reader), number, count));
        }
        Ok(Piece { path: attempt.path.to_owned(), witness, reader, left: self.piece_bytes })
    }

    /// Opens the next data file, with its witness.
    fn next(&self, path: &Path) -> Result<Piece, LoadError> {
        let attempt = Attempt { what: WHAT, path };
        let input = Input::open(attempt)?;
        let witness = Witness::of(attempt, &input)?;
        self.piece(attempt, input, self.storage.header_bytes, Some(witness))
    }

    /// Reads on to the checksum behind the last voxel, and verifies that the last file has not changed.
    pub(super) fn finish(&mut self, control: &LoadControl) -> Result<(), Fault> {
        fill(self, &mut [0], control).map(drop).map_err(Fault::of_stream)
    }

    /// Returns the error if an unusable data file ended the reading.
    pub(super) fn failure(&mut self) -> Option<LoadError> {
        self.failed.take()
    }

    /// Closes a data file whose voxels have been read.
    fn close(&self, mut piece: Piece) -> io::Result<Result<(), LoadError>> {
        if self.storage.is_compressed {
            // The decoder verifies the checksum, which follows the last byte.
            let _more = piece.reader.read(&mut [0])?;
        }
        let attempt = Attempt { what: WHAT, path: &piece.path };
        Ok(piece.witness.map_or(Ok(()), |witness| witness.vouch(attempt, Ok(()))))
    }

    fn read_some(&mut self, buffer: &mut [u8]) -> Result<usize, Stop> {
        loop {
            let mut piece = match self.open.take() {
                Some(piece) => piece,
                None => match self.rest.next() {
                    Some(path) => self.next(&path).map_err(Stop::Failed)?,
                    None => return Ok(0),
                },
            };
            if piece.left == 0 {
                self.close(piece).map_err(Stop::Io)?.map_err(Stop::Failed)?;
                continue;
            }
            let most = buffer.len().min(usize::try_from(piece.left).unwrap_or(usize::MAX));
            let count = piece.reader.read(&mut buffer[..most]).map_err(Stop::Io);
            piece.left -= *count.as_ref().unwrap_or(&0) as u64;
            if let Ok(0) = count
                && most > 0
            {
                // Missing bytes must not be taken from the next file.
                self.rest = Vec::new().into_iter();
                return Ok(0);
            }
            self.open = Some(piece);
            return count;
        }
    }
}

/// Reason to stop reading: an I/O error, or an unusable file.
enum Stop {
    Io(io::Error),
    Failed(LoadError),
}

impl Read for Pieces {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        self.read_some(buffer).map_err(|stop| match stop {
            Stop::Io(error) => error,
            Stop::Failed(error) => {
                self.failed = Some(error);
                io::Error::other("a data file cannot be used")
            }
        })
    }
}
