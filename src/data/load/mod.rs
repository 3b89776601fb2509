//! Volumes from files, and from folders of slices: `formats` says which, docs/FORMATS.md what of them.
//!
//! Files are not trusted. Every size is checked against the file's length and the memory budget
//! before anything is allocated; only regular files are opened; a header can name no file outside
//! its own folder. Files are read in blocks into typed voxels, never mapped: the peak is the volume
//! itself and one block.

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

/// The order of the bytes of one voxel.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Endian {
    /// The lowest byte first.
    Little,
    /// The highest byte first.
    Big,
}

/// What the user says about loading.
#[derive(Debug, Clone, PartialEq)]
pub struct LoadOptions {
    /// How RAW files are stored; other formats say it themselves.
    pub raw: RawFormat,
    /// Which volume is meant where there are several, and how much of it is read.
    pub choice: Choice,
    /// Of a folder, the files that are meant; all of them where nothing is said.
    pub among: Option<Arc<[PathBuf]>>,
    /// The largest volume that is loaded, in bytes of its voxels.
    pub memory_budget_bytes: u64,
}

impl Default for LoadOptions {
    /// Nothing said about RAW files, every voxel kept; a budget of three quarters of the memory that is free now
    /// (what the machine, its container and the user's limits leave), or 4 GiB where that is not known.
    fn default() -> Self {
        let (raw, choice) = (RawFormat::default(), Choice::default());
        Self { raw, choice, among: None, memory_budget_bytes: memory_budget_bytes() }
    }
}

impl LoadOptions {
    /// What there is for a volume, and how much of it is wanted.
    fn room<'a>(&'a self, control: &'a LoadControl) -> Room<'a> {
        Room { budget_bytes: self.memory_budget_bytes, choice: &self.choice, control }
    }
}

/// Loads a volume from a file, or from a folder of slices: all of it, or as much as `options` want.
///
/// A format is recognised by a file's first bytes, or else by its ending; when `options` give dimensions, a file that is
/// not recognised is read as RAW.
///
/// # Errors
/// [`LoadErrorKind::BadInput`] for a file or options that make no volume, or several ([`LoadError::Several`]), `Limit` for
/// a volume over the budget, `Io` for what is not readable, or neither a file nor a folder, `Cancelled` when asked to stop.
pub fn load(path: &Path, options: &LoadOptions, control: &LoadControl) -> Result<Volume, LoadError> {
    let portion = options.choice.portion.unwrap_or_default();
    let read = |are_labels: bool| {
        let (choice, watch) = Choice { are_labels, ..options.choice.clone() }.watched();
        let options = LoadOptions { choice, ..options.clone() };
        let volume = control.during(|| load_watched(path, &options, control));
        // Whatever became of it.
        control.check()?;
        let volume = volume?;
        Attempt { what: "open the volume", path }.refuse_unasked(&options.choice, &watch)?;
        let volume = volume.with_held(Held { portion, ..watch.held() });
        Ok::<_, LoadError>((watch.has_averaged() && volume.is_of_labels(), volume))
    };
    match read(false)? {
        // What its file does not call labels is known for labels when it has been read: then of each block one voxel.
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
    // Voxels that somebody describes may begin like that by chance.
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
