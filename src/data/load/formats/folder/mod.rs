//! Folders that are opened as a whole: slices of one volume, one file each. DICOM slices may lie in nested folders,
//! as on media and in archive exports.

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

/// Extensions of pictures that are volumes of their own.
const PICTURES: [&str; 6] = ["png", "jpg", "jpeg", "bmp", "tif", "tiff"];

/// Loads the volume whose slices lie in a folder, restricted to [`LoadOptions::among`] where it is given.
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
    // Each reader selects its own files, the one with the most specific signature first.
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

/// Returns true if a folder mainly contains pictures, so that a few DICOM files in nested folders are ignored.
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
