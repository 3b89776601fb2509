//! Header lines of an NRRD file: magic, then `field: value`, `key:=value` and `# comment`, then an empty line.

use std::collections::BTreeMap;
use std::io::{BufRead, Read as _};

use super::super::LoadError;
use chiaroscuro_volume::{LoadContext, quoted};

/// Maximum size of a header: real ones have a few kilobytes.
const MAX_HEADER_BYTES: u64 = 1 << 20;

/// Header fields of an NRRD file, as text.
#[derive(Debug)]
pub(super) struct NrrdHeader {
    /// Values by field name in lower case without spaces, so that `data file` and `datafile` are one field.
    fields: BTreeMap<String, String>,
    /// Values by key in lower case; the first of several wins.
    keys: BTreeMap<String, String>,
    /// Lines that follow a list of data files: their names.
    pub(super) files: Vec<String>,
    /// Byte offset of the data in this file; `None` if the file ends before an empty line.
    data_start: Option<u64>,
}

impl NrrdHeader {
    /// Reads up to the empty line or the end of the file.
    pub(super) fn read(context: LoadContext<'_>, reader: &mut impl BufRead) -> Result<Self, LoadError> {
        let mut reader = reader.take(MAX_HEADER_BYTES);
        let mut line = Vec::new();
        let (mut fields, mut keys) = (BTreeMap::new(), BTreeMap::new());
        let (mut files, mut is_list) = (Vec::new(), false);
        let mut data_start = None;
        for number in 1.. {
            line.clear();
            reader.read_until(b'\n', &mut line).map_err(|error| context.io_error(error))?;
            if !line.ends_with(b"\n") && reader.limit() == 0 {
                return Err(context.limit_error(
                    "header",
                    "the header has no end within 1 MiB",
                    "check that it ends with an empty line",
                ));
            }
            if line.is_empty() {
                break;
            }
            let text = String::from_utf8_lossy(&line);
            let text = text.trim_end_matches(['\n', '\r']);
            if number == 1 {
                check_magic(context, text)?;
            } else if is_list {
                files.extend(Some(text.trim()).filter(|name| !name.is_empty()).map(str::to_owned));
            } else if text.is_empty() {
                data_start = Some(MAX_HEADER_BYTES - reader.limit());
                break;
            } else if let Some((key, value)) = key_and_value(text) {
                keys.entry(key).or_insert(value);
            } else if !text.starts_with('#') {
                is_list = add_field(context, &mut fields, text, number)?;
            }
        }
        if fields.is_empty() {
            return Err(context.bad_input_error(
                "header",
                "it has no fields",
                "check that it is an NRRD file",
            ));
        }
        Ok(Self { fields, keys, files, data_start })
    }

    /// Returns the value of a field, if the header has it.
    pub(super) fn get(&self, name: &str) -> Option<&str> {
        self.fields.get(&normalized_key(name)).map(String::as_str)
    }

    /// Returns the value of a field that has two names; empty if the header has neither.
    pub(super) fn get_any(&self, name: &str, other: &str) -> &str {
        self.get(name).or_else(|| self.get(other)).unwrap_or_default()
    }

    /// Returns the value of a key, if the header has it; keys are case-insensitive.
    pub(super) fn get_key(&self, name: &str) -> Option<&str> {
        self.keys.get(&name.to_lowercase()).map(String::as_str)
    }

    /// Returns the value of a mandatory field; `help` tells the user what it should be.
    pub(super) fn require(
        &self,
        context: LoadContext<'_>,
        name: &str,
        help: &str,
    ) -> Result<&str, LoadError> {
        self.get(name)
            .ok_or_else(|| context.bad_input_error(name, format!("the field {name} is missing"), help))
    }

    /// Returns the byte offset of data in the header's own file.
    pub(super) fn data_start(&self, context: LoadContext<'_>) -> Result<u64, LoadError> {
        self.data_start.ok_or_else(|| {
            context.bad_input_error(
                "data file",
                "the file ends with its header: no data follow, and no data file is named",
                "copy the file again, or name the file that holds the voxels in the field data file",
            )
        })
    }
}

fn check_magic(context: LoadContext<'_>, line: &str) -> Result<(), LoadError> {
    match line.strip_prefix("NRRD000").map(str::trim_end) {
        Some("1" | "2" | "3" | "4" | "5") => Ok(()),
        Some(_) => Err(context.bad_input_error(
            "magic",
            format!("NRRD0001 to NRRD0005 are supported, {} was found", quoted(line)),
            "write it again as NRRD0004 or NRRD0005",
        )),
        None => Err(context.bad_input_error(
            "magic",
            format!("an NRRD file begins with NRRD0001 to NRRD0005, {} was found", quoted(line)),
            "check the file's name and format",
        )),
    }
}

/// Splits a `key:=value` line into key, in lower case, and value; `None` for comments and fields.
fn key_and_value(line: &str) -> Option<(String, String)> {
    let (key, value) =
        line.split_once(":=").filter(|(key, _)| !key.contains(':') && !key.starts_with('#'))?;
    Some((key.trim().to_lowercase(), value.trim().to_owned()))
}

/// Adds the field of one line; returns true if it announces a list of data files.
fn add_field(
    context: LoadContext<'_>,
    fields: &mut BTreeMap<String, String>,
    line: &str,
    number: u32,
) -> Result<bool, LoadError> {
    let Some((name, value)) = line.split_once(':') else {
        return Err(context.bad_input_error(
            "header",
            format!("line {number} is neither a field, a key, a comment nor empty: {}", quoted(line)),
            "check that an empty line separates header and data",
        ));
    };
    let (key, value) = (normalized_key(name), value.trim());
    let is_list = key == "datafile" && value.split_whitespace().next() == Some("LIST");
    let earlier = fields.insert(key, value.to_owned());
    match earlier {
        Some(earlier) if earlier != value => Err(context.bad_input_error(
            name.trim(),
            format!("the field is there twice, as {} and as {}", quoted(&earlier), quoted(value)),
            "remove one of the two lines",
        )),
        _ => Ok(is_list),
    }
}

fn normalized_key(name: &str) -> String {
    name.chars().filter(|c| !c.is_whitespace()).collect::<String>().to_lowercase()
}
