//! Coloured shadows against the reference: each colour of light is traced separately, on both sides.

use chiaroscuro_reference::{Reference, ReferenceOptions, merge_color_channels};
use chiaroscuro_render::{AttenuationData, RenderOptions, Renderer, WorkOptions, plan::RenderRequest};
use chiaroscuro_scene::{
    ClassificationOrder, ControlPoint, FloorSettings, LightGeometry, LightSettings, LightShape, LightStorage,
    LightVolumePrecision, MaterialBox, NearFieldRay, RenderEngine, Settings, ShadowAlgorithm,
};
use glam::DVec3;

use super::mutations::assert_in_shader;
use super::{SIZE, round_to_f16};
use crate::common::{Dataset, damaged_renderer, new_renderer, render};
use crate::compare::{ErrorLimit, channels_f32, channels_f64, compare};
use crate::scenes;
use crate::thresholds::{BYTES, COMBINED_NORMALS, SAME_WEIGHTS};

const N: usize = 22;

/// Look with soft parts of different hues under two lights.
fn look() -> Settings {
    let mut settings = scenes::look();
    settings.shadows.transmission = 0.9;
    settings.lights.push(scenes::light(LightGeometry::Perspective, [-1.9, 1.2, 1.4]));
    let point = |value, color, opacity| ControlPoint::new(value, color, opacity);
    settings.layer_mut().transfer.points = vec![
        point(8.0, [0.9, 0.1, 0.1], 0.0),
        point(60.0, [0.2, 0.9, 0.3], 0.1),
        point(110.0, [0.9, 0.3, 0.1], 0.3),
        point(170.0, [0.2, 0.4, 0.9], 0.5),
        point(250.0, [0.8, 0.8, 0.8], 0.8),
    ];
    settings
}

/// Replacement that leaves the shaders unchanged.
const NO_REPLACEMENT: (&str, &str) = ("\u{0}", "");

/// Differences of light volumes, picture and floor from the reference's, with a text in the shaders replaced.
fn differences(settings: &Settings, (from, to): (&str, &str)) -> Vec<String> {
    let loaded = Dataset::new(scenes::creature(N, DVec3::new(1.0, 1.0, 1.3)));
    let mut renderer = damaged_renderer(from, to);
    let drawn = settings.resolved_for_dataset(&loaded);
    let references = [0, 1, 2].map(|color| {
        let options = ReferenceOptions {
            color: Some(color),
            rounding: Some(round_to_f16),
            ..ReferenceOptions::default()
        };
        if settings.is_layered() {
            Reference::with_layers(&loaded, &drawn, options)
        } else {
            Reference::new(loaded.volume(), settings, options)
        }
    });
    let found = render(&mut renderer, &loaded, settings, SIZE);
    let attenuations = references.each_ref().map(Reference::attenuations);
    let picture = merge_color_channels(|color| references[color].picture(SIZE, &attenuations[color]));
    let mut failures = Vec::new();
    failures.extend(
        compare("picture", &channels_f32(&found.linear), &channels_f64(&picture), SAME_WEIGHTS).err(),
    );
    if settings.floor.on {
        let floor = merge_color_channels(|color| references[color].floor(SIZE));
        let found = renderer.read_floor().expect("a floor");
        failures.extend(compare("floor", &channels_f32(&found), &channels_f64(&floor), SAME_WEIGHTS).err());
    }
    for light in 0..settings.lights.len() {
        let Some(volume) = light_volume(&mut renderer, &loaded, settings, light) else { continue };
        for (color, attenuations) in attenuations.iter().enumerate() {
            let expected = &attenuations[light].as_ref().expect("the light casts shadows").values;
            let found: Vec<f64> = volume.colors.iter().map(|texel| f64::from(texel[color])).collect();
            let what = format!("light {light}, colour {color}");
            failures.extend(compare(&what, &found, expected, SAME_WEIGHTS).err());
        }
    }
    failures
}

/// Volume of one light, filled everywhere.
fn light_volume(
    renderer: &mut Renderer,
    loaded: &Dataset,
    settings: &Settings,
    light: usize,
) -> Option<AttenuationData> {
    let everything =
        RenderOptions::from(WorkOptions { fill_all_light_voxels: true, ..WorkOptions::default() });
    renderer.draw(loaded, settings, [8, 8], &everything).expect("light volumes are filled");
    let request = RenderRequest {
        volume: loaded.id(),
        settings: settings.resolved_for_dataset(loaded).into_owned(),
        size: [8, 8],
        preview_resolution: None,
    };
    renderer.attenuation(&request, light).expect("it is read back")
}

fn check(what: &str, settings: &Settings) {
    let failures = differences(settings, NO_REPLACEMENT);
    assert!(failures.is_empty(), "{what}: {}", failures.join("\n"));
}

#[test]
fn by_splatting() {
    let mut settings = look();
    check("near rays", &settings);
    settings.shadows.near_field = NearFieldRay::Off;
    settings.shadows.first_touch = true;
    check("first touch, no near rays", &settings);
}

#[test]
fn with_a_lighting_curve_of_its_own_and_cuts() {
    let mut settings = look();
    settings.layer_mut().lighting.linked = false;
    settings.layer_mut().lighting.curve = settings.layer().transfer.clone();
    settings.layer_mut().lighting.scale = 0.7;
    for (point, color) in
        settings.layer_mut().lighting.curve.points.iter_mut().zip([[0.1, 0.2, 0.9], [0.9, 0.8, 0.1]])
    {
        point.color = color;
    }
    settings.cuts.crop.on = true;
    settings.cuts.crop.high = [0.8, 1.0, 0.9];
    check("own curve", &settings);
}

#[test]
fn of_materials_by_value_and_change() {
    let mut settings = look();
    let material =
        |values, changes, color| MaterialBox { values, changes, color, softness: 0.4, opacity: 0.6 };
    settings.layer_mut().materials = vec![
        material([30.0, 140.0], [0.0, 20.0], [0.9, 0.2, 0.1]),
        material([60.0, 300.0], [10.0, 400.0], [0.2, 0.4, 0.9]),
    ];
    settings.layer_mut().lighting.scale = 0.6;
    check("materials", &settings);
}

#[test]
fn scattered() {
    let mut settings = look();
    settings.sampling.engine = RenderEngine::Scatter;
    check("scattered", &settings);
}

#[test]
fn by_rays_and_on_a_floor() {
    let mut settings = look();
    settings.floor = FloorSettings { on: true, height: -0.8, ..FloorSettings::default() };
    settings.shadows.algorithm = ShadowAlgorithm::Raycast;
    check("rays from voxels", &settings);
    settings.shadows.algorithm = ShadowAlgorithm::Direct;
    check("rays from samples", &settings);
}

#[test]
fn of_voxels_that_are_classified_first() {
    let mut settings = look();
    settings.sampling.classification = ClassificationOrder::Pre;
    settings.floor = FloorSettings { on: true, height: -0.8, ..FloorSettings::default() };
    for algorithm in [ShadowAlgorithm::Splat, ShadowAlgorithm::Raycast, ShadowAlgorithm::Direct] {
        settings.shadows.algorithm = algorithm;
        check(&format!("{algorithm:?}"), &settings);
    }
}

#[test]
fn under_a_light_that_has_a_size() {
    let mut settings = look();
    settings.lights =
        vec![LightSettings { shape: LightShape::Disc, angle_deg: 30.0, ..settings.lights[0].clone() }];
    settings.shadows.area.samples = 5;
    settings.floor = FloorSettings { on: true, height: -0.8, ..FloorSettings::default() };
    check("a disc", &settings);
}

#[test]
fn in_bytes() {
    let loaded = Dataset::new(scenes::creature(N, DVec3::ONE));
    let mut renderer = new_renderer();
    let mut colors = |precision| {
        let mut settings = look();
        settings.shadows.precision = precision;
        let volume = light_volume(&mut renderer, &loaded, &settings, 0).expect("it has a volume");
        volume.colors.into_iter().flatten().map(f64::from).collect::<Vec<_>>()
    };
    let (halves, bytes) = (colors(LightVolumePrecision::Half), colors(LightVolumePrecision::Byte));
    compare("bytes", &bytes, &halves, BYTES).unwrap_or_else(|err| panic!("{err}"));
}

#[test]
fn one_volume_for_all_lights_has_the_colours() {
    let mut settings = look();
    settings.shadows.near_field = NearFieldRay::Off;
    settings.shading.specular = 0.0;
    let loaded = Dataset::new(scenes::creature(N, DVec3::ONE));
    let mut renderer = new_renderer();
    let mut picture = |storage| {
        settings.shadows.storage = storage;
        channels_f32(&render(&mut renderer, &loaded, &settings, SIZE).linear)
    };
    let each = picture(LightStorage::PerLight);
    let all = picture(LightStorage::Combined);
    let limit = ErrorLimit { max: f64::INFINITY, rmse: COMBINED_NORMALS };
    compare("one volume for all", &all, &each, limit).unwrap_or_else(|err| panic!("{err}"));
}

/// A sky, which all material attenuates alike, beside light that is scattered.
#[test]
fn skies_are_attenuated_alike() {
    let mut settings = look();
    settings.sky.mode = chiaroscuro_scene::SkyMode::White;
    settings.sky.directions = 6;
    check("a sky", &settings);
}

/// Grey material has grey shadows, and the same picture as with the setting off.
#[test]
fn grey_matter_has_grey_shadows() {
    let mut settings = look();
    for point in &mut settings.layer_mut().transfer.points {
        point.color = [0.7; 3];
    }
    let loaded = Dataset::new(scenes::creature(N, DVec3::ONE));
    let mut renderer = new_renderer();
    let mut picture = |transmission| {
        settings.shadows.transmission = transmission;
        channels_f32(&render(&mut renderer, &loaded, &settings, SIZE).linear)
    };
    let (grey, colored) = (picture(0.0), picture(1.0));
    compare("grey", &colored, &grey, SAME_WEIGHTS).unwrap_or_else(|err| panic!("{err}"));
}

#[test]
fn mistakes_are_detected() {
    let settings = look();
    assert!(differences(&settings, NO_REPLACEMENT).is_empty());
    let mut classified = settings.clone();
    classified.sampling.classification = ClassificationOrder::Pre;
    let mut on_floor = classified.clone();
    on_floor.floor = FloorSettings { on: true, height: -0.8, ..FloorSettings::default() };
    for (settings, shader, from, to) in [
        (
            &settings,
            "light/colored_shadows.wgsl",
            "textureLoad(green, voxel, 0)",
            "textureLoad(blue, voxel, 0)",
        ),
        (
            &settings,
            "eye/eye_pass.wgsl",
            "let mean = lighting_table.integrals[low + 1u].rgb - first;",
            "let mean = lighting_table.integrals[low + 1u].aaa - lighting_table.integrals[low].aaa;",
        ),
        (&settings, "eye/eye_pass.wgsl", "return texel.rgb;", "return texel.rrr;"),
        (&classified, "light/march.wgsl", "[EXTINCTION_CHANNEL]", "[EXTINCTION_CHANNEL - 1u]"),
        (&classified, "eye/eye_pass.wgsl", "return texel.gba;", "return texel.rrr;"),
        (&on_floor, "eye/floor.wgsl", "extinction_of(Field(met.g))", "extinction_of(Field(met.b))"),
    ] {
        assert_in_shader(shader, from);
        assert!(!differences(settings, (from, to)).is_empty(), "{to:?} for {from:?} is not noticed");
    }
}
