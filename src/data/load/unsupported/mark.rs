//! Signatures by which unsupported formats are recognised.

use std::io::{Read as _, Seek as _};
use std::path::Path;

use super::super::reading::input::Input;
use super::super::reading::reader::Start;
use super::ole2;

/// Signature of a format.
#[derive(Debug)]
pub(super) enum Mark {
    /// Bytes at an offset of the content, inflated where the file is a gzip file.
    Bytes(usize, &'static [u8]),
    /// Bytes at an offset, in a file with one of these extensions: for bytes that are not specific enough.
    Named(usize, &'static [u8], &'static [&'static str]),
    /// Bytes at an offset, and others anywhere near the beginning: for containers and their content.
    Holding(usize, &'static [u8], &'static [u8]),
    /// Text that begins with some words, after white space and a byte order mark, ignoring case.
    Words(&'static str),
    /// Text that begins with the first words and has the second near its beginning.
    WordsWith(&'static str, &'static str),
    /// OLE 2 compound file with a stream or storage of this name.
    Compound(&'static str),
    /// Function that tests the beginning of the file.
    Test(fn(&Look) -> bool),
}

/// Beginning of a file, prepared for signature tests.
pub(super) struct Look {
    /// File name in lower case.
    pub(super) name: String,
    /// First kilobyte of the content, inflated where the file is a gzip file.
    pub(super) content: Vec<u8>,
    /// First bytes of the file as stored.
    pub(super) stored: Vec<u8>,
    /// Length of the file, in bytes.
    pub(super) length: u64,
    /// True if it is a gzip file.
    pub(super) is_gzip: bool,
    /// Names of streams and storages in an OLE 2 compound file.
    pub(super) compound: Vec<String>,
}

impl Look {
    /// Reads the first `bytes` bytes of a file, and seeks back to its beginning.
    pub(super) fn new(path: &Path, start: &Start, input: &mut Input, bytes: u64) -> Self {
        let mut stored = Vec::new();
        // A file that cannot be read matches no signature.
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

    /// Returns true if the content has `bytes` at offset `at`.
    pub(super) fn has(&self, at: usize, bytes: &[u8]) -> bool {
        self.content.get(at..).is_some_and(|rest| rest.starts_with(bytes))
    }

    /// Returns true if the inspected part contains `bytes` anywhere.
    pub(super) fn holds(&self, bytes: &[u8]) -> bool {
        let held = if self.is_gzip { &self.content } else { &self.stored };
        held.windows(bytes.len()).any(|window| window == bytes)
    }

    /// First kilobyte of the content as text, in lower case.
    pub(super) fn text(&self) -> String {
        let text = String::from_utf8_lossy(&self.content).to_lowercase();
        text.trim_start_matches('\u{feff}').trim_start().to_owned()
    }
}

impl Mark {
    /// Returns true if a file matches the signature.
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
