//! Loading of volumes from files, and from folders of slices; `formats` has the readers, docs/FORMATS.md the
//! supported variants.
//!
//! Files are not trusted. Every size is checked against the file's length and the memory budget before anything is
//! allocated; only regular files are opened; a header can name no file outside its own folder. Files are read in
//! blocks into typed voxels, never memory-mapped: the peak is the volume itself and one block.

mod formats;
mod large_pages;
mod neighbour;
mod reading;
#[cfg(test)]
mod tests;
mod unsupported;

use std::path::{Path, PathBuf};
use std::sync::Arc;

pub use formats::{RawFormat, RawGuess, RawLayout, endings, raw};

use super::Volume;
#[cfg(any(feature = "window", feature = "cli"))]
pub(crate) use super::attempt::human_bytes;
pub(crate) use super::attempt::memory_budget_bytes;
pub use super::attempt::{
    Aspect, Choice, Components, Dimension, Explanation, Held, LoadControl, LoadError, LoadErrorKind, Offer,
    Portion, Region, Several, Size, Stretch, Thinning, Watch, Whole,
};
use super::attempt::{Attempt, Room};
pub use neighbour::neighbour;
pub use reading::read_files::ReadFiles;

use formats::{FileFormat, READERS, folder, recognize};
use reading::input::{Input, Witness};
use reading::reader::{Source, Start};

/// Byte order of numbers in a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Endian {
    /// Least significant byte first (little-endian).
    Little,
    /// Most significant byte first (big-endian).
    Big,
}

/// Options of the user for loading a volume.
#[derive(Debug, Clone, PartialEq)]
pub struct LoadOptions {
    /// Layout of RAW files; other formats describe themselves.
    pub raw: RawFormat,
    /// Choice among several volumes, and the portion to read.
    pub choice: Choice,
    /// Files of a folder to consider; all of them if `None`.
    pub among: Option<Arc<[PathBuf]>>,
    /// Maximum size of a volume, in bytes of its voxels.
    pub memory_budget_bytes: u64,
}

impl Default for LoadOptions {
    /// No layout for RAW files, all voxels; a budget of three quarters of the memory that is free now (within the
    /// limits of the machine, its container and the user), or 4 GiB where that is unknown.
    fn default() -> Self {
        let (raw, choice) = (RawFormat::default(), Choice::default());
        Self { raw, choice, among: None, memory_budget_bytes: memory_budget_bytes() }
    }
}

impl LoadOptions {
    /// Limits and choices for a volume, to be checked before allocation.
    fn room<'a>(&'a self, control: &'a LoadControl) -> Room<'a> {
        Room { budget_bytes: self.memory_budget_bytes, choice: &self.choice, control }
    }
}

/// Loads a volume from a file, or from a folder of slices: all of it, or the portion that `options` select.
///
/// A format is recognised by a file's first bytes, or else by its extension; when `options` give dimensions, a file
/// that is not recognised is read as RAW.
///
/// # Errors
/// [`LoadErrorKind::BadInput`] for a file or options that make no volume, or several ([`LoadError::Several`]),
/// `Limit` for a volume over the budget, `Io` for an unreadable path, or one that is neither a file nor a folder,
/// `Cancelled` on cancellation.
pub fn load(path: &Path, options: &LoadOptions, control: &LoadControl) -> Result<Volume, LoadError> {
    let portion = options.choice.portion.unwrap_or_default();
    let read = |are_labels: bool| {
        let (choice, watch) = Choice { are_labels, ..options.choice.clone() }.watched();
        let options = LoadOptions { choice, ..options.clone() };
        let volume = control.during(|| load_watched(path, &options, control));
        // Cancellation takes precedence over the result.
        control.check()?;
        let volume = volume?;
        Attempt { what: "open the volume", path }.refuse_unasked(&options.choice, &watch)?;
        let volume = volume.with_held(Held { portion, ..watch.held() });
        Ok::<_, LoadError>((watch.has_averaged() && volume.is_of_labels(), volume))
    };
    match read(false)? {
        // Voxels may prove to be labels only after reading: then the file is read again, with the most frequent label
        // of each block.
        (true, _) => read(true).map(|(_, volume)| volume),
        (false, volume) => Ok(volume),
    }
}

fn load_watched(path: &Path, options: &LoadOptions, control: &LoadControl) -> Result<Volume, LoadError> {
    control.check()?;
    let attempt = Attempt { what: "open the volume", path };
    if path.is_dir() {
        return folder::load(path, options, control);
    }
    let mut input = Input::open(attempt)?;
    let witness = Witness::of(attempt, &input)?;
    let start = Start::of(&mut input).map_err(|error| attempt.io(error))?;
    // Voxels of a described raw file may begin like this by chance.
    if start.is_packed_twice() && options.raw.dims.is_none() {
        return Err(attempt.bad_input(
            "format",
            "it is compressed twice: what is in the gzip file is a gzip file again",
            "unpack it once, with gunzip for example, and open what comes out",
        ));
    }
    let reader = match recognize(path, &start, &mut input, options) {
        FileFormat::Reader(reader) => reader,
        FileFormat::Unsupported(format) => return Err(format.refusal(attempt)),
        FileFormat::Unknown => {
            let names: Vec<&str> = READERS.iter().map(|reader| reader.name).collect();
            return Err(attempt.bad_input(
                "format",
                format!("its format is not one that is read: {}", names.join(", ")),
                "convert it to NRRD, or describe its voxels with --dims and --type",
            ));
        }
    };
    let loaded = (reader.load)(Source { path, input, start, options, control });
    witness.vouch(attempt, loaded)
}
