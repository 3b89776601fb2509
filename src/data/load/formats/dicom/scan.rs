//! Scan of many files for DICOM headers, on all cores; pixels are not read.

use std::collections::BTreeMap;
use std::io::Read as _;
use std::path::{Path, PathBuf};

use rayon::prelude::*;

use super::super::input::Input;
use super::super::{LoadControl, LoadError};
use super::header::{Header, is_dicom};
use crate::data::attempt::Attempt;

/// Maximum number of files in a folder that are examined for slices of the same series.
const MOST_BESIDE: usize = 1 << 16;

/// Number of bytes from a file's beginning that are examined for the magic bytes.
const START_BYTES: u64 = 1024;

/// Result of scanning files for DICOM headers.
#[derive(Debug, Default)]
pub(super) struct Scan {
    /// Headers of files with pixels, in the order of the files.
    pub(super) headers: Vec<Header>,
    /// Number of DICOM files without pixels, by kind of object.
    pub(super) without_pixels: BTreeMap<String, usize>,
    /// Number of DICOM files that cannot be read.
    pub(super) broken: usize,
    /// Error of the first file that cannot be read.
    pub(super) why: Option<LoadError>,
}

enum Seen {
    Header(Box<Header>),
    /// DICOM file without pixels, of this kind.
    WithoutPixels(String),
    Broken(LoadError),
    Other,
}

/// Reads the headers of all DICOM files among `files`.
///
/// # Errors
/// `Cancelled` alone: files that cannot be read are counted.
pub(super) fn scan(files: &[PathBuf], control: &LoadControl) -> Result<Scan, LoadError> {
    let lengths = files.iter().map(|path| path.metadata().map_or(0, |metadata| metadata.len()));
    control.start(lengths.sum());
    let seen: Result<Vec<Seen>, LoadError> = files.par_iter().map(|path| look(path, control)).collect();
    let mut scan = Scan::default();
    for seen in seen? {
        match seen {
            Seen::Header(header) => scan.headers.push(*header),
            Seen::WithoutPixels(kind) => *scan.without_pixels.entry(kind).or_default() += 1,
            Seen::Broken(why) => {
                scan.broken += 1;
                scan.why = scan.why.or(Some(why));
            }
            Seen::Other => {}
        }
    }
    Ok(scan)
}

fn look(path: &Path, control: &LoadControl) -> Result<Seen, LoadError> {
    control.check()?;
    let attempt = Attempt { what: super::WHAT, path };
    let Ok(mut input) = Input::open(attempt) else { return Ok(Seen::Other) };
    let length = input.len;
    // Not through the buffer, which is large: most files in the folder may be of another kind.
    let mut start = Vec::new();
    let looked = input.reader.get_ref().take(START_BYTES).read_to_end(&mut start);
    if looked.is_err() || input.seek(0).is_err() || !is_dicom(&start) {
        control.advance(length);
        return Ok(Seen::Other);
    }
    let seen = match Header::of(attempt, input, &start, control) {
        Ok((header, _)) if header.pixels.is_some() => Seen::Header(Box::new(header)),
        Ok((header, _)) => Seen::WithoutPixels(header.kind()),
        Err(LoadError::Cancelled) => return Err(LoadError::Cancelled),
        Err(error) => Seen::Broken(error),
    };
    control.advance(length);
    Ok(seen)
}

/// Returns the other files in the folder of a file; empty if the folder cannot be read or has too many.
pub(super) fn beside(path: &Path) -> Vec<PathBuf> {
    let parent = path.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let Ok(entries) = std::fs::read_dir(parent) else { return Vec::new() };
    let mut files = Vec::new();
    for entry in entries.flatten() {
        let is_hidden = entry.file_name().to_string_lossy().starts_with('.');
        if is_hidden || Some(entry.file_name().as_os_str()) == path.file_name() || !entry.path().is_file() {
            continue;
        }
        if files.len() == MOST_BESIDE {
            return Vec::new();
        }
        files.push(entry.path());
    }
    // Directory listings have no defined order.
    files.sort();
    files
}
