//! Short form of the first layer's settings: at the top level, where files had them before schema 3, and where presets
//! and paths of `--set` may have them.

use serde_json::{Map, Value};

/// Settings of a layer that are found at the top level, too.
const LAYER_FIELDS: [&str; 10] = [
    "range",
    "labels",
    "transfer",
    "lighting",
    "opacity_unit",
    "visibility",
    "blend",
    "edges",
    "materials",
    "ignores_cuts",
];

/// Path of the first layer, before the path of a setting in it.
const FIRST_LAYER: &str = "layers.0.";

/// Returns true if a path begins at a setting of a layer.
fn begins_in_layer(path: &str) -> bool {
    path.split('.').next().is_some_and(|first| LAYER_FIELDS.contains(&first))
}

/// Returns the full path of a setting that may be given by its short one.
pub(super) fn full_path(path: &str) -> String {
    if begins_in_layer(path) { format!("{FIRST_LAYER}{path}") } else { path.to_owned() }
}

/// Returns the short path of a setting of the first layer, and other paths as they are.
pub(super) fn short_path(path: &str) -> &str {
    path.strip_prefix(FIRST_LAYER).filter(|short| begins_in_layer(short)).unwrap_or(path)
}

/// Returns the names at the top level: those of the settings, and the short ones of the first layer's.
pub(super) fn names_at_top(settings: &Map<String, Value>) -> Vec<String> {
    let names = |key: &String| {
        let short: &[&str] = if key == "layers" { &LAYER_FIELDS } else { &[] };
        [key.as_str()].into_iter().chain(short.iter().copied()).map(str::to_owned).collect::<Vec<_>>()
    };
    settings.keys().flat_map(names).collect()
}

/// Moves settings of the first layer from the top level of a record, and of the looks that it has saved, into the
/// layer. What is already there counts. A record with another number of layers is left to be refused.
pub(super) fn move_into_layer(record: &mut Value) {
    let Value::Object(fields) = record else { return };
    let saved = fields.get_mut("kept").and_then(Value::as_array_mut).into_iter().flatten();
    for look in saved.filter_map(|entry| entry.pointer_mut("/what/look")) {
        move_fields(look);
    }
    move_fields(record);
}

fn move_fields(look: &mut Value) {
    let Value::Object(fields) = look else { return };
    if !LAYER_FIELDS.iter().any(|name| fields.contains_key(*name)) {
        return;
    }
    let layers = fields.entry("layers").or_insert_with(|| Value::Array(vec![Value::Object(Map::new())]));
    let Value::Array(items) = layers else { return };
    let [Value::Object(layer)] = &mut items[..] else { return };
    let mut layer = std::mem::take(layer);
    for name in LAYER_FIELDS {
        if let Some(value) = fields.shift_remove(name) {
            layer.entry(name).or_insert(value);
        }
    }
    fields.insert("layers".to_owned(), Value::Array(vec![Value::Object(layer)]));
}

/// Returns the first layer of a record, if it has settings of it.
pub(super) fn first_layer(record: &Value) -> Option<&Value> {
    record.pointer("/layers/0")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{AppliedSettings, SCHEMA, Settings, VolumeLayer, apply_path, load_json, settings_to_json};
    use serde_json::json;

    #[test]
    fn every_setting_of_a_layer_has_a_short_path() {
        let layer = serde_json::to_value(VolumeLayer::default()).unwrap();
        assert!(layer.as_object().unwrap().keys().eq(LAYER_FIELDS));
        for (short, full) in [
            ("transfer.points.0", "layers.0.transfer.points.0"),
            ("range", "layers.0.range"),
            ("ranges", "ranges"),
            ("camera.distance", "camera.distance"),
            ("layers.0.labels.3", "layers.0.labels.3"),
        ] {
            assert_eq!(full_path(short), full);
        }
        assert_eq!(short_path("layers.0.labels.3"), "labels.3");
        assert_eq!(short_path("layers.0.name"), "layers.0.name");
        assert_eq!(short_path("layers.1.labels"), "layers.1.labels");
    }

    #[test]
    fn settings_of_files_before_layers_are_moved_into_the_first() {
        let mut before = json!({
            "schema": 2, "transfer": {"points": []}, "camera": {}, "range": "full",
            "kept": [{"what": {"look": {"opacity_unit": {"mm": 2}}}}, {"what": {"view": {"range": 3}}}, 1],
        });
        move_into_layer(&mut before);
        let after = json!({
            "schema": 2, "layers": [{"range": "full", "transfer": {"points": []}}], "camera": {},
            "kept": [
                {"what": {"look": {"layers": [{"opacity_unit": {"mm": 2}}]}}}, {"what": {"view": {"range": 3}}}, 1
            ],
        });
        assert_eq!(before, after);
        let mut both = json!({"layers": [{"range": "full"}], "range": "robust"});
        move_into_layer(&mut both);
        assert_eq!(both, json!({"layers": [{"range": "full"}]}), "what is newer counts");
        for odd in [json!({"layers": [], "range": "full"}), json!({"layers": 3, "range": "full"}), json!(3)] {
            let mut moved = odd.clone();
            move_into_layer(&mut moved);
            assert_eq!(moved, odd);
        }
    }

    /// Settings that differ from the defaults in everything that a layer has.
    fn changed() -> Settings {
        let mut settings = Settings::default();
        for (path, value) in [
            ("range.typed", "[-3, 7]"),
            ("transfer.points", r#"[{"value": 1, "color": [1, 0, 0], "opacity": 0.5}]"#),
            ("lighting.scale", "0.25"),
            ("layers.0.opacity_unit.mm", "2"),
            ("labels.17.visible", "false"),
            ("shadows.gain", "2"),
        ] {
            settings = apply_path(&settings, path, value).unwrap();
        }
        let look = crate::SavedEntry::look("a", &settings);
        assert!(settings.save_entry(look));
        settings
    }

    /// Returns settings as files of an earlier schema have them, with the names of the first layer at the top level.
    fn as_written_before(settings: &Settings, schema: u64) -> Value {
        fn flatten(look: &mut Value, schema: u64) {
            let Value::Object(fields) = look else { panic!("an object") };
            let Some(Value::Array(layers)) = fields.shift_remove("layers") else { panic!("a list") };
            fields.extend(layers[0].as_object().unwrap().clone());
            fields.insert("schema".to_owned(), schema.into());
        }
        let mut tree = serde_json::to_value(settings).unwrap();
        flatten(&mut tree, schema);
        flatten(&mut tree["kept"][0]["what"]["look"], schema);
        tree
    }

    fn without_warnings(settings: &Settings) -> AppliedSettings {
        AppliedSettings { settings: settings.clone(), warnings: Vec::new() }
    }

    #[test]
    fn looks_of_every_schema_are_the_same_look() {
        let settings = changed();
        for schema in [1, 2] {
            let before = as_written_before(&settings, schema);
            assert!(before.get("layers").is_none() && before["transfer"].is_object());
            let read = load_json(&Settings::default(), &before.to_string()).unwrap();
            assert_eq!(read, without_warnings(&settings), "schema {schema}");
        }
        let text = settings_to_json(&settings);
        let tree: Value = serde_json::from_str(&text).unwrap();
        assert_eq!((&tree["schema"], SCHEMA), (&json!(3), 3));
        assert_eq!(tree["layers"][0]["range"], json!({"typed": [-3.0, 7.0]}));
        assert_eq!(tree["kept"][0]["what"]["look"]["layers"][0]["lighting"]["scale"], 0.25);
        assert!(LAYER_FIELDS.iter().all(|name| tree.get(name).is_none()));
        assert_eq!(load_json(&Settings::default(), &text).unwrap(), without_warnings(&settings));
    }

    #[test]
    fn parts_of_a_layer_change_only_what_they_name() {
        let settings = changed();
        let laid_over = |text: &str| load_json(&settings, text).unwrap();
        let expected = settings.clone().with_opacity_unit(crate::OpacityLength::Voxels(3.0));
        for part in [
            r#"{"opacity_unit": {"voxels": 3}}"#,
            r#"{"layers": [{"opacity_unit": {"voxels": 3}}]}"#,
            r#"{"layers": [{}], "opacity_unit": {"voxels": 3}}"#,
        ] {
            assert_eq!(laid_over(part), without_warnings(&expected), "{part}");
        }
        assert_eq!(laid_over(r#"{"layers": [{}]}"#), without_warnings(&settings));
        for (part, unknown) in [
            (r#"{"transfer": {"glow": 1}}"#, "transfer.glow"),
            (r#"{"layers": [{"glow": 1}]}"#, "layers.0.glow"),
        ] {
            assert_eq!(laid_over(part).warnings, [format!("unknown setting `{unknown}` was ignored")]);
        }
    }

    #[test]
    fn other_numbers_of_layers_are_refused() {
        let refused = |text: &str| load_json(&Settings::default(), text).unwrap_err().to_string();
        assert!(refused(r#"{"layers": []}"#).contains("`layers` is empty"));
        let five = refused(r#"{"schema": 4, "layers": [{}, {}, {}, {}, {}]}"#);
        assert!(five.contains("`layers` has 5 layers, and a picture shows 4 at most"), "{five}");
        assert!(!refused(r#"{"layers": 3}"#).is_empty() && !refused(r#"{"layers": null}"#).is_empty());
        let newer =
            load_json(&Settings::default(), r#"{"schema": 4, "layers": [{"range": "full"}]}"#).unwrap();
        assert_eq!(newer.warnings, ["written by a newer version (schema 4, known 3)"]);
        let set = apply_path(&Settings::default(), "layers", "[]").unwrap_err().to_string();
        assert!(set.contains("`layers` is empty"), "{set}");
    }

    #[test]
    fn paths_may_be_short_or_full_and_errors_are_as_typed() {
        let set = |path: &str, value: &str| apply_path(&Settings::default(), path, value);
        for (path, value) in
            [("transfer.mixing", "seen"), ("labels.3.visible", "false"), ("range.typed", "[1,2]")]
        {
            let (short, full) = (set(path, value).unwrap(), set(&format!("layers.0.{path}"), value).unwrap());
            assert!(short == full && short != Settings::default(), "{path}");
        }
        let told = |path: &str| set(path, "1").unwrap_err().to_string();
        assert!(
            told("transfer.glow").contains("no setting `transfer.glow`; at `transfer` there are: points")
        );
        assert!(told("layers.0.transfer.glow").contains("; at `layers.0.transfer` there are: points"));
        assert!(told("layers.1.range").contains("; at `layers` there are: 0 … 0"));
        assert!(
            told("glow")
                .contains(": camera, lights, layers, range, labels, transfer, lighting, opacity_unit, ")
        );
        let curve =
            apply_path(&set("labels.3.visible", "false").unwrap(), "layers.0.transfer.mixing", "seen");
        assert!(curve.unwrap().layer().labels.is_empty());
    }
}
