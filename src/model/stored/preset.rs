//! Settings as JSON: presets, sessions and `--set`.
//!
//! A preset may name only what it cares about; the rest stays as it is. A session names everything.

use serde_json::Value;

use super::renames::{current_path, rename};
use super::schemas::{complete, keep_named_balance};
use crate::model::{SCHEMA, Settings};

/// Why JSON does not become settings.
#[derive(Debug, thiserror::Error)]
pub enum PresetError {
    /// Not JSON at all.
    #[error("not valid JSON: {0}")]
    Syntax(#[source] serde_json::Error),
    /// JSON, but a field has the wrong form.
    #[error("a setting has the wrong form: {0}")]
    Form(#[source] serde_json::Error),
    /// Not an object.
    #[error("a preset must be a JSON object, for instance {{\"shadows\": {{\"strength\": 0.8}}}}")]
    NotAnObject,
    /// `--set` names something that does not exist.
    #[error("there is no setting `{path}`; at `{at}` there are: {known}")]
    UnknownPath {
        /// The whole path.
        path: String,
        /// The part that exists.
        at: String,
        /// What exists there.
        known: String,
    },
}

/// Settings as pretty JSON.
pub fn to_json(settings: &Settings) -> String {
    serde_json::to_string_pretty(settings).unwrap_or_default()
}

/// Lays a JSON object over settings: objects are merged field by field, everything else replaces.
/// Returns the result, in range, and a warning for every field that is not known.
///
/// # Errors
/// When the value is not an object or a field has the wrong type.
pub fn apply_json(settings: &Settings, overlay: &Value) -> Result<(Settings, Vec<String>), PresetError> {
    if !overlay.is_object() {
        return Err(PresetError::NotAnObject);
    }
    let mut overlay = overlay.clone();
    rename("", &mut overlay);
    complete(&mut overlay);
    keep_named_balance(&mut overlay);
    let mut merged = serde_json::to_value(settings).map_err(PresetError::Form)?;
    merge(&mut merged, &overlay);
    let mut result: Settings = serde_json::from_value(merged).map_err(PresetError::Form)?;
    let mut warnings = Vec::new();
    if result.schema > SCHEMA {
        warnings.push(format!("written by a newer version (schema {}, known {SCHEMA})", result.schema));
    }
    result.schema = SCHEMA;
    let understood = serde_json::to_value(&result).map_err(PresetError::Form)?;
    list_unknown(&overlay, &understood, "", &mut warnings);
    result.sanitise();
    Ok((result, warnings))
}

/// Reads a preset or session text and lays it over settings; see [`apply_json`].
///
/// # Errors
/// As [`apply_json`], and when the text is not JSON.
pub fn load_json(settings: &Settings, text: &str) -> Result<(Settings, Vec<String>), PresetError> {
    apply_json(settings, &serde_json::from_str(text).map_err(PresetError::Syntax)?)
}

/// Sets one value by its path (`shadows.strength`, `lights.0.intensity`). The text is read as JSON
/// where it is JSON, else as a string.
///
/// # Errors
/// When the path names nothing or the value has the wrong form.
pub fn apply_path(settings: &Settings, path: &str, text: &str) -> Result<Settings, PresetError> {
    let mut tree = serde_json::to_value(settings).map_err(PresetError::Form)?;
    let mut node = &mut tree;
    let mut walked: Vec<&str> = Vec::new();
    let current = current_path(path);
    for key in current.split('.') {
        let known = match &*node {
            Value::Object(fields) => fields.keys().cloned().collect::<Vec<_>>().join(", "),
            Value::Array(items) => format!("0 … {}", items.len().saturating_sub(1)),
            _ => "nothing further".to_owned(),
        };
        let next = match node {
            Value::Object(fields) => fields.get_mut(key),
            Value::Array(items) => key.parse::<usize>().ok().and_then(|index| items.get_mut(index)),
            _ => None,
        };
        node = next.ok_or_else(|| PresetError::UnknownPath {
            path: path.to_owned(),
            at: walked.join("."),
            known,
        })?;
        walked.push(key);
    }
    *node = serde_json::from_str(text).unwrap_or_else(|_| Value::String(text.to_owned()));
    rename(&current, node);
    let mut result: Settings = serde_json::from_value(tree).map_err(PresetError::Form)?;
    // As in a preset: whoever names the balance means it.
    result.shadows.keep_balanced &= current != "shadows.balance";
    result.sanitise();
    Ok(result)
}

fn merge(base: &mut Value, overlay: &Value) {
    match (base, overlay) {
        // An enum value with a payload is an object with one key: another key replaces it.
        (Value::Object(base), Value::Object(overlay)) if !is_tagged_swap(base, overlay) => {
            for (key, value) in overlay {
                merge(base.entry(key.clone()).or_insert(Value::Null), value);
            }
        }
        (base, overlay) => *base = overlay.clone(),
    }
}

/// `{"voxels": 1}` laid over `{"mm": 2}`: two variants of one enum, which must not be mixed.
fn is_tagged_swap(base: &serde_json::Map<String, Value>, overlay: &serde_json::Map<String, Value>) -> bool {
    base.len() == 1 && overlay.len() == 1 && base.keys().next() != overlay.keys().next()
}

fn list_unknown(given: &Value, understood: &Value, path: &str, warnings: &mut Vec<String>) {
    let (Value::Object(given), Value::Object(understood)) = (given, understood) else { return };
    for (key, value) in given {
        let here = if path.is_empty() { key.clone() } else { format!("{path}.{key}") };
        match understood.get(key) {
            Some(known) => list_unknown(value, known, &here, warnings),
            // Presets may carry remarks under names that begin with an underscore.
            None if key.starts_with('_') => {}
            None => warnings.push(format!("unknown setting `{here}` was ignored")),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{Kernel, Length, LightLock, LightStorage};

    #[test]
    fn round_trip() {
        let mut settings = Settings::default();
        settings.sampling.kernel = Kernel::Gaussian { sigma: 0.55 };
        settings.opacity_unit = Length::Mm(0.3);
        let (back, warnings) = load_json(&Settings::default(), &to_json(&settings)).unwrap();
        assert_eq!(back, settings);
        assert!(warnings.is_empty(), "{warnings:?}");
    }

    #[test]
    fn a_preset_changes_only_what_it_names() {
        let (settings, warnings) =
            load_json(&Settings::default(), r#"{"shadows": {"strength": 0.5, "glow": 1}, "_note": "x"}"#)
                .unwrap();
        assert_eq!(settings.shadows.strength, 0.5);
        assert_eq!(settings.shadows.gain, 1.0);
        assert_eq!(warnings, ["unknown setting `shadows.glow` was ignored"]);
    }

    #[test]
    fn a_balance_that_is_named_stays() {
        let mut kept = Settings::default();
        kept.shadows.keep_balanced = true;
        let keeps = |text: &str| load_json(&kept, text).unwrap().0.shadows.keep_balanced;
        assert!(keeps(r#"{"shadows": {"gain": 2.0}}"#));
        assert!(!keeps(r#"{"shadows": {"balance": 1.0}}"#), "even the one that it has");
        assert!(keeps(r#"{"shadows": {"balance": 1.5, "keep_balanced": true}}"#));
        let set = |path: &str, value: &str| apply_path(&kept, path, value).unwrap().shadows.keep_balanced;
        assert!(!set("shadows.balance", "1.5"));
        assert!(!set("shadows", r#"{"balance": 1.5}"#));
        assert!(set("shadows.gain", "2") && set("shadows.keep_balanced", "true"));
    }

    #[test]
    fn enum_values_replace_each_other() {
        let (settings, _) = load_json(&Settings::default(), r#"{"opacity_unit": {"extent": 0.01}}"#).unwrap();
        assert_eq!(settings.opacity_unit, Length::Extent(0.01));
        let gaussian = r#"{"sampling": {"kernel": {"gaussian": {"sigma": 0.5}}}}"#;
        let (settings, _) = load_json(&settings, gaussian).unwrap();
        assert_eq!(settings.sampling.kernel, Kernel::Gaussian { sigma: 0.5 });
    }

    #[test]
    fn paths_reach_everything_and_name_what_exists() {
        let settings = Settings::default();
        assert_eq!(apply_path(&settings, "lights.0.intensity", "2.5").unwrap().lights[0].intensity, 2.5);
        assert_eq!(apply_path(&settings, "lights.0.name", "Sun").unwrap().lights[0].name, "Sun");
        let err = apply_path(&settings, "shadows.strenght", "1").unwrap_err().to_string();
        assert!(err.contains("shadows") && err.contains("strength"), "{err}");
        assert!(apply_path(&settings, "shadows.strength", "much").is_err());
    }

    #[test]
    fn names_from_before_are_understood() {
        let saved =
            r#"{"ground": {"on": true}, "lights": [{"lock": "world"}], "shadows": {"storage": "collapsed"}}"#;
        let (settings, warnings) = load_json(&Settings::default(), saved).unwrap();
        assert!(settings.floor.on && warnings.is_empty(), "{warnings:?}");
        assert_eq!(settings.shadows.storage, LightStorage::Combined);
        let set = |path: &str, value: &str| apply_path(&Settings::default(), path, value).unwrap();
        assert!(set("ground.on", "true").floor.on && set("ground", r#"{"on": true}"#).floor.on);
        assert_eq!(set("shadows.storage", "collapsed").shadows.storage, LightStorage::Combined);
        assert_eq!(set("lights.0.lock", "world").lights[0].lock, LightLock::Scene);
        assert!(apply_path(&Settings::default(), "ground.colour", "1").is_err());
    }

    #[test]
    fn broken_text_is_refused() {
        for text in ["", "{", "[]", "3", r#"{"lights": 5}"#, r#"{"shadows": {"strength": null}}"#] {
            assert!(load_json(&Settings::default(), text).is_err(), "{text}");
        }
    }
}
