//! What earlier schemas did where there was nothing to set yet: what was saved looks as it looked then.

use serde_json::{Map, Value, json};

/// Settings that came with a schema, and what schemas before it did: (schema, group, setting, value).
fn added() -> [(u64, &'static str, &'static str, Value); 5] {
    [
        (2, "sampling", "slabs", json!("even")),
        (2, "shading", "sides", json!("two")),
        (2, "shadows", "reverse_kernel", json!("forward")),
        (2, "shadows", "near_field", json!("off")),
        (2, "shadows", "keep_balanced", json!(false)),
    ]
}

/// Adds to a record that names its schema what that schema did, for every setting that it did not have. A preset
/// that names no schema is of none: it leaves open what it does not name.
pub(super) fn complete(record: &mut Value) {
    let Some(schema) = record.get("schema").and_then(Value::as_u64) else { return };
    let Value::Object(groups) = record else { return };
    for (_, group, setting, value) in added().into_iter().filter(|(since, ..)| schema < *since) {
        let group = groups.entry(group).or_insert_with(|| Value::Object(Map::new()));
        if let Value::Object(group) = group {
            group.entry(setting).or_insert(value);
        }
    }
}

/// Lets a balance be that a preset or record names: unless it also says that the balance is to be kept, whoever wrote
/// it means the number.
pub(super) fn keep_named_balance(record: &mut Value) {
    if let Some(Value::Object(shadows)) = record.get_mut("shadows")
        && shadows.contains_key("balance")
    {
        shadows.entry("keep_balanced").or_insert(Value::Bool(false));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{NearField, ReverseKernel, SCHEMA, Settings, Sides, load_json};

    #[test]
    fn what_was_saved_looks_as_it_did() {
        let load = |text: &str| load_json(&Settings::default(), text).expect("settings").0;
        let old = load(r#"{"schema": 1, "shadows": {"gain": 2.0}}"#);
        assert_eq!(old.shading.sides, Sides::Two);
        assert_eq!(old.shadows.reverse_kernel, ReverseKernel::Forward);
        assert_eq!(old.shadows.near_field, NearField::Off);
        let mut kept = Settings::default();
        kept.shadows.keep_balanced = true;
        assert!(!load_json(&kept, r#"{"schema": 1}"#).expect("settings").0.shadows.keep_balanced);
        assert!(load_json(&kept, r#"{"schema": 2}"#).expect("settings").0.shadows.keep_balanced);
        assert_eq!((old.shadows.gain, old.schema), (2.0, SCHEMA));
        // What it names all the same counts, and so does what has no schema.
        assert_eq!(load(r#"{"schema": 1, "shading": {"sides": "one"}}"#).shading.sides, Sides::One);
        assert_eq!(load(r#"{"shadows": {"gain": 2.0}}"#).shadows.near_field, NearField::Short);
        assert_eq!(load(r#"{"schema": 2}"#), Settings::default());
        // Nonsense is left to whoever reads it.
        let mut nonsense = serde_json::json!({"schema": 1, "shadows": 3});
        complete(&mut nonsense);
        assert_eq!(nonsense["shadows"], 3);
    }
}
