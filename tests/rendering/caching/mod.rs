//! Cache tests: products that are kept or refilled after a change, and bit-exact results.

use chiaroscuro_render::{Renderer, plan::RenderRequest};
use chiaroscuro_scene::{LightGeometry, NearFieldRay, Settings};
use glam::DVec3;

use crate::common::{Dataset, new_renderer, render};
use crate::scenes;
use crate::thresholds::{F16_STEP, REFILLED, SPOILED};

mod bit_exactness;
mod needed_blocks;
mod recomputes;
mod spare_volumes;
mod warm_up;

const SIZE: [u32; 2] = [64, 48];

fn three_lights() -> Settings {
    let mut settings = scenes::look();
    settings.lights = vec![
        scenes::light(LightGeometry::Parallel, [1.3, -0.8, 1.7]),
        scenes::light(LightGeometry::Perspective, [-1.8, 1.5, 2.0]),
        scenes::light(LightGeometry::Parallel, [-0.2, -1.0, 0.3]),
    ];
    settings
}

fn loaded() -> Dataset {
    Dataset::new(scenes::creature(32, DVec3::ONE))
}

#[test]
fn orbiting_rebuilds_no_light() {
    orbit(10);
}

#[test]
#[ignore = "long: a hundred frames; script/test --all runs it"]
fn orbiting_a_hundred_frames_rebuilds_no_light() {
    orbit(100);
}

/// Orbits once around in a number of frames, and checks that no light volume is refilled.
fn orbit(frames: u32) {
    let (loaded, mut settings) = (loaded(), three_lights());
    let mut renderer = new_renderer();
    render(&mut renderer, &loaded, &settings, SIZE);
    assert_eq!(renderer.light_rebuilds(), [1, 1, 1]);
    for _ in 0..frames {
        settings.camera.orbit(360.0 / f64::from(frames), 1.0);
        render(&mut renderer, &loaded, &settings, SIZE);
    }
    assert_eq!(renderer.light_rebuilds(), [1, 1, 1]);
}

#[test]
fn dragging_three_shadowed_lights_makes_nothing_anew() {
    dragging_makes_nothing_anew(three_lights());
}

#[test]
fn dragging_a_light_beside_a_fill_makes_nothing_anew() {
    let mut settings = three_lights();
    settings.lights.truncate(2);
    settings.lights[1].casts_shadows = false;
    dragging_makes_nothing_anew(settings);
}

fn dragging_makes_nothing_anew(mut settings: Settings) {
    let loaded = loaded();
    let mut renderer = new_renderer();
    let drag = |renderer: &mut Renderer, settings: &mut Settings, at: u32| {
        // Back and forth, so that sheets and lists have had every size.
        let turn = glam::DQuat::from_rotation_z(0.1 * f64::from(at % 8));
        settings.lights[0].position = (turn * DVec3::new(1.3, -0.8, 1.7)).into();
        settings.lights[1].position = (turn * DVec3::new(-1.8, 1.5, 2.0)).into();
        settings.camera.orbit(3.6, 0.3);
        render(renderer, &loaded, settings, SIZE);
    };
    let mut drag_on = |renderer: &mut Renderer| {
        (0..24).for_each(|at| drag(renderer, &mut settings, at));
        (renderer.created_resources(), renderer.gpu_bytes())
    };
    let mut known = drag_on(&mut renderer);
    assert!(known.0 > 10, "the count must see what was made: {}", known.0);
    // Work is split by the time that it takes, and a busy machine may split it in a new way now and then. What makes
    // buffers, bind groups or sheets with every light does so in each of these drags.
    let is_settled = (0..6).any(|_| {
        let before = std::mem::replace(&mut known, drag_on(&mut renderer));
        known == before
    });
    assert!(is_settled, "a drag makes things anew: {known:?}");
}

#[test]
fn live_controls_rebuild_no_light_and_change_the_picture() {
    let (loaded, settings) = (loaded(), three_lights());
    let mut renderer = new_renderer();
    let before = render(&mut renderer, &loaded, &settings, SIZE);
    type Change = fn(&mut Settings);
    let changes: [(&str, Change); 8] = [
        ("colour", |s| s.lights[0].color = [1.0, 0.2, 0.1]),
        ("intensity", |s| s.lights[1].intensity = 0.3),
        ("gain", |s| s.shadows.gain = 1.7),
        ("offset", |s| s.shadows.ambient_offset = 0.2),
        ("strength", |s| s.shadows.strength = 0.4),
        ("balance", |s| s.shadows.balance = 1.4),
        ("off", |s| s.lights[2].on = false),
        ("shading", |s| s.shading.diffuse = 0.5),
    ];
    for (name, change) in changes {
        let mut changed = settings.clone();
        change(&mut changed);
        let after = render(&mut renderer, &loaded, &changed, SIZE);
        assert_eq!(renderer.light_rebuilds(), [1, 1, 1], "{name}");
        assert_ne!(after.linear, before.linear, "{name} changes nothing");
    }
    // Back to the first settings: the same bytes, and still nothing is refilled.
    assert_eq!(render(&mut renderer, &loaded, &settings, SIZE), before);
    assert_eq!(renderer.light_rebuilds(), [1, 1, 1]);
}

/// With a bias, light is looked up further from material: that region is filled when a bias is first used, for the
/// largest bias. Filling it always would make every light build a seventh longer.
#[test]
fn a_light_bias_fills_more_once_and_is_live_from_then_on() {
    let (loaded, mut settings) = (loaded(), three_lights());
    settings.shadows.near_field = NearFieldRay::Off;
    let mut renderer = new_renderer();
    let before = render(&mut renderer, &loaded, &settings, SIZE);
    let mut seen = vec![before.linear.clone()];
    for bias_voxels in [0.1, 1.5, 2.0, 0.7] {
        settings.shadows.bias_voxels = bias_voxels;
        let picture = render(&mut renderer, &loaded, &settings, SIZE);
        assert!(!seen.contains(&picture.linear), "a bias of {bias_voxels} changes nothing");
        seen.push(picture.linear);
        assert!(renderer.light_rebuilds().iter().all(|&rebuilds| rebuilds <= 2), "{bias_voxels}");
    }
    let rebuilds = renderer.light_rebuilds().to_vec();
    settings.shadows.bias_voxels = 0.0;
    assert_eq!(render(&mut renderer, &loaded, &settings, SIZE), before);
    assert_eq!(renderer.light_rebuilds(), rebuilds);
}

#[test]
fn moving_one_of_three_lights_rebuilds_exactly_that_one() {
    let (loaded, mut settings) = (loaded(), three_lights());
    let mut renderer = new_renderer();
    render(&mut renderer, &loaded, &settings, SIZE);
    settings.lights[1].position = [-1.5, 1.7, 2.0];
    render(&mut renderer, &loaded, &settings, SIZE);
    assert_eq!(renderer.light_rebuilds(), [1, 2, 1]);
    // Further out along the same direction a parallel light is unchanged.
    settings.lights[0].position = [2.6, -1.6, 3.4];
    render(&mut renderer, &loaded, &settings, SIZE);
    assert_eq!(renderer.light_rebuilds(), [1, 2, 1]);
}

#[test]
fn a_lighting_transfer_edit_rebuilds_all() {
    let (loaded, mut settings) = (loaded(), three_lights());
    let mut renderer = new_renderer();
    render(&mut renderer, &loaded, &settings, SIZE);
    settings.layer_mut().lighting.scale = 0.5;
    render(&mut renderer, &loaded, &settings, SIZE);
    assert_eq!(renderer.light_rebuilds(), [2, 2, 2]);
}

/// A reused attenuation volume equals a fresh one; spoiling it shows that changes that may keep it do keep it, and
/// that moving the light refills it.
#[test]
fn kept_light_volumes_are_really_kept_and_refilled_ones_really_refilled() {
    let (loaded, mut settings) = (loaded(), scenes::look());
    let mut renderer = new_renderer();
    render(&mut renderer, &loaded, &settings, SIZE);
    settings.lights[0].color = [0.9, 0.7, 0.5];
    settings.shadows.gain = 1.3;
    let kept = render(&mut renderer, &loaded, &settings, SIZE);
    let fresh = render(&mut new_renderer(), &loaded, &settings, SIZE);
    let worst = kept.linear.iter().flatten().zip(fresh.linear.iter().flatten()).map(|(a, b)| (a - b).abs());
    assert!(worst.fold(0.0, f32::max) <= F16_STEP);

    let request = |settings: &Settings| RenderRequest {
        volume: loaded.id(),
        settings: settings.clone(),
        size: SIZE,
        preview_resolution: None,
    };
    assert!(renderer.corrupt_attenuation(&request(&settings), 0), "there is a volume to spoil");
    let mean = |picture: &chiaroscuro_render::RenderedPicture| {
        picture.linear.iter().map(|t| f64::from(t[1])).sum::<f64>()
    };
    let spoiled = render(&mut renderer, &loaded, &settings, SIZE);
    assert!(mean(&spoiled) < SPOILED * mean(&fresh), "no light is left");
    settings.lights[0].intensity = 1.01;
    let still = render(&mut renderer, &loaded, &settings, SIZE);
    assert!(mean(&still) < SPOILED * mean(&fresh), "a live control does not refill it");
    settings.lights[0].position = [1.31, -0.8, 1.7];
    let moved = render(&mut renderer, &loaded, &settings, SIZE);
    assert!(mean(&moved) > REFILLED * mean(&fresh), "moving the light does");
}
