//! Opening of volumes by a FILE argument: files and built-in volumes.

use std::path::Path;

use crate::{LoadOptions, load};
use chiaroscuro_volume::{
    ContentsRecorder, FileContents, LoadContext, LoadControl, LoadError, ResolvedPortion, Volume, quoted,
    synthetic,
};

/// Prefix of the names of built-in volumes in place of a file's path.
const BUILTIN: &str = "builtin:";

/// Loads the volume that a FILE argument names: a path, or `builtin:NAME` or `builtin:NAME:N` for a built-in volume
/// of N³ voxels. A file whose name has this prefix is reached as `./builtin:…`.
///
/// # Errors
/// Fails like [`load`] and [`builtin`](chiaroscuro_volume::synthetic::builtin).
pub fn open(
    source: impl AsRef<Path>,
    options: &LoadOptions,
    control: &LoadControl,
) -> Result<Volume, LoadError> {
    let source = source.as_ref();
    // A name that is not valid text belongs to a file.
    let Some(builtin) = source.to_str().and_then(|name| name.strip_prefix(BUILTIN)) else {
        return load(source, options, control);
    };
    let context = LoadContext { operation: "make the built-in volume", path: source };
    let (name, n) = match builtin.split_once(':') {
        None => (builtin, None),
        Some((name, digits)) => match digits.parse() {
            Ok(n) => (name, Some(n)),
            Err(_) => {
                return Err(context.bad_input_error(
                    "N",
                    format!("a number of voxels was expected after {name}:, {} was found", quoted(digits)),
                    "write it like builtin:chair:128",
                ));
            }
        },
    };
    context.reject_unsupported_choice(&options.choice, &ContentsRecorder::default())?;
    let volume =
        synthetic::builtin_with_budget(name, n, options.memory_budget_bytes, &options.choice, control)?;
    // Built-in volumes are made whole; the portion is taken afterwards.
    let (portion, dims) = (options.choice.portion.unwrap_or_default(), volume.dims());
    let Some(wanted) = ResolvedPortion::resolve(&portion, dims, false) else {
        return Err(context.region_error(dims));
    };
    let held = FileContents { portion, grid: Some(dims), ..FileContents::default() };
    // A part of a valid volume is valid; no other error is expected here.
    volume
        .extract_portion(&ResolvedPortion::whole_grid(dims), &wanted)
        .map(|volume| volume.with_contents(held))
        .map_err(|err| context.bad_input_error("voxels", err.to_string(), "load the whole volume"))
}
