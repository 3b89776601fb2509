//! What files of a format have in common.

use std::io::{Read as _, Seek as _};
use std::path::Path;

use super::super::reading::input::Input;
use super::super::reading::reader::Start;
use super::ole2;

/// Something by which a format is told.
#[derive(Debug)]
pub(super) enum Mark {
    /// Bytes at a place of what the file holds, unpacked where it is a gzip file.
    Bytes(usize, &'static [u8]),
    /// Bytes at a place, in a file whose name has one of these endings: for bytes that others may have as well.
    Named(usize, &'static [u8], &'static [&'static str]),
    /// Bytes at a place, and others anywhere near the beginning: what a container holds.
    Holding(usize, &'static [u8], &'static [u8]),
    /// Text that begins with some words (behind spaces and a byte order mark), in any case.
    Words(&'static str),
    /// Text that begins with one of them and has the other near its beginning.
    WordsWith(&'static str, &'static str),
    /// A compound file of OLE 2 with a stream or storage of a name.
    Compound(&'static str),
    /// A test of its own.
    Test(fn(&Look) -> bool),
}

/// How a file begins.
pub(super) struct Look {
    /// Its name in lower case.
    pub(super) name: String,
    /// What it holds, unpacked where it is a gzip file: the first kilobyte.
    pub(super) content: Vec<u8>,
    /// The file itself: as much as is looked at.
    pub(super) stored: Vec<u8>,
    /// Length of the file in bytes.
    pub(super) length: u64,
    /// Whether it is a gzip file.
    pub(super) is_gzip: bool,
    /// Names in a compound file of OLE 2.
    pub(super) compound: Vec<String>,
}

impl Look {
    /// Looks at so many bytes of a file, and goes back to its beginning.
    pub(super) fn new(path: &Path, start: &Start, input: &mut Input, bytes: u64) -> Self {
        let mut stored = Vec::new();
        // What cannot be read says nothing.
        let _read = input.reader.by_ref().take(bytes).read_to_end(&mut stored);
        let compound = ole2::names(&stored, input);
        let _back = input.reader.rewind();
        Self {
            name: path.file_name().unwrap_or_default().to_string_lossy().to_lowercase(),
            content: start.bytes().to_vec(),
            stored,
            length: input.len,
            is_gzip: start.is_gzip(),
            compound,
        }
    }

    /// Whether what the file holds has some bytes at a place.
    pub(super) fn has(&self, at: usize, bytes: &[u8]) -> bool {
        self.content.get(at..).is_some_and(|rest| rest.starts_with(bytes))
    }

    /// Whether the file has some bytes anywhere in what is looked at.
    pub(super) fn holds(&self, bytes: &[u8]) -> bool {
        let held = if self.is_gzip { &self.content } else { &self.stored };
        held.windows(bytes.len()).any(|window| window == bytes)
    }

    /// The beginning as text in lower case.
    pub(super) fn text(&self) -> String {
        let text = String::from_utf8_lossy(&self.content).to_lowercase();
        text.trim_start_matches('\u{feff}').trim_start().to_owned()
    }
}

impl Mark {
    /// Whether a file has it.
    pub(super) fn is_found(&self, look: &Look) -> bool {
        match *self {
            Self::Bytes(at, bytes) => look.has(at, bytes),
            Self::Named(at, bytes, endings) => {
                look.has(at, bytes) && endings.iter().any(|ending| look.name.ends_with(ending))
            }
            Self::Holding(at, bytes, held) => look.has(at, bytes) && look.holds(held),
            Self::Words(words) => look.text().starts_with(words),
            Self::WordsWith(words, others) => {
                let text = look.text();
                text.starts_with(words) && text.contains(others)
            }
            Self::Compound(name) => look.compound.iter().any(|held| held == name),
            Self::Test(test) => test(look),
        }
    }
}
