//! A folder that is opened as a whole: the slices of one volume, a file each. Those of DICOM may lie in folders within
//! it, as disks and exports of archives have them.

mod files;

use std::collections::HashSet;
use std::ffi::OsStr;
use std::path::{Path, PathBuf};

use super::pictures::slices;
use super::unsupported::of_folder;
use super::{LoadControl, LoadError, LoadOptions, dicom};
use crate::data::Volume;
use crate::data::attempt::Attempt;
use files::{Nested, files_in, files_within};

/// Endings of files that are pictures for themselves.
const PICTURES: [&str; 6] = ["png", "jpg", "jpeg", "bmp", "tif", "tiff"];

/// Loads the volume whose slices lie in a folder; of the files in it only those that are meant, where that is said.
pub(in crate::data::load) fn load(
    path: &Path,
    options: &LoadOptions,
    control: &LoadControl,
) -> Result<Volume, LoadError> {
    let attempt = Attempt { what: "open the folder", path };
    if let Some(format) = of_folder(path) {
        return Err(format.refusal(attempt));
    }
    let mut files = files_in(attempt, control)?;
    let mut nested = Nested::default();
    if let Some(among) = &options.among {
        let meant: HashSet<&OsStr> = among.iter().filter_map(|path| path.file_name()).collect();
        files.retain(|path| path.file_name().is_some_and(|name| meant.contains(name)));
    } else {
        nested = files_within(path, control)?;
    }
    let count = nested.files.len();
    if is_about_pictures(&files, &nested, control)? {
        nested = Nested::default();
    }
    // Each kind of slices looks for its own, the surest marks first.
    let all = [files.as_slice(), nested.files.as_slice()].concat();
    if let Some(volume) = dicom::load_folder(path, &all, nested.remarks(), options, control)? {
        return Ok(volume);
    }
    if let Some(volume) = slices::load(attempt, &files, options, control)? {
        return Ok(volume);
    }
    let within = if count > 0 { format!(", nor of the {count} in folders within,") } else { String::new() };
    Err(attempt.bad_input(
        "files",
        format!("none of its {} files{within} is a slice that is read", files.len()),
        "name one file",
    ))
}

/// Whether a folder is one of pictures, beside which a few DICOM files in folders within do not count.
fn is_about_pictures(files: &[PathBuf], nested: &Nested, control: &LoadControl) -> Result<bool, LoadError> {
    let is_picture = |path: &&PathBuf| {
        let ending = path.extension().map(|ending| ending.to_string_lossy().to_lowercase());
        ending.is_some_and(|ending| PICTURES.contains(&ending.as_str()))
    };
    let pictures = files.iter().filter(is_picture).count();
    Ok(pictures > 0 && !nested.files.is_empty() && dicom::count_pictures(&nested.files, control)? <= pictures)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_folder_without_slices_is_no_volume() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("notes.txt"), "x").unwrap();
        std::fs::write(folder.path().join(".hidden"), "x").unwrap();
        let load = || crate::data::load::load(folder.path(), &LoadOptions::default(), &LoadControl::new());
        assert!(load().unwrap_err().to_string().contains("none of its 1 files is"));
        std::fs::create_dir(folder.path().join("within")).unwrap();
        std::fs::write(folder.path().join("within/notes.txt"), "x").unwrap();
        assert!(
            load()
                .unwrap_err()
                .to_string()
                .contains("none of its 1 files, nor of the 1 in folders within, is")
        );
    }
}
