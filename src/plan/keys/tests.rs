//! What each setting makes stale.

use super::*;
use crate::model::{ControlPoint, LightLock, apply_path, to_json};
use serde_json::Value;

fn request() -> Request {
    let point = |value, opacity| ControlPoint::new(value, [1.0; 3], opacity);
    let settings = Settings {
        lights: vec![
            Light::default(),
            Light { position: [0.0, 3.0, 0.0], ..Light::default() },
            Light { kind: LightKind::Perspective, ..Light::default() },
        ],
        transfer: TransferFunction { points: vec![point(0.0, 0.0), point(1.0, 0.5)], ..Default::default() },
        ..Settings::default()
    };
    Request { volume: 1, settings, size: [100, 80], coarse: None }
}

fn changed(path: &str, value: &str) -> Plan {
    let before = request();
    let settings = apply_path(&before.settings, path, value).unwrap();
    plan(Some(&before), &Request { settings, ..before.clone() })
}

/// What a change is expected to cause.
#[derive(Debug, PartialEq)]
enum Effect {
    Nothing,
    Display,
    Eye,
    OneLight,
    AllLights,
}

fn effect(plan: &Plan) -> Effect {
    match plan.lights.iter().filter(|&&rebuild| rebuild).count() {
        1 => Effect::OneLight,
        n if n > 1 => Effect::AllLights,
        _ if plan.eye => Effect::Eye,
        _ if plan.display => Effect::Display,
        _ => Effect::Nothing,
    }
}

#[test]
fn every_setting_causes_what_the_design_says() {
    let table = [
        ("camera.azimuth_deg", "10", Effect::Eye),
        ("camera.elevation_deg", "10", Effect::Eye),
        ("camera.roll_deg", "10", Effect::Eye),
        ("camera.target", "[0.1,0,0]", Effect::Eye),
        ("camera.distance", "2", Effect::Eye),
        ("camera.fov_y_deg", "40", Effect::Eye),
        ("camera.projection", "orthographic", Effect::Eye),
        ("lights.1.name", "Fill", Effect::Nothing),
        ("lights.1.color", "[1,0,0]", Effect::Eye),
        ("lights.1.intensity", "2", Effect::Eye),
        ("lights.1.on", "false", Effect::Eye),
        ("lights.1.casts_shadows", "false", Effect::Eye),
        ("lights.1.position", "[0,6,0]", Effect::Eye),
        ("lights.1.position", "[0,6,1]", Effect::OneLight),
        ("lights.2.position", "[4,-4,5]", Effect::OneLight),
        ("lights.1.kind", "perspective", Effect::OneLight),
        ("lights.1.lock", "camera", Effect::OneLight),
        ("lights.1.hood", r#"{"on": true}"#, Effect::Eye),
        ("lights.2.hood", r#"{"on": true}"#, Effect::OneLight),
        ("lights.1.density_scale", "0.5", Effect::OneLight),
        ("transfer.points.0.color", "[1,0,0]", Effect::Eye),
        ("transfer.points.1.opacity", "0.4", Effect::AllLights),
        ("transfer.points.1.value", "0.9", Effect::AllLights),
        ("transfer.interpolation", "extinction", Effect::AllLights),
        ("lighting.scale", "0.5", Effect::AllLights),
        ("lighting.linked", "false", Effect::AllLights),
        ("lighting.curve.interpolation", "extinction", Effect::Eye),
        ("opacity_unit", r#"{"mm": 3}"#, Effect::AllLights),
        ("shading.emission", "0.1", Effect::Eye),
        ("shading.ambient", "0.1", Effect::Eye),
        ("shading.diffuse", "0.1", Effect::Eye),
        ("shading.specular", "0.1", Effect::Eye),
        ("shading.shininess", "10", Effect::Eye),
        ("shading.surface_gradient", "0.1", Effect::Eye),
        ("shadows.algorithm", "off", Effect::Eye),
        ("shadows.algorithm", "direct", Effect::Eye),
        ("shadows.algorithm", "raycast", Effect::AllLights),
        ("shadows.strength", "0.5", Effect::Eye),
        ("shadows.ambient_offset", "0.1", Effect::Eye),
        ("shadows.gain", "2", Effect::Eye),
        ("shadows.bias_voxels", "1", Effect::Eye),
        ("shadows.balance", "1.5", Effect::Eye),
        ("shadows.first_touch", "true", Effect::AllLights),
        ("shadows.deposit", "front", Effect::AllLights),
        ("shadows.kernel", "prefiltered", Effect::AllLights),
        ("shadows.slab", "0.5", Effect::AllLights),
        ("shadows.quadrature", "two", Effect::AllLights),
        ("shadows.resolution", "half", Effect::AllLights),
        ("shadows.precision", "byte", Effect::AllLights),
        ("shadows.storage", "combined", Effect::Eye),
        ("transfer.mixing", "seen", Effect::Eye),
        ("lighting.curve.mixing", "seen", Effect::Eye),
        ("cuts.crop", r#"{"on": true}"#, Effect::Nothing),
        ("cuts.crop", r#"{"on": true, "low": [0.1, 0, 0]}"#, Effect::AllLights),
        ("cuts.crop", r#"{"on": true, "low": [0.1, 0, 0], "effect": "hidden"}"#, Effect::Eye),
        ("cuts.plane", r#"{"offset": 0.1}"#, Effect::Nothing),
        ("cuts.plane", r#"{"on": true}"#, Effect::AllLights),
        ("cuts.plane", r#"{"on": true, "effect": "shadowless"}"#, Effect::AllLights),
        ("floor", r#"{"on": true}"#, Effect::Eye),
        ("sampling.kernel", "prefiltered", Effect::Eye),
        ("sampling.slab", "0.5", Effect::Eye),
        ("sampling.quadrature", "two", Effect::Eye),
        ("sampling.gradients", "sheets", Effect::Eye),
        ("sampling.classification", "pre", Effect::AllLights),
        ("sampling.engine", "scatter", Effect::AllLights),
        ("sampling.order", "volume_aligned", Effect::Eye),
        ("output.background.top", "[0,0,0]", Effect::Display),
        ("output.background.bottom", "[0,0,0]", Effect::Display),
        ("output.tone_map", "clip", Effect::Display),
    ];
    for (path, value, expected) in &table {
        assert_eq!(&effect(&changed(path, value)), expected, "{path} = {value}");
    }
    // The table is complete: every leaf of the settings is named, or lies below a name.
    let tree: Value = serde_json::from_str(&to_json(&request().settings)).unwrap();
    let mut leaves = Vec::new();
    collect(&tree, String::new(), &mut leaves);
    for leaf in leaves {
        let general = leaf.replace("lights.0", "lights.1").replace("lights.2", "lights.1");
        let covered = |path: &str| general == path || general.starts_with(&format!("{path}."));
        let listed =
            table.iter().any(|(path, ..)| covered(path) || covered(&path.replace("points.1", "points.0")));
        let exempt = ["schema", "lighting.curve.points", "transfer.points"].iter().any(|path| covered(path));
        assert!(listed || exempt, "{leaf} is not classified");
    }
}

fn collect(tree: &Value, path: String, leaves: &mut Vec<String>) {
    let join = |key: &str| if path.is_empty() { key.to_owned() } else { format!("{path}.{key}") };
    match tree {
        Value::Object(fields) => fields.iter().for_each(|(key, value)| collect(value, join(key), leaves)),
        Value::Array(items) if items.iter().any(Value::is_object) => {
            items.iter().enumerate().for_each(|(i, value)| collect(value, join(&i.to_string()), leaves));
        }
        _ => leaves.push(path),
    }
}

#[test]
fn the_same_request_needs_nothing_and_the_first_needs_all() {
    assert!(plan(Some(&request()), &request()).is_empty());
    let first = plan(None, &request());
    assert!(first.volume && first.eye_table && first.eye && first.lights == [true; 3]);
}

#[test]
fn a_light_that_is_locked_to_the_camera_turns_with_it() {
    let mut before = request();
    before.settings.lights[1].lock = LightLock::Camera;
    let settings = apply_path(&before.settings, "camera.azimuth_deg", "10").unwrap();
    let next = Request { settings, ..before.clone() };
    assert_eq!(effect(&plan(Some(&before), &next)), Effect::OneLight);
}

#[test]
fn removing_a_light_rebuilds_nothing() {
    let mut next = request();
    next.settings.lights.remove(0);
    assert_eq!(effect(&plan(Some(&request()), &next)), Effect::Eye);
}

#[test]
fn an_unlinked_lighting_curve_frees_the_eye() {
    let mut before = request();
    before.settings.lighting.linked = false;
    let settings = apply_path(&before.settings, "transfer.points.1.opacity", "0.4").unwrap();
    let next = Request { settings, ..before.clone() };
    assert_eq!(effect(&plan(Some(&before), &next)), Effect::Eye);
}

#[test]
fn another_volume_rebuilds_everything() {
    let next = Request { volume: 2, ..request() };
    let plan = plan(Some(&request()), &next);
    assert!(plan.volume && plan.eye_table && plan.eye && plan.lights == [true; 3]);
}
