//! Folders that are opened as a whole: slices of one volume, one file each, or masks of one segmentation. DICOM
//! slices may lie in nested folders, as on media and in archive exports.

mod files;

use std::collections::HashSet;
use std::ffi::OsStr;
use std::path::{Path, PathBuf};

use super::arrays::zarr;
use super::pictures::slices;
use super::unsupported::unsupported_folder;
use super::{LoadControl, LoadError, LoadOptions, dicom, nifti};
use chiaroscuro_volume::{LoadContext, LoadErrorKind, Volume};
use files::{NestedFiles, list_files, list_nested_files};

/// Extensions of pictures that are volumes of their own.
const PICTURES: [&str; 6] = ["png", "jpg", "jpeg", "bmp", "tif", "tiff"];

/// Loads the volume whose slices or masks lie in a folder, restricted to [`LoadOptions::only_files`] where it is
/// given.
pub(crate) fn load(path: &Path, options: &LoadOptions, control: &LoadControl) -> Result<Volume, LoadError> {
    let context = LoadContext { operation: "open the folder", path };
    if zarr::is_zarr_folder(path) {
        return zarr::load_folder(path, options, control);
    }
    if let Some(format) = unsupported_folder(path) {
        return Err(format.refusal(context));
    }
    let mut files = list_files(context, control)?;
    let mut nested = NestedFiles::default();
    if let Some(among) = &options.only_files {
        let selected: HashSet<&OsStr> = among.iter().filter_map(|path| path.file_name()).collect();
        files.retain(|path| path.file_name().is_some_and(|name| selected.contains(name)));
    } else {
        nested = list_nested_files(path, control)?;
    }
    let count = nested.files.len();
    if is_picture_folder(&files, &nested, control)? {
        nested = NestedFiles::default();
    }
    // Each reader selects its own files, the one with the most specific signature first.
    let all = [files.as_slice(), nested.files.as_slice()].concat();
    if let Some(volume) = dicom::load_folder(path, &all, nested.remarks(), options, control)? {
        return Ok(volume);
    }
    let masks = nifti::mask_files(&files);
    let mut mask_error = None;
    // Pictures may be previews of the masks, but not more of them than masks.
    if masks.len() > 1 && masks.len() > files.iter().filter(|path| is_picture(path)).count() {
        match nifti::load_masks(context, &masks, options, control) {
            Err(error) if matches!(error.kind(), LoadErrorKind::BadInput | LoadErrorKind::Io) => {
                mask_error = Some(error);
            }
            loaded => return loaded,
        }
    }
    if let Some(volume) = slices::load(context, &files, options, control)? {
        return Ok(volume);
    }
    if let Some(error) = mask_error {
        return Err(error);
    }
    let within =
        if count > 0 { format!(" or of the {count} files in its subfolders") } else { String::new() };
    Err(context.bad_input_error(
        "files",
        format!("none of its {} files{within} is a slice in a supported format", files.len()),
        if nifti::mask_files(&all).len() > 1 {
            "open a single file, or the subfolder that holds the masks of one segmentation"
        } else {
            "open a single file"
        },
    ))
}

/// Returns true if a file has the extension of a picture.
fn is_picture(path: &Path) -> bool {
    let ending = path.extension().map(|ending| ending.to_string_lossy().to_lowercase());
    ending.is_some_and(|ending| PICTURES.contains(&ending.as_str()))
}

/// Returns true if a folder mainly contains pictures, so that a few DICOM files in nested folders are ignored.
fn is_picture_folder(
    files: &[PathBuf],
    nested: &NestedFiles,
    control: &LoadControl,
) -> Result<bool, LoadError> {
    let pictures = files.iter().filter(|path| is_picture(path)).count();
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
        let load = || crate::load(folder.path(), &LoadOptions::default(), &LoadControl::new());
        assert!(load().unwrap_err().to_string().contains("none of its 1 files is"));
        std::fs::create_dir(folder.path().join("within")).unwrap();
        std::fs::write(folder.path().join("within/notes.txt"), "x").unwrap();
        assert!(
            load()
                .unwrap_err()
                .to_string()
                .contains("none of its 1 files or of the 1 files in its subfolders is")
        );
    }
}
