//! Header of a NumPy array: type, axis order and shape.

use std::io::Read;

use super::super::LoadError;
use super::dictionary::{PythonValue, parse};
use chiaroscuro_volume::{LoadContext, quoted};

/// Magic bytes of an array file.
pub(super) const MAGIC: &[u8] = b"\x93NUMPY";

/// Maximum length of a header, in bytes; NumPy itself limits headers of untrusted files as well.
const MAX_HEADER: u64 = 64 << 10;

#[derive(Debug, PartialEq, Eq)]
pub(super) struct NumpyHeader {
    /// Type code of the elements, such as `<f4`.
    pub(super) descr: String,
    /// True if the first axis is the fastest (Fortran order).
    pub(super) is_fortran: bool,
    pub(super) shape: Vec<u64>,
    /// Length of the header, in bytes.
    pub(super) bytes: u64,
}

impl NumpyHeader {
    /// Reads the header from the beginning of an array file.
    pub(super) fn read(context: LoadContext<'_>, content: &mut dyn Read) -> Result<Self, LoadError> {
        let bad =
            |why: String| context.bad_input_error("header", why, "save the array again with numpy.save");
        let mut exactly = |count: u64| {
            let mut bytes = Vec::new();
            match Read::take(&mut *content, count).read_to_end(&mut bytes) {
                Ok(_) if bytes.len() as u64 == count => Ok(bytes),
                Ok(_) => Err(bad("the header is truncated".to_owned())),
                Err(error) => Err(bad(format!("the header cannot be read: {error}"))),
            }
        };
        let start = exactly(8)?;
        if !start.starts_with(MAGIC) {
            return Err(bad("it does not begin like a NumPy array".to_owned()));
        }
        let (width, version) = match start[6] {
            1 => (2, 1),
            2 | 3 => (4, start[6]),
            other => return Err(bad(format!("version {other} is not supported, 1 to 3 are"))),
        };
        let length = exactly(width)?.iter().rev().fold(0u64, |sum, &byte| sum << 8 | u64::from(byte));
        if length > MAX_HEADER {
            return Err(bad(format!("a header of {length} bytes is too long for an array of numbers")));
        }
        let text = exactly(length)?;
        // Versions before 3 are in Latin-1; names of types and axes are ASCII in both.
        let text = if version == 3 {
            String::from_utf8_lossy(&text).into_owned()
        } else {
            text.iter().map(|&byte| char::from(byte)).collect()
        };
        let entries = parse(&text).map_err(|expected| {
            bad(format!("{} is not the header of an array: {expected} was expected", quoted(&text)))
        })?;
        let find = |key: &str| entries.iter().find(|(name, _)| name == key).map(|(_, value)| value);
        let descr = match find("descr") {
            Some(PythonValue::Text(descr)) => descr.clone(),
            Some(PythonValue::List) => {
                return Err(context.bad_input_error(
                    "descr",
                    "its elements are records of several fields",
                    "save one of the fields as an array",
                ));
            }
            _ => return Err(bad("it does not state the type of its numbers (descr)".to_owned())),
        };
        let (Some(PythonValue::Bool(is_fortran)), Some(PythonValue::Numbers(shape))) =
            (find("fortran_order"), find("shape"))
        else {
            return Err(bad("it does not state fortran_order or shape".to_owned()));
        };
        let bytes = 8 + width + length;
        Ok(Self { descr, is_fortran: *is_fortran, shape: shape.clone(), bytes })
    }
}
