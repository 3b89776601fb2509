//! Errors in reading presets and other stored settings.

/// Reason why JSON cannot be converted to settings.
#[derive(Debug, thiserror::Error)]
pub enum PresetError {
    /// Syntax error: the text is not JSON.
    #[error("not valid JSON: {0}")]
    Syntax(#[source] serde_json::Error),
    /// Encoding error: the bytes are not UTF-8.
    #[error("it is not UTF-8 text: {0}")]
    Encoding(#[source] std::str::Utf8Error),
    /// Valid JSON with a field of the wrong type.
    #[error("a setting has a wrong type or value: {0}")]
    WrongType(#[source] serde_json::Error),
    /// Valid JSON that is not an object.
    #[error("a preset must be a JSON object, for instance {{\"shadows\": {{\"strength\": 0.8}}}}")]
    NotAnObject,
    /// Text that exceeds the largest size of a look.
    #[error("it has {bytes} bytes, and a look has at most 1.25 MiB")]
    TooLong {
        /// Size of the text in bytes.
        bytes: usize,
    },
    /// Path of `--set` that does not exist.
    #[error("there is no setting `{path}`; at {} there are: {known}", describe_position(at))]
    UnknownPath {
        /// Complete path as given.
        path: String,
        /// Existing part of the path; empty for the top level.
        at: String,
        /// Names that exist at that point.
        known: String,
    },
}

/// Describes the position of a setting in words.
fn describe_position(path: &str) -> String {
    if path.is_empty() { "the top level".to_owned() } else { format!("`{path}`") }
}
