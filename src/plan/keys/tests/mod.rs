//! Tests of the keys that each setting changes.

mod lights;

use serde_json::Value;

use super::*;
use crate::data::{Shown, ValueRange, ValueRanges, VolumeId};
use crate::model::{
    ControlPoint, LabelLook, Light, LightKind, Scattering, Settings, Sky, SkyMode, TransferFunction,
    apply_path, to_json,
};

fn request() -> Request {
    let point = |value, opacity| ControlPoint::new(value, [1.0; 3], opacity);
    let settings = Settings {
        lights: vec![
            Light::default(),
            Light { position: [0.0, 3.0, 0.0], ..Light::default() },
            Light { kind: LightKind::Perspective, ..Light::default() },
        ],
        transfer: TransferFunction { points: vec![point(0.0, 0.0), point(1.0, 0.5)], ..Default::default() },
        sky: Sky { mode: SkyMode::Gradient, ..Sky::default() },
        ..Settings::default()
    };
    let ranges = ValueRanges { all: ValueRange::new(-9.0, 9.0), robust: ValueRange::UNIT };
    Request {
        volume: VolumeId { content_id: 1, ranges, dims: [256; 3] },
        settings,
        size: [100, 80],
        coarse: None,
    }
}

/// Makes a request with light that bounces.
fn bouncing() -> Request {
    let mut request = request();
    request.settings.scattering = Scattering { bounces: 4, ..Scattering::default() };
    request
}

/// Makes a request with a table of labels.
fn of_labels() -> Request {
    let mut request = bouncing();
    request.settings.labels.entry(1);
    *request.settings.labels.entry(2) = LabelLook { visible: false, ..LabelLook::of(2) };
    request
}

fn keys(request: &Request) -> FrameKeys {
    FrameKeys::of(request, &RenderOptions::default())
}

/// Expected effect of a change: the most expensive product that is recomputed.
#[derive(Debug, PartialEq)]
enum Effect {
    Nothing,
    Display,
    Floor,
    Eye,
    /// Sky visibility is recomputed.
    Sky,
    /// Bounced light is recomputed.
    Bounces,
    OneLight,
    AllLights,
}

fn effect(before: &FrameKeys, after: &FrameKeys) -> Effect {
    match after.lights_missing_in(before) {
        1 => Effect::OneLight,
        n if n > 1 => Effect::AllLights,
        _ if after.sky.is_some() && after.sky != before.sky => Effect::Sky,
        _ if after.bounces.is_some() && after.bounces != before.bounces => Effect::Bounces,
        _ if after.eye != before.eye => Effect::Eye,
        _ if after.floor != before.floor => Effect::Floor,
        _ if after.display != before.display => Effect::Display,
        _ => Effect::Nothing,
    }
}

fn effect_of(before: &Request, path: &str, value: &str) -> Effect {
    let settings = apply_path(&before.settings, path, value).unwrap();
    effect(&keys(before), &keys(&Request { settings, ..before.clone() }))
}

#[test]
fn every_setting_causes_what_the_design_says() {
    let table = [
        ("camera.up", "plus_y", Effect::Bounces),
        ("camera.azimuth_deg", "10", Effect::Eye),
        ("camera.elevation_deg", "10", Effect::Eye),
        ("camera.roll_deg", "10", Effect::Eye),
        ("camera.target", "[0.1,0,0]", Effect::Eye),
        ("camera.distance", "2", Effect::Eye),
        ("camera.fov_y_deg", "40", Effect::Eye),
        ("camera.fit", "frame", Effect::Eye),
        ("camera.projection", "orthographic", Effect::Eye),
        ("lights.1.name", "Fill", Effect::Nothing),
        ("lights.1.color", "[1,0,0]", Effect::Bounces),
        ("lights.1.intensity", "2", Effect::Bounces),
        ("lights.1.on", "false", Effect::Bounces),
        ("lights.1.casts_shadows", "false", Effect::Bounces),
        // A parallel light that moves outwards stays the same.
        ("lights.1.position", "[0,6,0]", Effect::Nothing),
        ("lights.1.position", "[0,6,1]", Effect::OneLight),
        ("lights.2.position", "[4,-4,5]", Effect::OneLight),
        ("lights.1.kind", "perspective", Effect::OneLight),
        ("lights.1.lock", "camera", Effect::OneLight),
        ("lights.1.hood", r#"{"on": true}"#, Effect::Nothing),
        ("lights.2.hood", r#"{"on": true}"#, Effect::OneLight),
        ("lights.1.density_scale", "0.5", Effect::OneLight),
        ("lights.1.shape", "disc", Effect::OneLight),
        ("lights.2.shape", "ball", Effect::OneLight),
        // A point light has no size.
        ("lights.1.size", "0.5", Effect::Nothing),
        ("lights.1.angle_deg", "5", Effect::Nothing),
        ("lights.1.aspect", "2", Effect::Nothing),
        ("lights.1.turn_deg", "20", Effect::Nothing),
        ("range", "full", Effect::AllLights),
        ("range", r#"{"typed": [0, 2]}"#, Effect::AllLights),
        // The range is widened by points beyond it.
        ("transfer.points.1.value", "1.2", Effect::AllLights),
        ("transfer.points.0.color", "[1,0,0]", Effect::Bounces),
        ("transfer.points.1.opacity", "0.4", Effect::AllLights),
        ("transfer.points.1.value", "0.9", Effect::AllLights),
        ("transfer.interpolation", "extinction", Effect::AllLights),
        ("lighting.scale", "0.5", Effect::AllLights),
        ("lighting.linked", "false", Effect::AllLights),
        ("lighting.curve.interpolation", "extinction", Effect::Nothing),
        ("opacity_unit", r#"{"mm": 3}"#, Effect::AllLights),
        ("shading.emission", "0.1", Effect::Bounces),
        ("shading.ambient", "0.1", Effect::Eye),
        ("shading.diffuse", "0.1", Effect::Eye),
        ("shading.specular", "0.1", Effect::Eye),
        ("shading.shininess", "10", Effect::Eye),
        ("shading.surface_gradient", "0.1", Effect::Eye),
        ("shading.sides", "two", Effect::Eye),
        ("shadows.algorithm", "off", Effect::Eye),
        ("shadows.algorithm", "direct", Effect::Eye),
        ("shadows.algorithm", "raycast", Effect::AllLights),
        ("shadows.strength", "0.5", Effect::Eye),
        ("shadows.ambient_offset", "0.1", Effect::Eye),
        ("shadows.gain", "2", Effect::Eye),
        // Near-field rays replace the bias.
        ("shadows.bias_voxels", "1", Effect::Nothing),
        ("shadows.balance", "1.5", Effect::Bounces),
        ("shadows.transmission", "0.5", Effect::AllLights),
        ("shadows.keep_balanced", "true", Effect::Nothing),
        ("shadows.first_touch", "true", Effect::AllLights),
        ("shadows.deposit", "front", Effect::AllLights),
        ("shadows.kernel", "prefiltered", Effect::AllLights),
        ("shadows.slab", "0.5", Effect::AllLights),
        ("shadows.quadrature", "two", Effect::AllLights),
        ("shadows.resolution", "half", Effect::AllLights),
        ("shadows.precision", "byte", Effect::AllLights),
        ("shadows.storage", "combined", Effect::Eye),
        ("shadows.reverse_kernel", "forward", Effect::AllLights),
        ("shadows.near_field", "long", Effect::Eye),
        // Point lights have no samples.
        ("shadows.area.samples", "16", Effect::Nothing),
        ("shadows.area.resolution", "full", Effect::Nothing),
        ("sky.mode", "off", Effect::Bounces),
        ("sky.mode", "white", Effect::Bounces),
        ("sky.intensity", "0.1", Effect::Bounces),
        ("sky.zenith", "[1,0,0]", Effect::Bounces),
        ("sky.horizon", "[1,0,0]", Effect::Bounces),
        ("sky.ground", "[1,0,0]", Effect::Bounces),
        ("sky.mode", "picture", Effect::Bounces),
        // A gradient sky uses no environment map.
        ("sky.picture", r#"{"mean": [1, 2, 3]}"#, Effect::Nothing),
        ("sky.tilt_deg", "30", Effect::Bounces),
        ("sky.turn_deg", "30", Effect::Bounces),
        ("sky.density_scale", "0.5", Effect::Sky),
        ("sky.directions", "14", Effect::Sky),
        ("sky.resolution", "full", Effect::Sky),
        ("scattering.bounces", "0", Effect::Eye),
        ("scattering.bounces", "5", Effect::Bounces),
        ("scattering.albedo", "0.5", Effect::Bounces),
        ("scattering.strength", "2", Effect::Eye),
        ("scattering.anisotropy", "0.5", Effect::Eye),
        ("scattering.density_scale", "0.5", Effect::Bounces),
        ("scattering.directions", "26", Effect::Bounces),
        ("scattering.resolution", "half", Effect::Bounces),
        // The volume has as many blocks already.
        ("shadows.least_blocks", "64", Effect::Nothing),
        ("shadows.least_blocks", "128", Effect::Sky),
        ("transfer.mixing", "seen", Effect::Bounces),
        ("lighting.curve.mixing", "seen", Effect::Nothing),
        ("cuts.crop", r#"{"on": true}"#, Effect::Nothing),
        ("cuts.crop", r#"{"on": true, "low": [0.1, 0, 0]}"#, Effect::AllLights),
        ("cuts.crop", r#"{"on": true, "low": [0.1, 0, 0], "effect": "hidden"}"#, Effect::Eye),
        ("cuts.plane", r#"{"offset": 0.1}"#, Effect::Nothing),
        ("cuts.plane", r#"{"on": true}"#, Effect::AllLights),
        ("cuts.plane", r#"{"on": true, "effect": "shadowless"}"#, Effect::AllLights),
        ("floor", r#"{"on": true}"#, Effect::Floor),
        ("sampling.kernel", "prefiltered", Effect::Eye),
        ("sampling.slab", "0.5", Effect::Eye),
        ("sampling.slabs", "by_need", Effect::Eye),
        ("sampling.slabs", "preintegrated", Effect::Eye),
        ("sampling.quadrature", "two", Effect::Eye),
        ("sampling.gradients", "sheets", Effect::Eye),
        ("sampling.classification", "pre", Effect::AllLights),
        ("sampling.engine", "scatter", Effect::AllLights),
        // The gathering engine has no order.
        ("sampling.order", "volume_aligned", Effect::Nothing),
        ("output.background.top", "[0,0,0]", Effect::Display),
        ("output.background.bottom", "[0,0,0]", Effect::Display),
        ("output.tone_map", "clip", Effect::Display),
        ("output.exposure", "2", Effect::Display),
        // Corrections make another volume, whose identity is in every key.
        ("volume.spacing", "[0.5, 0.5, 2]", Effect::Nothing),
        ("volume.unit", "um", Effect::Nothing),
        ("volume.flip.x", "true", Effect::Nothing),
        ("volume.flip.y", "true", Effect::Nothing),
        ("volume.flip.z", "true", Effect::Nothing),
        ("volume.axis_order", "zyx", Effect::Nothing),
        ("volume.orientation", "LPS", Effect::Nothing),
        ("volume.padding_value", "-2000", Effect::Nothing),
        ("volume.value_scale.slope", "2", Effect::Nothing),
        ("volume.value_scale.intercept", "-1024", Effect::Nothing),
    ];
    for (path, value, expected) in &table {
        assert_eq!(&effect_of(&bouncing(), path, value), expected, "{path} = {value}");
    }
    // Looks of labels.
    for (path, value, expected) in [
        ("labels.1.name", "Liver", Effect::Nothing),
        ("labels.1.color", "[1,0,0]", Effect::Bounces),
        ("labels.1.opacity", "0.5", Effect::AllLights),
        ("labels.1.visible", "false", Effect::AllLights),
        ("labels", r#"{"1": {}, "2": {"visible": false}}"#, Effect::Nothing),
        ("labels", r#"{"1": {}, "2": {}}"#, Effect::AllLights),
        // A hidden label has no opacity.
        ("labels.2.opacity", "0.5", Effect::Nothing),
        ("labels", "{}", Effect::AllLights),
        // Settings without effect while there is a table of labels.
        ("range", "full", Effect::Nothing),
        ("lighting.linked", "false", Effect::Nothing),
        ("lighting.curve.interpolation", "extinction", Effect::Nothing),
        ("sampling.classification", "pre", Effect::Nothing),
        ("sampling.slabs", "by_need", Effect::Eye),
        ("lighting.scale", "0.5", Effect::AllLights),
    ] {
        assert_eq!(effect_of(&of_labels(), path, value), expected, "{path} = {value}");
    }
    // The table is complete: every leaf of the settings is listed, or lies below a listed path.
    let tree: Value = serde_json::from_str(&to_json(&request().settings)).unwrap();
    let mut leaves = Vec::new();
    collect(&tree, String::new(), &mut leaves);
    for leaf in leaves {
        let general = leaf.replace("lights.0", "lights.1").replace("lights.2", "lights.1");
        let covered = |path: &str| general == path || general.starts_with(&format!("{path}."));
        let listed =
            table.iter().any(|(path, ..)| covered(path) || covered(&path.replace("points.1", "points.0")));
        let exempt = ["schema", "kept", "labels", "lighting.curve.points", "transfer.points"]
            .iter()
            .any(|path| covered(path));
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
fn saved_views_are_no_part_of_a_picture() {
    let mut after = request();
    assert!(after.settings.keep_view_under(1, "front"));
    assert_eq!(keys(&after), keys(&request()));
}

#[test]
fn requests_that_are_the_same_have_the_same_keys() {
    assert_eq!(keys(&request()), keys(&request()));
    let larger = Request { size: [101, 80], ..request() };
    assert_eq!(effect(&keys(&request()), &keys(&larger)), Effect::Eye);
}

#[test]
fn options_that_only_display_reads_change_the_display_alone() {
    let options = RenderOptions { exposure: 1.5, ..RenderOptions::default() };
    assert_eq!(effect(&keys(&request()), &FrameKeys::of(&request(), &options)), Effect::Display);
    let options = RenderOptions { transparent: true, ..RenderOptions::default() };
    assert_eq!(effect(&keys(&request()), &FrameKeys::of(&request(), &options)), Effect::Display);
    let options = RenderOptions { timed: true, light_parts: 3, ..RenderOptions::default() };
    assert_eq!(effect(&keys(&request()), &FrameKeys::of(&request(), &options)), Effect::Nothing);
}

#[test]
fn an_unlinked_lighting_curve_frees_the_eye() {
    let mut before = request();
    before.settings.lighting.linked = false;
    before.settings.sky.mode = SkyMode::Off;
    assert_eq!(effect_of(&before, "transfer.points.1.opacity", "0.4"), Effect::Eye);
    // Shadow rays use the lighting curve in the eye pass itself.
    before.settings.shadows.algorithm = crate::model::ShadowAlgorithm::Direct;
    assert_eq!(effect_of(&before, "lighting.scale", "0.4"), Effect::Eye);
    // Sky light has a volume, regardless of the shadow algorithm of lights.
    before.settings.sky.mode = SkyMode::White;
    assert_eq!(effect_of(&before, "lighting.scale", "0.4"), Effect::Sky);
}

#[test]
fn another_volume_changes_every_key() {
    let mut other = request();
    other.volume.content_id = 2;
    let (before, after) = (keys(&request()), keys(&other));
    assert!(before.volume != after.volume && before.tables != after.tables && before.eye != after.eye);
    assert_eq!(after.lights_missing_in(&before), 3);
}

#[test]
fn a_corrected_volume_changes_every_key() {
    let samples = crate::data::Samples::U8((0..64).collect());
    let opened = crate::data::Volume::with_spacing("t", [4; 3], glam::DVec3::ONE, samples).unwrap();
    let before = Request { volume: opened.id(), ..request() };
    for (path, value) in [
        ("volume.spacing", "0.5,0.5,2"),
        ("volume.unit", "um"),
        ("volume.flip.x", "true"),
        ("volume.axis_order", "zyx"),
        ("volume.orientation", "LPS"),
        ("volume.padding_value", "3"),
        ("volume.value_scale.slope", "2"),
    ] {
        let settings = apply_path(&before.settings, path, value).unwrap();
        let volume = opened.corrected(&settings.volume).unwrap().id();
        let (old, new) = (keys(&before), keys(&Request { volume, settings, ..before.clone() }));
        assert!(old.volume != new.volume && old.eye != new.eye, "{path}");
        assert_eq!(new.lights_missing_in(&old), 3, "{path}");
    }
}

#[test]
fn another_range_changes_every_key() {
    let before = request();
    let settings = apply_path(&before.settings, "range", "full").unwrap();
    let after = keys(&Request { settings, ..before.clone() });
    let before = keys(&before);
    assert!(before.volume != after.volume && before.tables != after.tables && before.eye != after.eye);
    assert_eq!(
        (before.volume.shown, after.volume.shown),
        (Shown::Range(ValueRange::UNIT), Shown::Range(ValueRange::new(-9.0, 9.0)))
    );
    assert_eq!(after.lights_missing_in(&before), 3);
}

#[test]
fn a_table_of_labels_shows_another_volume_and_settings_as_drawn_have_its_keys() {
    let before = of_labels();
    assert_eq!((keys(&before).volume.shown, keys(&request()).volume.shown), {
        (Shown::Labels, Shown::Range(ValueRange::UNIT))
    });
    assert_ne!(keys(&before).tables, keys(&request()).tables);
    let samples = crate::data::Samples::U8(vec![0, 1, 2]);
    let volume = crate::data::Volume::with_spacing("t", [3, 1, 1], glam::DVec3::ONE, samples).unwrap();
    let drawn = before.settings.as_drawn(&volume).into_owned();
    assert_ne!(drawn, before.settings);
    assert_eq!(keys(&Request { settings: drawn, ..before.clone() }), keys(&before));
}

#[test]
fn points_within_the_range_leave_the_volume_as_it_is() {
    let volume = |value: &str| {
        let settings = apply_path(&request().settings, "transfer.points.1.value", value).unwrap();
        keys(&Request { settings, ..request() }).volume
    };
    assert_eq!(volume("0.4"), volume("1.004"));
    assert_ne!(volume("0.4"), volume("1.1"));
    assert_eq!(volume("1.1"), volume("1.12"));
}

#[test]
fn combined_light_follows_what_its_samples_see() {
    let mut before = request();
    before.settings.shadows.storage = crate::model::LightStorage::Combined;
    let differs = |path: &str, value: &str| {
        let settings = apply_path(&before.settings, path, value).unwrap();
        keys(&Request { settings, ..before.clone() }).combined != keys(&before).combined
    };
    assert!(keys(&before).combined.is_some() && keys(&request()).combined.is_none());
    for (path, value) in
        [("lights.0.color", "[1,0,0]"), ("shadows.gain", "2"), ("shading.surface_gradient", "1")]
    {
        assert!(differs(path, value), "{path}");
    }
    for (path, value) in [("camera.azimuth_deg", "9"), ("shading.diffuse", "0.1"), ("lights.0.name", "Key")] {
        assert!(!differs(path, value), "{path}");
    }
}
