//! Renamed settings: conversion of old names in files and paths.

use serde_json::{Map, Value, json};

use crate::{Camera, FovReference};

/// Renamed fields by path: (before, now).
const FIELDS: [(&str, &str); 1] = [("ground", "floor")];

/// Renamed values: (path of the setting with its current name, before, now). `*` matches any item of a list.
const VALUES: [(&str, &str, &str); 2] =
    [("lights.*.lock", "world", "scene"), ("shadows.storage", "collapsed", "combined")];

/// Returns the current path of a setting.
pub(super) fn current_path(path: &str) -> String {
    for (before, now) in FIELDS {
        match path.strip_prefix(before) {
            Some("") => return now.to_owned(),
            Some(rest) if rest.starts_with('.') => return format!("{now}{rest}"),
            _ => {}
        }
    }
    path.to_owned()
}

/// Converts views of the old format, which had digit keys and no names, to saved views, in the order of their digits.
fn convert_old_views(fields: &mut Map<String, Value>) {
    let Some(Value::Object(views)) = fields.get("views") else { return };
    let mut views: Vec<(u8, Value)> = views
        .iter()
        .filter_map(|(digit, camera)| Some((digit.parse().ok()?, camera.clone())))
        .filter(|(_, camera)| camera.is_object())
        .collect();
    views.sort_by_key(|(digit, _)| *digit);
    let kept = views.into_iter().map(|(digit, camera)| {
        // Missing fields get their defaults, but the field of view refers to the height.
        let mut whole = serde_json::to_value(Camera { fit: FovReference::Height, ..Camera::default() })
            .unwrap_or_default();
        if let (Value::Object(whole), Value::Object(camera)) = (&mut whole, camera) {
            whole.extend(camera);
        }
        json!({"name": format!("View {digit}"), "digit": digit, "what": {"view": whole}})
    });
    let kept = Value::Array(kept.collect());
    fields.remove("views");
    fields.entry("kept").or_insert(kept);
}

/// Replaces old names in a value at a path, recursively.
pub(super) fn rename_old_names(path: &str, value: &mut Value) {
    if let (true, Value::Object(fields)) = (path.is_empty(), &mut *value) {
        convert_old_views(fields);
    }
    let below = |key: &str| if path.is_empty() { key.to_owned() } else { format!("{path}.{key}") };
    match value {
        Value::Object(fields) => {
            let before = std::mem::take(fields);
            for (key, mut value) in before {
                let now = current_path(&below(&key));
                rename_old_names(&now, &mut value);
                let key = now.rsplit('.').next().unwrap_or(&now).to_owned();
                fields.insert(key, value);
            }
        }
        Value::Array(items) => items.iter_mut().for_each(|item| rename_old_names(&below("*"), item)),
        Value::String(text) => {
            let is_here = |pattern: &str| path_matches(pattern, path);
            let known = VALUES.iter().find(|(pattern, before, _)| is_here(pattern) && before == text);
            if let Some((.., now)) = known {
                (*now).clone_into(text);
            }
        }
        Value::Null | Value::Bool(_) | Value::Number(_) => {}
    }
}

/// Returns true if a path matches a pattern.
fn path_matches(pattern: &str, path: &str) -> bool {
    let is_item = |part: &str| part == "*" || part.parse::<usize>().is_ok();
    pattern.split('.').count() == path.split('.').count()
        && pattern
            .split('.')
            .zip(path.split('.'))
            .all(|(pattern, part)| pattern == part || pattern == "*" && is_item(part))
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn fields_and_values_get_their_present_names() {
        let mut saved = json!({
            "ground": {"on": true, "height": -1.0},
            "lights": [{"lock": "world", "name": "world"}, {"lock": "camera"}],
            "shadows": {"storage": "collapsed"},
            "_note": "world",
        });
        rename_old_names("", &mut saved);
        let now = json!({
            "floor": {"on": true, "height": -1.0},
            "lights": [{"lock": "scene", "name": "world"}, {"lock": "camera"}],
            "shadows": {"storage": "combined"},
            "_note": "world",
        });
        assert_eq!(saved, now);
    }

    #[test]
    fn views_of_digits_are_kept_in_their_order() {
        let mut saved = json!({"views": {"7": {"distance": 2.0}, "3": {"distance": 3.0}, "x": {}, "4": 1}});
        rename_old_names("", &mut saved);
        let kept: Vec<crate::SavedEntry> = serde_json::from_value(saved["kept"].clone()).unwrap();
        let found: Vec<_> = kept.iter().map(|kept| (kept.name.as_str(), kept.camera().distance)).collect();
        assert_eq!(found, [("View 3", 3.0), ("View 7", 2.0)]);
        assert!(saved.get("views").is_none());
        let mut both = json!({"views": {"7": {}}, "kept": []});
        rename_old_names("", &mut both);
        assert_eq!(both, json!({"kept": []}), "what is newer counts");
    }

    #[test]
    fn paths_get_their_present_names() {
        assert_eq!(current_path("ground"), "floor");
        assert_eq!(current_path("ground.on"), "floor.on");
        assert_eq!(current_path("grounds.on"), "grounds.on");
        let mut value = json!("world");
        rename_old_names("lights.3.lock", &mut value);
        assert_eq!(value, json!("scene"));
    }
}
