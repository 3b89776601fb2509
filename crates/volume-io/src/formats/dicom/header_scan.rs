//! Scan of many files for DICOM headers, on all cores; pixels are not read.

use std::collections::BTreeMap;
use std::io::Read as _;
use std::path::{Path, PathBuf};

use rayon::prelude::*;

use super::super::input::InputFile;
use super::super::{LoadControl, LoadError};
use super::header::{DicomHeader, is_dicom};
use chiaroscuro_volume::LoadContext;

/// Maximum number of files in a folder that are examined for slices of the same series.
const MAX_FILES_BESIDE: usize = 1 << 16;

/// Number of bytes from a file's beginning that are examined for the magic bytes.
const START_BYTES: u64 = 1024;

/// Result of scanning files for DICOM headers.
#[derive(Debug, Default)]
pub(super) struct HeaderScan {
    /// Headers of files with pixels, in the order of the files.
    pub(super) headers: Vec<DicomHeader>,
    /// Number of DICOM files without pixels, by kind of object.
    pub(super) without_pixels: BTreeMap<String, usize>,
    /// Number of DICOM files that cannot be read.
    pub(super) unreadable_count: usize,
    /// Error of the first file that cannot be read.
    pub(super) first_error: Option<LoadError>,
}

enum ScannedFile {
    Header(Box<DicomHeader>),
    /// DICOM file without pixels, of this kind.
    WithoutPixels(String),
    Broken(LoadError),
    Other,
}

/// Reads the headers of all DICOM files among `files`.
///
/// # Errors
/// `Cancelled` alone: files that cannot be read are counted.
pub(super) fn scan_headers(files: &[PathBuf], control: &LoadControl) -> Result<HeaderScan, LoadError> {
    let lengths = files.iter().map(|path| path.metadata().map_or(0, |metadata| metadata.len()));
    control.start(lengths.sum());
    let seen: Result<Vec<ScannedFile>, LoadError> =
        files.par_iter().map(|path| scan_file(path, control)).collect();
    let mut scan = HeaderScan::default();
    for seen in seen? {
        match seen {
            ScannedFile::Header(header) => scan.headers.push(*header),
            ScannedFile::WithoutPixels(kind) => *scan.without_pixels.entry(kind).or_default() += 1,
            ScannedFile::Broken(why) => {
                scan.unreadable_count += 1;
                scan.first_error = scan.first_error.or(Some(why));
            }
            ScannedFile::Other => {}
        }
    }
    Ok(scan)
}

fn scan_file(path: &Path, control: &LoadControl) -> Result<ScannedFile, LoadError> {
    control.check()?;
    let context = LoadContext { operation: super::READ_FILE, path };
    let Ok(mut input) = InputFile::open(context) else { return Ok(ScannedFile::Other) };
    let length = input.len;
    // Not through the buffer, which is large: most files in the folder may be of another kind.
    let mut start = Vec::new();
    let looked = input.reader.get_ref().take(START_BYTES).read_to_end(&mut start);
    if looked.is_err() || input.seek(0).is_err() || !is_dicom(&start) {
        control.advance(length);
        return Ok(ScannedFile::Other);
    }
    let seen = match DicomHeader::parse(context, input, &start, control) {
        Ok((header, _)) if header.pixels.is_some() => ScannedFile::Header(Box::new(header)),
        Ok((header, _)) => ScannedFile::WithoutPixels(header.object_kind()),
        Err(LoadError::Cancelled) => return Err(LoadError::Cancelled),
        Err(error) => ScannedFile::Broken(error),
    };
    control.advance(length);
    Ok(seen)
}

/// Returns the other files in the folder of a file; empty if the folder cannot be read or has too many.
pub(super) fn files_beside(path: &Path) -> Vec<PathBuf> {
    let parent = path.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let Ok(entries) = std::fs::read_dir(parent) else { return Vec::new() };
    let mut files = Vec::new();
    for entry in entries.flatten() {
        let is_hidden = entry.file_name().to_string_lossy().starts_with('.');
        if is_hidden || Some(entry.file_name().as_os_str()) == path.file_name() || !entry.path().is_file() {
            continue;
        }
        if files.len() == MAX_FILES_BESIDE {
            return Vec::new();
        }
        files.push(entry.path());
    }
    // Directory listings have no defined order.
    files.sort();
    files
}
