//! Provenance mark in every file that Chiaroscuro writes, which identifies the file as its own.

use serde_json::Value;

/// Provenance mark: text that other programs would not write.
pub const PROVENANCE_MARK: &str = "Chiaroscuro, the volume viewer";

/// Maximum length of a look as JSON, in bytes: 1 MiB of settings, and 256 KiB of saved views and looks.
pub const MAX_LOOK_BYTES: usize = (1 << 20) + (1 << 18);

/// Returns the provenance mark with the version number.
pub fn provenance_mark() -> String {
    format!("{PROVENANCE_MARK}, {}", env!("CARGO_PKG_VERSION"))
}

/// Adds the provenance mark as the first field of a JSON object.
pub fn with_provenance_mark(tree: Value) -> Value {
    match tree {
        Value::Object(fields) => {
            let mark = ("_made_by".to_owned(), Value::String(provenance_mark()));
            Value::Object(std::iter::once(mark).chain(fields).collect())
        }
        other => other,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn objects_tell_their_maker_first() {
        let told = with_provenance_mark(serde_json::json!({"a": 1})).to_string();
        assert!(
            told.starts_with(&format!(r#"{{"_made_by":"{PROVENANCE_MARK}"#)) && told.ends_with(r#""a":1}"#),
            "{told}"
        );
        assert_eq!(with_provenance_mark(serde_json::json!([1])), serde_json::json!([1]));
    }
}
