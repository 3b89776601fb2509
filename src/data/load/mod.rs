//! Volumes from files: RAW (with its size in the name or in options) and NRRD, both also gzipped.
//!
//! Files are not trusted. Every size is checked against the file's length and the memory budget
//! before anything is allocated; only regular files are opened; a header can name no file outside
//! its own folder. Files are read in blocks into typed voxels, never mapped: the peak is the volume
//! itself and one block.

mod control;
mod error;
mod input;
mod limits;
mod nrrd;
mod raw;
mod raw_layout;
mod samples;
#[cfg(test)]
mod tests;

use std::path::Path;

pub use control::LoadControl;
pub(crate) use error::Attempt;
pub use error::{Explanation, LoadError, LoadErrorKind};
pub(crate) use limits::Extent;
pub(crate) use limits::default_budget_bytes as memory_budget_bytes;
pub use raw::RawFormat;
pub use raw_layout::{RawGuess, RawLayout};

use super::{Volume, synthetic};
use error::quoted;
use input::Input;

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
    /// (`MemAvailable` in `/proc/meminfo`), or 4 GiB where that is not known.
    fn default() -> Self {
        Self { raw: RawFormat::default(), reduce: 1, memory_budget_bytes: limits::default_budget_bytes() }
    }
}

/// Prefix of the names of built-in volumes where a file is expected.
const BUILTIN: &str = "builtin:";

/// Loads what a FILE argument names: a path, or `builtin:NAME` or `builtin:NAME:N` for a built-in
/// volume of N³ voxels. A file whose name begins like that is reached as `./builtin:…`.
///
/// # Errors
/// As [`load`] and [`synthetic::builtin`].
pub fn open(source: &str, options: &LoadOptions, control: &LoadControl) -> Result<Volume, LoadError> {
    let volume = open_whole(source, options, control)?;
    let attempt = Attempt { what: "average the voxels", path: Path::new(source) };
    // What was a volume stays one: nothing else can go wrong.
    volume
        .reduced([options.reduce; 3])
        .map_err(|err| attempt.bad_input("voxels", err.to_string(), "load them all"))
}

fn open_whole(source: &str, options: &LoadOptions, control: &LoadControl) -> Result<Volume, LoadError> {
    let Some(builtin) = source.strip_prefix(BUILTIN) else {
        return load(Path::new(source), options, control);
    };
    let (name, n) = match builtin.split_once(':') {
        None => (builtin, None),
        Some((name, digits)) => match digits.parse() {
            Ok(n) => (name, Some(n)),
            Err(_) => {
                return Err(Attempt { what: "make the built-in volume", path: Path::new(source) }.bad_input(
                    "N",
                    format!("a number of voxels was expected after {name}:, {} was found", quoted(digits)),
                    "write it like builtin:chair:128",
                ));
            }
        },
    };
    synthetic::builtin_within(name, n, options.memory_budget_bytes, control)
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
    let magic: [u8; 8] = input.magic().map_err(|error| attempt.io(error))?;
    if nrrd::is_nrrd(&magic) || has_ending(path, ".nrrd") || has_ending(path, ".nhdr") {
        nrrd::load(path, input, options, control)
    } else if has_ending(path, ".raw") || has_ending(path, ".raw.gz") || options.raw.dims.is_some() {
        raw::load(path, input, &magic, options, control)
    } else {
        Err(attempt.bad_input(
            "format",
            "its format is not one that is read: .nrrd, .nhdr, .raw or .raw.gz",
            "convert it to NRRD, or describe its voxels with --dims and --type",
        ))
    }
}

/// Whether the file name ends in `ending` (lower case), in any case.
fn has_ending(path: &Path, ending: &str) -> bool {
    let name = path.file_name().unwrap_or_default().to_string_lossy().to_lowercase();
    name.ends_with(ending)
}
