//! Header lines of a `MetaImage`: `Field = value`, the last of them `ElementDataFile`.

use std::collections::BTreeMap;
use std::io::{BufRead, Read as _};

use super::super::LoadError;
use chiaroscuro_volume::{LoadContext, quoted};

/// Maximum size of a header: real ones have a kilobyte, plus a name for each slice if they list files.
const MAX_HEADER_BYTES: u64 = 4 << 20;

/// Field that names the data and ends the header.
pub(super) const DATA_FILE: &str = "ElementDataFile";

/// True if these bytes begin a `MetaImage`: all of them state the number of dimensions (`NDims`).
pub(super) fn is_metaimage(start: &[u8]) -> bool {
    start
        .split(|&byte| byte == b'\n')
        .take_while(|line| parse_field(line).is_some())
        .any(|line| parse_field(line).is_some_and(|(name, _)| name == "ndims"))
}

/// Splits a line into its field name in lower case and its value.
fn parse_field(line: &[u8]) -> Option<(String, String)> {
    let separator =
        line.iter().position(|&byte| byte == b'=').or_else(|| line.iter().position(|&byte| byte == b':'))?;
    let name = str::from_utf8(line.get(..separator)?).ok()?.trim();
    // Field names that programs copy from other formats look like `0008|0060`.
    let is_name = !name.is_empty() && name.len() <= 200 && !name.contains(char::is_control);
    let value = String::from_utf8_lossy(line.get(separator + 1..)?).trim().to_owned();
    is_name.then(|| (name.to_lowercase(), value))
}

/// Header fields of a `MetaImage`, as text.
#[derive(Debug)]
pub(super) struct MetaImageHeader {
    /// Values by field name in lower case.
    fields: BTreeMap<String, String>,
    /// Lines after the last field if it announces a list: file names.
    pub(super) list: Vec<String>,
    /// Byte offset of data that follow the header in the same file.
    pub(super) data_start: u64,
}

impl MetaImageHeader {
    /// Reads up to the field that names the data, and the list that it may announce.
    pub(super) fn read(context: LoadContext<'_>, reader: &mut impl BufRead) -> Result<Self, LoadError> {
        let mut reader = reader.take(MAX_HEADER_BYTES);
        let mut line = Vec::new();
        let (mut fields, mut list) = (BTreeMap::new(), Vec::new());
        let (mut data_start, mut is_list) = (0, false);
        loop {
            line.clear();
            reader.read_until(b'\n', &mut line).map_err(|error| context.io_error(error))?;
            if !line.ends_with(b"\n") && reader.limit() == 0 {
                return Err(context.limit_error(
                    "header",
                    "the header has no end within 4 MiB",
                    format!("check that its last field is {DATA_FILE}"),
                ));
            }
            if line.is_empty() {
                break;
            }
            if is_list {
                let name = String::from_utf8_lossy(&line).trim().to_owned();
                list.extend((!name.is_empty()).then_some(name));
                continue;
            }
            // Lines that are no fields are ignored.
            let Some((name, value)) = parse_field(&line) else { continue };
            let is_last = name == DATA_FILE.to_lowercase();
            is_list = is_last && value.split_whitespace().next() == Some("LIST");
            fields.insert(name, value);
            if is_last {
                data_start = MAX_HEADER_BYTES - reader.limit();
                if !is_list {
                    break;
                }
            }
        }
        let header = Self { fields, list, data_start };
        header.require(context, DATA_FILE, "write LOCAL, or the name of the file of voxels")?;
        Ok(header)
    }

    /// Returns the value of a field, if the header has it.
    pub(super) fn get(&self, name: &str) -> Option<&str> {
        self.fields.get(&name.to_lowercase()).map(String::as_str)
    }

    /// Returns name and value of the first of several fields that the header has.
    pub(super) fn first_of<'a>(&self, names: &[&'a str]) -> Option<(&'a str, &str)> {
        names.iter().find_map(|&name| Some((name, self.get(name)?)))
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

    /// Returns the boolean value of a field; `None` if it is absent.
    pub(super) fn flag(&self, names: &[&str]) -> Option<bool> {
        let (_, value) = self.first_of(names)?;
        // Decided by the first letter, as in MetaIO.
        Some(value.starts_with(['T', 't', '1', 'Y', 'y']))
    }

    /// Returns the value of a field as a number.
    pub(super) fn number(&self, name: &str) -> Option<f64> {
        self.get(name)?.parse().ok()
    }

    /// Returns the numbers of the first of several fields that the header has.
    pub(super) fn numbers(
        &self,
        context: LoadContext<'_>,
        names: &[&str],
        count: usize,
    ) -> Result<Option<Vec<f64>>, LoadError> {
        let Some((name, text)) = self.first_of(names) else { return Ok(None) };
        let numbers: Option<Vec<f64>> =
            text.split_whitespace().take(count + 1).map(|word| word.parse().ok()).collect();
        match numbers.filter(|numbers| numbers.len() == count) {
            Some(numbers) => Ok(Some(numbers)),
            None => Err(context.bad_input_error(
                name,
                format!("{count} numbers were expected, {} was found", quoted(text)),
                "correct the header",
            )),
        }
    }
}
