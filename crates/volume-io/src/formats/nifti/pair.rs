//! Pairs of header and data files (`.hdr`, `.img`): finds the second file of a pair.

use std::io::{Read as _, Seek as _};
use std::path::{Path, PathBuf};

use super::super::input::{InputFile, is_gzip, name_without_extension};
use super::super::reader::FileStart;
use super::super::{LoadError, companion_path};
use super::ENDINGS;
use super::header::{NiftiHeader, NiftiVersion};
use chiaroscuro_volume::{LoadContext, LoadControl};

/// Reads the header file beside a file of voxels.
pub(super) fn read_header_beside(
    context: LoadContext<'_>,
    control: &LoadControl,
) -> Result<NiftiHeader, LoadError> {
    let Some(path) = paired_file(context, "hdr")? else {
        return Err(context.bad_input_error(
            "header",
            "it has no NIfTI or Analyze header, and there is no .hdr file of the same name beside it",
            "put the header file beside it",
        ));
    };
    let of_header = LoadContext { operation: "read the NIfTI volume's header", path: &path };
    let mut input = InputFile::open(of_header)?;
    control.record_read(&path);
    let start = FileStart::read(&mut input).map_err(|error| of_header.io_error(error))?;
    let Some(form) = NiftiVersion::detect(start.bytes()) else {
        return Err(of_header.bad_input_error(
            "header",
            "it is not a NIfTI or Analyze header",
            "check the file",
        ));
    };
    NiftiHeader::parse(of_header, form, start.bytes())
}

/// Finds the data file beside a header file.
pub(super) fn data_path_beside(context: LoadContext<'_>) -> Result<PathBuf, LoadError> {
    paired_file(context, "img")?.ok_or_else(|| {
        context.bad_input_error(
            "data",
            "the header's voxels are in a second file, and no .img or .img.gz file of the same name is beside it",
            "put the data file beside the header",
        )
    })
}

/// Finds the file in the same folder with the same stem and another ending, in either case and optionally gzipped.
fn paired_file(context: LoadContext<'_>, ending: &str) -> Result<Option<PathBuf>, LoadError> {
    let stem = name_without_extension(context.path, ENDINGS);
    let folder = context.path.parent().unwrap_or(Path::new(""));
    let (lower, upper) = (format!("{stem}.{ending}"), format!("{stem}.{}", ending.to_uppercase()));
    for name in [lower.clone(), format!("{lower}.gz"), upper.clone(), format!("{upper}.GZ")] {
        if folder.join(&name).is_file() {
            return companion_path::resolve(context, "file name", &name).map(Some);
        }
    }
    Ok(None)
}

/// Returns true if a file is gzipped as a whole; rewinds it to its beginning.
pub(super) fn starts_as_gzip(context: LoadContext<'_>, input: &mut InputFile) -> Result<bool, LoadError> {
    let mut magic = Vec::new();
    let magic_read =
        input.reader.by_ref().take(3).read_to_end(&mut magic).and_then(|_| input.reader.rewind());
    magic_read.map(|()| is_gzip(&magic)).map_err(|error| context.io_error(error))
}
