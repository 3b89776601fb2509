//! A folder that is opened as a whole: the slices of one volume, a file each.

use std::collections::HashSet;
use std::ffi::OsStr;
use std::path::{Path, PathBuf};

use super::pictures::slices;
use super::unsupported::of_folder;
use super::{LoadControl, LoadError, LoadOptions, dicom};
use crate::data::Volume;
use crate::data::attempt::Attempt;

/// Most files of a folder that are looked at: eight times the slices of the longest scans.
const MOST_FILES: usize = 1 << 16;

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
    let mut files = files(attempt, control)?;
    if let Some(among) = &options.among {
        let meant: HashSet<&OsStr> = among.iter().filter_map(|path| path.file_name()).collect();
        files.retain(|path| path.file_name().is_some_and(|name| meant.contains(name)));
    }
    // Each kind of slices looks for its own, the surest marks first.
    if let Some(volume) = dicom::load_folder(path, &files, options, control)? {
        return Ok(volume);
    }
    if let Some(volume) = slices::load(attempt, &files, options, control)? {
        return Ok(volume);
    }
    Err(attempt.bad_input(
        "files",
        format!("none of its {} files is a slice that is read", files.len()),
        "name one file",
    ))
}

/// The regular files of a folder, also behind links, in natural order: `slice 9` before `slice 10`. Hidden ones are not
/// meant.
///
/// # Errors
/// `Io` where the folder cannot be read, `Limit` where it has more files than any volume has slices.
fn files(attempt: Attempt<'_>, control: &LoadControl) -> Result<Vec<PathBuf>, LoadError> {
    let mut files = Vec::new();
    for entry in std::fs::read_dir(attempt.path).map_err(|error| attempt.io(error))? {
        control.check()?;
        let entry = entry.map_err(|error| attempt.io(error))?;
        let is_hidden = entry.file_name().to_string_lossy().starts_with('.');
        if is_hidden || !entry.path().is_file() {
            continue;
        }
        if files.len() == MOST_FILES {
            return Err(attempt.limit(
                "files",
                format!("there are more than {MOST_FILES} files in it"),
                "put the slices of one volume into a folder of their own",
            ));
        }
        files.push(entry.path());
    }
    files.sort_by_cached_key(|path| natural(&path.file_name().unwrap_or_default().to_string_lossy()));
    Ok(files)
}

/// A piece of a name, so that numbers come in the order of their values.
#[derive(PartialEq, Eq, PartialOrd, Ord)]
pub(in crate::data::load) enum Piece {
    /// Digits without leading zeros, shorter ones first; then how many there were.
    Number(usize, String, usize),
    Text(String),
}

/// By what names are put in natural order.
pub(in crate::data::load) fn natural(name: &str) -> Vec<Piece> {
    let mut pieces = Vec::new();
    let mut rest = name;
    while let Some(first) = rest.chars().next() {
        let is_number = first.is_ascii_digit();
        let end = rest.find(|c: char| c.is_ascii_digit() != is_number).unwrap_or(rest.len());
        let (piece, after) = rest.split_at(end);
        pieces.push(if is_number {
            let digits = piece.trim_start_matches('0');
            Piece::Number(digits.len(), digits.to_owned(), piece.len())
        } else {
            Piece::Text(piece.to_lowercase())
        });
        rest = after;
    }
    pieces
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_in_the_order_of_their_values() {
        let mut names = [
            "b1",
            "a10",
            "a9",
            "A2.tif",
            "a010",
            "a",
            "2",
            "10",
            "x99999999999999999999",
            "x100000000000000000000",
        ];
        names.sort_by_cached_key(|name| natural(name));
        let expected = [
            "2",
            "10",
            "a",
            "A2.tif",
            "a9",
            "a10",
            "a010",
            "b1",
            "x99999999999999999999",
            "x100000000000000000000",
        ];
        assert_eq!(names, expected);
    }

    #[test]
    fn a_folder_without_slices_is_no_volume() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("notes.txt"), "x").unwrap();
        std::fs::write(folder.path().join(".hidden"), "x").unwrap();
        let error = crate::data::load::load(folder.path(), &LoadOptions::default(), &LoadControl::new());
        assert!(error.unwrap_err().to_string().contains("none of its 1 files"));
    }
}
