//! Registry of the supported formats, and detection of a file's format: by its first bytes, or else by its extension.

mod arrays;
mod cube;
pub(super) mod dicom;
mod fits;
pub(super) mod folder;
mod metaimage;
mod mgh;
mod mrc;
mod nifti;
mod nrrd;
mod pictures;
mod pvm;
pub mod raw;
mod vtk;

use std::path::Path;

pub use raw::{RawFormat, RawGuess, RawLayout};

use super::reading::input::InputFile;
use super::reading::reader::{FileStart, FormatReader};
use super::reading::{
    companion_path, content, input, label_tables, number, placement, reader, rescale, samples, text_numbers,
    voxel_filter, voxels,
};
use super::unsupported::{self, UnsupportedFormat};
use super::{Endian, LoadOptions};
use chiaroscuro_volume::{FileDimension, LoadControl, LoadError, VolumeChoice, VolumeOffer};
use pictures::{slices, tiff};

/// All readers, those with the most specific signatures first.
pub(super) const READERS: &[FormatReader] = &[
    nrrd::READER,
    arrays::numpy::NPY,
    arrays::numpy::NPZ,
    arrays::hdf5::READER,
    arrays::hdf5::DESCRIPTION,
    arrays::zarr::ARCHIVE,
    arrays::zarr::DOCUMENT,
    pvm::READER,
    nifti::READER,
    metaimage::READER,
    dicom::READER,
    tiff::READER,
    tiff::COMPANION,
    slices::READER,
    vtk::XML,
    vtk::LEGACY,
    mrc::READER,
    fits::READER,
    // Formats without a signature come after those with one.
    mgh::READER,
    cube::READER,
    raw::DAT,
    raw::IVF,
    raw::INI,
    raw::READER,
];

/// Detected format of a file.
pub(super) enum FileFormat {
    /// Supported format, with its reader.
    Reader(&'static FormatReader),
    /// Format that is recognised but not supported.
    Unsupported(&'static UnsupportedFormat),
    /// No known format.
    Unknown,
}

/// Detects the format of a file by its first bytes, or else by its extension. The file stays positioned at its
/// beginning.
pub(super) fn detect_format(
    path: &Path,
    start: &FileStart,
    input: &mut InputFile,
    options: &LoadOptions,
) -> FileFormat {
    // Dimensions in the options or a description in the name mean that the file is raw.
    let is_described = || options.raw.dims.is_some() || has_raw_extension(path) && raw::is_described(path);
    if let Some(reader) = by_content(start) {
        // Its content looks like another format, and is meaningless without its companion.
        return unsupported::by_overriding_extension(path)
            .map_or(FileFormat::Reader(reader), FileFormat::Unsupported);
    }
    if is_described() {
        return FileFormat::Reader(&raw::READER);
    }
    // By extension, because an array archive may begin with an entry that is no array, or contain none at all.
    let archives = [&arrays::numpy::NPZ, &arrays::zarr::ARCHIVE].into_iter();
    let archive = archives.filter(|_| start.has_at(b"PK", 0)).find(|reader| reader.has_extension_of(path));
    if let Some(reader) = archive {
        return FileFormat::Reader(reader);
    }
    if let Some(format) = unsupported::by_content(path, start, input) {
        return FileFormat::Unsupported(format);
    }
    if let Some(reader) = by_extension(path) {
        return FileFormat::Reader(reader);
    }
    unsupported::by_name(path).map_or(FileFormat::Unknown, FileFormat::Unsupported)
}

/// Reader of a file by its first bytes or its extension.
pub(super) fn reader_of(path: &Path, start: &FileStart) -> Option<&'static FormatReader> {
    by_content(start).or_else(|| by_extension(path))
}

fn by_content(start: &FileStart) -> Option<&'static FormatReader> {
    READERS.iter().find(|reader| (reader.recognises)(start))
}

fn by_extension(path: &Path) -> Option<&'static FormatReader> {
    READERS.iter().find(|reader| reader.has_extension_of(path))
}

/// Returns true if the extension is that of raw voxels.
fn has_raw_extension(path: &Path) -> bool {
    by_extension(path).is_some_and(|reader| reader.name == raw::READER.name)
}

/// Extensions that files of other programs have as well, so that only their content tells the format.
const AMBIGUOUS_EXTENSIONS: [&str; 1] = [".xml"];

/// Extensions of all supported files, for dialogs and messages.
pub fn supported_extensions() -> Vec<&'static str> {
    let readers = READERS.iter().flat_map(|reader| reader.extensions);
    let mut all: Vec<&str> = readers.chain(&AMBIGUOUS_EXTENSIONS).copied().collect();
    all.dedup();
    all
}

impl FormatReader {
    /// Returns true if a file has one of the format's extensions.
    fn has_extension_of(&self, path: &Path) -> bool {
        self.extensions.iter().any(|ending| has_extension(path, ending))
    }
}

/// Returns true if the file name ends in `ending` (lower case), ignoring case.
fn has_extension(path: &Path, ending: &str) -> bool {
    let name = path.file_name().unwrap_or_default().to_string_lossy().to_lowercase();
    name.ends_with(ending)
}
