//! Data stream of an NRRD volume: the bytes of all data files, decoded and without skipped parts.

use std::fs::File;
use std::io::{self, BufRead, BufReader, Read};
use std::path::{Path, PathBuf};

use super::super::content::members::{Bzip2Members, GzipMembers};
use super::super::input::{Input, Witness, most_inflated};
use super::super::sieve::leap_in_file;
use super::super::text_numbers::TextNumbers;
use super::super::{LoadControl, LoadError};
use super::layout::{Encoding, Storage};
use crate::data::attempt::{Attempt, quoted};

pub(super) const HELP: &str = "check sizes, type and the skips in the header, or copy the file again";

/// Location of data: behind the header, or in a file of its own.
#[derive(Debug, Clone)]
pub(super) enum Place {
    /// Header file, and the byte offset at which its data begin.
    Attached(PathBuf, u64),
    Detached(PathBuf),
}

impl Place {
    pub(super) fn path(&self) -> &Path {
        match self {
            Self::Attached(path, _) | Self::Detached(path) => path,
        }
    }
}

/// Reader that concatenates the decoded data of all files.
pub(super) struct Data<'a> {
    /// Files that are still to be read, the next one last.
    places: Vec<Place>,
    storage: Storage,
    /// Number of bytes per file after decoding.
    bytes_of_file: u64,
    control: &'a LoadControl,
    current: Option<Current>,
    /// Detailed error of the last failed read.
    pub(super) failure: Option<LoadError>,
}

struct Current {
    path: PathBuf,
    witness: Witness,
    reader: Stream,
    left: u64,
}

/// Source of a file's bytes: raw, or through a decoder.
enum Stream {
    /// Raw bytes, as stored in the file.
    Plain(BufReader<File>),
    Decoded(Box<dyn Read>),
}

impl Read for Stream {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        match self {
            Self::Plain(reader) => reader.read(into),
            Self::Decoded(reader) => reader.read(into),
        }
    }
}

impl<'a> Data<'a> {
    pub(super) fn new(
        mut places: Vec<Place>,
        storage: Storage,
        bytes_of_file: u64,
        control: &'a LoadControl,
    ) -> Self {
        places.reverse();
        Self { places, storage, bytes_of_file, control, current: None, failure: None }
    }

    /// Skips to a byte of the stream; files before it are not opened.
    pub(super) fn skip(&mut self, bytes: u64) -> io::Result<()> {
        let files = bytes / self.bytes_of_file.max(1);
        self.places.truncate(self.places.len().saturating_sub(usize::try_from(files).unwrap_or(usize::MAX)));
        self.leap(bytes % self.bytes_of_file.max(1))
    }

    /// Skips forward; in raw files by seeking, without reading.
    pub(super) fn leap(&mut self, bytes: u64) -> io::Result<()> {
        let mut left = bytes;
        let mut block = Vec::new();
        while left > 0 {
            if let Some(Current { reader: Stream::Plain(reader), left: in_file, .. }) = &mut self.current {
                let step = left.min(*in_file);
                leap_in_file(reader, step)?;
                *in_file -= step;
                left -= step;
                self.check_end().map_err(|failure| self.failed(failure))?;
                continue;
            }
            // Reads at most as much as between two checks for cancellation; a single byte if a file has yet to be
            // opened.
            let most = if self.current.is_some() { 1 << 16 } else { 1 };
            block.resize(usize::try_from(left).map_or(most, |left| left.min(most)), 0);
            let got = self.read(&mut block)?;
            if got == 0 {
                break;
            }
            left -= got as u64;
        }
        Ok(())
    }

    /// Stores the detailed error, and returns a generic one for `io::Read`.
    fn failed(&mut self, failure: LoadError) -> io::Error {
        self.failure = Some(failure);
        io::Error::other("the data cannot be read")
    }

    /// Opens the next file; returns false if there is none.
    fn open_next(&mut self) -> Result<bool, LoadError> {
        let Some(place) = self.places.pop() else { return Ok(false) };
        let attempt = attempt(&place);
        let input = Input::open(attempt)?;
        let witness = Witness::of(attempt, &input)?;
        let reader = decoded(attempt, input, &place, self.storage, self.bytes_of_file, self.control)?;
        let path = place.path().to_owned();
        self.current = Some(Current { path, witness, reader, left: self.bytes_of_file });
        Ok(true)
    }

    /// Does nothing within the current file; at its end, verifies that the file has not changed and that no
    /// unannounced data follow.
    fn check_end(&mut self) -> Result<(), LoadError> {
        let Some(current) = &mut self.current else { return Ok(()) };
        if current.left > 0 {
            return Ok(());
        }
        let attempt = Attempt { what: READ, path: &current.path };
        let is_more = match self.storage.encoding {
            // Several headers may refer to one file.
            Encoding::Raw => false,
            // Also makes decoders verify the checksum, which follows the last byte.
            _ => {
                current
                    .reader
                    .read(&mut [0])
                    .map_err(|error| broken(attempt, self.storage.encoding, error))?
                    > 0
            }
        };
        current.witness.vouch(attempt, Ok(()))?;
        if is_more {
            let why = format!("there is more data than the {} bytes expected", self.bytes_of_file);
            return Err(attempt.bad_input("data", why, HELP));
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
        let attempt = Attempt { what: READ, path: &current.path };
        let want = usize::try_from(current.left).map_or(into.len(), |left| left.min(into.len()));
        let got = loop {
            match current.reader.read(&mut into[..want]) {
                Err(error) if error.kind() == io::ErrorKind::Interrupted => self.control.check()?,
                Err(error) => return Err(broken(attempt, self.storage.encoding, error)),
                Ok(got) => break got,
            }
        };
        current.left -= got as u64;
        if got == 0 {
            let (unit, size) = match self.storage.encoding {
                Encoding::Text => ("numbers", self.storage.number.bytes() as u64),
                _ => ("bytes", 1),
            };
            let (expected, found) = (self.bytes_of_file / size, (self.bytes_of_file - current.left) / size);
            let why = format!("the data are truncated: {expected} {unit} expected, {found} found");
            return Err(attempt.bad_input("data", why, HELP));
        }
        self.check_end()?;
        Ok(got)
    }
}

impl Read for Data<'_> {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        self.read_some(into).map_err(|failure| self.failed(failure))
    }
}

/// Action that error messages name for data files.
const READ: &str = "read the NRRD volume's data";

fn attempt(place: &Place) -> Attempt<'_> {
    Attempt { what: READ, path: place.path() }
}

/// Opens the decoder of a file at the first byte of its data; the length of uncompressed data is checked.
fn decoded(
    attempt: Attempt<'_>,
    mut input: Input,
    place: &Place,
    storage: Storage,
    bytes: u64,
    control: &LoadControl,
) -> Result<Stream, LoadError> {
    let start = match place {
        Place::Attached(_, start) => *start,
        Place::Detached(_) => 0,
    };
    input.seek(start).map_err(|error| attempt.io(error))?;
    let Some(lines) = input.skip_lines(attempt, storage.line_skip, control)? else {
        return Err(attempt.bad_input(
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
        attempt.bad_input("data", why, HELP)
    };
    let numbers = bytes / storage.number.bytes() as u64;
    match storage.encoding {
        Encoding::Raw if found < bytes => return Err(truncated(bytes, found, "bytes")),
        Encoding::Raw if found > bytes => {
            // Legal: several headers may refer to one file.
            attempt.warn(format_args!("{} bytes after the voxels are ignored", found - bytes));
        }
        Encoding::Gzip if most_inflated(available) < bytes => {
            return Err(truncated(bytes, most_inflated(available), "bytes"));
        }
        Encoding::Hex if found / 2 < bytes => return Err(truncated(bytes, found / 2, "bytes")),
        // Minimum size of text: a digit per number, and a space between two.
        Encoding::Text if found.div_ceil(2) < numbers => {
            return Err(truncated(numbers, found.div_ceil(2), "numbers"));
        }
        _ => {}
    }
    let reader = input.reader;
    // In compressed data, `byte skip` counts bytes after decompression.
    let mut decoder = match storage.encoding {
        Encoding::Raw => Stream::Plain(reader),
        Encoding::Gzip => Stream::Decoded(Box::new(GzipMembers::new(reader))),
        Encoding::Bzip2 => Stream::Decoded(Box::new(Bzip2Members::new(reader))),
        Encoding::Hex | Encoding::Text => {
            let mut reader = reader;
            skip_bytes(attempt, storage.encoding, &mut reader, skip, control)?;
            return Ok(Stream::Decoded(match storage.encoding {
                Encoding::Hex => Box::new(Hex { reader }),
                // One number more than needed, so that surplus data are detected.
                _ => Box::new(TextNumbers::new(reader, storage.number, numbers.saturating_add(1))),
            }));
        }
    };
    skip_bytes(attempt, storage.encoding, &mut decoder, skip, control)?;
    Ok(decoder)
}

fn skip_bytes(
    attempt: Attempt<'_>,
    encoding: Encoding,
    reader: &mut impl Read,
    count: u64,
    control: &LoadControl,
) -> Result<(), LoadError> {
    let mut left = count;
    while left > 0 {
        control.check()?;
        let skipped = io::copy(&mut reader.by_ref().take(left.min(1 << 20)), &mut io::sink());
        match skipped.map_err(|error| broken(attempt, encoding, error))? {
            0 => break,
            skipped => left -= skipped,
        }
    }
    Ok(())
}

/// Converts an error of a decoder: either the data are corrupt, or the disk failed.
fn broken(attempt: Attempt<'_>, encoding: Encoding, error: io::Error) -> LoadError {
    let name = match encoding {
        Encoding::Gzip => "gzip",
        Encoding::Bzip2 => "bzip2",
        Encoding::Hex | Encoding::Text => return attempt.bad_input("data", error.to_string(), HELP),
        Encoding::Raw => return attempt.io(error),
    };
    match error.kind() {
        io::ErrorKind::UnexpectedEof => attempt.bad_input(
            "data",
            format!("the {name} data are truncated: they end too early"),
            "copy or download the file again",
        ),
        io::ErrorKind::InvalidInput | io::ErrorKind::InvalidData => attempt.bad_input(
            "data",
            format!("the {name} data are broken: {error}"),
            "copy or download the file again",
        ),
        _ => attempt.io(error),
    }
}

/// Decoder of pairs of hexadecimal digits; white space is ignored.
struct Hex<R> {
    reader: R,
}

impl<R: BufRead> Read for Hex<R> {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        let mut made = 0;
        let mut high = None;
        while made < into.len() {
            let block = self.reader.fill_buf()?;
            if block.is_empty() {
                if high.is_some() {
                    return Err(io::Error::new(io::ErrorKind::InvalidData, "the data end within a byte"));
                }
                break;
            }
            let mut used = 0;
            for &byte in block {
                if made == into.len() {
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
                        into[made] = (high << 4 | digit) as u8;
                        made += 1;
                    }
                }
            }
            self.reader.consume(used);
        }
        Ok(made)
    }
}
