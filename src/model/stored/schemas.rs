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
    let kept = groups.get_mut("kept").and_then(Value::as_array_mut);
    for what in kept.into_iter().flatten().filter_map(|kept| kept.get_mut("what")) {
        if let Some(camera) = what.get_mut("view") {
            complete_camera(camera);
        }
        // It names the schema that it was written with.
        if let Some(look) = what.get_mut("look") {
            complete(look);
        }
    }
    if let Some(camera) = groups.get_mut("camera") {
        complete_camera(camera);
    }
    complete_range(groups);
    for (_, group, setting, value) in added().into_iter().filter(|(since, ..)| schema < *since) {
        let group = groups.entry(group).or_insert_with(|| Value::Object(Map::new()));
        if let Value::Object(group) = group {
            group.entry(setting).or_insert(value);
        }
    }
    if schema < 2 {
        complete_scattered(groups);
    }
    complete_exposure(groups);
}

/// Exposes as before there was a choice what a record says of the end of a picture, if it says all that there was then:
/// the automatic look that it is laid over may have an exposure of its own.
fn complete_exposure(groups: &mut Map<String, Value>) {
    if let Some(Value::Object(output)) = groups.get_mut("output")
        && output.contains_key("tone_map")
        && output.contains_key("background")
    {
        output.entry("exposure").or_insert(json!(1.0));
    }
}

/// Takes the normals of scattered sheets from sheets, whatever was set: so they were.
fn complete_scattered(groups: &mut Map<String, Value>) {
    if let Some(Value::Object(sampling)) = groups.get_mut("sampling")
        && sampling.get("engine") == Some(&Value::from("scatter"))
    {
        sampling.insert("gradients".to_owned(), Value::from("sheets"));
    }
}

/// Spends densities on all values of the file where a look says what is seen at which value, but not which values that
/// is about: so all looks did before there was a choice. What has neither leaves the range.
fn complete_range(groups: &mut Map<String, Value>) {
    if groups.contains_key("transfer") {
        groups.entry("range").or_insert_with(|| Value::from("full"));
    }
}

/// Whether what a record says of labels is all of it: a session names every label that its look knows, those that it is
/// laid over are others.
pub(super) fn lays_labels_anew(record: &Value) -> bool {
    record.get("labels").is_some() && record.get("schema").is_some()
}

/// Whether a record is about values, and not about labels: it says what is seen at which
/// value. So were all before there were tables of labels.
pub(super) fn shows_values(record: &Value) -> bool {
    record.get("labels").is_none() && record.pointer("/transfer/points").is_some()
}

/// Gives the angle of view of a camera to the picture's height, if it says how far away the eye is, which frames
/// what is seen, and not what it is framed in; and its z up, if it says from where it looks: all cameras of schema 1
/// are so, and those of schema 2 from before there was a choice.
fn complete_camera(camera: &mut Value) {
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
    use crate::model::{
        Camera, DensityRange, Fit, Gradients, LabelLook, LabelTable, NearField, ReverseKernel, SCHEMA,
        Settings, Sides, apply_path, load_json, to_json,
    };

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
        let scattered = load(r#"{"schema": 1, "sampling": {"engine": "scatter", "gradients": "volume"}}"#);
        assert_eq!(scattered.sampling.gradients, Gradients::Sheets);
        // What it names all the same counts, and so does what has no schema.
        assert_eq!(load(r#"{"schema": 1, "shading": {"sides": "one"}}"#).shading.sides, Sides::One);
        assert_eq!(load(r#"{"shadows": {"gain": 2.0}}"#).shadows.near_field, NearField::Short);
        assert_eq!(load(r#"{"schema": 2}"#), Settings::default());
    }

    #[test]
    fn saved_pictures_are_as_bright_as_they_were() {
        let mut now = Settings::default();
        now.output.exposure = 1.7;
        let exposure = |text: &str| load_json(&now, text).expect("settings").0.output.exposure;
        let mut saved = serde_json::to_value(Settings::default()).expect("settings");
        saved["output"].as_object_mut().expect("an object").remove("exposure");
        assert_eq!(exposure(&saved.to_string()), 1.0);
        saved["output"]["exposure"] = serde_json::json!(0.5);
        assert_eq!(exposure(&saved.to_string()), 0.5);
        // What leaves the end of a picture open leaves its exposure, too.
        assert_eq!(exposure(r#"{"schema": 2, "output": {"tone_map": "clip"}}"#), 1.7);
        assert_eq!(exposure(r#"{"schema": 2}"#), 1.7);
    }

    #[test]
    fn saved_cameras_see_what_they_saw() {
        let mut now = Settings::default();
        now.camera.fit = Fit::Frame;
        assert!(now.keep_view_under(1, "front"));
        let load = |text: &str| load_json(&now, text).expect("settings").0;
        let before = load(
            r#"{"schema": 2, "camera": {"distance": 4.0}, "views": {"2":
                {"projection": "perspective", "azimuth_deg": 0.0, "elevation_deg": 0.0, "roll_deg": 0.0,
                "target": [0.0, 0.0, 0.0], "distance": 3.0, "fov_y_deg": 30.0}}}"#,
        );
        assert_eq!((before.camera.fit, before.camera.distance), (Fit::Height, 4.0));
        assert_eq!(before.kept.iter().map(|kept| kept.digit).collect::<Vec<_>>(), [Some(2)]);
        assert!(before.kept.iter().all(|kept| kept.camera().fit == Fit::Height));
        // What says nothing of the frame leaves it, and what names it counts.
        for kept in [
            r#"{"schema": 1, "shadows": {"gain": 2.0}}"#,
            r#"{"schema": 2, "camera": {"azimuth_deg": 10.0}}"#,
            r#"{"camera": {"distance": 4.0}}"#,
            r#"{"schema": 2, "camera": {"distance": 4.0, "fit": "frame"}}"#,
        ] {
            assert_eq!(load(kept).camera.fit, Fit::Frame, "{kept}");
        }
        // A whole camera that is read by itself.
        let mut saved = serde_json::to_value(&now.camera).expect("a camera");
        saved.as_object_mut().expect("an object").remove("fit");
        assert_eq!(serde_json::from_value::<Camera>(saved).expect("a camera").fit, Fit::Height);
    }

    #[test]
    fn saved_looks_show_all_values_as_they_did() {
        let range = |text: &str| load_json(&Settings::default(), text).expect("settings").0.range;
        assert_eq!(range(r#"{"schema": 2, "transfer": {"points": []}}"#), DensityRange::Full);
        assert_eq!(range(r#"{"schema": 1, "transfer": {}}"#), DensityRange::Full);
        // What says nothing of values, what names the range, and what is of no schema.
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
        let table: LabelTable = [1, 2, 3].map(|number| (number, LabelLook::of(number))).into_iter().collect();
        let first = Settings { labels: table.clone(), ..Settings::default() };
        let labels = |text: &str| load_json(&first, text).expect("settings").0.labels;
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
        // A session has all that its look had, a preset lays its entries over those that there are.
        assert_eq!(labels(r#"{"schema": 2, "labels": {"9": {}}, "transfer": {"points": []}}"#).len(), 1);
        assert_eq!(labels(r#"{"labels": {"9": {}}}"#).len(), 4);
        let kept = load_json(&Settings::default(), &to_json(&first)).expect("settings").0;
        assert_eq!(kept, first);
        // Whoever names the curve means it.
        let curve = apply_path(&first, "transfer.interpolation", "extinction").expect("settings");
        assert!(curve.labels.is_empty());
        assert!(!apply_path(&first, "shadows.gain", "2").expect("settings").labels.is_empty());
    }

    #[test]
    fn nonsense_is_left_to_whoever_reads_it() {
        let mut nonsense = serde_json::json!({"schema": 1, "shadows": 3});
        complete(&mut nonsense);
        assert_eq!(nonsense["shadows"], 3);
        let mut nonsense = serde_json::json!({"schema": 2, "camera": [], "kept": [{"what": {"look": 3}}, 1]});
        complete(&mut nonsense);
        assert_eq!(nonsense["camera"], serde_json::json!([]));
    }
}
