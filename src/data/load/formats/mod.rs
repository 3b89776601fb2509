//! The formats that are read, and which of them a file has: by how it begins, or by its ending where that says nothing.

mod cube;
pub(super) mod dicom;
mod fits;
pub(super) mod folder;
mod metaimage;
mod mgh;
mod mrc;
mod nifti;
mod nrrd;
mod numpy;
mod pictures;
mod pvm;
pub mod raw;
mod vtk;

use std::path::Path;

pub use raw::{RawFormat, RawGuess, RawLayout};

use super::reading::input::Input;
use super::reading::reader::{Reader, Start};
use super::reading::{
    beside, content, input, label_files, number, placement, read_files, reader, rescaled, samples, sieve,
    text_numbers, voxels,
};
use super::unsupported::{self, UnsupportedFormat};
use super::{Choice, Dimension, Endian, LoadControl, LoadError, LoadOptions, Offer};
use pictures::{slices, tiff};

/// All formats, the surest marks first.
pub(super) const READERS: &[Reader] = &[
    nrrd::READER,
    numpy::NPY,
    numpy::NPZ,
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
    // Without a mark: what has one comes first.
    mgh::READER,
    cube::READER,
    raw::DAT,
    raw::IVF,
    raw::INI,
    raw::READER,
];

/// The format of a file.
pub(super) enum FileFormat {
    /// One that is read.
    Reader(&'static Reader),
    /// One that is known and not read.
    Unsupported(&'static UnsupportedFormat),
    /// None that is known.
    Unknown,
}

/// Recognises the format of a file that is open at its beginning, where it stays: by its first bytes, or else by its ending.
pub(super) fn recognize(path: &Path, start: &Start, input: &mut Input, options: &LoadOptions) -> FileFormat {
    // Who says how voxels are stored means that they are nothing else: the options, or a name.
    let is_described = || options.raw.dims.is_some() || has_raw_ending(path) && raw::is_described(path);
    if let Some(reader) = by_content(start) {
        // Its bytes are those of the other, and say nothing.
        return unsupported::disguised(path).map_or(FileFormat::Reader(reader), FileFormat::Unsupported);
    }
    if is_described() {
        return FileFormat::Reader(&raw::READER);
    }
    // An archive of arrays is a ZIP archive, also where it has none.
    if has_ending(path, ".npz") && start.has(b"PK", 0) {
        return FileFormat::Reader(&numpy::NPZ);
    }
    if let Some(format) = unsupported::by_content(path, start, input) {
        return FileFormat::Unsupported(format);
    }
    if let Some(reader) = by_ending(path) {
        return FileFormat::Reader(reader);
    }
    unsupported::by_name(path).map_or(FileFormat::Unknown, FileFormat::Unsupported)
}

/// The reader of a file, as far as its first bytes and its ending tell.
pub(super) fn reader_of(path: &Path, start: &Start) -> Option<&'static Reader> {
    by_content(start).or_else(|| by_ending(path))
}

fn by_content(start: &Start) -> Option<&'static Reader> {
    READERS.iter().find(|reader| (reader.recognises)(start))
}

fn by_ending(path: &Path) -> Option<&'static Reader> {
    READERS.iter().find(|reader| reader.endings.iter().any(|ending| has_ending(path, ending)))
}

/// Whether a file is bare voxels by its ending.
fn has_raw_ending(path: &Path) -> bool {
    by_ending(path).is_some_and(|reader| reader.name == raw::READER.name)
}

/// Endings of all files that are read, for dialogs and messages.
pub fn endings() -> Vec<&'static str> {
    let mut all: Vec<&str> = READERS.iter().flat_map(|reader| reader.endings).copied().collect();
    all.dedup();
    all
}

/// Whether the file name ends in `ending` (lower case), in any case.
fn has_ending(path: &Path, ending: &str) -> bool {
    let name = path.file_name().unwrap_or_default().to_string_lossy().to_lowercase();
    name.ends_with(ending)
}
