//! Provenance mark in every file that Chiaroscuro writes, which identifies the file as its own.

use serde_json::Value;

/// Provenance mark: text that other programs would not write.
pub const MADE_BY: &str = "Chiaroscuro, the volume viewer";

/// Returns the provenance mark with the version number.
pub fn made_by() -> String {
    format!("{MADE_BY}, {}", env!("CARGO_PKG_VERSION"))
}

/// Adds the provenance mark as the first field of a JSON object.
pub fn tells_maker(tree: Value) -> Value {
    match tree {
        Value::Object(fields) => {
            let mark = ("_made_by".to_owned(), Value::String(made_by()));
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
        let told = tells_maker(serde_json::json!({"a": 1})).to_string();
        assert!(
            told.starts_with(&format!(r#"{{"_made_by":"{MADE_BY}"#)) && told.ends_with(r#""a":1}"#),
            "{told}"
        );
        assert_eq!(tells_maker(serde_json::json!([1])), serde_json::json!([1]));
    }
}
