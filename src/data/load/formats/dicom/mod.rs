//! DICOM: the pictures of medical devices, a file each or many in one.
//!
//! After PS3.3 (what headers mean), PS3.5 (how data sets are written) and PS3.10 (files) of the standard at
//! <https://www.dicomstandard.org/current>. A data set is read up to its pixels, of which only those that are shown are
//! read. World space is left-posterior-superior millimetres in files, right-anterior-superior here.

mod groups;
mod header;
mod hints;
mod pixels;
mod scan;
mod stack;
#[cfg(test)]
mod tests;
mod voxels;

use std::path::{Path, PathBuf};

use super::input::{Input, stem};
use super::reader::{Reader, Source, Start};
use super::{LoadControl, LoadError, LoadOptions};
use crate::data::attempt::{Attempt, Dimension, Offer, quoted};
use crate::data::{Volume, plain};
use groups::{Group, groups, left_out, shape_of};
use header::{Header, is_dicom};
use scan::{Scan, beside, scan};
use stack::Stack;

/// What is being done, for messages.
const WHAT: &str = "read the DICOM file";

/// As [`WHAT`], with a folder.
const WHAT_SERIES: &str = "read the DICOM series";

pub(super) const READER: Reader = Reader {
    name: "DICOM",
    endings: &[".dcm", ".dicom", ".ima"],
    recognises: |start| is_dicom(start.bytes()),
    load,
};

/// The series of which a file is a slice; none where it is something else, or holds all of it.
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

/// Loads a DICOM file, and where it is one slice of a series, those beside it.
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
    let (mut headers, mut unreadable) = (vec![header], None);
    if is_slice {
        let Scan { headers: others, broken, why, .. } = scan(&beside(path), control)?;
        unreadable = why.map(|why| left_out(broken, &why));
        let series = headers[0].found.series.clone();
        let is_another = |other: &Header| other.found.series == series && other.frame_count() == 1;
        headers.extend(others.into_iter().filter(is_another));
    }
    let mut remarks = drop_copies(&mut headers);
    remarks.extend(unreadable);
    let (mut found, wrong) = groups(&headers)?;
    let of_file = |group: &Group| group.slices.iter().any(|slice| slice.file == 0);
    if is_slice {
        // The file itself says what is meant.
        let all: usize = found.iter().map(|group| group.slices.len()).sum();
        found.retain(of_file);
        let count: usize = found.iter().map(|group| group.slices.len()).sum();
        if count > 1 {
            remarks.push(format!("the {count} slices of its series in the same folder are shown with it"));
        }
        if all > count {
            remarks.push(format!("{} pictures of the series have another size or direction", all - count));
        }
    }
    remarks.extend(wrong);
    if found.is_empty() {
        // Others of its series are well, it is not.
        return Err(shape_of(&headers[0]).err().unwrap_or_else(|| without_pixels(attempt, &headers[0])));
    }
    let chosen = if is_slice { 0 } else { choose(attempt, &found, &headers, options)? };
    let group = found.swap_remove(chosen);
    let name = if group.slices.len() > 1 { name(&headers, &group, path) } else { stem(path) };
    volume(attempt, name, &headers, group, remarks, options, control)
}

/// Loads the series in a folder's files; `None` where none is a DICOM file.
pub(super) fn load_folder(
    path: &Path,
    files: &[PathBuf],
    options: &LoadOptions,
    control: &LoadControl,
) -> Result<Option<Volume>, LoadError> {
    let attempt = Attempt { what: WHAT_SERIES, path };
    let Scan { mut headers, without_pixels, broken, why } = scan(files, control)?;
    if headers.is_empty() {
        return match why {
            Some(why) => Err(why),
            None if without_pixels > 0 => Err(attempt.bad_input(
                "files",
                format!("its {without_pixels} DICOM files have no pixels"),
                "name the folder that holds the pictures",
            )),
            None => Ok(None),
        };
    }
    let mut remarks = drop_copies(&mut headers);
    remarks.extend(why.map(|why| left_out(broken, &why)));
    let (mut found, wrong) = groups(&headers)?;
    remarks.extend(wrong);
    let chosen = choose(attempt, &found, &headers, options)?;
    let group = found.swap_remove(chosen);
    let name = name(&headers, &group, path);
    volume(attempt, name, &headers, group, remarks, options, control).map(Some)
}

/// Why there is nothing to see in a file without pixels.
fn without_pixels(attempt: Attempt<'_>, header: &Header) -> LoadError {
    let found = &header.found;
    if found.is_directory {
        return attempt.bad_input(
            "Directory Record Sequence",
            "it lists the files of a disk, and has no pictures itself",
            "open one of the files, or the folder that holds those of a series",
        );
    }
    let kind = match (found.modality.as_str(), found.sop_class.as_str()) {
        ("", "") => "it says nothing of what it is".to_owned(),
        ("", class) => format!("it is of class {}", quoted(class)),
        (modality, _) => format!("its modality is {}", quoted(modality)),
    };
    attempt.bad_input(
        "Pixel Data",
        format!("it has no pixels, as reports and plans have none: {kind}"),
        "open a file with pictures; if this one should have some, copy it again",
    )
}

/// Leaves out files that are copies of others.
fn drop_copies(headers: &mut Vec<Header>) -> Vec<String> {
    let mut seen = std::collections::BTreeSet::new();
    let before = headers.len();
    headers.retain(|header| {
        let instance = &header.found.sop_instance;
        instance.is_empty() || seen.insert(instance.clone())
    });
    let copies = before - headers.len();
    let remark = (copies > 0).then(|| format!("{copies} files are copies of others: they are left out"));
    remark.into_iter().collect()
}

/// Which group is meant.
fn choose(
    attempt: Attempt<'_>,
    found: &[Group],
    headers: &[Header],
    options: &LoadOptions,
) -> Result<usize, LoadError> {
    let offers = found.iter().enumerate().map(|(number, group)| group.offer(number, headers)).collect();
    attempt.chosen(&options.choice, Dimension::Series, offers)
}

/// What a series is called, or else what its file or folder is.
fn name(headers: &[Header], group: &Group, path: &Path) -> String {
    let first = group.slices.first().map(|slice| headers[slice.file].found.description());
    let said = first.filter(|description| !description.is_empty());
    said.map_or_else(|| stem(path), |description| plain(description, 120))
}

/// The volume of a group.
fn volume(
    attempt: Attempt<'_>,
    name: String,
    headers: &[Header],
    group: Group,
    remarks: Vec<String>,
    options: &LoadOptions,
    control: &LoadControl,
) -> Result<Volume, LoadError> {
    let Group { shape, slices } = group;
    let mut stack = Stack::of(slices);
    let dims = |count: usize| [shape.columns as u64, shape.rows as u64, count as u64];
    let steps = stack.steps.iter().enumerate();
    let offers =
        steps.map(|(step, (name, slices))| Offer::numbered(step, name, dims(slices.len()))).collect();
    let step = attempt.chosen(&options.choice, Dimension::Frame, offers)?;
    let (_, slices) = stack.steps.swap_remove(step);
    stack.placement.remarks.splice(0..0, remarks);
    voxels::load(attempt, name, headers, shape, &slices, stack.placement, options, control)
}
