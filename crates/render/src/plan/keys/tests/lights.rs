//! Tests of changes to lights, and of the keys of their volumes.

use super::{ChangeEffect, effect, effect_of, keys, request};
use crate::plan::{LightKey, RenderRequest};
use chiaroscuro_scene::{LightLock, LightShape, LightVolumeResolution, SkyMode, apply_path};

#[test]
fn the_size_of_a_light_is_part_of_its_volume_alone() {
    let mut before = request();
    before.settings.lights[1].shape = LightShape::Disc;
    // Wide enough for all points.
    before.settings.lights[1].angle_deg = 40.0;
    before.settings.lights[2].shape = LightShape::Rectangle;
    for (path, value, expected) in [
        ("lights.1.angle_deg", "5", ChangeEffect::OneLight),
        // The size of the disc is an angle, that of the rectangle a length.
        ("lights.1.size", "0.5", ChangeEffect::Nothing),
        ("lights.2.size", "0.5", ChangeEffect::OneLight),
        ("lights.2.angle_deg", "5", ChangeEffect::Nothing),
        ("lights.1.aspect", "2", ChangeEffect::Nothing),
        ("lights.2.aspect", "2", ChangeEffect::OneLight),
        ("lights.2.turn_deg", "20", ChangeEffect::OneLight),
        ("lights.1.color", "[1,0,0]", ChangeEffect::Eye),
        ("lights.1.intensity", "2", ChangeEffect::Eye),
        ("shadows.area.samples", "16", ChangeEffect::AllLights),
        ("shadows.area.resolution", "full", ChangeEffect::AllLights),
        // The area light is coarser already.
        ("shadows.resolution", "half", ChangeEffect::OneLight),
    ] {
        assert_eq!(effect_of(&before, path, value), expected, "{path} = {value}");
    }
    let key = LightKey::new(&before, 1).expect("it casts shadows");
    assert_eq!((key.samples(), key.resolution()), (64, LightVolumeResolution::Half));
    let coarse = key.for_preview(LightVolumeResolution::Quarter);
    assert_eq!((coarse.samples(), coarse.resolution()), (16, LightVolumeResolution::Quarter));
    // A preview is never finer than the picture.
    let point = LightKey::new(&before, 0).expect("it casts shadows");
    assert_eq!(
        (point.samples(), point.for_preview(LightVolumeResolution::Half).resolution()),
        (1, LightVolumeResolution::Half)
    );
    before.settings.shadows.resolution = LightVolumeResolution::Quarter;
    let key = LightKey::new(&before, 1).expect("it casts shadows");
    assert_eq!(key.for_preview(LightVolumeResolution::Half).resolution(), LightVolumeResolution::Quarter);
}

#[test]
fn wide_lights_depend_on_whether_there_are_surfaces() {
    let mut before = request();
    before.settings.sky.mode = SkyMode::Off;
    before.settings.lights[1].shape = LightShape::Disc;
    for (angle_deg, expected) in [(5.0, ChangeEffect::Eye), (20.0, ChangeEffect::OneLight)] {
        before.settings.lights[1].angle_deg = angle_deg;
        assert_eq!(effect_of(&before, "shading.surface_gradient", "1.5"), expected, "{angle_deg}°");
        assert_eq!(effect_of(&before, "shading.surface_gradient", "0.1"), ChangeEffect::Eye, "{angle_deg}°");
    }
}

#[test]
fn a_light_that_is_off_may_move() {
    let mut before = request();
    before.settings.lights[1].on = false;
    assert_eq!(effect_of(&before, "lights.1.position", "[5,0,0]"), ChangeEffect::Nothing);
    assert_eq!(effect_of(&before, "lights.1.on", "true"), ChangeEffect::OneLight);
}

#[test]
fn a_light_that_is_locked_to_the_camera_turns_with_it() {
    let mut before = request();
    before.settings.lights[1].lock = LightLock::Camera;
    assert_eq!(effect_of(&before, "camera.azimuth_deg", "10"), ChangeEffect::OneLight);
}

#[test]
fn removing_a_light_rebuilds_nothing() {
    let mut next = request();
    next.settings.lights.remove(0);
    assert_eq!(effect(&keys(&request()), &keys(&next)), ChangeEffect::Eye);
}

#[test]
fn light_colours_only_rebuild_bounced_light() {
    for (path, value) in [
        ("lights.1.color", "[1,0,0]"),
        ("lights.1.intensity", "2"),
        ("transfer.points.0.color", "[1,0,0]"),
        ("shading.emission", "0.1"),
        ("sky.intensity", "0.1"),
        ("scattering.anisotropy", "0.5"),
    ] {
        assert_eq!(effect_of(&request(), path, value), ChangeEffect::Eye, "{path}");
    }
    assert_eq!(effect_of(&request(), "scattering.albedo", "0.5"), ChangeEffect::Nothing);
    assert_eq!(effect_of(&request(), "scattering.bounces", "2"), ChangeEffect::Bounces);
}

#[test]
fn colours_of_what_light_meets_count_where_shadows_are_coloured() {
    let mut before = request();
    before.settings.sky.mode = SkyMode::Off;
    before.settings.shadows.transmission = 0.5;
    assert_eq!(effect_of(&before, "transfer.points.0.color", "[1,0,0]"), ChangeEffect::AllLights);
    assert_eq!(effect_of(&before, "shadows.transmission", "0.4"), ChangeEffect::AllLights);
    assert_eq!(effect_of(&before, "lighting.curve.points", "[]"), ChangeEffect::Nothing);
    let layer = before.settings.layer_mut();
    layer.lighting.linked = false;
    layer.lighting.curve = layer.transfer.clone();
    // The eye's colours no longer apply to light.
    assert_eq!(effect_of(&before, "lighting.curve.points.0.color", "[1,0,0]"), ChangeEffect::AllLights);
    // Shadow rays use the colours in the eye pass itself.
    before.settings.shadows.algorithm = chiaroscuro_scene::ShadowAlgorithm::Direct;
    assert_eq!(effect_of(&before, "lighting.curve.points.0.color", "[1,0,0]"), ChangeEffect::Eye);
    // Without shadows, the colours have no effect.
    before.settings.shadows.algorithm = chiaroscuro_scene::ShadowAlgorithm::Off;
    assert_eq!(effect_of(&before, "shadows.transmission", "0.4"), ChangeEffect::Nothing);
}

#[test]
fn combined_light_follows_what_its_samples_see() {
    let mut before = request();
    before.settings.shadows.storage = chiaroscuro_scene::LightStorage::Combined;
    let differs = |path: &str, value: &str| {
        let settings = apply_path(&before.settings, path, value).unwrap();
        keys(&RenderRequest { settings, ..before.clone() }).combined != keys(&before).combined
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
