//! Stream of a volume's voxel bytes, out of one file or many, of which one is open at a time.

use std::io::{self, BufReader, Read};
use std::path::{Path, PathBuf};
use std::vec;

use flate2::bufread::ZlibDecoder;

use super::super::content::members::GzipMembers;
use super::super::input::{FileChangeGuard, InputFile, is_gzip};
use super::super::samples::{ReadFault, read_until_full, skip_bytes};
use super::super::text_numbers::TextNumbers;
use super::super::{LoadControl, LoadError, companion_path};
use super::data_files::DataFiles;
use super::header::DATA_FILE;
use super::layout::{MetaImageGrid, MetaImageStorage};
use chiaroscuro_volume::{LoadContext, quoted};

/// Action that error messages name for a data file.
const READ_DATA: &str = "read the MetaImage volume's data file";

/// Header data that locate the voxels: grid, storage, files, offset.
#[derive(Clone, Copy)]
pub(super) struct DataDescription<'a> {
    pub(super) grid: &'a MetaImageGrid,
    pub(super) storage: &'a MetaImageStorage,
    pub(super) files: &'a DataFiles,
    /// Byte offset of the end of the header.
    pub(super) data_start: u64,
}

/// Reader that concatenates the voxels of all data files.
pub(super) struct DataStream<'a> {
    storage: MetaImageStorage,
    /// Size of the voxels in each file, in bytes, before compression or conversion to text.
    piece_bytes: u64,
    /// Data files that have not been opened yet.
    remaining_paths: vec::IntoIter<PathBuf>,
    open: Option<OpenDataFile>,
    /// Reason why a data file could not be used.
    failure: Option<LoadError>,
    control: &'a LoadControl,
}

/// Data file that is open for reading.
struct OpenDataFile {
    path: PathBuf,
    /// Detects changes of the file while it is read; `None` for the header's own file, which the caller watches.
    guard: Option<FileChangeGuard>,
    reader: Box<dyn Read>,
    /// Bytes of voxels that remain to be read from the file.
    remaining_bytes: u64,
}

impl<'a> DataStream<'a> {
    /// Finds the data files of a time step, and skips to the first of its voxels.
    pub(super) fn open(
        context: LoadContext<'_>,
        input: InputFile,
        description: DataDescription<'_>,
        frame: usize,
        control: &'a LoadControl,
    ) -> Result<Self, LoadError> {
        let DataDescription { grid, storage, files, data_start } = description;
        let too_large = || {
            context.limit_error(
                "DimSize",
                "the volume has more bytes than a file can have",
                "check the dimensions",
            )
        };
        let volume_bytes = grid.voxels().checked_mul(storage.stored.voxel_bytes()).ok_or_else(too_large)?;
        let all_bytes = volume_bytes.checked_mul(grid.frames as u64).ok_or_else(too_large)?;
        let count = if let DataFiles::Detached(names) = files { names.len() as u64 } else { 1 };
        let piece_bytes = all_bytes / count.max(1);
        if piece_bytes == 0 || piece_bytes.checked_mul(count) != Some(all_bytes) {
            return Err(context.bad_input_error(
                DATA_FILE,
                format!("{all_bytes} bytes of voxels cannot be divided equally among {count} files"),
                "write a file for each slice",
            ));
        }
        let start = volume_bytes * frame as u64;
        let (first, last) = (start / piece_bytes, (start + volume_bytes - 1) / piece_bytes);
        let mut pieces = Self {
            storage: *storage,
            piece_bytes,
            remaining_paths: Vec::new().into_iter(),
            open: None,
            failure: None,
            control,
        };
        match files {
            DataFiles::Attached => {
                let begin = match storage.header_bytes {
                    Some(0) => Some(data_start),
                    given => given,
                };
                pieces.check_length(context, input.len, begin)?;
                pieces.open = Some(pieces.open_at(context, input, begin, None)?);
            }
            DataFiles::Detached(names) => {
                let mut paths = Vec::new();
                for name in &names[first as usize..=last as usize] {
                    control.check()?;
                    let path = companion_path::resolve(context, DATA_FILE, name)?;
                    if path.canonicalize().ok() == context.path.canonicalize().ok() {
                        return Err(context.bad_input_error(
                            DATA_FILE,
                            format!("{} is the header itself", quoted(name)),
                            "write LOCAL if the voxels follow the header",
                        ));
                    }
                    let of_data = LoadContext { operation: READ_DATA, path: &path };
                    // All files are checked before memory for any of them is allocated.
                    pieces.check_length(of_data, InputFile::open(of_data)?.len, storage.header_bytes)?;
                    paths.push(path);
                }
                pieces.remaining_paths = paths.into_iter();
            }
        }
        let skip = start - first * piece_bytes;
        match skip_bytes(&mut pieces, skip, control) {
            Ok(skipped) if skipped == skip => Ok(pieces),
            Err(ReadFault::Stopped(error)) => Err(error),
            other => Err(pieces.failure().unwrap_or_else(|| {
                let why = match other {
                    Err(ReadFault::Io(error)) => error.to_string(),
                    _ => "the data end before it".to_owned(),
                };
                context.bad_input_error(
                    "data",
                    format!("no data for time step {frame}: {why}"),
                    "copy the file again",
                )
            })),
        }
    }

    /// Checks that a file of `len` bytes can hold its share of the voxels.
    fn check_length(&self, context: LoadContext<'_>, len: u64, begin: Option<u64>) -> Result<(), LoadError> {
        let found = len.saturating_sub(begin.unwrap_or(0));
        let expected = match self.storage {
            // Compressed data take at least one byte.
            MetaImageStorage { is_compressed: true, .. } => 1,
            // Minimum size of text: a digit per number, and a space between two.
            MetaImageStorage { is_text: true, stored, .. } => {
                (self.piece_bytes / stored.number.bytes() as u64) * 2 - 1
            }
            _ => self.piece_bytes,
        };
        if found < expected {
            return Err(context.bad_input_error(
                "data",
                format!("the data are truncated: {expected} bytes expected, {found} found"),
                "check DimSize, ElementType and HeaderSize, or copy the file again",
            ));
        }
        if found > expected && begin.is_some() && !self.storage.is_compressed && !self.storage.is_text {
            context.warn(format_args!("{} bytes after the voxels are ignored", found - expected));
        }
        Ok(())
    }

    /// Opens a data file at offset `begin`; `None` means that the voxels are its last bytes.
    fn open_at(
        &self,
        context: LoadContext<'_>,
        mut input: InputFile,
        begin: Option<u64>,
        guard: Option<FileChangeGuard>,
    ) -> Result<OpenDataFile, LoadError> {
        let begin = begin.unwrap_or(input.len.saturating_sub(self.piece_bytes));
        input.seek(begin).map_err(|error| context.io_error(error))?;
        let mut reader: Box<dyn Read> = Box::new(input.reader);
        if self.storage.is_compressed {
            let mut magic = Vec::new();
            let mut source = reader;
            source.by_ref().take(3).read_to_end(&mut magic).map_err(|error| context.io_error(error))?;
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
        Ok(OpenDataFile { path: context.path.to_owned(), guard, reader, remaining_bytes: self.piece_bytes })
    }

    /// Opens the next data file, with its guard.
    fn open_file(&self, path: &Path) -> Result<OpenDataFile, LoadError> {
        let context = LoadContext { operation: READ_DATA, path };
        let input = InputFile::open(context)?;
        let guard = FileChangeGuard::new(context, &input, self.control)?;
        self.open_at(context, input, self.storage.header_bytes, Some(guard))
    }

    /// Reads on to the checksum behind the last voxel, and verifies that the last file has not changed.
    pub(super) fn finish(&mut self) -> Result<(), ReadFault> {
        let control = self.control;
        read_until_full(self, &mut [0], control).map(drop).map_err(ReadFault::into_decoder_fault)
    }

    /// Returns the error if an unusable data file ended the reading.
    pub(super) fn failure(&mut self) -> Option<LoadError> {
        self.failure.take()
    }

    /// Closes a data file whose voxels have been read.
    fn close(&self, mut piece: OpenDataFile) -> io::Result<Result<(), LoadError>> {
        if self.storage.is_compressed {
            // The decoder verifies the checksum, which follows the last byte.
            let _more = piece.reader.read(&mut [0])?;
        }
        let context = LoadContext { operation: READ_DATA, path: &piece.path };
        Ok(piece.guard.map_or(Ok(()), |guard| guard.check_unchanged(context, Ok(()))))
    }

    fn read_some(&mut self, buffer: &mut [u8]) -> Result<usize, MetaImageReadFailure> {
        loop {
            let mut piece = match self.open.take() {
                Some(piece) => piece,
                None => match self.remaining_paths.next() {
                    Some(path) => self.open_file(&path).map_err(MetaImageReadFailure::Failed)?,
                    None => return Ok(0),
                },
            };
            if piece.remaining_bytes == 0 {
                self.close(piece).map_err(MetaImageReadFailure::Io)?.map_err(MetaImageReadFailure::Failed)?;
                continue;
            }
            let most = buffer.len().min(usize::try_from(piece.remaining_bytes).unwrap_or(usize::MAX));
            let count = piece.reader.read(&mut buffer[..most]).map_err(MetaImageReadFailure::Io);
            piece.remaining_bytes -= *count.as_ref().unwrap_or(&0) as u64;
            if let Ok(0) = count
                && most > 0
            {
                // Missing bytes must not be taken from the next file.
                self.remaining_paths = Vec::new().into_iter();
                return Ok(0);
            }
            self.open = Some(piece);
            return count;
        }
    }
}

/// Reason to stop reading: an I/O error, or an unusable file.
enum MetaImageReadFailure {
    Io(io::Error),
    Failed(LoadError),
}

impl Read for DataStream<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        self.read_some(buffer).map_err(|stop| match stop {
            MetaImageReadFailure::Io(error) => error,
            MetaImageReadFailure::Failed(error) => {
                self.failure = Some(error);
                io::Error::other("a data file cannot be used")
            }
        })
    }
}
