//! Data stream of an NRRD volume: the bytes of all data files, decoded and without skipped parts.

use std::fs::File;
use std::io::{self, BufRead, BufReader, Read};
use std::path::{Path, PathBuf};

use super::super::content::members::{Bzip2Members, GzipMembers};
use super::super::input::{FileChangeGuard, InputFile, max_inflated_bytes};
use super::super::text_numbers::TextNumbers;
use super::super::voxel_filter::skip_in_file;
use super::super::{LoadControl, LoadError};
use super::storage::{NrrdEncoding, NrrdStorage};
use chiaroscuro_volume::{LoadContext, quoted};

pub(super) const HELP: &str = "check sizes, type and the skips in the header, or copy the file again";

/// Location of data: behind the header, or in a file of its own.
#[derive(Debug, Clone)]
pub(super) enum DataLocation {
    /// Header file, and the byte offset at which its data begin.
    Attached(PathBuf, u64),
    Detached(PathBuf),
}

impl DataLocation {
    pub(super) fn path(&self) -> &Path {
        match self {
            Self::Attached(path, _) | Self::Detached(path) => path,
        }
    }
}

/// Reader that concatenates the decoded data of all files.
pub(super) struct NrrdDataStream<'a> {
    /// Files that are still to be read, the next one last.
    locations: Vec<DataLocation>,
    storage: NrrdStorage,
    /// Number of bytes per file after decoding.
    bytes_of_file: u64,
    control: &'a LoadControl,
    current: Option<CurrentFile>,
    /// Detailed error of the last failed read.
    pub(super) failure: Option<LoadError>,
}

struct CurrentFile {
    path: PathBuf,
    guard: FileChangeGuard,
    reader: FileReader,
    remaining_bytes: u64,
}

/// Source of a file's bytes: raw, or through a decoder.
enum FileReader {
    /// Raw bytes, as stored in the file.
    Plain(BufReader<File>),
    Decoded(Box<dyn Read>),
}

impl Read for FileReader {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        match self {
            Self::Plain(reader) => reader.read(into),
            Self::Decoded(reader) => reader.read(into),
        }
    }
}

impl<'a> NrrdDataStream<'a> {
    pub(super) fn new(
        mut places: Vec<DataLocation>,
        storage: NrrdStorage,
        bytes_of_file: u64,
        control: &'a LoadControl,
    ) -> Self {
        places.reverse();
        Self { locations: places, storage, bytes_of_file, control, current: None, failure: None }
    }

    /// Skips to a byte of the stream; files before it are not opened.
    pub(super) fn skip(&mut self, bytes: u64) -> io::Result<()> {
        let files = bytes / self.bytes_of_file.max(1);
        self.locations
            .truncate(self.locations.len().saturating_sub(usize::try_from(files).unwrap_or(usize::MAX)));
        self.skip_forward(bytes % self.bytes_of_file.max(1))
    }

    /// Skips forward; in raw files by seeking, without reading.
    pub(super) fn skip_forward(&mut self, bytes: u64) -> io::Result<()> {
        let mut left = bytes;
        let mut block = Vec::new();
        while left > 0 {
            if let Some(CurrentFile { reader: FileReader::Plain(reader), remaining_bytes: in_file, .. }) =
                &mut self.current
            {
                let step = left.min(*in_file);
                skip_in_file(reader, step)?;
                *in_file -= step;
                left -= step;
                self.check_end().map_err(|failure| self.record_failure(failure))?;
                continue;
            }
            // Reads at most as much as between two checks for cancellation; a single byte if a file has yet to be
            // opened.
            let max_bytes = if self.current.is_some() { 1 << 16 } else { 1 };
            block.resize(usize::try_from(left).map_or(max_bytes, |left| left.min(max_bytes)), 0);
            let got = self.read(&mut block)?;
            if got == 0 {
                break;
            }
            left -= got as u64;
        }
        Ok(())
    }

    /// Stores the detailed error, and returns a generic one for `io::Read`.
    fn record_failure(&mut self, failure: LoadError) -> io::Error {
        self.failure = Some(failure);
        io::Error::other("the data cannot be read")
    }

    /// Opens the next file; returns false if there is none.
    fn open_next(&mut self) -> Result<bool, LoadError> {
        let Some(place) = self.locations.pop() else { return Ok(false) };
        let context = context_for(&place);
        let input = InputFile::open(context)?;
        let guard = FileChangeGuard::new(context, &input, self.control)?;
        let reader = open_decoder(context, input, &place, self.storage, self.bytes_of_file, self.control)?;
        let path = place.path().to_owned();
        self.current = Some(CurrentFile { path, guard, reader, remaining_bytes: self.bytes_of_file });
        Ok(true)
    }

    /// Does nothing within the current file; at its end, verifies that the file has not changed and that no
    /// unannounced data follow.
    fn check_end(&mut self) -> Result<(), LoadError> {
        let Some(current) = &mut self.current else { return Ok(()) };
        if current.remaining_bytes > 0 {
            return Ok(());
        }
        let context = LoadContext { operation: READ_DATA, path: &current.path };
        let is_more = match self.storage.encoding {
            // Several headers may refer to one file.
            NrrdEncoding::Raw => false,
            // Also makes decoders verify the checksum, which follows the last byte.
            _ => {
                current
                    .reader
                    .read(&mut [0])
                    .map_err(|error| decode_error(context, self.storage.encoding, error))?
                    > 0
            }
        };
        current.guard.check_unchanged(context, Ok(()))?;
        if is_more {
            let why = format!("there is more data than the {} bytes expected", self.bytes_of_file);
            return Err(context.bad_input_error("data", why, HELP));
        }
        self.current = None;
        Ok(())
    }

    fn read_some(&mut self, into: &mut [u8]) -> Result<usize, LoadError> {
        self.control.check()?;
        if into.is_empty() || (self.current.is_none() && !self.open_next()?) {
            return Ok(0);
        }
        let Some(current) = &mut self.current else { return Ok(0) };
        let context = LoadContext { operation: READ_DATA, path: &current.path };
        let want = usize::try_from(current.remaining_bytes).map_or(into.len(), |left| left.min(into.len()));
        let got = loop {
            match current.reader.read(&mut into[..want]) {
                Err(error) if error.kind() == io::ErrorKind::Interrupted => self.control.check()?,
                Err(error) => return Err(decode_error(context, self.storage.encoding, error)),
                Ok(got) => break got,
            }
        };
        current.remaining_bytes -= got as u64;
        if got == 0 {
            let (unit, size) = match self.storage.encoding {
                NrrdEncoding::Text => ("numbers", self.storage.number.bytes() as u64),
                _ => ("bytes", 1),
            };
            let (expected, found) =
                (self.bytes_of_file / size, (self.bytes_of_file - current.remaining_bytes) / size);
            let why = format!("the data are truncated: {expected} {unit} expected, {found} found");
            return Err(context.bad_input_error("data", why, HELP));
        }
        self.check_end()?;
        Ok(got)
    }
}

impl Read for NrrdDataStream<'_> {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        self.read_some(into).map_err(|failure| self.record_failure(failure))
    }
}

/// Action that error messages name for data files.
const READ_DATA: &str = "read the NRRD volume's data";

fn context_for(place: &DataLocation) -> LoadContext<'_> {
    LoadContext { operation: READ_DATA, path: place.path() }
}

/// Opens the decoder of a file at the first byte of its data; the length of uncompressed data is checked.
fn open_decoder(
    context: LoadContext<'_>,
    mut input: InputFile,
    place: &DataLocation,
    storage: NrrdStorage,
    bytes: u64,
    control: &LoadControl,
) -> Result<FileReader, LoadError> {
    let start = match place {
        DataLocation::Attached(_, start) => *start,
        DataLocation::Detached(_) => 0,
    };
    input.seek(start).map_err(|error| context.io_error(error))?;
    let Some(lines) = input.skip_lines(context, storage.line_skip, control)? else {
        return Err(context.bad_input_error(
            "line skip",
            format!("the data end before {} lines have been skipped", storage.line_skip),
            HELP,
        ));
    };
    let available = input.len.saturating_sub(start + lines);
    let skip = storage.byte_skip.unwrap_or_else(|| available.saturating_sub(bytes));
    let found = available.saturating_sub(skip);
    let truncated = |needed: u64, found: u64, unit: &str| {
        let why = format!("the data are truncated: {needed} {unit} expected, {found} found");
        context.bad_input_error("data", why, HELP)
    };
    let numbers = bytes / storage.number.bytes() as u64;
    match storage.encoding {
        NrrdEncoding::Raw if found < bytes => return Err(truncated(bytes, found, "bytes")),
        NrrdEncoding::Raw if found > bytes => {
            // Legal: several headers may refer to one file.
            context.warn(format_args!("{} bytes after the voxels are ignored", found - bytes));
        }
        NrrdEncoding::Gzip if max_inflated_bytes(available) < bytes => {
            return Err(truncated(bytes, max_inflated_bytes(available), "bytes"));
        }
        NrrdEncoding::Hex if found / 2 < bytes => return Err(truncated(bytes, found / 2, "bytes")),
        // Minimum size of text: a digit per number, and a space between two.
        NrrdEncoding::Text if found.div_ceil(2) < numbers => {
            return Err(truncated(numbers, found.div_ceil(2), "numbers"));
        }
        _ => {}
    }
    let reader = input.reader;
    // In compressed data, `byte skip` counts bytes after decompression.
    let mut decoder = match storage.encoding {
        NrrdEncoding::Raw => FileReader::Plain(reader),
        NrrdEncoding::Gzip => FileReader::Decoded(Box::new(GzipMembers::new(reader))),
        NrrdEncoding::Bzip2 => FileReader::Decoded(Box::new(Bzip2Members::new(reader))),
        NrrdEncoding::Hex | NrrdEncoding::Text => {
            let mut reader = reader;
            skip_bytes(context, storage.encoding, &mut reader, skip, control)?;
            return Ok(FileReader::Decoded(match storage.encoding {
                NrrdEncoding::Hex => Box::new(HexDecoder { reader }),
                // One number more than needed, so that surplus data are detected.
                _ => Box::new(TextNumbers::new(reader, storage.number, numbers.saturating_add(1))),
            }));
        }
    };
    skip_bytes(context, storage.encoding, &mut decoder, skip, control)?;
    Ok(decoder)
}

fn skip_bytes(
    context: LoadContext<'_>,
    encoding: NrrdEncoding,
    reader: &mut impl Read,
    count: u64,
    control: &LoadControl,
) -> Result<(), LoadError> {
    let mut left = count;
    while left > 0 {
        control.check()?;
        let skipped = io::copy(&mut reader.by_ref().take(left.min(1 << 20)), &mut io::sink());
        match skipped.map_err(|error| decode_error(context, encoding, error))? {
            0 => break,
            skipped => left -= skipped,
        }
    }
    Ok(())
}

/// Converts an error of a decoder: either the data are corrupt, or the disk failed.
fn decode_error(context: LoadContext<'_>, encoding: NrrdEncoding, error: io::Error) -> LoadError {
    let name = match encoding {
        NrrdEncoding::Gzip => "gzip",
        NrrdEncoding::Bzip2 => "bzip2",
        NrrdEncoding::Hex | NrrdEncoding::Text => {
            return context.bad_input_error("data", error.to_string(), HELP);
        }
        NrrdEncoding::Raw => return context.io_error(error),
    };
    match error.kind() {
        io::ErrorKind::UnexpectedEof => context.bad_input_error(
            "data",
            format!("the {name} data are truncated: they end too early"),
            "copy or download the file again",
        ),
        io::ErrorKind::InvalidInput | io::ErrorKind::InvalidData => context.bad_input_error(
            "data",
            format!("the {name} data are broken: {error}"),
            "copy or download the file again",
        ),
        _ => context.io_error(error),
    }
}

/// Decoder of pairs of hexadecimal digits; white space is ignored.
struct HexDecoder<R> {
    reader: R,
}

impl<R: BufRead> Read for HexDecoder<R> {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        let mut written = 0;
        let mut high = None;
        while written < into.len() {
            let block = self.reader.fill_buf()?;
            if block.is_empty() {
                if high.is_some() {
                    return Err(io::Error::new(io::ErrorKind::InvalidData, "the data end within a byte"));
                }
                break;
            }
            let mut used = 0;
            for &byte in block {
                if written == into.len() {
                    break;
                }
                used += 1;
                if byte.is_ascii_whitespace() {
                    continue;
                }
                let Some(digit) = char::from(byte).to_digit(16) else {
                    let text = quoted(&char::from(byte).to_string());
                    let why = format!("a hexadecimal digit was expected, {text} was found");
                    return Err(io::Error::new(io::ErrorKind::InvalidData, why));
                };
                match high.take() {
                    None => high = Some(digit),
                    Some(high) => {
                        into[written] = (high << 4 | digit) as u8;
                        written += 1;
                    }
                }
            }
            self.reader.consume(used);
        }
        Ok(written)
    }
}
