//! Companion files that describe raw voxels in another file; they are read when they are opened, and when the voxels
//! are.

mod dat;
mod ini;
mod ivf;
#[cfg(test)]
mod tests;
mod words;

use std::path::{Path, PathBuf};

use super::super::input::{Input, Witness, stem};
use super::super::reader::{Reader, Source, Start};
use super::super::{LoadError, beside as beside_header};
use super::form::Form;
use super::{has_name, overridden};
use crate::data::Volume;
use crate::data::attempt::Attempt;

pub(in crate::data::load) const DAT: Reader = Reader {
    name: "DAT",
    // The extension is also that of raw voxels: only the content decides.
    endings: &[],
    recognises: |start| dat::is_dat(start.stored()),
    load: |source| load(source, dat::parse),
};

pub(in crate::data::load) const IVF: Reader = Reader {
    name: "IVF",
    endings: &[".ivf"],
    recognises: |start| ivf::is_ivf(start.stored()),
    load: |source| load(source, ivf::parse),
};

pub(in crate::data::load) const INI: Reader = Reader {
    name: "INI",
    endings: &[".ini"],
    recognises: |start| ini::is_ini(start.stored()),
    load: |source| load(source, ini::parse),
};

/// Returns true if a file with this beginning is a description of any kind.
pub(super) fn is_description(start: &[u8]) -> bool {
    dat::is_dat(start) || ivf::is_ivf(start) || ini::is_ini(start)
}

/// Maximum length of a description, in bytes.
const MOST_BYTES: u64 = 64 << 10;

const WHAT: &str = "read the description of a RAW volume";

/// Parsed description of a raw file.
struct Described {
    /// Name of the file of voxels, where the description has one.
    data: Option<String>,
    form: Form,
}

impl Described {
    fn names(&self, path: &Path) -> bool {
        self.data.as_ref().is_some_and(|name| has_name(path, name))
    }
}

type Parse = fn(Attempt<'_>, &str) -> Result<Described, LoadError>;

/// Loads the volume that a description refers to.
fn load(mut source: Source<'_>, parse: Parse) -> Result<Volume, LoadError> {
    let attempt = Attempt { what: WHAT, path: source.path };
    let text = text(attempt, &mut source.input)?;
    let Described { data, form } = parse(attempt, &text)?;
    let name = match data {
        Some(name) => name,
        None => unnamed(attempt)?,
    };
    let data_path = beside_header::resolve(attempt, "data file", &name)?;
    let attempt = Attempt { what: "read the RAW volume", path: &data_path };
    let form = overridden(attempt, form, &source.options.raw)?;
    let mut input = Input::open(attempt)?;
    let witness = Witness::of(attempt, &input)?;
    let start = Start::of(&mut input).map_err(|error| attempt.io(error))?;
    let name = stem(&data_path);
    let source = Source { path: &data_path, input, start, options: source.options, control: source.control };
    witness.vouch(attempt, form.read(source, attempt, name, "check the description against the data"))
}

/// Name of the data file for a description that names none: `x.raw` or `x` for `x.raw.ini`, `x.raw` for `x.ini`.
fn unnamed(attempt: Attempt<'_>) -> Result<String, LoadError> {
    let stem = attempt.path.file_stem().unwrap_or_default().to_string_lossy();
    let candidates = ["", ".raw", ".dat", ".raw.gz", ".bin"].map(|ending| format!("{stem}{ending}"));
    let is_there = |name: &&String| attempt.path.with_file_name(name).is_file();
    candidates.iter().find(is_there).cloned().ok_or_else(|| {
        attempt.bad_input(
            "data file",
            "there is no file beside it that it could describe",
            format!("put the voxels beside it and call them {}.raw", crate::data::plain(&stem, 60)),
        )
    })
}

/// Finds and parses the description beside a file of voxels; the error tells why one cannot be parsed. Descriptions
/// that name another file are ignored.
pub(super) fn beside(data: &Path) -> Option<Result<Form, LoadError>> {
    candidates(data).into_iter().find_map(|path| {
        let attempt = Attempt { what: WHAT, path: &path };
        if !path.is_file() {
            return None;
        }
        let mut input = Input::open(attempt).ok()?;
        let start = Start::of(&mut input).ok()?;
        let bytes = start.stored();
        let (parse, names_it): (Parse, bool) = if dat::is_dat(bytes) {
            (dat::parse, true)
        } else if ivf::is_ivf(bytes) {
            (ivf::parse, true)
        } else if ini::is_ini(bytes) {
            (ini::parse, false)
        } else {
            return None;
        };
        match text(attempt, &mut input).and_then(|text| parse(attempt, &text)) {
            Ok(described) if names_it && !described.names(data) => None,
            Ok(described) => Some(Ok(described.form)),
            Err(error) => Some(Err(error)),
        }
    })
}

/// Possible paths of a file's description: its name with another extension, or with an additional one.
fn candidates(data: &Path) -> Vec<PathBuf> {
    let name = data.file_name().unwrap_or_default().to_os_string();
    let is_zipped = data.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("gz"));
    let unzipped = if is_zipped { data.with_extension("") } else { data.to_path_buf() };
    let mut found = Vec::new();
    for ending in ["dat", "ini", "ivf"] {
        let mut longer = name.clone();
        longer.push(".");
        longer.push(ending);
        found.extend([data.with_file_name(longer), unzipped.with_extension(ending)]);
    }
    found.retain(|path| path != data);
    found
}

/// Reads the text of a description.
fn text(attempt: Attempt<'_>, input: &mut Input) -> Result<String, LoadError> {
    use std::io::Read as _;
    let mut bytes = Vec::new();
    let read = input.reader.by_ref().take(MOST_BYTES + 1).read_to_end(&mut bytes);
    read.map_err(|error| attempt.io(error))?;
    if bytes.len() as u64 > MOST_BYTES {
        return Err(attempt.bad_input(
            "",
            format!("it is longer than {MOST_BYTES} bytes, which no description is"),
            "check the file's name and format",
        ));
    }
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}
