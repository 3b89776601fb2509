//! The header's lines: `Field = value`, the last of them `ElementDataFile`.

use std::collections::BTreeMap;
use std::io::{BufRead, Read as _};

use super::super::LoadError;
use crate::data::attempt::{Attempt, quoted};

/// Longer headers are refused: real ones have a kilobyte, and a name for each slice where there is a list of files.
const LONGEST_HEADER_BYTES: u64 = 4 << 20;

/// The last field.
pub(super) const DATA_FILE: &str = "ElementDataFile";

/// Whether a file that begins like this is a `MetaImage`: all of them say how many dimensions they have.
pub(super) fn is_metaimage(start: &[u8]) -> bool {
    start
        .split(|&byte| byte == b'\n')
        .take_while(|line| field(line).is_some())
        .any(|line| field(line).is_some_and(|(name, _)| name == "ndims"))
}

/// The name of a line's field in lower case, and its value.
fn field(line: &[u8]) -> Option<(String, String)> {
    let separator =
        line.iter().position(|&byte| byte == b'=').or_else(|| line.iter().position(|&byte| byte == b':'))?;
    let name = str::from_utf8(line.get(..separator)?).ok()?.trim();
    // Those that programs put there from other formats are called like `0008|0060`.
    let is_name = !name.is_empty() && name.len() <= 200 && !name.contains(char::is_control);
    let value = String::from_utf8_lossy(line.get(separator + 1..)?).trim().to_owned();
    is_name.then(|| (name.to_lowercase(), value))
}

/// The header's fields as text.
#[derive(Debug)]
pub(super) struct Header {
    /// By name in lower case.
    fields: BTreeMap<String, String>,
    /// Lines after the last field, where it announces a list.
    pub(super) list: Vec<String>,
    /// Where the data begin that are in this file.
    pub(super) data_start: u64,
}

impl Header {
    /// Reads up to the field that names the data, and the list that it announces.
    pub(super) fn read(attempt: Attempt<'_>, reader: &mut impl BufRead) -> Result<Self, LoadError> {
        let mut reader = reader.take(LONGEST_HEADER_BYTES);
        let mut line = Vec::new();
        let (mut fields, mut list) = (BTreeMap::new(), Vec::new());
        let (mut data_start, mut is_list) = (0, false);
        loop {
            line.clear();
            reader.read_until(b'\n', &mut line).map_err(|error| attempt.io(error))?;
            if !line.ends_with(b"\n") && reader.limit() == 0 {
                return Err(attempt.limit(
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
            // What is no field says nothing.
            let Some((name, value)) = field(&line) else { continue };
            let is_last = name == DATA_FILE.to_lowercase();
            is_list = is_last && value.split_whitespace().next() == Some("LIST");
            fields.insert(name, value);
            if is_last {
                data_start = LONGEST_HEADER_BYTES - reader.limit();
                if !is_list {
                    break;
                }
            }
        }
        let header = Self { fields, list, data_start };
        header.require(attempt, DATA_FILE, "write LOCAL, or the name of the file of voxels")?;
        Ok(header)
    }

    /// The value of a field, if the header has it.
    pub(super) fn get(&self, name: &str) -> Option<&str> {
        self.fields.get(&name.to_lowercase()).map(String::as_str)
    }

    /// The value of the first of several fields that the header has, and the field's name.
    pub(super) fn first<'a>(&self, names: &[&'a str]) -> Option<(&'a str, &str)> {
        names.iter().find_map(|&name| Some((name, self.get(name)?)))
    }

    /// The value of a field that must be there; `help` says what it should be.
    pub(super) fn require(&self, attempt: Attempt<'_>, name: &str, help: &str) -> Result<&str, LoadError> {
        self.get(name).ok_or_else(|| attempt.bad_input(name, format!("the field {name} is missing"), help))
    }

    /// Whether a field says yes; `None` where it is not there.
    pub(super) fn flag(&self, names: &[&str]) -> Option<bool> {
        let (_, value) = self.first(names)?;
        // As MetaIO takes it: by its first letter.
        Some(value.starts_with(['T', 't', '1', 'Y', 'y']))
    }

    /// The value of a field that is a number.
    pub(super) fn number(&self, name: &str) -> Option<f64> {
        self.get(name)?.parse().ok()
    }

    /// The numbers of the first of several fields that the header has.
    pub(super) fn numbers(
        &self,
        attempt: Attempt<'_>,
        names: &[&str],
        count: usize,
    ) -> Result<Option<Vec<f64>>, LoadError> {
        let Some((name, text)) = self.first(names) else { return Ok(None) };
        let numbers: Option<Vec<f64>> =
            text.split_whitespace().take(count + 1).map(|word| word.parse().ok()).collect();
        match numbers.filter(|numbers| numbers.len() == count) {
            Some(numbers) => Ok(Some(numbers)),
            None => Err(attempt.bad_input(
                name,
                format!("{count} numbers were expected, {} was found", quoted(text)),
                "correct the header",
            )),
        }
    }
}
