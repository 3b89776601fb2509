//! Formats that are known and not read: what a file is, and the command that makes something of it that is read.
//!
//! They are told by the bytes of their files; by a name alone only where these say nothing.

mod archives;
mod compound;
mod documents;
mod fields;
mod folders;
mod hdf5;
mod mark;
mod medical;
mod microscopy;
mod ole2;
mod surfaces;
#[cfg(test)]
mod tests;

use std::path::Path;

use super::LoadError;
use super::reading::input::Input;
use super::reading::reader::Start;
use crate::data::attempt::Attempt;
pub(crate) use folders::of_folder;
use mark::{Look, Mark};

/// A format that is known and not read.
#[derive(Debug)]
pub(crate) struct UnsupportedFormat {
    /// What a file of it is, with its article: `a CZI file of Zeiss microscopes`.
    what: &'static str,
    /// What its files have, any of these.
    marks: &'static [Mark],
    /// Endings of its files in lower case, for those whose bytes say nothing.
    endings: &'static [&'static str],
    /// What makes something that is read of it. IN and OUT stand for files.
    help: &'static str,
}

/// Bytes of a file's beginning that are looked at where its first ones say that it is a container: the names of what it
/// holds begin there.
const LOOK_BYTES: u64 = 64 << 10;

/// All of them, the surest marks first.
fn all() -> impl Iterator<Item = &'static UnsupportedFormat> {
    let tables = [
        hdf5::FORMATS,
        compound::FORMATS,
        microscopy::FORMATS,
        medical::FORMATS,
        fields::FORMATS,
        surfaces::FORMATS,
        documents::FORMATS,
        archives::FORMATS,
    ];
    tables.into_iter().flatten()
}

/// The format of a file by its bytes; goes back to its beginning.
///
/// What cannot be read now will be refused for that when it is.
pub(crate) fn by_content(
    path: &Path,
    start: &Start,
    input: &mut Input,
) -> Option<&'static UnsupportedFormat> {
    let look = Look::new(path, start, input, LOOK_BYTES);
    all().find(|format| format.marks.iter().any(|mark| mark.is_found(&look)))
}

/// Endings of files that are told by their names first: by their bytes they are another format, without what matters.
const DISGUISED: [&str; 1] = [".vsi"];

/// The format of a file whose bytes are those of another.
pub(crate) fn disguised(path: &Path) -> Option<&'static UnsupportedFormat> {
    let name = path.file_name().unwrap_or_default().to_string_lossy().to_lowercase();
    DISGUISED.iter().any(|ending| name.ends_with(ending)).then(|| by_name(path)).flatten()
}

/// The format of a file by its name alone.
pub(crate) fn by_name(path: &Path) -> Option<&'static UnsupportedFormat> {
    let name = path.file_name().unwrap_or_default().to_string_lossy().to_lowercase();
    all().find(|format| format.endings.iter().any(|ending| name.ends_with(ending)))
}

impl UnsupportedFormat {
    /// The refusal, in one line.
    pub(crate) fn refusal(&self, attempt: Attempt<'_>) -> LoadError {
        attempt.bad_input("format", format!("it is {}, which is not read", self.what), self.help)
    }
}
