//! Signatures by which unsupported formats are recognised.

use std::io::{Read as _, Seek as _};
use std::path::Path;

use super::super::reading::input::InputFile;
use super::super::reading::reader::FileStart;
use super::ole2;

/// Signature of a format.
#[derive(Debug)]
pub(super) enum FormatSignature {
    /// Bytes at an offset of the content, inflated where the file is a gzip file.
    Bytes(usize, &'static [u8]),
    /// Bytes at an offset, in a file with one of these extensions: for bytes that are not specific enough.
    BytesWithExtension(usize, &'static [u8], &'static [&'static str]),
    /// Bytes at an offset, and others anywhere near the beginning: for containers and their content.
    Container(usize, &'static [u8], &'static [u8]),
    /// Text that begins with some words, after white space and a byte order mark, ignoring case.
    Text(&'static str),
    /// Text that begins with the first words and has the second near its beginning.
    TextWith(&'static str, &'static str),
    /// OLE 2 compound file with a stream or storage of this name.
    Compound(&'static str),
    /// Function that tests the beginning of the file.
    Test(fn(&InspectedFile) -> bool),
}

/// Beginning of a file, prepared for signature tests.
pub(super) struct InspectedFile {
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

impl InspectedFile {
    /// Reads the first `bytes` bytes of a file, and seeks back to its beginning.
    pub(super) fn new(path: &Path, start: &FileStart, input: &mut InputFile, bytes: u64) -> Self {
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
    pub(super) fn has_at(&self, at: usize, bytes: &[u8]) -> bool {
        self.content.get(at..).is_some_and(|rest| rest.starts_with(bytes))
    }

    /// Returns true if the inspected part contains `bytes` anywhere.
    pub(super) fn contains(&self, bytes: &[u8]) -> bool {
        let held = if self.is_gzip { &self.content } else { &self.stored };
        held.windows(bytes.len()).any(|window| window == bytes)
    }

    /// First kilobyte of the content as text, in lower case.
    pub(super) fn text(&self) -> String {
        let text = String::from_utf8_lossy(&self.content).to_lowercase();
        text.trim_start_matches('\u{feff}').trim_start().to_owned()
    }
}

impl FormatSignature {
    /// Returns true if a file matches the signature.
    pub(super) fn matches(&self, look: &InspectedFile) -> bool {
        match *self {
            Self::Bytes(at, bytes) => look.has_at(at, bytes),
            Self::BytesWithExtension(at, bytes, endings) => {
                look.has_at(at, bytes) && endings.iter().any(|ending| look.name.ends_with(ending))
            }
            Self::Container(at, bytes, held) => look.has_at(at, bytes) && look.contains(held),
            Self::Text(words) => look.text().starts_with(words),
            Self::TextWith(words, others) => {
                let text = look.text();
                text.starts_with(words) && text.contains(others)
            }
            Self::Compound(name) => look.compound.iter().any(|held| held == name),
            Self::Test(test) => test(look),
        }
    }
}
