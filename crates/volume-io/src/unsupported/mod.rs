//! Formats that are recognised but not supported, each with a command that converts its files.
//!
//! They are recognised by the bytes of their files; by the name only where these are not specific.

mod archives;
mod compound;
mod documents;
mod folders;
mod hdf5;
mod medical;
mod microscopy;
mod ole2;
mod signature;
mod simulation;
mod surfaces;
#[cfg(test)]
mod tests;

use std::path::Path;

use super::reading::input::InputFile;
use super::reading::reader::FileStart;
use chiaroscuro_volume::{LoadContext, LoadError};
pub(crate) use folders::unsupported_folder;
pub(crate) use hdf5::minc_2_refusal;
use signature::{FormatSignature, InspectedFile};

/// Format that is recognised but not supported.
#[derive(Debug)]
pub(crate) struct UnsupportedFormat {
    /// Description of a file, with its article: `a CZI file of Zeiss microscopes`.
    description: &'static str,
    /// Signatures of its files; one of them must match.
    signatures: &'static [FormatSignature],
    /// Extensions of its files in lower case, for those without a signature.
    extensions: &'static [&'static str],
    /// Command or advice to convert a file. IN and OUT stand for file names.
    advice: &'static str,
}

/// Bytes of a file's beginning that are searched for the names in a container.
const INSPECTED_BYTES: u64 = 64 << 10;

/// All unsupported formats, those with the most specific signatures first.
fn all() -> impl Iterator<Item = &'static UnsupportedFormat> {
    let tables = [
        hdf5::FORMATS,
        compound::FORMATS,
        microscopy::FORMATS,
        medical::FORMATS,
        simulation::FORMATS,
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
    start: &FileStart,
    input: &mut InputFile,
) -> Option<&'static UnsupportedFormat> {
    let look = InspectedFile::new(path, start, input, INSPECTED_BYTES);
    all().find(|format| format.signatures.iter().any(|mark| mark.matches(&look)))
}

/// Extensions that take precedence over the content: it looks like another format, without the actual data.
const OVERRIDING_EXTENSIONS: [&str; 1] = [".vsi"];

/// Unsupported format of a file whose content looks like a supported one.
pub(crate) fn by_overriding_extension(path: &Path) -> Option<&'static UnsupportedFormat> {
    let name = path.file_name().unwrap_or_default().to_string_lossy().to_lowercase();
    OVERRIDING_EXTENSIONS.iter().any(|ending| name.ends_with(ending)).then(|| by_name(path)).flatten()
}

/// Recognises the format of a file by its name alone.
pub(crate) fn by_name(path: &Path) -> Option<&'static UnsupportedFormat> {
    let name = path.file_name().unwrap_or_default().to_string_lossy().to_lowercase();
    all().find(|format| format.extensions.iter().any(|ending| name.ends_with(ending)))
}

impl UnsupportedFormat {
    /// Error message of one line, with the advice.
    pub(crate) fn refusal(&self, context: LoadContext<'_>) -> LoadError {
        context.bad_input_error(
            "format",
            format!("it is {}, which is not supported", self.description),
            self.advice,
        )
    }
}
