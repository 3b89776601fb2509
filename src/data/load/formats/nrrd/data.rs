//! The data of all files as one stream of bytes: decoded, without what is skipped.

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

/// A file with data.
#[derive(Debug, Clone)]
pub(super) enum Place {
    /// The header's own, from this byte on.
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

/// The files that are still to be read, and the one that is.
pub(super) struct Data<'a> {
    /// The next one last.
    places: Vec<Place>,
    storage: Storage,
    /// Bytes that each file has when it is decoded.
    bytes_of_file: u64,
    control: &'a LoadControl,
    current: Option<Current>,
    /// Why the last read has failed, in better words.
    pub(super) failure: Option<LoadError>,
}

struct Current {
    path: PathBuf,
    witness: Witness,
    reader: Stream,
    left: u64,
}

/// What the bytes of a file come from.
enum Stream {
    /// As they are.
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

    /// Goes to a byte of the stream; files before it are not opened.
    pub(super) fn skip(&mut self, bytes: u64) -> io::Result<()> {
        let files = bytes / self.bytes_of_file.max(1);
        self.places.truncate(self.places.len().saturating_sub(usize::try_from(files).unwrap_or(usize::MAX)));
        self.leap(bytes % self.bytes_of_file.max(1))
    }

    /// Goes forward: of what is neither packed nor text nothing is read.
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
            // As much as lies between two looks at `cancel`; little where a file has yet to be opened.
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

    /// Keeps why something has failed, and says that it has.
    fn failed(&mut self, failure: LoadError) -> io::Error {
        self.failure = Some(failure);
        io::Error::other("the data cannot be read")
    }

    /// Opens the next file; whether there is one.
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

    /// What was read of the current file, where it goes on; at its end it must be as it was, and nothing may follow that
    /// was not announced.
    fn check_end(&mut self) -> Result<(), LoadError> {
        let Some(current) = &mut self.current else { return Ok(()) };
        if current.left > 0 {
            return Ok(());
        }
        let attempt = Attempt { what: READ, path: &current.path };
        let is_more = match self.storage.encoding {
            // Several headers can point into one file.
            Encoding::Raw => false,
            // Also makes decoders look at the checksum, which comes after the last byte.
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

/// What messages say is being done.
const READ: &str = "read the NRRD volume's data";

fn attempt(place: &Place) -> Attempt<'_> {
    Attempt { what: READ, path: place.path() }
}

/// A decoder of a file, at the first byte of its data; of uncompressed ones the length is checked.
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
            // Legal: several headers can point into one file.
            attempt.warn(format_args!("{} bytes after the voxels are ignored", found - bytes));
        }
        Encoding::Gzip if most_inflated(available) < bytes => {
            return Err(truncated(bytes, most_inflated(available), "bytes"));
        }
        Encoding::Hex if found / 2 < bytes => return Err(truncated(bytes, found / 2, "bytes")),
        // A digit each and a space between: less cannot hold the numbers.
        Encoding::Text if found.div_ceil(2) < numbers => {
            return Err(truncated(numbers, found.div_ceil(2), "numbers"));
        }
        _ => {}
    }
    let reader = input.reader;
    // The skipped bytes of compressed data are counted after inflating.
    let mut decoder = match storage.encoding {
        Encoding::Raw => Stream::Plain(reader),
        Encoding::Gzip => Stream::Decoded(Box::new(GzipMembers::new(reader))),
        Encoding::Bzip2 => Stream::Decoded(Box::new(Bzip2Members::new(reader))),
        Encoding::Hex | Encoding::Text => {
            let mut reader = reader;
            skip_bytes(attempt, storage.encoding, &mut reader, skip, control)?;
            return Ok(Stream::Decoded(match storage.encoding {
                Encoding::Hex => Box::new(Hex { reader }),
                // One more than needed tells too much from enough.
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

/// An error of a decoder: about the data, or about the disk that they are on.
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

/// Bytes from pairs of hexadecimal digits, with white space anywhere.
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
