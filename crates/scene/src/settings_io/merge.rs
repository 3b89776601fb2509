//! Merging of a preset or a session into settings, as JSON.

use serde_json::{Map, Value};

use crate::VolumeLayer;

/// Merges a record into settings. Its layers are merged with those of the settings, and further ones with the default;
/// a record of one layer, as presets are, leaves the others. Other lists are replaced.
pub(super) fn merge_record(settings: &mut Value, record: &Value) {
    let merged = match (settings.get("layers"), record.get("layers")) {
        (Some(Value::Array(layers)), Some(Value::Array(over))) if !over.is_empty() => {
            Some(Value::Array(merge_layers(layers, over)))
        }
        _ => None,
    };
    merge(settings, record);
    if let Some(layers) = merged {
        settings["layers"] = layers;
    }
}

fn merge_layers(layers: &[Value], over: &[Value]) -> Vec<Value> {
    let default = || serde_json::to_value(VolumeLayer::default()).unwrap_or(Value::Null);
    let merge_one = |(at, over): (usize, &Value)| {
        let mut layer = layers.get(at).cloned().unwrap_or_else(default);
        merge(&mut layer, over);
        layer
    };
    let rest = if over.len() == 1 { layers.get(1..).unwrap_or_default() } else { &[] };
    over.iter().enumerate().map(merge_one).chain(rest.iter().cloned()).collect()
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
