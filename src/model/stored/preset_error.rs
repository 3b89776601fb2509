//! Why a text is no look.

/// Why JSON does not become settings.
#[derive(Debug, thiserror::Error)]
pub enum PresetError {
    /// Not JSON at all.
    #[error("not valid JSON: {0}")]
    Syntax(#[source] serde_json::Error),
    /// Bytes of something else.
    #[error("it is no text: {0}")]
    NoText(#[source] std::str::Utf8Error),
    /// JSON, but a field has the wrong form.
    #[error("a setting has the wrong form: {0}")]
    Form(#[source] serde_json::Error),
    /// Not an object.
    #[error("a preset must be a JSON object, for instance {{\"shadows\": {{\"strength\": 0.8}}}}")]
    NotAnObject,
    /// Longer than any look.
    #[error("it has {bytes} bytes, and a look has at most 1.25 MiB")]
    TooLong {
        /// How many there are.
        bytes: usize,
    },
    /// `--set` names something that does not exist.
    #[error("there is no setting `{path}`; at {} there are: {known}", place(at))]
    UnknownPath {
        /// The whole path.
        path: String,
        /// The part that exists; empty for the top.
        at: String,
        /// What exists there.
        known: String,
    },
}

/// Place of a setting in words.
fn place(path: &str) -> String {
    if path.is_empty() { "the top".to_owned() } else { format!("`{path}`") }
}
