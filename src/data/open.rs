//! Volumes by what a FILE argument names: files and built-in ones.

use std::path::Path;

use super::attempt::{Attempt, quoted};
use super::load::{LoadControl, LoadError, LoadOptions, load};
use super::{Volume, synthetic};

/// Prefix of the names of built-in volumes where a file is expected.
const BUILTIN: &str = "builtin:";

/// Loads what a FILE argument names: a path, or `builtin:NAME` or `builtin:NAME:N` for a built-in
/// volume of N³ voxels. A file whose name begins like that is reached as `./builtin:…`.
///
/// # Errors
/// As [`load`] and [`builtin`](super::synthetic::builtin).
pub fn open(
    source: impl AsRef<Path>,
    options: &LoadOptions,
    control: &LoadControl,
) -> Result<Volume, LoadError> {
    let source = source.as_ref();
    let volume = open_whole(source, options, control)?;
    let attempt = Attempt { what: "average the voxels", path: source };
    // What was a volume stays one: nothing else can go wrong.
    volume
        .reduced([options.reduce; 3])
        .map_err(|err| attempt.bad_input("voxels", err.to_string(), "load them all"))
}

fn open_whole(source: &Path, options: &LoadOptions, control: &LoadControl) -> Result<Volume, LoadError> {
    // A name that is no text is a file's.
    let Some(builtin) = source.to_str().and_then(|name| name.strip_prefix(BUILTIN)) else {
        return load(source, options, control);
    };
    let (name, n) = match builtin.split_once(':') {
        None => (builtin, None),
        Some((name, digits)) => match digits.parse() {
            Ok(n) => (name, Some(n)),
            Err(_) => {
                return Err(Attempt { what: "make the built-in volume", path: source }.bad_input(
                    "N",
                    format!("a number of voxels was expected after {name}:, {} was found", quoted(digits)),
                    "write it like builtin:chair:128",
                ));
            }
        },
    };
    synthetic::builtin_within(name, n, options.memory_budget_bytes, control)
}
