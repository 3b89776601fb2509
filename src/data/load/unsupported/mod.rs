//! Formats that are recognised but not supported, each with a command that converts its files.
//!
//! They are recognised by the bytes of their files; by the name only where these are not specific.

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

/// Format that is recognised but not supported.
#[derive(Debug)]
pub(crate) struct UnsupportedFormat {
    /// Description of a file, with its article: `a CZI file of Zeiss microscopes`.
    what: &'static str,
    /// Signatures of its files; one of them must match.
    marks: &'static [Mark],
    /// Extensions of its files in lower case, for those without a signature.
    endings: &'static [&'static str],
    /// Command or advice to convert a file. IN and OUT stand for file names.
    help: &'static str,
}

/// Bytes of a file's beginning that are searched for the names in a container.
const LOOK_BYTES: u64 = 64 << 10;

/// All unsupported formats, those with the most specific signatures first.
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

/// Recognises the format of a file by its bytes; the file is positioned at its beginning afterwards.
///
/// Read errors are ignored here: they will be reported when the file is read.
pub(crate) fn by_content(
    path: &Path,
    start: &Start,
    input: &mut Input,
) -> Option<&'static UnsupportedFormat> {
    let look = Look::new(path, start, input, LOOK_BYTES);
    all().find(|format| format.marks.iter().any(|mark| mark.is_found(&look)))
}

/// Extensions that take precedence over the content: it looks like another format, without the actual data.
const DISGUISED: [&str; 1] = [".vsi"];

/// Unsupported format of a file whose content looks like a supported one.
pub(crate) fn disguised(path: &Path) -> Option<&'static UnsupportedFormat> {
    let name = path.file_name().unwrap_or_default().to_string_lossy().to_lowercase();
    DISGUISED.iter().any(|ending| name.ends_with(ending)).then(|| by_name(path)).flatten()
}

/// Recognises the format of a file by its name alone.
pub(crate) fn by_name(path: &Path) -> Option<&'static UnsupportedFormat> {
    let name = path.file_name().unwrap_or_default().to_string_lossy().to_lowercase();
    all().find(|format| format.endings.iter().any(|ending| name.ends_with(ending)))
}

impl UnsupportedFormat {
    /// Error message of one line, with the advice.
    pub(crate) fn refusal(&self, attempt: Attempt<'_>) -> LoadError {
        attempt.bad_input("format", format!("it is {}, which is not read", self.what), self.help)
    }
}
