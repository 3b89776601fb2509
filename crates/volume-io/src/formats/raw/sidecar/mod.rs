//! Companion files that describe raw voxels in another file; they are read when they are opened, and when the voxels
//! are.

mod dat;
mod ini;
mod ivf;
#[cfg(test)]
mod tests;
mod values;

use std::path::{Path, PathBuf};

use super::super::input::{FileChangeGuard, InputFile, stem};
use super::super::reader::{FileStart, FormatReader, VolumeSource};
use super::super::{LoadError, companion_path as beside_header};
use super::storage::RawStorage;
use super::{is_same_file_name, with_overrides};
use chiaroscuro_volume::{LoadContext, Volume};

pub(crate) const DAT: FormatReader = FormatReader {
    name: "DAT",
    // The extension is also that of raw voxels: only the content decides.
    extensions: &[],
    recognises: |start| dat::is_dat(start.stored()),
    load: |source| load(source, dat::parse),
};

pub(crate) const IVF: FormatReader = FormatReader {
    name: "IVF",
    extensions: &[".ivf"],
    recognises: |start| ivf::is_ivf(start.stored()),
    load: |source| load(source, ivf::parse),
};

pub(crate) const INI: FormatReader = FormatReader {
    name: "INI",
    extensions: &[".ini"],
    recognises: |start| ini::is_ini(start.stored()),
    load: |source| load(source, ini::parse),
};

/// Returns true if a file with this beginning is a description of any kind.
pub(super) fn is_description(start: &[u8]) -> bool {
    dat::is_dat(start) || ivf::is_ivf(start) || ini::is_ini(start)
}

/// Maximum length of a description, in bytes.
const MAX_BYTES: u64 = 64 << 10;

const WHAT: &str = "read the description of a RAW volume";

/// Parsed description of a raw file.
struct RawDescription {
    /// Name of the file of voxels, where the description has one.
    data_file: Option<String>,
    storage: RawStorage,
}

impl RawDescription {
    fn names(&self, path: &Path) -> bool {
        self.data_file.as_ref().is_some_and(|name| is_same_file_name(path, name))
    }
}

type DescriptionParser = fn(LoadContext<'_>, &str) -> Result<RawDescription, LoadError>;

/// Loads the volume that a description refers to.
fn load(mut source: VolumeSource<'_>, parse: DescriptionParser) -> Result<Volume, LoadError> {
    let context = LoadContext { operation: WHAT, path: source.path };
    let text = text(context, &mut source.input)?;
    let RawDescription { data_file: data, storage: form } = parse(context, &text)?;
    let name = match data {
        Some(name) => name,
        None => guess_data_file(context)?,
    };
    let data_path = beside_header::resolve(context, "data file", &name)?;
    let context = LoadContext { operation: "read the RAW volume", path: &data_path };
    let form = with_overrides(context, form, &source.options.raw)?;
    let mut input = InputFile::open(context)?;
    let guard = FileChangeGuard::new(context, &input, source.control)?;
    let start = FileStart::read(&mut input).map_err(|error| context.io_error(error))?;
    let name = stem(&data_path);
    let source =
        VolumeSource { path: &data_path, input, start, options: source.options, control: source.control };
    guard.check_unchanged(context, form.read(source, context, name, "check the description against the data"))
}

/// Name of the data file for a description that names none: `x.raw` or `x` for `x.raw.ini`, `x.raw` for `x.ini`.
fn guess_data_file(context: LoadContext<'_>) -> Result<String, LoadError> {
    let stem = context.path.file_stem().unwrap_or_default().to_string_lossy();
    let candidates = ["", ".raw", ".dat", ".raw.gz", ".bin"].map(|ending| format!("{stem}{ending}"));
    let is_there = |name: &&String| context.path.with_file_name(name).is_file();
    candidates.iter().find(is_there).cloned().ok_or_else(|| {
        context.bad_input_error(
            "data file",
            "the data file that it describes is not beside it",
            format!("put the data file beside it, named {}.raw", chiaroscuro_files::sanitised(&stem, 60)),
        )
    })
}

/// Finds and parses the description beside a file of voxels; the error tells why one cannot be parsed. Descriptions
/// that name another file are ignored.
pub(super) fn find_description(data: &Path) -> Option<Result<RawStorage, LoadError>> {
    description_paths(data).into_iter().find_map(|path| {
        let context = LoadContext { operation: WHAT, path: &path };
        if !path.is_file() {
            return None;
        }
        let mut input = InputFile::open(context).ok()?;
        let start = FileStart::read(&mut input).ok()?;
        let bytes = start.stored();
        let (parse, names_it): (DescriptionParser, bool) = if dat::is_dat(bytes) {
            (dat::parse, true)
        } else if ivf::is_ivf(bytes) {
            (ivf::parse, true)
        } else if ini::is_ini(bytes) {
            (ini::parse, false)
        } else {
            return None;
        };
        match text(context, &mut input).and_then(|text| parse(context, &text)) {
            Ok(described) if names_it && !described.names(data) => None,
            Ok(described) => Some(Ok(described.storage)),
            Err(error) => Some(Err(error)),
        }
    })
}

/// Possible paths of a file's description: its name with another extension, or with an additional one.
fn description_paths(data: &Path) -> Vec<PathBuf> {
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
fn text(context: LoadContext<'_>, input: &mut InputFile) -> Result<String, LoadError> {
    use std::io::Read as _;
    let mut bytes = Vec::new();
    let read = input.reader.by_ref().take(MAX_BYTES + 1).read_to_end(&mut bytes);
    read.map_err(|error| context.io_error(error))?;
    if bytes.len() as u64 > MAX_BYTES {
        return Err(context.bad_input_error(
            "",
            format!("it is longer than {MAX_BYTES} bytes, the maximum for a description"),
            "check the file's name and format",
        ));
    }
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}
