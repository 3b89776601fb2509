//! The mark that every file of this program carries, by which it is told from files of others.

use serde_json::Value;

/// The mark: words that nobody else would write into a file.
pub const MADE_BY: &str = "Chiaroscuro, the volume viewer";

/// Who made a file, for a text in it.
pub fn made_by() -> String {
    format!("{MADE_BY}, {}", env!("CARGO_PKG_VERSION"))
}

/// A JSON object that says who made it, before anything else.
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
