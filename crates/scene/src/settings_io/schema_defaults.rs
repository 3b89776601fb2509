//! Compatibility with earlier schemas: missing settings get the values that were in effect then.

use serde_json::{Map, Value, json};

use super::layer_fields::first_layer;

/// Setting that a schema has added.
struct AddedSetting {
    /// Schema that has added it.
    since: u64,
    group: &'static str,
    setting: &'static str,
    /// Value that was in effect before.
    value: Value,
}

/// Returns the settings that schemas have added.
fn added_settings() -> [AddedSetting; 5] {
    let added = |group, setting, value| AddedSetting { since: 2, group, setting, value };
    [
        added("sampling", "slabs", json!("even")),
        added("shading", "sides", json!("two")),
        added("shadows", "reverse_kernel", json!("forward")),
        added("shadows", "near_field", json!("off")),
        added("shadows", "keep_balanced", json!(false)),
    ]
}

/// Adds to a record with a schema number the values that were in effect for settings it does not have. A preset
/// without a schema number is left unchanged. Settings of a layer are already in the layer.
pub(super) fn fill_in_defaults(record: &mut Value) {
    let Some(schema) = record.get("schema").and_then(Value::as_u64) else { return };
    let Value::Object(groups) = record else { return };
    let kept = groups.get_mut("kept").and_then(Value::as_array_mut);
    for what in kept.into_iter().flatten().filter_map(|kept| kept.get_mut("what")) {
        if let Some(camera) = what.get_mut("view") {
            fill_in_camera(camera);
        }
        // A saved look has its own schema number.
        if let Some(look) = what.get_mut("look") {
            fill_in_defaults(look);
        }
    }
    if let Some(camera) = groups.get_mut("camera") {
        fill_in_camera(camera);
    }
    let layers = groups.get_mut("layers").and_then(Value::as_array_mut);
    layers.into_iter().flatten().filter_map(Value::as_object_mut).for_each(fill_in_range);
    let missing = added_settings().into_iter().filter(|added| schema < added.since);
    for AddedSetting { group, setting, value, .. } in missing {
        let group = groups.entry(group).or_insert_with(|| Value::Object(Map::new()));
        if let Value::Object(group) = group {
            group.entry(setting).or_insert(value);
        }
    }
    if schema < 2 {
        fill_in_scatter_gradients(groups);
    }
    fill_in_exposure(groups);
    fill_in_antialiasing(groups);
}

/// Sets one ray per pixel in the record of an image from before antialiasing, so that the image can be reproduced.
fn fill_in_antialiasing(groups: &mut Map<String, Value>) {
    if groups.contains_key("_picture")
        && let Some(Value::Object(output)) = groups.get_mut("output")
    {
        output.entry("antialiasing").or_insert(json!(1));
    }
}

/// Sets the exposure to 1 in a record from before it was a setting, if it has all other output settings of that time:
/// the automatic look to which it is applied may have another exposure.
fn fill_in_exposure(groups: &mut Map<String, Value>) {
    if let Some(Value::Object(output)) = groups.get_mut("output")
        && output.contains_key("tone_map")
        && output.contains_key("background")
    {
        output.entry("exposure").or_insert(json!(1.0));
    }
}

/// Sets normals of scattered sheets to come from sheets, regardless of the setting: earlier versions ignored it.
fn fill_in_scatter_gradients(groups: &mut Map<String, Value>) {
    if let Some(Value::Object(sampling)) = groups.get_mut("sampling")
        && sampling.get("engine") == Some(&Value::from("scatter"))
    {
        sampling.insert("gradients".to_owned(), Value::from("sheets"));
    }
}

/// Sets the density range to all values of the file for a layer that has a transfer function, but no range: all looks
/// did so before it was a setting. A layer with neither is left unchanged.
fn fill_in_range(layer: &mut Map<String, Value>) {
    if layer.contains_key("transfer") {
        layer.entry("range").or_insert_with(|| Value::from("full"));
    }
}

/// Returns true if a record replaces the label table instead of merging with it: a session contains every label of
/// its look.
pub(super) fn replaces_labels(record: &Value) -> bool {
    first_layer(record).is_some_and(|layer| layer.get("labels").is_some()) && record.get("schema").is_some()
}

/// Returns true if a record is about values, not labels: it has a transfer function. So had all records before label
/// tables existed.
pub(super) fn is_about_values(record: &Value) -> bool {
    first_layer(record)
        .is_some_and(|layer| layer.get("labels").is_none() && layer.pointer("/transfer/points").is_some())
}

/// Adds the defaults of earlier versions to a camera. One with a distance refers its field of view to the height: the
/// distance frames the object, but not in which frame. One with an azimuth gets z up. All cameras of schema 1 need
/// this, and those of schema 2 from before the settings existed.
fn fill_in_camera(camera: &mut Value) {
    if let Value::Object(camera) = camera
        && camera.contains_key("distance")
    {
        camera.entry("fit").or_insert_with(|| Value::String("height".to_owned()));
    }
    if let Value::Object(camera) = camera
        && camera.contains_key("azimuth_deg")
    {
        camera.entry("up").or_insert_with(|| Value::String("plus_z".to_owned()));
    }
}

/// Turns off automatic balancing if a preset or record sets the balance, unless it also sets `keep_balanced`: an
/// explicit number is meant to stay.
pub(super) fn keep_explicit_balance(record: &mut Value) {
    if let Some(Value::Object(shadows)) = record.get_mut("shadows")
        && shadows.contains_key("balance")
    {
        shadows.entry("keep_balanced").or_insert(Value::Bool(false));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        Camera, DensityRange, FovReference, GradientSource, LabelLook, LabelTable, LitSides, NearFieldRay,
        ReverseKernel, SCHEMA, Settings, apply_path, load_json, settings_to_json,
    };

    #[test]
    fn what_was_saved_looks_as_it_did() {
        let load = |text: &str| load_json(&Settings::default(), text).expect("settings").settings;
        let old = load(r#"{"schema": 1, "shadows": {"gain": 2.0}}"#);
        assert_eq!(old.shading.sides, LitSides::Two);
        assert_eq!(old.shadows.reverse_kernel, ReverseKernel::Forward);
        assert_eq!(old.shadows.near_field, NearFieldRay::Off);
        let mut kept = Settings::default();
        kept.shadows.keep_balanced = true;
        assert!(!load_json(&kept, r#"{"schema": 1}"#).expect("settings").settings.shadows.keep_balanced);
        assert!(load_json(&kept, r#"{"schema": 2}"#).expect("settings").settings.shadows.keep_balanced);
        assert_eq!((old.shadows.gain, old.schema), (2.0, SCHEMA));
        let scattered = load(r#"{"schema": 1, "sampling": {"engine": "scatter", "gradients": "volume"}}"#);
        assert_eq!(scattered.sampling.gradients, GradientSource::Sheets);
        // Explicit settings take precedence, and a record without a schema is not completed.
        assert_eq!(load(r#"{"schema": 1, "shading": {"sides": "one"}}"#).shading.sides, LitSides::One);
        assert_eq!(load(r#"{"shadows": {"gain": 2.0}}"#).shadows.near_field, NearFieldRay::Short);
        assert_eq!(load(r#"{"schema": 2}"#), Settings::default());
    }

    #[test]
    fn saved_pictures_are_as_bright_as_they_were() {
        let mut now = Settings::default();
        now.output.exposure = 1.7;
        let exposure = |text: &str| load_json(&now, text).expect("settings").settings.output.exposure;
        let mut saved = serde_json::to_value(Settings::default()).expect("settings");
        saved["output"].as_object_mut().expect("an object").remove("exposure");
        assert_eq!(exposure(&saved.to_string()), 1.0);
        saved["output"]["exposure"] = serde_json::json!(0.5);
        assert_eq!(exposure(&saved.to_string()), 0.5);
        // A record without output settings keeps the current exposure.
        assert_eq!(exposure(r#"{"schema": 2, "output": {"tone_map": "clip"}}"#), 1.7);
        assert_eq!(exposure(r#"{"schema": 2}"#), 1.7);
    }

    #[test]
    fn images_from_before_antialiasing_are_reproduced_without() {
        let rays = |text: &str| {
            let record = crate::LookRecord::parse(text).expect("a record");
            let applied = record.apply(&Settings::default(), &chiaroscuro_volume::ValueRanges::UNIT);
            applied.expect("settings").settings.output.antialiasing
        };
        let image =
            r#""_picture": {"size": [4, 3], "transparent": false, "version": "0.1.0", "adapter": "x"}"#;
        assert_eq!(rays(&format!(r#"{{"schema": 3, "output": {{"exposure": 2.0}}, {image}}}"#)), 1);
        assert_eq!(rays(&format!(r#"{{"schema": 3, "output": {{"antialiasing": 8}}, {image}}}"#)), 8);
        // Sessions are looked at with antialiasing, and numbers are served by the nearest.
        assert_eq!(rays(r#"{"schema": 3, "output": {"exposure": 2.0}}"#), 4);
        assert_eq!(rays(r#"{"schema": 3, "output": {"antialiasing": 11}}"#), 8);
        assert_eq!(rays(r#"{"schema": 3, "output": {"antialiasing": 0}}"#), 1);
    }

    #[test]
    fn saved_cameras_see_what_they_saw() {
        let mut now = Settings::default();
        now.camera.fit = FovReference::Frame;
        assert!(now.save_view_for_digit(1, "front"));
        let load = |text: &str| load_json(&now, text).expect("settings").settings;
        let before = load(
            r#"{"schema": 2, "camera": {"distance": 4.0}, "views": {"2":
                {"projection": "perspective", "azimuth_deg": 0.0, "elevation_deg": 0.0, "roll_deg": 0.0,
                "target": [0.0, 0.0, 0.0], "distance": 3.0, "fov_y_deg": 30.0}}}"#,
        );
        assert_eq!((before.camera.fit, before.camera.distance), (FovReference::Height, 4.0));
        assert_eq!(before.kept.iter().map(|kept| kept.digit).collect::<Vec<_>>(), [Some(2)]);
        assert!(before.kept.iter().all(|kept| kept.camera().fit == FovReference::Height));
        // A record without a camera leaves the frame, and an explicit frame takes precedence.
        for kept in [
            r#"{"schema": 1, "shadows": {"gain": 2.0}}"#,
            r#"{"schema": 2, "camera": {"azimuth_deg": 10.0}}"#,
            r#"{"camera": {"distance": 4.0}}"#,
            r#"{"schema": 2, "camera": {"distance": 4.0, "fit": "frame"}}"#,
        ] {
            assert_eq!(load(kept).camera.fit, FovReference::Frame, "{kept}");
        }
        // A complete camera, deserialised directly.
        let mut saved = serde_json::to_value(&now.camera).expect("a camera");
        saved.as_object_mut().expect("an object").remove("fit");
        assert_eq!(serde_json::from_value::<Camera>(saved).expect("a camera").fit, FovReference::Height);
    }

    #[test]
    fn saved_looks_show_all_values_as_they_did() {
        let range =
            |text: &str| load_json(&Settings::default(), text).expect("settings").settings.layer().range;
        assert_eq!(range(r#"{"schema": 2, "transfer": {"points": []}}"#), DensityRange::Full);
        assert_eq!(range(r#"{"schema": 1, "transfer": {}}"#), DensityRange::Full);
        // Records without values, with an explicit range, or without a schema.
        for now in [
            r#"{"schema": 2, "shadows": {"gain": 2.0}}"#,
            r#"{"schema": 2, "transfer": {}, "range": "robust"}"#,
            r#"{"transfer": {}}"#,
        ] {
            assert_eq!(range(now), DensityRange::Robust, "{now}");
        }
    }

    #[test]
    fn what_was_saved_of_values_does_not_show_labels() {
        let table: LabelTable =
            [1, 2, 3].map(|number| (number, LabelLook::default_for(number))).into_iter().collect();
        let first = Settings::default().with_labels(table.clone());
        let labels = |text: &str| load_json(&first, text).expect("settings").settings.layer().labels.clone();
        for of_values in [
            r#"{"schema": 2, "transfer": {"points": []}}"#,
            r#"{"transfer": {"points": []}}"#,
            r#"{"schema": 2, "labels": {}}"#,
            r#"{"labels": null}"#,
        ] {
            assert!(labels(of_values).is_empty(), "{of_values}");
        }
        for of_neither in [r#"{"schema": 2, "shadows": {"gain": 2.0}}"#, r#"{"labels": {}}"#] {
            assert_eq!(labels(of_neither), table, "{of_neither}");
        }
        // A session replaces the label table; a preset merges its entries.
        assert_eq!(labels(r#"{"schema": 2, "labels": {"9": {}}, "transfer": {"points": []}}"#).len(), 1);
        assert_eq!(labels(r#"{"labels": {"9": {}}}"#).len(), 4);
        let kept = load_json(&Settings::default(), &settings_to_json(&first)).expect("settings").settings;
        assert_eq!(kept, first);
        // Setting the curve explicitly discards labels.
        let curve = apply_path(&first, "transfer.interpolation", "extinction").expect("settings");
        assert!(curve.layer().labels.is_empty());
        assert!(!apply_path(&first, "shadows.gain", "2").expect("settings").layer().labels.is_empty());
    }

    #[test]
    fn nonsense_is_left_to_whoever_reads_it() {
        let mut nonsense = serde_json::json!({"schema": 1, "shadows": 3});
        fill_in_defaults(&mut nonsense);
        assert_eq!(nonsense["shadows"], 3);
        let mut nonsense = serde_json::json!({"schema": 2, "camera": [], "kept": [{"what": {"look": 3}}, 1]});
        fill_in_defaults(&mut nonsense);
        assert_eq!(nonsense["camera"], serde_json::json!([]));
    }
}
