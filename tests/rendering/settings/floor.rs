//! Floor: against the reference, against closed forms, and below the picture.

use chiaroscuro_reference::{Reference, ReferenceOptions};
use chiaroscuro_render::{PictureOptions, RenderOptions, Renderer};
use chiaroscuro_scene::{
    Background, Camera, DepositMode, FloorSettings, FovReference, LightGeometry, LightShape,
    LightVolumeResolution, ObjectRotation, OpacityLength, Projection, ReconstructionKernel, SceneAxis,
    Settings, ShadowAlgorithm, SkyMode, SkySettings, Spotlight, ToneMap, linear_from_srgb,
};
use glam::DVec3;

use crate::against_reference::mutations::assert_in_shader;
use crate::common::{Dataset, damaged_renderer, full_precision_renderer, new_renderer, render};
use crate::compare::{ErrorLimit, compare};
use crate::scenes::{self, axis_camera, linear_extinction};
use crate::thresholds::{
    EIGHT_BITS, F16_STEP, FLOOR_EDGE, FLOOR_PENUMBRA, FLOOR_SHADOW, FLOOR_UNDER_A_SKY, SAME_WEIGHTS,
};

const SIZE: [u32; 2] = [96, 80];
const NARROW: [u32; 2] = [48, 128];

fn with_floor(settings: Settings) -> Settings {
    Settings { floor: FloorSettings { on: true, height: -0.9, ..FloorSettings::default() }, ..settings }
}

/// Compares the visible floor beside the volume with the reference.
fn check_floor(name: &str, size: [u32; 2], spacing_mm: DVec3, settings: &Settings) {
    check_within(name, size, spacing_mm, settings, SAME_WEIGHTS);
}

fn check_within(name: &str, size: [u32; 2], spacing_mm: DVec3, settings: &Settings, limit: ErrorLimit) {
    check_against(size, spacing_mm, [settings; 2], name, limit);
}

/// Compares the floor of the GPU under one look with that of the reference under another.
fn check_against(
    size: [u32; 2],
    spacing_mm: DVec3,
    [settings, reference_settings]: [&Settings; 2],
    name: &str,
    limit: ErrorLimit,
) {
    let mut renderer = new_renderer();
    let loaded = Dataset::new(scenes::creature(40, spacing_mm));
    let [found, expected] = visible_floors(&mut renderer, size, &loaded, [settings, reference_settings]);
    assert!(expected.iter().sum::<f64>() > 10.0, "{name}: there is a floor to see");
    compare(name, &found, &expected, limit).unwrap_or_else(|err| panic!("{err}"));
}

/// Floor of a renderer under one look where it is not covered, and of the reference under another.
fn visible_floors(
    renderer: &mut Renderer,
    size: [u32; 2],
    loaded: &Dataset,
    [settings, of_reference]: [&Settings; 2],
) -> [Vec<f64>; 2] {
    let rounding: fn(f32) -> f32 = |value| half::f16::from_f32(value).to_f32();
    let options = ReferenceOptions { rounding: Some(rounding), ..ReferenceOptions::default() };
    let reference = Reference::new(loaded.volume(), of_reference, options);
    let picture = render(renderer, loaded, settings, size);
    let floor = renderer.read_floor().expect("a floor");
    let past = |floor: [f64; 4], at: usize| {
        let through = 1.0 - f64::from(picture.linear[at][3]);
        floor.map(|channel| channel * through)
    };
    let found = floor.iter().enumerate().flat_map(|(at, texel)| past(texel.map(f64::from), at)).collect();
    let expected =
        reference.floor(size).iter().enumerate().flat_map(|(at, texel)| past(*texel, at)).collect();
    [found, expected]
}

#[test]
fn floor_and_shadows_as_in_the_reference() {
    let mut settings = with_floor(scenes::look());
    settings.shadows.balance = 1.7;
    check_floor("parallel light, perspective camera", SIZE, DVec3::ONE, &settings);
    settings.camera.fit = FovReference::Frame;
    check_floor("a frame in a narrow picture", NARROW, DVec3::ONE, &settings);
    settings.camera.projection = Projection::Orthographic;
    settings.camera.elevation_deg = 50.0;
    let mut scene_light = scenes::light(LightGeometry::Perspective, [1.1, -0.8, 1.6]);
    scene_light.hood = Spotlight { on: true, half_angle_deg: 30.0, rim_deg: 8.0 };
    settings.lights.push(scene_light);
    settings.lights[0].casts_shadows = false;
    settings.shadows.gain = 1.3;
    settings.shadows.ambient_offset = 0.1;
    settings.shadows.kernel = ReconstructionKernel::Prefiltered;
    settings.shadows.deposit = DepositMode::Front;
    check_floor("hood, cures, orthographic camera", NARROW, DVec3::new(1.0, 0.8, 1.6), &settings);
    settings.floor.shadow_only = true;
    settings.floor.opacity = 0.8;
    settings.lights[0].casts_shadows = true;
    settings.cuts.plane.on = true;
    check_floor("shadow alone, and cut", SIZE, DVec3::ONE, &settings);
}

/// Area lights, one of them partly below the floor: by rays, and on maps, which are interpolated.
#[test]
fn penumbrae_on_the_floor_as_in_the_reference() {
    let mut settings = with_floor(scenes::look());
    let mut scene_light = scenes::light(LightGeometry::Perspective, [2.1, -0.9, 0.0]);
    (scene_light.shape, scene_light.size) = (LightShape::Rectangle, 2.6);
    scene_light.hood = Spotlight { on: true, half_angle_deg: 60.0, rim_deg: 20.0 };
    settings.lights.push(scene_light);
    (settings.lights[0].shape, settings.lights[0].angle_deg) = (LightShape::Disc, 25.0);
    settings.shadows.area.samples = 4;
    settings.shadows.algorithm = ShadowAlgorithm::Raycast;
    check_floor("by rays", SIZE, DVec3::ONE, &settings);
    settings.shadows.algorithm = ShadowAlgorithm::Splat;
    settings.floor.height = -1.05;
    settings.shadows.area.resolution = LightVolumeResolution::Full;
    check_within("on maps", SIZE, DVec3::ONE, &settings, FLOOR_PENUMBRA);
    // A light within the bounding cube of its own sheets.
    settings.lights[1].position = [0.9, -0.8, 0.7];
    settings.lights[1].shape = LightShape::Ball;
    settings.lights[1].size = 0.4;
    check_within("a lamp near by", SIZE, DVec3::ONE, &settings, FLOOR_PENUMBRA);
    let mut narrow = settings.clone();
    narrow.lights[0].angle_deg = 12.0;
    let found = std::panic::catch_unwind(|| {
        check_against(SIZE, DVec3::ONE, [&settings, &narrow], "half as wide", FLOOR_PENUMBRA);
    });
    assert!(found.is_err(), "a light that is half as wide is noticed");
}

/// The sky visibility of the floor is interpolated from a map, while the reference evaluates every pixel.
#[test]
fn it_takes_the_light_of_a_sky() {
    let mut settings = with_floor(scenes::look());
    settings.sky = SkySettings {
        mode: SkyMode::Gradient,
        intensity: 0.9,
        zenith: [0.6, 0.8, 1.0],
        ground: [0.4, 0.2, 0.1],
        tilt_deg: 30.0,
        turn_deg: 200.0,
        directions: 14,
        ..SkySettings::default()
    };
    check_within("under a sky", SIZE, DVec3::new(1.0, 0.9, 1.2), &settings, FLOOR_UNDER_A_SKY);
    settings.floor.shadow_only = true;
    settings.shadows.strength = 0.8;
    check_within("shadow alone", SIZE, DVec3::ONE, &settings, FLOOR_UNDER_A_SKY);
    settings.shadows.algorithm = ShadowAlgorithm::Off;
    settings.floor.shadow_only = false;
    check_floor("nothing in its way", SIZE, DVec3::ONE, &settings);
    // Guards the comparison: another sky is detected.
    settings.shadows.algorithm = ShadowAlgorithm::Splat;
    let dark = Settings { sky: SkySettings { intensity: 0.5, ..settings.sky.clone() }, ..settings.clone() };
    let found = std::panic::catch_unwind(|| {
        check_against(SIZE, DVec3::ONE, [&settings, &dark], "another sky", FLOOR_UNDER_A_SKY);
    });
    assert!(found.is_err(), "half as bright a sky is noticed");
}

/// A floor that cuts through an object receives the light at its height, and each mistake in how it is traced there
/// is detected.
#[test]
fn light_of_a_sky_ends_where_it_meets_the_floor() {
    // In a corner of its grid, and extending below the floor.
    let loaded =
        Dataset::new(scenes::block(32, |[x, y, z]| x < 14 && y < 12 && (4..30).contains(&z) && x + y < 20));
    let mut settings = with_floor(scenes::look());
    settings.layer_mut().transfer = scenes::linear_extinction(0.2);
    (settings.floor.height, settings.camera.elevation_deg) = (-0.2, 40.0);
    settings.sky =
        SkySettings { mode: SkyMode::White, intensity: 0.9, directions: 14, ..SkySettings::default() };
    settings.lights.clear();
    let disagrees = |from: &str, to: &str| {
        let mut renderer = damaged_renderer(from, to);
        let [found, expected] = visible_floors(&mut renderer, SIZE, &loaded, [&settings; 2]);
        compare(to, &found, &expected, FLOOR_UNDER_A_SKY).is_err()
    };
    assert!(!disagrees("\u{0}", ""), "undamaged sides agree");
    let mistakes = [
        // Through the floor, instead of to it.
        ("sky/floor_sweep.wgsl", "min(ray.span.y, end)", "ray.span.y"),
        ("sky/floor_sweep.wgsl", "min(ray.span.y, end)", "min(ray.span.y, end - 1.0)"),
        ("sky/floor_sweep.wgsl", "map.plane.w - dot", "-dot"),
        // Transmittance at the floor is lower than the mean over the last slice.
        (
            "sky/floor_sweep.wgsl",
            "slab_mean_transmittance(tau), n == end",
            "slab_mean_transmittance(tau), n > end",
        ),
        // Light that passes beside the grid is taken from its border.
        ("sky/floor_sweep.wgsl", "select(min(ray.span.y, end), -1.0, is_beside)", "min(ray.span.y, end)"),
        ("sky/floor_map.wgsl", "ray + 1.5", "ray + 1.0"),
        ("sky/floor_map.wgsl", "f32(i) + 0.5) * sweep", "0.5) * sweep"),
    ];
    for (shader, from, to) in mistakes {
        assert_in_shader(shader, from);
        assert!(disagrees(from, to), "{shader}: {to:?} is not noticed");
    }
}

/// The floor beside an object that hides at most a quarter of the sky is as bright as the sky gives, and darker under
/// it.
#[test]
fn it_is_dark_below_and_bright_beside_the_object() {
    let loaded =
        Dataset::new(scenes::block(32, |[x, y, z]| (8..24).contains(&x) && (8..24).contains(&y) && z > 3));
    let mut settings = with_floor(scenes::look());
    settings.layer_mut().transfer = scenes::linear_extinction(3.0);
    settings.lights.clear();
    settings.floor.radius = 20.0;
    settings.sky =
        SkySettings { mode: SkyMode::White, intensity: 0.8, directions: 64, ..SkySettings::default() };
    settings.camera.elevation_deg = 40.0;
    let mut renderer = new_renderer();
    render(&mut renderer, &loaded, &settings, SIZE);
    let floor = renderer.read_floor().expect("a floor");
    let open = 0.8 * linear_from_srgb(f64::from(settings.floor.color[0]));
    let reds: Vec<f64> =
        floor.iter().filter(|texel| texel[3] > 0.0).map(|texel| f64::from(texel[0] / texel[3])).collect();
    let (least, most) =
        reds.iter().fold((f64::INFINITY, 0f64), |(least, most), &red| (least.min(red), most.max(red)));
    println!("{least} … {most} of {open}");
    assert!((most / open - 1.0).abs() < 0.02, "{most} of {open}");
    assert!(least < 0.4 * open, "{least} of {open}");
}

/// The floor lies under the object, and faces up, for every up axis.
#[test]
fn it_lies_below_whatever_is_up() {
    for up in SceneAxis::ALL {
        let mut settings = with_floor(scenes::look());
        settings.rotate_object(ObjectRotation::MakeUpright(up));
        settings.floor.radius = 2.0;
        check_floor(&format!("{up:?} up"), [48, 40], DVec3::new(1.0, 0.8, 1.6), &settings);
    }
}

#[test]
fn every_algorithm_and_engine_has_it() {
    let mut settings = with_floor(scenes::look());
    let loaded = Dataset::new(scenes::creature(24, DVec3::ONE));
    let mut renderer = new_renderer();
    let mut shadows = Vec::new();
    for algorithm in [ShadowAlgorithm::Splat, ShadowAlgorithm::Raycast, ShadowAlgorithm::Direct] {
        settings.shadows.algorithm = algorithm;
        render(&mut renderer, &loaded, &settings, SIZE);
        shadows.push(renderer.read_floor().expect("a floor"));
    }
    // Pixels that the volume nearly covers are not drawn, and the set of these may differ.
    let differ = |a: &[[f32; 4]], b: &[[f32; 4]]| a.iter().zip(b).filter(|(a, b)| a != b).count();
    for other in &shadows[1..] {
        let share = differ(&shadows[0], other) as f64 / shadows[0].len() as f64;
        assert!(share < FLOOR_EDGE, "{share}");
    }
    settings.shadows.algorithm = ShadowAlgorithm::Off;
    render(&mut renderer, &loaded, &settings, SIZE);
    let bare = renderer.read_floor().expect("a floor");
    assert!(differ(&shadows[0], &bare) > 200, "shadows lie on the floor");
    assert!(bare.iter().zip(&shadows[0]).all(|(bare, shadowed)| bare[0] >= shadowed[0] - F16_STEP));
}

/// Block of 32³ voxels with extinction ln 2 per 16 voxels, under a light straight above it: a quarter of the light is
/// transmitted.
#[test]
fn what_a_block_lets_through_falls_on_the_floor() {
    let inside = |at: [usize; 3]| at.iter().all(|c| (8..40).contains(c));
    let loaded = Dataset::new(scenes::block(48, inside));
    let mut settings = Settings {
        lights: vec![scenes::light(LightGeometry::Parallel, [0.0, 0.0, 1.0])],
        // From above, past the block: it looks at the floor beside the centre.
        camera: axis_camera(-90.0, 60.0),
        ..Settings::default()
    }
    .with_transfer(linear_extinction(2.0_f64.ln() / 16.0))
    .with_opacity_unit(OpacityLength::Voxels(1.0));
    settings.shading.ambient = 0.0;
    settings.shading.diffuse = 1.0;
    settings.floor =
        FloorSettings { on: true, height: -3.0, color: [1.0; 3], radius: 50.0, ..FloorSettings::default() };
    let camera = settings.camera.clone();
    let mut renderer = full_precision_renderer();
    // Aims at a point of the floor.
    settings.camera.target = [0.0, 0.0, -3.0];
    let picture = render(&mut renderer, &loaded, &settings, [65, 65]);
    let floor = renderer.read_floor().expect("a floor");
    let at = 32 * 65 + 32;
    assert_eq!(picture.linear[at][3], 0.0, "the block is not in the way");
    assert!((f64::from(floor[at][0]) - 0.25).abs() < FLOOR_SHADOW, "{:?}", floor[at]);
    settings.camera.target = [1.5, 0.0, -3.0];
    render(&mut renderer, &loaded, &settings, [65, 65]);
    let floor = renderer.read_floor().expect("a floor");
    assert!((f64::from(floor[at][0]) - 1.0).abs() < FLOOR_SHADOW, "beside the shadow: {:?}", floor[at]);
    // The floor is invisible from below.
    settings.camera = Camera { elevation_deg: -30.0, ..camera };
    render(&mut renderer, &loaded, &settings, [65, 65]);
    assert!(renderer.read_floor().expect("a floor").iter().all(|texel| *texel == [0.0; 4]));
}

#[test]
fn it_lies_behind_the_volume_and_before_the_background() {
    let loaded = Dataset::new(scenes::creature(32, DVec3::ONE));
    let mut settings = scenes::look();
    settings.output.background = Background { top: [0.2; 3], bottom: [0.2; 3] };
    settings.output.tone_map = ToneMap::Clip;
    let mut renderer = new_renderer();
    let bare = render(&mut renderer, &loaded, &settings, SIZE);
    settings = with_floor(settings);
    let with = render(&mut renderer, &loaded, &settings, SIZE);
    assert!(bare.linear == with.linear, "the volume is as it was");
    let texel =
        |bytes: &[u8], at: usize| [bytes[4 * at], bytes[4 * at + 1], bytes[4 * at + 2], bytes[4 * at + 3]];
    let floor = renderer.read_floor().expect("a floor");
    let mut seen = 0;
    for (at, light) in bare.linear.iter().enumerate() {
        if light[3] > 0.9999 || floor[at][3] == 0.0 {
            assert_eq!(texel(&bare.display, at), texel(&with.display, at));
        } else if light[3] == 0.0 && floor[at][3] == 1.0 {
            let srgb = |c: f32| if c <= 0.003_130_8 { c * 12.92 } else { 1.055 * c.powf(1.0 / 2.4) - 0.055 };
            for (found, wanted) in texel(&with.display, at).iter().zip(&floor[at][..3]) {
                let apart = f64::from(f32::from(*found) / 255.0 - srgb(wanted.min(1.0))).abs();
                assert!(apart < EIGHT_BITS, "{apart}");
            }
            seen += 1;
        }
    }
    assert!(seen > 300, "{seen} pixels of the bare floor");
    // On transparent pictures shadows are half-transparent black.
    settings.floor.shadow_only = true;
    let options = RenderOptions::from(PictureOptions { transparent: true, ..PictureOptions::default() });
    let picture = renderer.render(&loaded, &settings, SIZE, &options).expect("a picture");
    let shadows = (0..bare.linear.len()).filter(|&at| {
        let [r, g, b, alpha] = texel(&picture.display, at);
        bare.linear[at][3] == 0.0 && alpha > 100 && [r, g, b] == [0; 3]
    });
    assert!(shadows.count() > 100);
}
