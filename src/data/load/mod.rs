//! Volumes from files: RAW (with its size in the name or in options) and NRRD, both also gzipped.
//!
//! Files are not trusted. Every size is checked against the file's length and the memory budget
//! before anything is allocated; only regular files are opened; a header can name no file outside
//! its own folder. Files are read in blocks into typed voxels, never mapped: the peak is the volume
//! itself and one block.

mod input;
mod nrrd;
mod raw;
mod raw_layout;
mod samples;
#[cfg(test)]
mod tests;

use std::path::Path;

pub use raw::RawFormat;
pub use raw_layout::{RawGuess, RawLayout};

use super::Volume;
use super::attempt::Attempt;
pub(crate) use super::attempt::memory_budget_bytes;
pub use super::attempt::{Explanation, LoadControl, LoadError, LoadErrorKind};
use input::{Input, Witness};

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
    /// Blocks of so many voxels along each axis are averaged into one.
    pub reduce: usize,
    /// The largest volume that is loaded, in bytes of its voxels.
    pub memory_budget_bytes: u64,
}

impl Default for LoadOptions {
    /// Nothing said about RAW files, every voxel kept; a budget of three quarters of the memory that is free now
    /// (what the machine, its container and the user's limits leave), or 4 GiB where that is not known.
    fn default() -> Self {
        Self { raw: RawFormat::default(), reduce: 1, memory_budget_bytes: memory_budget_bytes() }
    }
}

/// Loads a volume from a file.
///
/// NRRD is recognised by its first bytes or by `.nrrd` and `.nhdr`. `.raw`, `.raw.gz` and, when
/// `options` give dimensions, any other file are read as RAW.
///
/// # Errors
/// [`LoadErrorKind::BadInput`] for a file or options that make no volume, `Limit` for a volume
/// over the budget, `Io` for what is not a readable regular file, `Cancelled` when asked to stop.
pub fn load(path: &Path, options: &LoadOptions, control: &LoadControl) -> Result<Volume, LoadError> {
    control.check()?;
    let attempt = Attempt { what: "open the volume", path };
    let mut input = Input::open(attempt)?;
    let witness = Witness::of(attempt, &input)?;
    let magic: [u8; 8] = input.magic().map_err(|error| attempt.io(error))?;
    let loaded = if nrrd::is_nrrd(&magic) || has_ending(path, ".nrrd") || has_ending(path, ".nhdr") {
        nrrd::load(path, input, options, control)
    } else if has_ending(path, ".raw") || has_ending(path, ".raw.gz") || options.raw.dims.is_some() {
        raw::load(path, input, &magic, options, control)
    } else {
        Err(attempt.bad_input(
            "format",
            "its format is not one that is read: .nrrd, .nhdr, .raw or .raw.gz",
            "convert it to NRRD, or describe its voxels with --dims and --type",
        ))
    };
    witness.vouch(attempt, loaded)
}

/// Whether the file name ends in `ending` (lower case), in any case.
fn has_ending(path: &Path, ending: &str) -> bool {
    let name = path.file_name().unwrap_or_default().to_string_lossy().to_lowercase();
    name.ends_with(ending)
}
