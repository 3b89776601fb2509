//! Bit-exactness tests: empty-space skipping, repetition, earlier previews, and the margin of light volumes change no
//! bit.

use chiaroscuro_render::{RenderOptions, Renderer, TestSwitches, WorkOptions, plan::RenderRequest};
use chiaroscuro_scene::{
    LightGeometry, LightStorage, LightVolumeResolution, ReconstructionKernel, Settings, ShadowAlgorithm,
    SkyMode, SlabMode, SlabQuadrature,
};
use chiaroscuro_volume::{Samples, Volume};
use glam::DVec3;

use super::{SIZE, loaded, three_lights};
use crate::common::{Dataset, full_attenuation, new_renderer, render};
use crate::scenes;
use crate::thresholds::F16_STEP;

/// Tests every look with one chunk length, a different one for each look.
#[test]
fn skipping_changes_no_bit_and_chunks_only_rounding() {
    check_skipping(|look, chunk| CHUNK_LENGTHS[look % CHUNK_LENGTHS.len()] == chunk);
}

#[test]
#[ignore = "long: every look with chunks of every length; script/test --all runs it"]
fn chunks_of_every_length_change_only_rounding() {
    check_skipping(|_, _| true);
}

/// Number of slabs per chunk: one, some, and more than exist.
const CHUNK_LENGTHS: [u32; 3] = [1, 5, 1000];

/// Looks in which rays and light skip empty space in different ways.
fn skipping_looks() -> Vec<Settings> {
    let mut looks = vec![scenes::look(), three_lights()];
    looks[0].sampling.slab = 2.0;
    looks[0].sampling.quadrature = SlabQuadrature::Two;
    looks[0].shadows.quadrature = SlabQuadrature::Two;
    looks[1].camera.distance = 11.0;
    looks[1].sampling.kernel = ReconstructionKernel::Gaussian { sigma: 0.8 };
    let mut inside = scenes::look();
    inside.lights[0] = scenes::light(LightGeometry::Perspective, [0.1, -0.4, 0.5]);
    inside.camera.distance = 0.6;
    looks.push(inside);
    let mut by_need = scenes::look();
    by_need.sampling.slabs = SlabMode::ByNeed;
    looks.push(by_need.clone());
    by_need.sampling.slabs = SlabMode::Preintegrated;
    looks.push(by_need);
    let mut biased = scenes::look();
    biased.shadows.bias_voxels = 2.0;
    let mut halved = scenes::look();
    halved.shadows.resolution = LightVolumeResolution::Half;
    let mut combined = three_lights();
    combined.shadows.storage = LightStorage::Combined;
    looks.extend([biased, halved, combined]);
    for algorithm in [ShadowAlgorithm::Raycast, ShadowAlgorithm::Direct] {
        let mut rays = scenes::look();
        rays.shadows.algorithm = algorithm;
        looks.push(rays);
    }
    let mut quartered = scenes::look();
    quartered.shadows.resolution = LightVolumeResolution::Quarter;
    let mut cropped = scenes::look();
    (cropped.cuts.crop.on, cropped.cuts.crop.low) = (true, [0.3, 0.0, 0.0]);
    let mut near = scenes::look();
    near.lights[0] = scenes::light(LightGeometry::Perspective, [1.9, -1.4, 1.6]);
    let mut thick = looks[2].clone();
    (thick.shadows.quadrature, thick.shadows.slab) = (SlabQuadrature::Two, 2.0);
    looks.extend([quartered, cropped, near, thick]);
    looks.extend(soft_light_looks());
    looks
}

/// Looks in which rays from all directions skip empty space: towards places near visible material, towards scattering
/// material, and towards a floor.
fn soft_light_looks() -> [Settings; 3] {
    let mut sky = scenes::look();
    (sky.sky.mode, sky.sky.directions, sky.floor.on) = (SkyMode::Gradient, 9, true);
    let mut bounces = sky.clone();
    (bounces.scattering.bounces, bounces.scattering.directions) = (3, 6);
    bounces.sky.resolution = LightVolumeResolution::Quarter;
    // The lighting curve shows less than the eye's; and pixels are wide.
    let mut apart = sky.clone();
    apart.layer_mut().lighting.linked = false;
    apart.layer_mut().lighting.curve = apart.layer().transfer.clone();
    apart.layer_mut().lighting.curve.points.iter_mut().for_each(|point| point.value += 40.0);
    apart.sky.resolution = LightVolumeResolution::Full;
    apart.camera.distance = 11.0;
    [sky, bounces, apart]
}

/// Checks that skipping bricks changes no bit. Sheets are streamed in chunks: the ring's layers move, so fetches
/// between them are rounded differently, and nothing else changes. `is_selected` selects the looks and chunk lengths.
fn check_skipping(is_selected: impl Fn(usize, u32) -> bool) {
    let loaded = Dataset::new(scenes::creature(48, DVec3::new(1.0, 1.0, 1.3)));
    for (at, settings) in skipping_looks().iter().enumerate() {
        let picture = |options: &RenderOptions| {
            let mut renderer = new_renderer();
            renderer.render(&loaded, settings, [120, 90], options).expect("a picture")
        };
        let usual = picture(&RenderOptions::default());
        let plodding = picture(&RenderOptions {
            work: WorkOptions { fill_all_light_voxels: true, ..WorkOptions::default() },
            switches: TestSwitches { empty_space_skipping: false, ..TestSwitches::default() },
            ..RenderOptions::default()
        });
        assert_eq!(usual.linear, plodding.linear, "look {at}: skipping empty space changes the picture");
        assert_eq!(usual.display, plodding.display, "look {at}: skipping empty space changes what is shown");
        let parts = picture(&RenderOptions::from(WorkOptions { light_parts: 3, ..WorkOptions::default() }));
        assert_eq!(usual.linear, parts.linear, "look {at}: cutting chunks into parts changes the picture");
        for chunk in CHUNK_LENGTHS.into_iter().filter(|&chunk| is_selected(at, chunk)) {
            let chunked =
                picture(&RenderOptions::from(TestSwitches { chunk: Some(chunk), ..TestSwitches::default() }));
            let differences = usual.linear.iter().flatten().zip(chunked.linear.iter().flatten());
            let worst = differences.map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
            assert!(worst <= F16_STEP, "look {at}: chunks of {chunk} slabs change the picture by {worst}");
        }
    }
}

#[test]
fn the_same_settings_give_the_same_bytes() {
    let (loaded, settings) = (loaded(), three_lights());
    let picture = || render(&mut new_renderer(), &loaded, &settings, SIZE);
    let first = picture();
    assert_eq!(first, picture());
    // Also after unrelated work on the same renderer.
    let mut renderer = new_renderer();
    let mut other = settings.clone();
    other.lights[0].position = [0.0, 0.0, 1.0];
    other.layer_mut().transfer.points[2].opacity = 0.9;
    render(&mut renderer, &loaded, &other, [30, 70]);
    full_attenuation(&mut renderer, &loaded, &other, 1);
    assert_eq!(first, render(&mut renderer, &loaded, &settings, SIZE));
}

/// Previews take shortcuts; a light volume that they share with pictures must not contain any.
#[test]
fn previews_leave_nothing_behind_that_pictures_would_not_make() {
    let middle = |[x, y, z]: [usize; 3]| [x, y, z].iter().all(|c| (20..28).contains(c));
    let (loaded, mut settings) = (Dataset::new(scenes::block(48, middle)), three_lights());
    // Even the thinnest tail of a kernel attenuates light.
    for (point, at) in settings.layer_mut().transfer.points.iter_mut().zip(1..) {
        (point.value, point.opacity) = (f64::from(at) / 2.0, if at == 1 { 0.0 } else { 0.3 });
    }
    settings.shadows.resolution = LightVolumeResolution::Quarter;
    let fresh = render(&mut new_renderer(), &loaded, &settings, SIZE);
    let mut renderer = new_renderer();
    let request = RenderRequest {
        volume: loaded.id(),
        settings: settings.clone(),
        size: SIZE.map(|n| n / 4),
        preview_resolution: Some(LightVolumeResolution::Quarter),
    };
    let options = RenderOptions::from(WorkOptions { preview: true, ..WorkOptions::default() });
    let mut job = renderer.begin(&loaded, request, &options).expect("a job");
    while job.step().expect("a step") {}
    assert_eq!(render(&mut renderer, &loaded, &settings, SIZE), fresh);
    assert_eq!(renderer.light_rebuilds(), [1, 1, 1], "the picture looks up what the preview filled");
}

/// The margin around the filled part of a light volume is fully lit; it is cleared once, and again only where another
/// transfer function had it filled before.
#[test]
fn the_clear_margin_is_cleared_once() {
    // A block in the faintest haze.
    let value = |at: usize| {
        let place = [at % 48, at / 48 % 48, at / 48 / 48];
        let within = |reach: usize| place.iter().all(|&c| c.abs_diff(24) < reach);
        if within(5) { 255 } else { u8::from(within(16)) }
    };
    let samples = Samples::U8((0..48 * 48 * 48).map(value).collect());
    let volume = Volume::with_spacing("haze", [48; 3], DVec3::ONE, samples).expect("a valid volume");
    let (loaded, settings) = (Dataset::new(volume), scenes::look());
    let preview = |renderer: &mut Renderer, direction: [f64; 3], onset: f64| {
        let mut settings = settings.clone();
        settings.lights[0].position = direction;
        for (point, at) in settings.layer_mut().transfer.points.iter_mut().zip(0..) {
            (point.value, point.opacity) = (onset + 0.1 * f64::from(at), if at == 0 { 0.0 } else { 0.3 });
        }
        // Filled for a fine picture, and looked up by a coarse one.
        for size in [[256, 192], [16, 12]] {
            let settings = settings.clone();
            let volume = loaded.id();
            let request = RenderRequest {
                volume,
                settings,
                size,
                preview_resolution: Some(LightVolumeResolution::Half),
            };
            let options = RenderOptions::from(WorkOptions { preview: true, ..WorkOptions::default() });
            let mut job = renderer.begin(&loaded, request, &options).expect("a job");
            while job.step().expect("a step") {}
        }
        renderer.read_light().expect("light")
    };
    let mut renderer = new_renderer();
    // The haze is hidden, visible, and hidden again: often enough that textures are reused.
    let onsets = [[1.5; 4], [0.5; 4], [1.5; 4]];
    for (at, onset) in onsets.into_iter().flatten().enumerate() {
        let place = [(at as f64).cos(), (at as f64).sin(), 1.5];
        let fresh = preview(&mut new_renderer(), place, onset);
        assert!(fresh == preview(&mut renderer, place, onset), "preview {at} differs from a fresh one");
    }
}
