//! Tests of the keys that each setting changes.

mod layers;
mod lights;

use serde_json::Value;

use super::*;
use crate::plan::{PictureOptions, WorkOptions};
use chiaroscuro_scene::{
    ControlPoint, LabelLook, LightGeometry, LightSettings, ScatteringSettings, Settings, SkyMode,
    SkySettings, TransferFunction, apply_path, settings_to_json,
};
use chiaroscuro_volume::{DensityMapping, PagesId, ValueRange, ValueRanges, VolumeId};

fn request() -> RenderRequest {
    let point = |value, opacity| ControlPoint::new(value, [1.0; 3], opacity);
    let settings = Settings {
        lights: vec![
            LightSettings::default(),
            LightSettings { position: [0.0, 3.0, 0.0], ..LightSettings::default() },
            LightSettings { kind: LightGeometry::Perspective, ..LightSettings::default() },
        ],
        sky: SkySettings { mode: SkyMode::Gradient, ..SkySettings::default() },
        ..Settings::default()
    }
    .with_transfer(TransferFunction { points: vec![point(0.0, 0.0), point(1.0, 0.5)], ..Default::default() });
    let ranges = ValueRanges { all: ValueRange::new(-9.0, 9.0), robust: ValueRange::UNIT };
    RenderRequest {
        volume: VolumeId {
            content_id: 1,
            ranges,
            dims: [256; 3],
            further_ranges: [None; 3],
            pages: PagesId::default(),
        },
        settings,
        size: [100, 80],
        preview_resolution: None,
    }
}

/// Makes a request with light that bounces.
fn request_with_bounces() -> RenderRequest {
    let mut request = request();
    request.settings.scattering = ScatteringSettings { bounces: 4, ..ScatteringSettings::default() };
    request
}

/// Makes a request with a table of labels.
fn request_with_labels() -> RenderRequest {
    let mut request = request_with_bounces();
    let look = |number, visible| (number, LabelLook { visible, ..LabelLook::default_for(number) });
    request.settings.layer_mut().labels = [look(1, true), look(2, false)].into_iter().collect();
    request
}

fn keys(request: &RenderRequest) -> FrameKeys {
    FrameKeys::new(request, &RenderOptions::default())
}

/// Expected effect of a change: the most expensive product that is recomputed.
#[derive(Debug, PartialEq)]
enum ChangeEffect {
    Nothing,
    Display,
    Floor,
    /// Rays beside the middle of pixels are drawn.
    Antialiasing,
    Eye,
    /// Sky visibility is recomputed.
    Sky,
    /// Bounced light is recomputed.
    Bounces,
    OneLight,
    AllLights,
}

fn effect(before: &FrameKeys, after: &FrameKeys) -> ChangeEffect {
    match after.count_lights_missing_in(before) {
        1 => ChangeEffect::OneLight,
        n if n > 1 => ChangeEffect::AllLights,
        _ if after.sky.is_some() && after.sky != before.sky => ChangeEffect::Sky,
        _ if after.bounces.is_some() && after.bounces != before.bounces => ChangeEffect::Bounces,
        _ if after.eye != before.eye => ChangeEffect::Eye,
        _ if after.antialiased != before.antialiased => ChangeEffect::Antialiasing,
        _ if after.floor != before.floor => ChangeEffect::Floor,
        _ if after.display != before.display => ChangeEffect::Display,
        _ => ChangeEffect::Nothing,
    }
}

fn effect_of(before: &RenderRequest, path: &str, value: &str) -> ChangeEffect {
    let settings = apply_path(&before.settings, path, value).unwrap();
    effect(&keys(before), &keys(&RenderRequest { settings, ..before.clone() }))
}

#[test]
fn every_setting_causes_what_the_design_says() {
    let table = [
        ("camera.up", "plus_y", ChangeEffect::Bounces),
        ("camera.azimuth_deg", "10", ChangeEffect::Eye),
        ("camera.elevation_deg", "10", ChangeEffect::Eye),
        ("camera.roll_deg", "10", ChangeEffect::Eye),
        ("camera.target", "[0.1,0,0]", ChangeEffect::Eye),
        ("camera.distance", "2", ChangeEffect::Eye),
        ("camera.fov_y_deg", "40", ChangeEffect::Eye),
        ("camera.fit", "frame", ChangeEffect::Eye),
        ("camera.projection", "orthographic", ChangeEffect::Eye),
        ("lights.1.name", "Fill", ChangeEffect::Nothing),
        ("lights.1.color", "[1,0,0]", ChangeEffect::Bounces),
        ("lights.1.intensity", "2", ChangeEffect::Bounces),
        ("lights.1.on", "false", ChangeEffect::Bounces),
        ("lights.1.casts_shadows", "false", ChangeEffect::Bounces),
        // A parallel light that moves outwards stays the same.
        ("lights.1.position", "[0,6,0]", ChangeEffect::Nothing),
        ("lights.1.position", "[0,6,1]", ChangeEffect::OneLight),
        ("lights.2.position", "[4,-4,5]", ChangeEffect::OneLight),
        ("lights.1.kind", "perspective", ChangeEffect::OneLight),
        ("lights.1.lock", "camera", ChangeEffect::OneLight),
        ("lights.1.hood", r#"{"on": true}"#, ChangeEffect::Nothing),
        ("lights.2.hood", r#"{"on": true}"#, ChangeEffect::OneLight),
        ("lights.1.density_scale", "0.5", ChangeEffect::OneLight),
        ("lights.1.shape", "disc", ChangeEffect::OneLight),
        ("lights.2.shape", "ball", ChangeEffect::OneLight),
        ("lights.1.size", "0.5", ChangeEffect::Nothing), // A point light has no size.
        ("lights.1.angle_deg", "5", ChangeEffect::Nothing),
        ("lights.1.aspect", "2", ChangeEffect::Nothing),
        ("lights.1.turn_deg", "20", ChangeEffect::Nothing),
        ("range", "full", ChangeEffect::AllLights),
        ("range", r#"{"typed": [0, 2]}"#, ChangeEffect::AllLights),
        // The range is widened by points beyond it.
        ("transfer.points.1.value", "1.2", ChangeEffect::AllLights),
        ("transfer.points.0.color", "[1,0,0]", ChangeEffect::Bounces),
        ("transfer.points.1.opacity", "0.4", ChangeEffect::AllLights),
        ("transfer.points.1.value", "0.9", ChangeEffect::AllLights),
        ("transfer.interpolation", "extinction", ChangeEffect::AllLights),
        ("lighting.scale", "0.5", ChangeEffect::AllLights),
        ("lighting.linked", "false", ChangeEffect::AllLights),
        ("lighting.curve.interpolation", "extinction", ChangeEffect::Nothing),
        ("opacity_unit", r#"{"mm": 3}"#, ChangeEffect::AllLights),
        ("visibility", "hidden", ChangeEffect::AllLights),
        ("visibility", "casts_shadows", ChangeEffect::Bounces),
        ("blend", "gate", ChangeEffect::Nothing), // There is no layer before the first.
        ("edges", "0.1", ChangeEffect::AllLights),
        // A single layer is cut in any case.
        ("ignores_cuts", "true", ChangeEffect::Nothing),
        ("materials", r#"[{"values": [0, 9], "changes": [0, 9]}]"#, ChangeEffect::AllLights),
        // Volumes of light stay, but a projection without light needs none.
        ("mode.kind", "maximum", ChangeEffect::Eye),
        ("mode.kind", "mean", ChangeEffect::Eye),
        ("mode.kind", "surface", ChangeEffect::AllLights),
        // Only surfaces have an isovalue, and only maxima are lit.
        ("mode.isovalue", "0.5", ChangeEffect::Nothing),
        ("mode.lit", "true", ChangeEffect::Nothing),
        ("shading.emission", "0.1", ChangeEffect::Bounces),
        ("shading.ambient", "0.1", ChangeEffect::Eye),
        ("shading.diffuse", "0.1", ChangeEffect::Eye),
        ("shading.specular", "0.1", ChangeEffect::Eye),
        ("shading.shininess", "10", ChangeEffect::Eye),
        ("shading.surface_gradient", "0.1", ChangeEffect::Eye),
        // Without surfaces, all material is lit by the sky like fog.
        ("shading.surface_gradient", "1.5", ChangeEffect::Sky),
        ("shading.sides", "two", ChangeEffect::Eye),
        ("shadows.algorithm", "off", ChangeEffect::Eye),
        ("shadows.algorithm", "direct", ChangeEffect::Eye),
        ("shadows.algorithm", "raycast", ChangeEffect::AllLights),
        ("shadows.strength", "0.5", ChangeEffect::Eye),
        ("shadows.ambient_offset", "0.1", ChangeEffect::Eye),
        ("shadows.gain", "2", ChangeEffect::Eye),
        // Near-field rays replace the bias.
        ("shadows.bias_voxels", "1", ChangeEffect::Nothing),
        ("shadows.balance", "1.5", ChangeEffect::Bounces),
        ("shadows.transmission", "0.5", ChangeEffect::AllLights),
        ("shadows.keep_balanced", "true", ChangeEffect::Nothing),
        ("shadows.first_touch", "true", ChangeEffect::AllLights),
        ("shadows.deposit", "front", ChangeEffect::AllLights),
        ("shadows.kernel", "prefiltered", ChangeEffect::AllLights),
        ("shadows.slab", "0.5", ChangeEffect::AllLights),
        ("shadows.quadrature", "two", ChangeEffect::AllLights),
        ("shadows.resolution", "half", ChangeEffect::AllLights),
        ("shadows.precision", "byte", ChangeEffect::AllLights),
        ("shadows.storage", "combined", ChangeEffect::Eye),
        ("shadows.reverse_kernel", "forward", ChangeEffect::AllLights),
        ("shadows.near_field", "long", ChangeEffect::Eye),
        // Point lights have no samples.
        ("shadows.area.samples", "16", ChangeEffect::Nothing),
        ("shadows.area.resolution", "full", ChangeEffect::Nothing),
        ("sky.mode", "off", ChangeEffect::Bounces),
        ("sky.mode", "white", ChangeEffect::Bounces),
        ("sky.intensity", "0.1", ChangeEffect::Bounces),
        ("sky.zenith", "[1,0,0]", ChangeEffect::Bounces),
        ("sky.horizon", "[1,0,0]", ChangeEffect::Bounces),
        ("sky.ground", "[1,0,0]", ChangeEffect::Bounces),
        ("sky.mode", "picture", ChangeEffect::Bounces),
        // A gradient sky uses no environment map.
        ("sky.picture", r#"{"mean": [1, 2, 3]}"#, ChangeEffect::Nothing),
        ("sky.tilt_deg", "30", ChangeEffect::Bounces),
        ("sky.turn_deg", "30", ChangeEffect::Bounces),
        ("sky.density_scale", "0.5", ChangeEffect::Sky),
        ("sky.directions", "14", ChangeEffect::Sky),
        ("sky.resolution", "full", ChangeEffect::Sky),
        ("scattering.bounces", "0", ChangeEffect::Eye),
        ("scattering.bounces", "5", ChangeEffect::Bounces),
        ("scattering.albedo", "0.5", ChangeEffect::Bounces),
        ("scattering.strength", "2", ChangeEffect::Eye),
        ("scattering.anisotropy", "0.5", ChangeEffect::Eye),
        ("scattering.density_scale", "0.5", ChangeEffect::Bounces),
        ("scattering.directions", "26", ChangeEffect::Bounces),
        ("scattering.resolution", "half", ChangeEffect::Bounces),
        // The volume has as many blocks already.
        ("shadows.least_blocks", "64", ChangeEffect::Nothing),
        ("shadows.least_blocks", "128", ChangeEffect::Sky),
        ("transfer.mixing", "seen", ChangeEffect::Bounces),
        ("lighting.curve.mixing", "seen", ChangeEffect::Nothing),
        ("cuts.crop", r#"{"on": true, "low": [0.1, 0, 0]}"#, ChangeEffect::AllLights),
        ("cuts.crop", r#"{"on": true, "low": [0.1, 0, 0], "effect": "hidden"}"#, ChangeEffect::Eye),
        ("cuts.plane", r#"{"offset": 0.1}"#, ChangeEffect::Nothing),
        ("cuts.plane", r#"{"on": true}"#, ChangeEffect::AllLights),
        ("cuts.plane", r#"{"on": true, "effect": "shadowless"}"#, ChangeEffect::AllLights),
        ("cuts.shapes", r"[{}]", ChangeEffect::AllLights),
        ("floor", r#"{"on": true}"#, ChangeEffect::Floor),
        ("sampling.kernel", "prefiltered", ChangeEffect::Eye),
        ("sampling.slab", "0.5", ChangeEffect::Eye),
        ("sampling.slabs", "by_need", ChangeEffect::Eye),
        ("sampling.slabs", "preintegrated", ChangeEffect::Eye),
        ("sampling.max_undivided_share", "0.5", ChangeEffect::Nothing),
        ("sampling.quadrature", "two", ChangeEffect::Eye),
        ("sampling.gradients", "sheets", ChangeEffect::Eye),
        ("sampling.classification", "pre", ChangeEffect::AllLights),
        ("sampling.engine", "scatter", ChangeEffect::AllLights),
        // Without pages they change nothing.
        ("sampling.finer_levels", "false", ChangeEffect::Nothing),
        // The gathering engine has no order.
        ("sampling.order", "volume_aligned", ChangeEffect::Nothing),
        ("output.background.top", "[0,0,0]", ChangeEffect::Display),
        ("output.background.bottom", "[0,0,0]", ChangeEffect::Display),
        ("output.tone_map", "clip", ChangeEffect::Display),
        ("output.exposure", "2", ChangeEffect::Display),
        // The callers' options have the number of rays.
        ("output.antialiasing", "8", ChangeEffect::Nothing),
        // Corrections make another volume, whose identity is in every key.
        ("volume.spacing", "[0.5, 0.5, 2]", ChangeEffect::Nothing),
        ("volume.unit", "um", ChangeEffect::Nothing),
        ("volume.flip.x", "true", ChangeEffect::Nothing),
        ("volume.flip.y", "true", ChangeEffect::Nothing),
        ("volume.flip.z", "true", ChangeEffect::Nothing),
        ("volume.axis_order", "zyx", ChangeEffect::Nothing),
        ("volume.orientation", "LPS", ChangeEffect::Nothing),
        ("volume.padding_value", "-2000", ChangeEffect::Nothing),
        ("volume.hidden_table", "-500", ChangeEffect::Nothing),
        ("volume.value_scale.slope", "2", ChangeEffect::Nothing),
        ("volume.value_scale.intercept", "-1024", ChangeEffect::Nothing),
    ];
    for (path, value, expected) in &table {
        assert_eq!(&effect_of(&request_with_bounces(), path, value), expected, "{path} = {value}");
    }
    // Looks of labels.
    for (path, value, expected) in [
        ("labels.1.name", "Liver", ChangeEffect::Nothing),
        ("labels.1.color", "[1,0,0]", ChangeEffect::Bounces),
        ("labels.1.opacity", "0.5", ChangeEffect::AllLights),
        ("labels.1.visible", "false", ChangeEffect::AllLights),
        ("labels", r#"{"1": {}, "2": {"visible": false}}"#, ChangeEffect::Nothing),
        ("labels", r#"{"1": {}, "2": {}}"#, ChangeEffect::AllLights),
        ("labels.2.opacity", "0.5", ChangeEffect::Nothing), // A hidden label has no opacity.
        ("labels", "{}", ChangeEffect::AllLights),
        // Settings without effect while there is a table of labels.
        ("range", "full", ChangeEffect::Nothing),
        ("lighting.linked", "false", ChangeEffect::Nothing),
        ("lighting.curve.interpolation", "extinction", ChangeEffect::Nothing),
        ("sampling.classification", "pre", ChangeEffect::Nothing),
        ("sampling.classification", "pre_crisp", ChangeEffect::AllLights),
        ("sampling.slabs", "by_need", ChangeEffect::Eye),
        ("lighting.scale", "0.5", ChangeEffect::AllLights),
    ] {
        assert_eq!(effect_of(&request_with_labels(), path, value), expected, "{path} = {value}");
    }
    // The table is complete: every leaf of the settings is listed, or lies below a listed path.
    let tree: Value = serde_json::from_str(&settings_to_json(&request().settings)).unwrap();
    let mut leaves = Vec::new();
    collect(&tree, String::new(), &mut leaves);
    for leaf in leaves {
        let short = leaf.strip_prefix("layers.0.").unwrap_or(&leaf);
        let general = short.replace("lights.0", "lights.1").replace("lights.2", "lights.1");
        let covered = |path: &str| general == path || general.starts_with(&format!("{path}."));
        let listed =
            table.iter().any(|(path, ..)| covered(path) || covered(&path.replace("points.1", "points.0")));
        let unlisted = ["schema", "kept", "labels", "lighting.curve.points", "transfer.points"];
        assert!(listed || unlisted.into_iter().any(covered), "{leaf} is not classified");
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
    assert!(after.settings.save_view_for_digit(1, "front"));
    assert_eq!(keys(&after), keys(&request()));
}

#[test]
fn requests_that_are_the_same_have_the_same_keys() {
    assert_eq!(keys(&request()), keys(&request()));
    let larger = RenderRequest { size: [101, 80], ..request() };
    assert_eq!(effect(&keys(&request()), &keys(&larger)), ChangeEffect::Eye);
}

#[test]
fn options_that_only_display_reads_change_the_display_alone() {
    let options = RenderOptions::from(PictureOptions { exposure: 1.5, ..PictureOptions::default() });
    assert_eq!(effect(&keys(&request()), &FrameKeys::new(&request(), &options)), ChangeEffect::Display);
    let options = RenderOptions::from(PictureOptions { transparent: true, ..PictureOptions::default() });
    assert_eq!(effect(&keys(&request()), &FrameKeys::new(&request(), &options)), ChangeEffect::Display);
    let options = RenderOptions::from(PictureOptions { rays: 4, ..PictureOptions::default() });
    assert_eq!(effect(&keys(&request()), &FrameKeys::new(&request(), &options)), ChangeEffect::Antialiasing);
    let options = RenderOptions::from(WorkOptions { timed: true, light_parts: 3, ..WorkOptions::default() });
    assert_eq!(effect(&keys(&request()), &FrameKeys::new(&request(), &options)), ChangeEffect::Nothing);
}

#[test]
fn another_volume_changes_every_key() {
    let mut other = request();
    other.volume.content_id = 2;
    let (before, after) = (keys(&request()), keys(&other));
    assert!(before.volume != after.volume && before.tables != after.tables && before.eye != after.eye);
    assert_eq!(after.count_lights_missing_in(&before), 3);
}

#[test]
fn a_corrected_volume_changes_every_key() {
    let samples = chiaroscuro_volume::Samples::U8((0..64).collect());
    let opened = chiaroscuro_volume::Volume::with_spacing("t", [4; 3], glam::DVec3::ONE, samples).unwrap();
    let before = RenderRequest { volume: opened.id(), ..request() };
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
        let (old, new) = (keys(&before), keys(&RenderRequest { volume, settings, ..before.clone() }));
        assert!(old.volume != new.volume && old.eye != new.eye, "{path}");
        assert_eq!(new.count_lights_missing_in(&old), 3, "{path}");
    }
}

#[test]
fn another_range_changes_every_key() {
    let before = request();
    let settings = apply_path(&before.settings, "range", "full").unwrap();
    let after = keys(&RenderRequest { settings, ..before.clone() });
    let before = keys(&before);
    assert!(before.volume != after.volume && before.tables != after.tables && before.eye != after.eye);
    assert_eq!(
        (before.volume.density_mapping, after.volume.density_mapping),
        (DensityMapping::Range(ValueRange::UNIT), DensityMapping::Range(ValueRange::new(-9.0, 9.0)))
    );
    assert_eq!(after.count_lights_missing_in(&before), 3);
}

#[test]
fn a_table_of_labels_shows_another_volume_and_settings_as_drawn_have_its_keys() {
    let before = request_with_labels();
    let mapping = [&before, &request()].map(|request| keys(request).volume.density_mapping);
    assert_eq!(mapping, [DensityMapping::Labels, DensityMapping::Range(ValueRange::UNIT)]);
    assert_ne!(keys(&before).tables, keys(&request()).tables);
    let samples = chiaroscuro_volume::Samples::U8(vec![0, 1, 2]);
    let volume = chiaroscuro_volume::Volume::with_spacing("t", [3, 1, 1], glam::DVec3::ONE, samples).unwrap();
    let drawn = before.settings.resolved_for(&volume).into_owned();
    assert_ne!(drawn, before.settings);
    assert_eq!(keys(&RenderRequest { settings: drawn, ..before.clone() }), keys(&before));
}

#[test]
fn points_within_the_range_leave_the_volume_as_it_is() {
    let volume = |value: &str| {
        let settings = apply_path(&request().settings, "transfer.points.1.value", value).unwrap();
        keys(&RenderRequest { settings, ..request() }).volume
    };
    assert_eq!(volume("0.4"), volume("1.004"));
    assert_ne!(volume("0.4"), volume("1.1"));
    assert_eq!(volume("1.1"), volume("1.12"));
}
