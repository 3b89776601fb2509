//! Fields of metadata documents, with errors that name them.

use serde_json::Value;

use super::super::LoadError;
use super::data_type::encode_fill;
use super::{Endian, FileNumberType, MAX_DIMENSIONS};
use chiaroscuro_volume::{LoadContext, quoted};

/// Advice for metadata that are broken.
pub(super) const HELP: &str = "check the metadata, or write the array again";

/// Document of metadata, for errors about its fields.
#[derive(Clone, Copy)]
pub(super) struct MetadataDocument<'a> {
    pub(super) context: LoadContext<'a>,
    /// Key of the document in the store.
    pub(super) key: &'a str,
    pub(super) value: &'a Value,
}

impl MetadataDocument<'_> {
    /// Error about a field.
    pub(super) fn error(&self, field: &str, why: impl Into<String>, help: &str) -> LoadError {
        self.context.bad_input_error(&format!("{}, {field}", self.key), why, help)
    }

    /// Error about a feature that is not supported.
    pub(super) fn unsupported(&self, field: &str, what: &str, supported: &str) -> LoadError {
        self.error(
            field,
            format!("{what} is not supported; supported are {supported}"),
            "write the array again, with zarr-python for example",
        )
    }

    /// Text of a value for a message, shortened.
    pub(super) fn text(value: &Value) -> String {
        quoted(value.as_str().unwrap_or(&value.to_string()))
    }

    /// Parses the fill value, as one element of the array.
    pub(super) fn fill_value(&self, number: FileNumberType, endian: Endian) -> Result<Vec<u8>, LoadError> {
        let value = &self.value["fill_value"];
        encode_fill(value, number, endian).ok_or_else(|| {
            let why = format!("{} is no number of the array's type", Self::text(value));
            self.error("fill_value", why, HELP)
        })
    }

    /// Parses an array of lengths: `count` of them, where that is known, all above 0 if they are those of chunks.
    pub(super) fn lengths(
        &self,
        field: &str,
        value: &Value,
        count: Option<usize>,
        smallest: u64,
    ) -> Result<Vec<u64>, LoadError> {
        let lengths: Option<Vec<u64>> =
            value.as_array().and_then(|list| list.iter().map(Value::as_u64).collect());
        let expected = count.map_or_else(String::new, |count| format!("{count} "));
        lengths
            .filter(|lengths| {
                count.is_none_or(|count| lengths.len() == count)
                    && lengths.len() <= MAX_DIMENSIONS
                    && lengths.iter().all(|&length| length >= smallest)
            })
            .ok_or_else(|| {
                self.error(
                    field,
                    format!(
                        "{expected}whole numbers from {smallest} were expected, {} was found",
                        Self::text(value)
                    ),
                    HELP,
                )
            })
    }
}
