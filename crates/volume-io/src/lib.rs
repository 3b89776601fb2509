//! Readers and writers of volume files, and of folders of slices; `formats` has the readers, `write` the writers,
//! docs/FORMATS.md the supported variants.
//!
//! Files are not trusted. Every size is checked against the file's length and the memory budget before anything is
//! allocated; only regular files are opened; a header can name no file outside its own folder. Files are read in
//! blocks into typed voxels, never memory-mapped: the peak is the volume itself and one block, or a few decoded
//! slices.
//!
//! Begin with [`load`], which detects the format by the table of readers in `formats/mod.rs`, and then with one
//! reader: `formats/mrc/mod.rs` is short. Bytes become voxels in `reading/samples.rs`; `reading/reader.rs` is the
//! interface of the readers. `unsupported/` has the formats that are recognised only to advise how to convert
//! them.

mod file_pages;
mod formats;
mod huge_pages;
mod length_unit;
mod neighbour;
mod open;
mod reading;
#[cfg(test)]
mod tests;
mod time_steps;
mod unsupported;
pub mod write;

use std::path::{Path, PathBuf};
use std::sync::Arc;

pub use file_pages::{FilePages, NoPages};
pub use formats::{RawFormat, RawGuess, RawLayout, raw, supported_extensions};
pub use neighbour::neighbour_volume;
pub use open::open;
pub use time_steps::{StepReadError, StepReadOptions, TimeSteps, is_same_file};

use chiaroscuro_volume::{
    ContentsRecorder, FileContents, FileDimension, LevelRule, LoadContext, LoadControl, LoadError,
    ReadContext, Volume, VolumeChoice, memory_budget_bytes,
};
use formats::{FileFormat, READERS, detect_format, folder};
use reading::input::{FileChangeGuard, InputFile};
use reading::reader::{FileStart, VolumeSource};

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
    pub choice: VolumeChoice,
    /// Files of a folder to consider; all of them if `None`.
    pub only_files: Option<Arc<[PathBuf]>>,
    /// Maximum size of a volume, in bytes of its voxels.
    pub memory_budget_bytes: u64,
    /// Rule for the resolution level that is read where the choice names none.
    pub level: LevelRule,
}

impl Default for LoadOptions {
    /// No layout for RAW files, all voxels; a budget of three quarters of the memory that is free now (within the
    /// limits of the machine, its container and the user), or 4 GiB where that is unknown.
    fn default() -> Self {
        let (raw, choice) = (RawFormat::default(), VolumeChoice::default());
        let (memory_budget_bytes, level) = (memory_budget_bytes(), LevelRule::default());
        Self { raw, choice, only_files: None, memory_budget_bytes, level }
    }
}

impl LoadOptions {
    /// Limits and choices for a volume, to be checked before allocation.
    fn limits<'a>(&'a self, control: &'a LoadControl) -> ReadContext<'a> {
        ReadContext {
            budget_bytes: self.memory_budget_bytes,
            choice: &self.choice,
            control,
            level: self.level,
        }
    }
}

/// Loads a volume from a file, or from a folder of slices: all of it, or the portion that `options` select.
///
/// A format is recognised by a file's first bytes, or else by its extension; when `options` give dimensions, a file
/// that is not recognised is read as RAW.
///
/// # Errors
/// [`BadInput`](LoadError::BadInput) for a file or options that make no volume, or several ([`LoadError::Several`]),
/// `Limit` for a volume over the budget, `Io` for an unreadable path, or one that is neither a file nor a folder,
/// `Cancelled` on cancellation.
pub fn load(path: &Path, options: &LoadOptions, control: &LoadControl) -> Result<Volume, LoadError> {
    let portion = options.choice.portion.unwrap_or_default();
    let read = |are_labels: bool| {
        let watch = ContentsRecorder::default();
        let choice = VolumeChoice { are_labels, ..options.choice.clone() }.with_recorder(&watch);
        let options = LoadOptions { choice, ..options.clone() };
        let volume = control.run(|| load_watched(path, &options, control));
        // Cancellation takes precedence over the result.
        control.check()?;
        let volume = volume?;
        let context = LoadContext { operation: "open the volume", path };
        context.reject_unsupported_choice(&options.choice, &watch)?;
        let volume = volume.with_contents(FileContents { portion, ..watch.contents() });
        let volume = with_level_remark(context, volume, &options);
        Ok::<_, LoadError>((watch.was_averaged_while_reading() && volume.is_label_map(), volume))
    };
    match read(false)? {
        // Voxels may prove to be labels only after reading: then the file is read again, with the most frequent label
        // of each block.
        (true, _) => read(true).map(|(_, volume)| volume),
        (false, volume) if options.level != LevelRule::Finest => {
            file_pages::beside_pages(path, options, control, volume)
        }
        (false, volume) => Ok(volume),
    }
}

/// Adds a remark to a volume if it is not the finest level of its image, and the user has chosen none.
fn with_level_remark(context: LoadContext<'_>, volume: Volume, options: &LoadOptions) -> Volume {
    let levels = volume.contents().alternatives_in(FileDimension::Level);
    let is_automatic = options.choice.level.is_none() && options.level == LevelRule::Finest;
    let coarse = levels.filter(|levels| levels.selected > 0 && is_automatic);
    let Some([x, y, z]) = coarse.and_then(|levels| levels.offers[0].dims) else { return volume };
    let remark = format!(
        "it is shown coarsely: its finest level, of {x} x {y} x {z} voxels, does not fit into memory and on the graphics \
         adapter; a region of it does (--level 0 --region)"
    );
    context.warn(&remark);
    let remarks = [volume.remarks(), &[remark]].concat();
    volume.with_remarks(remarks)
}

fn load_watched(path: &Path, options: &LoadOptions, control: &LoadControl) -> Result<Volume, LoadError> {
    control.check()?;
    let context = LoadContext { operation: "open the volume", path };
    if path.is_dir() {
        return folder::load(path, options, control);
    }
    let mut input = InputFile::open(context)?;
    let guard = FileChangeGuard::new(context, &input, control)?;
    let start = FileStart::read(&mut input).map_err(|error| context.io_error(error))?;
    // Voxels of a described raw file may begin like this by chance.
    if start.is_packed_twice() && options.raw.dims.is_none() {
        return Err(context.bad_input_error(
            "format",
            "it is compressed twice: the gzip file contains another gzip file",
            "unpack it once, with gunzip for example, and open the result",
        ));
    }
    let reader = match detect_format(path, &start, &mut input, options) {
        FileFormat::Reader(reader) => reader,
        FileFormat::Unsupported(format) => return Err(format.refusal(context)),
        FileFormat::Unknown => {
            let names: Vec<&str> = READERS.iter().map(|reader| reader.name).collect();
            return Err(context.bad_input_error(
                "format",
                format!("its format is not supported; supported formats: {}", names.join(", ")),
                "convert it to NRRD, or describe its voxels with --dims and --type",
            ));
        }
    };
    options.choice.record_format(reader.name);
    let loaded = (reader.load)(VolumeSource { path, input, start, options, control });
    guard.check_unchanged(context, loaded)
}
