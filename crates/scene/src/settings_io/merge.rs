//! Merging of a preset or a session into settings, as JSON.

use serde_json::{Map, Value};

/// Merges a record into settings. Its layer is merged with that of the settings; other lists are replaced.
pub(super) fn merge_record(settings: &mut Value, record: &Value) {
    let merged = match (settings.pointer("/layers/0"), record.get("layers")) {
        (Some(layer), Some(Value::Array(layers))) => match &layers[..] {
            [over] => {
                let mut layer = layer.clone();
                merge(&mut layer, over);
                Some(Value::Array(vec![layer]))
            }
            _ => None,
        },
        _ => None,
    };
    merge(settings, record);
    if let Some(layers) = merged {
        settings["layers"] = layers;
    }
}

/// Merges objects field by field, and replaces everything else.
fn merge(base: &mut Value, overlay: &Value) {
    match (base, overlay) {
        // An enum variant with data is an object with one key: another key replaces it.
        (Value::Object(base), Value::Object(overlay)) if !is_variant_swap(base, overlay) => {
            for (key, value) in overlay {
                merge(base.entry(key.clone()).or_insert(Value::Null), value);
            }
        }
        (base, overlay) => *base = overlay.clone(),
    }
}

/// Returns true for `{"voxels": 1}` over `{"mm": 2}`: two variants of one enum, which must not be merged. Numbers are
/// not variants, but keys of labels.
fn is_variant_swap(base: &Map<String, Value>, overlay: &Map<String, Value>) -> bool {
    let is_variant = |key: Option<&String>| key.is_some_and(|key| key.parse::<i64>().is_err());
    let (before, after) = (base.keys().next(), overlay.keys().next());
    base.len() == 1 && overlay.len() == 1 && before != after && is_variant(before) && is_variant(after)
}
