//! DICOM: images of medical devices, one per file or several frames in one.
//!
//! After PS3.3 (meaning of headers), PS3.5 (encoding of data sets) and PS3.10 (files) of the standard at
//! <https://www.dicomstandard.org/current>. A data set is parsed up to its pixels, and only pixels to be shown are
//! read. World space is left-posterior-superior millimetres in files, right-anterior-superior in volumes.

mod groups;
mod header;
mod hints;
mod layer;
mod layers;
mod mosaic;
mod object_class;
mod open_series;
mod pixels;
mod scan;
mod series;
mod stack;
#[cfg(test)]
mod tests;
mod voxels;

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use super::input::Input;
use super::reader::{Reader, Source, Start};
use super::{LoadControl, LoadError, LoadOptions};
use crate::data::attempt::Attempt;
use crate::data::{Volume, natural};
use groups::{groups, left_out};
use header::{Header, is_dicom};
use object_class::ObjectClass;
use open_series::OpenSeries;
use scan::{Scan, beside, scan};

/// Action that error messages name for a single file.
const WHAT: &str = "read the DICOM file";

/// Action that error messages name for a folder.
const WHAT_SERIES: &str = "read the DICOM series";

pub(super) const READER: Reader = Reader {
    name: "DICOM",
    endings: &[".dcm", ".dicom", ".ima"],
    recognises: |start| is_dicom(start.bytes()),
    load,
};

/// Returns the identifier of the series of which a file is a slice; `None` for other files, and for files that hold a
/// whole volume.
pub(in crate::data::load) fn series_of(path: &Path, control: &LoadControl) -> Option<String> {
    let attempt = Attempt { what: WHAT, path };
    let mut input = Input::open(attempt).ok()?;
    let start = Start::of(&mut input).ok()?;
    if !is_dicom(start.stored()) {
        return None;
    }
    let (header, _) = Header::of(attempt, input, start.stored(), control).ok()?;
    let is_slice = header.pixels.is_some() && header.frame_count() == 1;
    Some(header.found.series).filter(|series| is_slice && !series.is_empty())
}

/// Loads a DICOM file; if it is one slice of a series, the other slices in its folder as well.
fn load(source: Source<'_>) -> Result<Volume, LoadError> {
    let Source { path, input, start, options, control } = source;
    let attempt = Attempt { what: WHAT, path };
    if start.is_gzip() {
        return Err(attempt.bad_input("file", "it is compressed as a whole", "unpack it with gunzip"));
    }
    let (header, _) = Header::of(attempt, input, start.stored(), control)?;
    if header.pixels.is_none() {
        return Err(without_pixels(attempt, &header));
    }
    let is_slice = header.frame_count() == 1 && !header.found.series.is_empty();
    if !is_slice {
        let headers = [header];
        let grouping = groups(&headers);
        let open = OpenSeries { attempt, path, headers: &headers, main: None, options, control };
        return open.load(grouping, Vec::new());
    }
    let Scan { headers: others, broken, why, .. } = scan(&beside(path), control)?;
    let found = &header.found;
    let is_another = |other: &Header| other.found.series == found.series && other.frame_count() == 1;
    let others: Vec<Header> = others.into_iter().filter(is_another).collect();
    let mut headers = vec![header];
    headers.extend(others);
    let mut remarks = drop_copies(&mut headers);
    // Without any other order, that of the file names counts.
    headers.sort_by_cached_key(|header| natural(&name_of(&header.path)));
    let main = headers.iter().position(|header| header.path == path);
    remarks.extend(why.map(|why| left_out(broken, headers.len() + broken, "files", &why)));
    let mut grouping = groups(&headers);
    if let Some(wrong) = grouping.unreadable.iter().position(|unreadable| Some(unreadable.file) == main) {
        // Other files of the series may be readable, but the named one is not.
        return Err(grouping.unreadable.swap_remove(wrong).why);
    }
    OpenSeries { attempt, path, headers: &headers, main, options, control }.load(grouping, remarks)
}

/// Loads a series from a folder's files; `None` if none is a DICOM file. `remarks` holds earlier remarks on the
/// files.
pub(super) fn load_folder(
    path: &Path,
    files: &[PathBuf],
    mut remarks: Vec<String>,
    options: &LoadOptions,
    control: &LoadControl,
) -> Result<Option<Volume>, LoadError> {
    let attempt = Attempt { what: WHAT_SERIES, path };
    let Scan { mut headers, without_pixels, broken, why } = scan(files, control)?;
    if headers.is_empty() {
        return match why {
            Some(why) => Err(why),
            None if !without_pixels.is_empty() => Err(no_pixels_in_folder(attempt, without_pixels)),
            None => Ok(None),
        };
    }
    remarks.extend(drop_copies(&mut headers));
    remarks.extend(why.map(|why| left_out(broken, headers.len() + broken, "files", &why)));
    let grouping = groups(&headers);
    let open = OpenSeries { attempt, path, headers: &headers, main: None, options, control };
    open.load(grouping, remarks).map(Some)
}

/// Counts the DICOM files that have pixels.
pub(super) fn count_pictures(files: &[PathBuf], control: &LoadControl) -> Result<usize, LoadError> {
    scan(files, control).map(|scan| scan.headers.len())
}

/// Returns the file name of a path, as text.
fn name_of(path: &Path) -> String {
    path.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

/// Makes the error for a file without pixels, which tells what the file is.
fn without_pixels(attempt: Attempt<'_>, header: &Header) -> LoadError {
    let found = &header.found;
    if found.is_directory {
        return attempt.bad_input(
            "Directory Record Sequence",
            "it lists the files of a disk, and has no pictures itself",
            "open the folder that it lies in: folders within are looked through",
        );
    }
    match ObjectClass::from_uid(&found.sop_class) {
        Some(ObjectClass { name, help }) => attempt.bad_input(
            "SOP Class UID",
            format!("it has no pixels: it is a DICOM object of its own, {name}"),
            help,
        ),
        None => attempt.bad_input(
            "Pixel Data",
            format!("it has no pixels, as reports and plans have none: {}", header.kind()),
            "open a file with pictures; if this one should have some, copy it again",
        ),
    }
}

/// Makes the error for a folder whose DICOM files have no pixels, with a count of each kind of object.
fn no_pixels_in_folder(attempt: Attempt<'_>, kinds: BTreeMap<String, usize>) -> LoadError {
    // As many kinds as fit on a line.
    const MOST_KINDS: usize = 6;
    let count: usize = kinds.values().sum();
    let listed = kinds.into_iter().take(MOST_KINDS).map(|(kind, count)| format!("{count} {kind}"));
    let kinds = listed.collect::<Vec<_>>().join(", ");
    attempt.bad_input(
        "files",
        format!("its {count} DICOM files have no pixels: {kinds}"),
        "name the folder that holds the pictures",
    )
}

/// Drops files that are copies of others, by their SOP instance identifiers; returns a remark.
fn drop_copies(headers: &mut Vec<Header>) -> Vec<String> {
    let mut seen = BTreeSet::new();
    let before = headers.len();
    headers.retain(|header| {
        let instance = &header.found.sop_instance;
        instance.is_empty() || seen.insert(instance.clone())
    });
    let copies = before - headers.len();
    let remark = (copies > 0).then(|| format!("{copies} files are copies of others: they are left out"));
    remark.into_iter().collect()
}
