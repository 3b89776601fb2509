//! What a format is told by, and what its reader is given.

use std::io::{self, BufReader, Read, Seek as _};
use std::path::Path;

use flate2::bufread::MultiGzDecoder;

use super::input::{Input, is_gzip};
use super::{LoadControl, LoadError, LoadOptions};
use crate::data::Volume;

/// Bytes of a file's beginning that are looked at: a header of NIfTI-2 has 540, DICOM's mark ends at 132.
const START_BYTES: usize = 1024;

/// A format.
pub(super) struct Reader {
    /// What messages and menus call it.
    pub(super) name: &'static str,
    /// Endings of its files, in lower case and with their dots.
    pub(super) endings: &'static [&'static str],
    /// Whether a file that begins like this is one, whatever it is called.
    pub(super) recognises: fn(&Start) -> bool,
    /// Reads such a file.
    pub(super) load: fn(Source<'_>) -> Result<Volume, LoadError>,
}

/// A file to be read.
pub(super) struct Source<'a> {
    pub(super) path: &'a Path,
    /// Open at its beginning.
    pub(super) input: Input,
    pub(super) start: Start,
    pub(super) options: &'a LoadOptions,
    pub(super) control: &'a LoadControl,
}

impl Source<'_> {
    /// What the file holds from its beginning: inflated where it is compressed as a whole.
    ///
    /// Whoever reads it takes no more than was announced: a compressed file may hold anything.
    pub(super) fn content(&mut self) -> Box<dyn Read + '_> {
        if self.start.is_gzip() {
            Box::new(BufReader::new(MultiGzDecoder::new(&mut self.input.reader)))
        } else {
            Box::new(&mut self.input.reader)
        }
    }
}

/// How a file begins.
pub(super) struct Start {
    stored: Vec<u8>,
    /// What the file holds, where it is compressed as a whole.
    inflated: Option<Vec<u8>>,
}

impl Start {
    /// Looks at a file, and goes back to its beginning.
    pub(super) fn of(input: &mut Input) -> io::Result<Self> {
        let mut stored = Vec::with_capacity(START_BYTES);
        input.reader.by_ref().take(START_BYTES as u64).read_to_end(&mut stored)?;
        input.reader.rewind()?;
        let inflated = is_gzip(&stored).then(|| {
            let mut found = Vec::new();
            // What is broken, or cut off where the look ends, says what it says until there.
            let mut decoder = MultiGzDecoder::new(&mut input.reader).take(START_BYTES as u64);
            let _how_far = decoder.read_to_end(&mut found);
            found
        });
        input.reader.rewind()?;
        Ok(Self { stored, inflated })
    }

    /// The first bytes of what the file holds, inflated where it is compressed.
    pub(super) fn bytes(&self) -> &[u8] {
        self.inflated.as_ref().unwrap_or(&self.stored)
    }

    /// The first bytes of the file.
    pub(super) fn stored(&self) -> &[u8] {
        &self.stored
    }

    /// Whether the file is compressed as a whole.
    pub(super) fn is_gzip(&self) -> bool {
        self.inflated.is_some()
    }

    /// Whether the content has some bytes at a place.
    pub(super) fn has(&self, bytes: &[u8], at: usize) -> bool {
        self.bytes().get(at..).is_some_and(|rest| rest.starts_with(bytes))
    }
}
