//! Unknown content of a record: remarks of other programs, and settings of other versions. It is preserved when the
//! record is saved again.

use serde_json::{Map, Value};

/// Remarks of this program, which are not preserved: they are rewritten, or hold only for the record that was read.
const OWN_REMARKS: [&str; 4] = ["_volume", "_picture", "_values", "_made_by"];

/// Returns the content of a record that was not understood; null if there is none.
pub(super) fn unknown_content(given: &Value, understood: &Value) -> Value {
    let is_ours = |name: &str| OWN_REMARKS.contains(&name);
    match difference(given, understood) {
        Value::Object(fields) => {
            let fields: Map<_, _> = fields.into_iter().filter(|(name, _)| !is_ours(name)).collect();
            if fields.is_empty() { Value::Null } else { Value::Object(fields) }
        }
        _ => Value::Null,
    }
}

/// Returns the parts of a value that have no counterpart in another.
fn difference(given: &Value, understood: &Value) -> Value {
    match (given, understood) {
        (Value::Object(given), Value::Object(understood)) => {
            let parts = given.iter().map(|(name, value)| {
                let part =
                    understood.get(name).map_or_else(|| value.clone(), |known| difference(value, known));
                (name.clone(), part)
            });
            let parts: Map<_, _> = parts.filter(|(_, part)| !part.is_null()).collect();
            if parts.is_empty() { Value::Null } else { Value::Object(parts) }
        }
        // List items are matched by position.
        (Value::Array(given), Value::Array(understood)) if given.len() == understood.len() => {
            let parts: Vec<_> =
                given.iter().zip(understood).map(|(given, known)| difference(given, known)).collect();
            if parts.iter().all(Value::is_null) { Value::Null } else { Value::Array(parts) }
        }
        _ => Value::Null,
    }
}

/// Adds unknown content to a tree; existing fields take precedence.
pub(super) fn merge_unknown(tree: &mut Value, unknown: &Value) {
    match (tree, unknown) {
        (Value::Object(tree), Value::Object(unknown)) => {
            for (name, value) in unknown {
                match tree.get_mut(name) {
                    Some(known) => merge_unknown(known, value),
                    None => drop(tree.insert(name.clone(), value.clone())),
                }
            }
        }
        // After items were added or removed, positions no longer match.
        (Value::Array(tree), Value::Array(unknown)) if tree.len() == unknown.len() => {
            tree.iter_mut().zip(unknown).for_each(|(known, value)| merge_unknown(known, value));
        }
        _ => {}
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn what_is_not_known_survives_and_what_is_known_is_as_it_is_now() {
        let given = json!({
            "schema": 2, "_notes": "mine", "_volume": {"source": "a"}, "future": {"a": [1, null]},
            "shadows": {"gain": 2.0, "glow": 3}, "lights": [{"on": true, "halo": 1}, {"on": true}],
        });
        let understood = json!({
            "schema": 2, "shadows": {"gain": 2.0, "bias": 0.0}, "lights": [{"on": true}, {"on": true}],
        });
        let unknown = unknown_content(&given, &understood);
        let expected = json!({
            "_notes": "mine", "future": {"a": [1, null]},
            "shadows": {"glow": 3}, "lights": [{"halo": 1}, null],
        });
        assert_eq!(unknown, expected);
        let mut written = json!({"shadows": {"gain": 1.0}, "lights": [{"on": false}, {"on": true}]});
        merge_unknown(&mut written, &unknown);
        let expected = json!({
            "shadows": {"gain": 1.0, "glow": 3}, "lights": [{"on": false, "halo": 1}, {"on": true}],
            "_notes": "mine", "future": {"a": [1, null]},
        });
        assert_eq!(written, expected);
        let mut fewer = json!({"lights": [{"on": true}]});
        merge_unknown(&mut fewer, &json!({"lights": [{"halo": 1}, null]}));
        assert_eq!(fewer, json!({"lights": [{"on": true}]}));
        assert_eq!(unknown_content(&understood, &understood), Value::Null);
    }
}
