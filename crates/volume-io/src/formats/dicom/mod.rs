//! DICOM: images of medical devices, one per file or several frames in one.
//!
//! After PS3.3 (meaning of headers), PS3.5 (encoding of data sets) and PS3.10 (files) of the standard at
//! <https://www.dicomstandard.org/current>. A data set is parsed up to its pixels, and only pixels to be shown are
//! read. World space is left-posterior-superior millimetres in files, right-anterior-superior in volumes.

mod header;
mod header_scan;
mod hints;
mod image_groups;
mod layer_reader;
mod mosaic;
mod object_class;
mod pixels;
mod series;
mod series_selection;
mod slice_layer;
mod stack;
#[cfg(test)]
mod tests;
mod volume_reader;

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use super::input::InputFile;
use super::reader::{FileStart, FormatReader, VolumeSource};
use super::{LoadControl, LoadError, LoadOptions};
use chiaroscuro_files::natural_sort_key;
use chiaroscuro_volume::{LoadContext, Volume};
use header::{DicomHeader, is_dicom};
use header_scan::{HeaderScan, files_beside, scan_headers};
use image_groups::{group_images, omission_remark};
use object_class::ObjectClass;
use series_selection::SeriesSelection;

/// Action that error messages name for a single file.
const READ_FILE: &str = "read the DICOM file";

/// Action that error messages name for a folder.
const READ_SERIES: &str = "read the DICOM series";

pub(super) const READER: FormatReader = FormatReader {
    name: "DICOM",
    extensions: &[".dcm", ".dicom", ".ima"],
    recognises: |start| is_dicom(start.bytes()),
    load,
};

/// Returns the identifier of the series of which a file is a slice; `None` for other files, and for files that hold a
/// whole volume.
pub(crate) fn series_uid(path: &Path, control: &LoadControl) -> Option<String> {
    let context = LoadContext { operation: READ_FILE, path };
    let mut input = InputFile::open(context).ok()?;
    let start = FileStart::read(&mut input).ok()?;
    if !is_dicom(start.stored()) {
        return None;
    }
    let (header, _) = DicomHeader::parse(context, input, start.stored(), control).ok()?;
    let is_slice = header.pixels.is_some() && header.frame_count() == 1;
    Some(header.values.series_uid).filter(|series| is_slice && !series.is_empty())
}

/// Loads a DICOM file; if it is one slice of a series, the other slices in its folder as well.
fn load(source: VolumeSource<'_>) -> Result<Volume, LoadError> {
    let VolumeSource { path, input, start, options, control } = source;
    let context = LoadContext { operation: READ_FILE, path };
    if start.is_gzip() {
        return Err(context.bad_input_error(
            "file",
            "the file itself is compressed with gzip",
            "unpack it with gunzip",
        ));
    }
    let (header, _) = DicomHeader::parse(context, input, start.stored(), control)?;
    if header.pixels.is_none() {
        return Err(no_pixels_error(context, &header));
    }
    let is_slice = header.frame_count() == 1 && !header.values.series_uid.is_empty();
    if !is_slice {
        let headers = [header];
        let grouping = group_images(&headers);
        let open = SeriesSelection { context, path, headers: &headers, named_file: None, options, control };
        return open.load(grouping, Vec::new());
    }
    let HeaderScan { headers: others, unreadable_count, first_error, .. } =
        scan_headers(&files_beside(path), control)?;
    let found = &header.values;
    let is_another =
        |other: &DicomHeader| other.values.series_uid == found.series_uid && other.frame_count() == 1;
    let others: Vec<DicomHeader> = others.into_iter().filter(is_another).collect();
    let mut headers = vec![header];
    headers.extend(others);
    let mut remarks = drop_copies(&mut headers);
    // Without any other order, that of the file names counts.
    headers.sort_by_cached_key(|header| natural_sort_key(&file_name(&header.path)));
    let main = headers.iter().position(|header| header.path == path);
    remarks.extend(
        first_error
            .map(|why| omission_remark(unreadable_count, headers.len() + unreadable_count, "files", &why)),
    );
    let mut grouping = group_images(&headers);
    if let Some(wrong) = grouping.unreadable.iter().position(|unreadable| Some(unreadable.file) == main) {
        // Other files of the series may be readable, but the named one is not.
        return Err(grouping.unreadable.swap_remove(wrong).error);
    }
    SeriesSelection { context, path, headers: &headers, named_file: main, options, control }
        .load(grouping, remarks)
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
    let context = LoadContext { operation: READ_SERIES, path };
    let HeaderScan { mut headers, without_pixels, unreadable_count, first_error: why } =
        scan_headers(files, control)?;
    if headers.is_empty() {
        return match why {
            Some(why) => Err(why),
            None if !without_pixels.is_empty() => Err(no_pixels_in_folder_error(context, without_pixels)),
            None => Ok(None),
        };
    }
    options.choice.record_format(READER.name);
    remarks.extend(drop_copies(&mut headers));
    remarks.extend(
        why.map(|why| omission_remark(unreadable_count, headers.len() + unreadable_count, "files", &why)),
    );
    let grouping = group_images(&headers);
    let open = SeriesSelection { context, path, headers: &headers, named_file: None, options, control };
    open.load(grouping, remarks).map(Some)
}

/// Counts the DICOM files that have pixels.
pub(super) fn count_pictures(files: &[PathBuf], control: &LoadControl) -> Result<usize, LoadError> {
    scan_headers(files, control).map(|scan| scan.headers.len())
}

/// Returns the file name of a path, as text.
fn file_name(path: &Path) -> String {
    path.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

/// Makes the error for a file without pixels, which tells what the file is.
fn no_pixels_error(context: LoadContext<'_>, header: &DicomHeader) -> LoadError {
    let found = &header.values;
    if found.is_directory {
        return context.bad_input_error(
            "Directory Record Sequence",
            "it is a DICOMDIR: it lists the files of a disk, and has no images itself",
            "open the folder that contains it: subfolders are searched as well",
        );
    }
    match ObjectClass::from_uid(&found.sop_class) {
        Some(ObjectClass { name, advice: help }) => context.bad_input_error(
            "SOP Class UID",
            format!("it has no pixels: it is a DICOM object of another kind, {name}"),
            help,
        ),
        None => context.bad_input_error(
            "Pixel Data",
            format!("it has no pixels, as is usual for reports and plans: {}", header.object_kind()),
            "open a file with images; if this one should have some, copy it again",
        ),
    }
}

/// Makes the error for a folder whose DICOM files have no pixels, with a count of each kind of object.
fn no_pixels_in_folder_error(context: LoadContext<'_>, kinds: BTreeMap<String, usize>) -> LoadError {
    // As many kinds as fit on a line.
    const MAX_KINDS: usize = 6;
    let count: usize = kinds.values().sum();
    let listed = kinds.into_iter().take(MAX_KINDS).map(|(kind, count)| format!("{count} {kind}"));
    let kinds = listed.collect::<Vec<_>>().join(", ");
    context.bad_input_error(
        "files",
        format!("its {count} DICOM files have no pixels: {kinds}"),
        "open the folder that holds the images",
    )
}

/// Drops files that are copies of others, by their SOP instance identifiers; returns a remark.
fn drop_copies(headers: &mut Vec<DicomHeader>) -> Vec<String> {
    let mut seen = BTreeSet::new();
    let before = headers.len();
    headers.retain(|header| {
        let instance = &header.values.sop_instance;
        instance.is_empty() || seen.insert(instance.clone())
    });
    let copies = before - headers.len();
    let remark = (copies > 0).then(|| format!("{copies} files are copies of others: they are left out"));
    remark.into_iter().collect()
}
