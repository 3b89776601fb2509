//! The formats that are read, and which of them a file has: by how it begins, or by its ending where that says nothing.

mod cube;
pub(super) mod dicom;
pub(super) mod folder;
mod metaimage;
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

use super::reading::reader::{Reader, Start};
use super::reading::{
    beside, content, input, label_files, number, placement, read_files, reader, rescaled, samples, sieve,
    text_numbers, voxels,
};
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
    cube::READER,
    raw::DAT,
    raw::IVF,
    raw::INI,
    raw::READER,
];

/// The reader of a file.
pub(super) fn reader_of(path: &Path, start: &Start, options: &LoadOptions) -> Option<&'static Reader> {
    let by_content = READERS.iter().find(|reader| (reader.recognises)(start));
    let by_ending =
        || READERS.iter().find(|reader| reader.endings.iter().any(|ending| has_ending(path, ending)));
    // Who says how voxels are stored means that they are nothing else.
    let described = || options.raw.dims.map(|_| &raw::READER);
    by_content.or_else(described).or_else(by_ending)
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
