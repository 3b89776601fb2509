//! Pairs of header and data files (`.hdr`, `.img`): finds the second file of a pair.

use std::io::{Read as _, Seek as _};
use std::path::{Path, PathBuf};

use super::super::input::{Input, bare_name, is_gzip};
use super::super::read_files::note;
use super::super::reader::Start;
use super::super::{LoadError, beside};
use super::ENDINGS;
use super::header::{Form, Header};
use crate::data::attempt::Attempt;

/// Reads the header file beside a file of voxels.
pub(super) fn header(attempt: Attempt<'_>) -> Result<Header, LoadError> {
    let Some(path) = other(attempt, "hdr")? else {
        return Err(attempt.bad_input(
            "header",
            "it does not begin with a header of NIfTI or Analyze, and no file beside it is called like it and ends in .hdr",
            "put its header beside it",
        ));
    };
    let of_header = Attempt { what: "read the NIfTI volume's header", path: &path };
    let mut input = Input::open(of_header)?;
    note(&path);
    let start = Start::of(&mut input).map_err(|error| of_header.io(error))?;
    let Some(form) = Form::of(start.bytes()) else {
        return Err(of_header.bad_input("header", "it is no header of NIfTI or Analyze", "check the file"));
    };
    Header::of(of_header, form, start.bytes())
}

/// Finds the data file beside a header file.
pub(super) fn data(attempt: Attempt<'_>) -> Result<PathBuf, LoadError> {
    other(attempt, "img")?.ok_or_else(|| {
        attempt.bad_input(
            "data",
            "the header's voxels are in a second file, and none beside it is called like it and ends in .img or .img.gz",
            "put the data file beside the header",
        )
    })
}

/// Finds the file in the same folder with the same stem and another ending, in either case and optionally gzipped.
fn other(attempt: Attempt<'_>, ending: &str) -> Result<Option<PathBuf>, LoadError> {
    let stem = bare_name(attempt.path, ENDINGS);
    let folder = attempt.path.parent().unwrap_or(Path::new(""));
    let (lower, upper) = (format!("{stem}.{ending}"), format!("{stem}.{}", ending.to_uppercase()));
    for name in [lower.clone(), format!("{lower}.gz"), upper.clone(), format!("{upper}.GZ")] {
        if folder.join(&name).is_file() {
            return beside::resolve(attempt, "file name", &name).map(Some);
        }
    }
    Ok(None)
}

/// Returns true if a file is gzipped as a whole; rewinds it to its beginning.
pub(super) fn starts_as_gzip(attempt: Attempt<'_>, input: &mut Input) -> Result<bool, LoadError> {
    let mut magic = Vec::new();
    let looked = input.reader.by_ref().take(3).read_to_end(&mut magic).and_then(|_| input.reader.rewind());
    looked.map(|()| is_gzip(&magic)).map_err(|error| attempt.io(error))
}
