//! JSON format of settings: presets, sessions and `--set`.
//!
//! A preset may contain only some settings; the others stay unchanged. A session contains all of them.

use serde_json::Value;

use super::json_limits::{self, BoundedTree};
use super::layer_fields::{full_path, move_into_layer, names_at_top, short_path};
use super::merge::merge_record;
use super::preset_error::PresetError;
use super::renames::{current_path, rename_old_names};
use super::saved_entries::remove_unreadable_entries;
use super::schema_defaults::{fill_in_defaults, is_about_values, keep_explicit_balance, replaces_labels};
use crate::{LabelLook, LabelTable, MAX_NAME_CHARS, SCHEMA, Settings};
use chiaroscuro_files::sanitised;

/// Largest number of unknown settings that are reported one by one.
const MAX_REPORTED_UNKNOWN: usize = 8;

/// Serialises settings as pretty-printed JSON.
#[cfg(any(test, feature = "testing"))]
pub fn settings_to_json(settings: &Settings) -> String {
    serde_json::to_string_pretty(settings).unwrap_or_default()
}

/// Settings to which something was applied, with warnings about what was not understood.
#[derive(Debug, Clone, PartialEq)]
pub struct AppliedSettings {
    /// Settings after the change, sanitised.
    pub settings: Settings,
    /// Warnings for the user: about what was cut, unknown, or beyond its range.
    pub warnings: Vec<String>,
}

/// Applies a JSON object to settings: objects are merged field by field, everything else is replaced.
///
/// Warnings are about content beyond a look's limits, which was cut, about unknown fields, and a newer version.
///
/// # Errors
/// Returns an error if the value is not an object, a field has the wrong type, or the limits of a look are exceeded.
pub fn apply_json(settings: &Settings, overlay: &Value) -> Result<AppliedSettings, PresetError> {
    if !overlay.is_object() {
        return Err(PresetError::NotAnObject);
    }
    let BoundedTree { tree: mut overlay, cuts: mut warnings } = json_limits::cut_tree(overlay)?;
    rename_old_names("", &mut overlay);
    move_into_layer(&mut overlay);
    fill_in_defaults(&mut overlay);
    warnings.extend(remove_unreadable_entries(&mut overlay));
    keep_explicit_balance(&mut overlay);
    let mut merged = serde_json::to_value(settings).map_err(PresetError::WrongType)?;
    if replaces_labels(&overlay) || is_about_values(&overlay) {
        merged["layers"][0]["labels"] = Value::Object(serde_json::Map::new());
    }
    merge_record(&mut merged, &overlay);
    let mut result: Settings = serde_json::from_value(merged).map_err(PresetError::WrongType)?;
    if result.schema > SCHEMA {
        warnings.push(format!("written by a newer version (schema {}, known {SCHEMA})", result.schema));
    }
    result.schema = SCHEMA;
    let understood = serde_json::to_value(&result).map_err(PresetError::WrongType)?;
    let mut unknown = Vec::new();
    collect_unknown(&overlay, &understood, "", &mut unknown);
    let more = unknown.len().saturating_sub(MAX_REPORTED_UNKNOWN);
    warnings.extend(
        unknown.iter().take(MAX_REPORTED_UNKNOWN).map(|path| format!("unknown setting `{path}` was ignored")),
    );
    warnings.extend((more > 0).then(|| format!("{more} more unknown settings were ignored")));
    result.sanitise();
    let left_out = result.drop_oversized_saved();
    warnings.extend(
        (left_out > 0)
            .then(|| format!("{left_out} saved views or looks were left out: together they are too long")),
    );
    Ok(AppliedSettings { settings: result, warnings })
}

/// Parses a preset or session and applies it to settings; see [`apply_json`].
///
/// # Errors
/// As [`apply_json`], and if the text is not JSON.
#[cfg(any(test, feature = "testing"))]
pub fn load_json(settings: &Settings, text: &str) -> Result<AppliedSettings, PresetError> {
    let BoundedTree { tree, cuts } = json_limits::parse_bounded(text)?;
    let applied = apply_json(settings, &tree)?;
    Ok(AppliedSettings { warnings: [cuts, applied.warnings].concat(), ..applied })
}

/// Sets one value as [`set_value`] does, without its warning.
///
/// # Errors
/// As [`set_value`].
#[cfg(any(test, feature = "testing"))]
pub fn apply_path(settings: &Settings, path: &str, text: &str) -> Result<Settings, PresetError> {
    set_value(settings, path, text).map(|applied| applied.settings)
}

/// Sets one value by its path (`shadows.strength`, `lights.0.intensity`), with a warning if the value was clamped to its
/// range.
///
/// Settings of the first layer have a short path, too: `range` for `layers.0.range`. The text is parsed as JSON, or
/// else taken as a string.
///
/// # Errors
/// Returns an error if the path does not exist or the value has the wrong type.
pub fn set_value(settings: &Settings, path: &str, text: &str) -> Result<AppliedSettings, PresetError> {
    let mut tree = serde_json::to_value(settings).map_err(PresetError::WrongType)?;
    // The schema says how to read a file, and is not a setting of the image.
    tree.as_object_mut().map(|fields| fields.shift_remove("schema"));
    let current = full_path(&current_path(path));
    let short = short_path(&current);
    let number = short.strip_prefix("labels.").and_then(|rest| rest.split('.').next()?.parse::<i64>().ok());
    if let Some(number) = number.filter(|&number| settings.layer().labels.get(number).is_none()) {
        let look = serde_json::to_value(LabelLook::default_for(number)).map_err(PresetError::WrongType)?;
        tree["layers"][0]["labels"][number.to_string()] = look;
    }
    if let Some((parent, key)) = current.rsplit_once('.')
        && is_other_variant(&tree, &json_pointer(parent), key)
        && let Some(node) = tree.pointer_mut(&json_pointer(parent))
    {
        *node = Value::Object(std::iter::once((key.to_owned(), Value::Null)).collect());
    }
    let mut node = &mut tree;
    let mut walked: Vec<&str> = Vec::new();
    for key in current.split('.') {
        let known = match &*node {
            Value::Object(fields) if walked.is_empty() => names_at_top(fields).join(", "),
            Value::Object(fields) => fields.keys().cloned().collect::<Vec<_>>().join(", "),
            Value::Array(items) => format!("0 … {}", items.len().saturating_sub(1)),
            _ => "no further settings".to_owned(),
        };
        let next = match node {
            Value::Object(fields) => fields.get_mut(key),
            Value::Array(items) => key.parse::<usize>().ok().and_then(|index| items.get_mut(index)),
            _ => None,
        };
        node = next.ok_or_else(|| {
            let at = walked.join(".");
            let at = if current == path { at } else { short_path(&at).to_owned() };
            PresetError::UnknownPath { path: path.to_owned(), at, known }
        })?;
        walked.push(key);
    }
    *node = serde_json::from_str(text).unwrap_or_else(|_| Value::String(text.to_owned()));
    rename_old_names(&current, node);
    let mut result: Settings = serde_json::from_value(tree).map_err(PresetError::WrongType)?;
    // As in a preset: a balance that is set explicitly is kept.
    result.shadows.keep_balanced &= current != "shadows.balance";
    if short.split('.').next() == Some("transfer") {
        result.layer_mut().labels = LabelTable::default();
    }
    let requested = setting_value(&result, &current);
    result.sanitise();
    let used = setting_value(&result, &current);
    let warning = (requested != used).then(|| {
        let [asked, used] =
            [requested, used].map(|value| value.map_or_else(|| "nothing".to_owned(), |v| v.to_string()));
        let [asked, used] = [asked, used].map(|value| sanitised(&value, MAX_NAME_CHARS));
        format!("`{path}` is out of range: {asked} was requested, {used} is used")
    });
    Ok(AppliedSettings { settings: result, warnings: warning.into_iter().collect() })
}

/// Returns true if the setting at a path is an enum, and the key is another of its variants. Detected by
/// deserialising an invalid variant: only an enum responds with a list of its variants.
fn is_other_variant(settings: &Value, at: &str, key: &str) -> bool {
    let mut tried = settings.clone();
    let Some(node) = tried.pointer_mut(at).filter(|node| node.get(key).is_none()) else { return false };
    *node = Value::String(INVALID_VARIANT.to_owned());
    serde_json::from_value::<Settings>(tried).is_err_and(|refused| {
        let refused = refused.to_string();
        refused.starts_with(&format!("unknown variant `{INVALID_VARIANT}`"))
            && refused.contains(&format!("`{key}`"))
    })
}

/// Text that is not the name of any enum variant.
const INVALID_VARIANT: &str = "?";

/// Converts a dotted path to a JSON pointer.
fn json_pointer(path: &str) -> String {
    format!("/{}", path.replace('.', "/"))
}

/// Returns the value of a setting by its path, as [`set_value`] takes it; `None` if there is no such setting.
pub fn setting_value(settings: &Settings, path: &str) -> Option<Value> {
    let tree = serde_json::to_value(settings).ok()?;
    tree.pointer(&json_pointer(&full_path(&current_path(path)))).cloned()
}

/// Collects the paths of fields that were given but not understood. Names that begin with an underscore are remarks,
/// which presets may contain.
fn collect_unknown(given: &Value, understood: &Value, path: &str, unknown: &mut Vec<String>) {
    let below = |key: &str| if path.is_empty() { key.to_owned() } else { format!("{path}.{key}") };
    match (given, understood) {
        (Value::Object(given), Value::Object(understood)) => {
            for (key, value) in given.iter().filter(|(key, _)| !key.starts_with('_')) {
                match understood.get(key) {
                    Some(known) => collect_unknown(value, known, &below(key), unknown),
                    None => unknown.push(sanitised(short_path(&below(key)), MAX_NAME_CHARS)),
                }
            }
        }
        (Value::Array(given), Value::Array(understood)) => {
            for (at, (value, known)) in given.iter().zip(understood).enumerate() {
                collect_unknown(value, known, &below(&at.to_string()), unknown);
            }
        }
        _ => {}
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        Camera, DensityRange, LightLock, LightStorage, MAX_LIGHTS, OpacityLength, ReconstructionKernel,
    };
    use chiaroscuro_volume::ValueRange;

    #[test]
    fn round_trip() {
        let mut settings = Settings::default();
        settings.sampling.kernel = ReconstructionKernel::Gaussian { sigma: 0.55 };
        settings.layer_mut().opacity_unit = OpacityLength::Mm(0.3);
        let AppliedSettings { settings: back, warnings } =
            load_json(&Settings::default(), &settings_to_json(&settings)).unwrap();
        assert_eq!(back, settings);
        assert!(warnings.is_empty(), "{warnings:?}");
    }

    #[test]
    fn a_preset_changes_only_what_it_names() {
        let AppliedSettings { settings, warnings } =
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
        let keeps = |text: &str| load_json(&kept, text).unwrap().settings.shadows.keep_balanced;
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
        let settings =
            load_json(&Settings::default(), r#"{"opacity_unit": {"extent": 0.01}}"#).unwrap().settings;
        assert_eq!(settings.layer().opacity_unit, OpacityLength::Extent(0.01));
        let gaussian = r#"{"sampling": {"kernel": {"gaussian": {"sigma": 0.5}}}}"#;
        let settings = load_json(&settings, gaussian).unwrap().settings;
        assert_eq!(settings.sampling.kernel, ReconstructionKernel::Gaussian { sigma: 0.5 });
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
    fn paths_reach_variants_with_numbers() {
        let set = |path: &str, text: &str| apply_path(&Settings::default(), path, text);
        let typed = DensityRange::Typed(ValueRange::new(-100.0, 300.0));
        assert_eq!(set("range.typed", "[-100, 300]").unwrap().layer().range, typed);
        assert_eq!(set("range", r#"{"typed": [-100, 300]}"#).unwrap().layer().range, typed);
        assert_eq!(set("range", "full").unwrap().layer().range, DensityRange::Full);
        assert_eq!(set("opacity_unit.mm", "2").unwrap().layer().opacity_unit, OpacityLength::Mm(2.0));
        let told = set_value(&Settings::default(), "range.typed", "[300, -100]").unwrap();
        assert_eq!((told.settings.layer().range, told.warnings.len()), (typed, 1));
        // From one variant with a number to another.
        let in_mm = set("opacity_unit.mm", "2").unwrap();
        assert_eq!(
            apply_path(&in_mm, "opacity_unit.voxels", "3").unwrap().layer().opacity_unit,
            OpacityLength::Voxels(3.0)
        );
        // An object with one entry, or a string, need not be an enum.
        let mut one_view = Settings::default();
        assert!(one_view.save_view_for_digit(3, "front"));
        let camera = serde_json::to_string(&Camera::default()).unwrap();
        for path in ["kept.5", "sampling.kernel.gaussian.sigmo", "lights.0.name.x", "shadows.strength.x"] {
            let mut settings = one_view.clone();
            settings.sampling.kernel = ReconstructionKernel::Gaussian { sigma: 0.5 };
            let refused = apply_path(&settings, path, &camera).unwrap_err();
            assert!(matches!(refused, PresetError::UnknownPath { .. }), "{path}: {refused}");
        }
        let said = |path: &str| set(path, "1").unwrap_err().to_string();
        assert!(said("schema").contains("; at the top level there are: "), "{}", said("schema"));
        assert!(said("shadows.x").contains("; at `shadows` there are: "), "{}", said("shadows.x"));
        for (path, text) in [("range.robuster", "1"), ("range.typed", "3"), ("lights.0.name.x", "1")] {
            assert!(set(path, text).is_err(), "{path}");
        }
    }

    #[test]
    fn what_is_brought_into_range_is_told_and_the_schema_is_no_setting() {
        let told =
            |path: &str, text: &str| set_value(&Settings::default(), path, text).unwrap().warnings.pop();
        assert_eq!(
            told("shadows.strength", "-1e308").unwrap(),
            "`shadows.strength` is out of range: -1e+308 was requested, 0.0 is used"
        );
        assert_eq!(told("shadows.strength", "0.3"), None);
        assert_eq!(told("output.background.top", "[0.3,1,1]"), None, "32-bit numbers are what they are");
        assert!(told("lights.0.name", &"x".repeat(300)).is_some());
        let refused = apply_path(&Settings::default(), "schema", "99999").unwrap_err().to_string();
        assert!(refused.contains("there is no setting `schema`"), "{refused}");
    }

    #[test]
    fn what_is_unknown_is_named_wherever_it_stands_and_not_without_end() {
        let warnings = |text: &str| load_json(&Settings::default(), text).unwrap().warnings;
        assert_eq!(
            warnings(r#"{"lights": [{"films": 1, "_note": 2}]}"#),
            ["unknown setting `lights.0.films` was ignored"]
        );
        let many: Vec<_> = (0..3000).map(|at| format!("\"k\u{1b}{at}\": 0")).collect();
        let many = format!("{{{}}}", many.join(",").replace('\u{1b}', "\\u001b"));
        let warnings = warnings(&many);
        assert_eq!(warnings.len(), MAX_REPORTED_UNKNOWN + 1);
        assert!(
            warnings[0].contains("k·0") && warnings[MAX_REPORTED_UNKNOWN].starts_with("2992 more"),
            "{warnings:?}"
        );
    }

    #[test]
    fn more_than_a_look_has_is_cut_before_anything_is_made_of_it() {
        let light = r#"{"name": "a"}"#;
        let text = format!(r#"{{"lights": [{}{light}]}}"#, format!("{light},").repeat(60_000));
        let AppliedSettings { settings, warnings } = load_json(&Settings::default(), &text).unwrap();
        assert_eq!((settings.lights.len(), warnings.len()), (MAX_LIGHTS, 1));
        assert_eq!(warnings[0], "60001 entries of `lights` were cut to 8");
        // This holds for an already parsed tree, too.
        let tree = serde_json::from_str(&text).unwrap();
        assert_eq!(apply_json(&Settings::default(), &tree).unwrap(), AppliedSettings { settings, warnings });
    }

    #[test]
    fn names_from_before_are_understood() {
        let saved =
            r#"{"ground": {"on": true}, "lights": [{"lock": "world"}], "shadows": {"storage": "collapsed"}}"#;
        let AppliedSettings { settings, warnings } = load_json(&Settings::default(), saved).unwrap();
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
