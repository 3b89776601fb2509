//! Bit-exactness tests: empty-space skipping, repetition, earlier previews, and the margin of light volumes change no
//! bit.

use chiaroscuro::data::{Samples, Volume};
use chiaroscuro::gpu::{RenderOptions, Renderer};
use chiaroscuro::model::{
    Kernel, LightKind, LightStorage, Quadrature, Resolution, Settings, ShadowAlgorithm, SkyMode, Slabs,
};
use chiaroscuro::plan::Request;
use glam::DVec3;

use super::{SIZE, loaded, three_lights};
use crate::common::{Dataset, attenuation, context, render};
use crate::scenes;
use crate::thresholds::F16_STEP;

/// Tests every look with one chunk length, a different one for each look.
#[test]
fn skipping_changes_no_bit_and_chunks_only_rounding() {
    check_skipping(|look, chunk| CHUNKS[look % CHUNKS.len()] == chunk);
}

#[test]
#[ignore = "long: every look with chunks of every length; script/test --all runs it"]
fn chunks_of_every_length_change_only_rounding() {
    check_skipping(|_, _| true);
}

/// Number of slabs per chunk: one, some, and more than exist.
const CHUNKS: [u32; 3] = [1, 5, 1000];

/// Looks in which rays and light skip empty space in different ways.
fn looks() -> Vec<Settings> {
    let mut looks = vec![scenes::look(), three_lights()];
    looks[0].sampling.slab = 2.0;
    looks[0].sampling.quadrature = Quadrature::Two;
    looks[0].shadows.quadrature = Quadrature::Two;
    looks[1].camera.distance = 11.0;
    looks[1].sampling.kernel = Kernel::Gaussian { sigma: 0.8 };
    let mut inside = scenes::look();
    inside.lights[0] = scenes::light(LightKind::Perspective, [0.1, -0.4, 0.5]);
    inside.camera.distance = 0.6;
    looks.push(inside);
    let mut by_need = scenes::look();
    by_need.sampling.slabs = Slabs::ByNeed;
    looks.push(by_need.clone());
    by_need.sampling.slabs = Slabs::Preintegrated;
    looks.push(by_need);
    let mut biased = scenes::look();
    biased.shadows.bias_voxels = 2.0;
    let mut halved = scenes::look();
    halved.shadows.resolution = Resolution::Half;
    let mut combined = three_lights();
    combined.shadows.storage = LightStorage::Combined;
    looks.extend([biased, halved, combined]);
    for algorithm in [ShadowAlgorithm::Raycast, ShadowAlgorithm::Direct] {
        let mut rays = scenes::look();
        rays.shadows.algorithm = algorithm;
        looks.push(rays);
    }
    let mut quartered = scenes::look();
    quartered.shadows.resolution = Resolution::Quarter;
    let mut cropped = scenes::look();
    (cropped.cuts.crop.on, cropped.cuts.crop.low) = (true, [0.3, 0.0, 0.0]);
    let mut near = scenes::look();
    near.lights[0] = scenes::light(LightKind::Perspective, [1.9, -1.4, 1.6]);
    let mut thick = looks[2].clone();
    (thick.shadows.quadrature, thick.shadows.slab) = (Quadrature::Two, 2.0);
    looks.extend([quartered, cropped, near, thick]);
    looks.extend(lit_from_around());
    looks
}

/// Looks in which rays from all directions skip empty space: towards places near visible material, towards scattering
/// material, and towards a floor.
fn lit_from_around() -> [Settings; 3] {
    let mut sky = scenes::look();
    (sky.sky.mode, sky.sky.directions, sky.floor.on) = (SkyMode::Gradient, 9, true);
    let mut bounces = sky.clone();
    (bounces.scattering.bounces, bounces.scattering.directions) = (3, 6);
    bounces.sky.resolution = Resolution::Quarter;
    // The lighting curve shows less than the eye's; and pixels are wide.
    let mut apart = sky.clone();
    apart.lighting.linked = false;
    apart.lighting.curve = apart.transfer.clone();
    apart.lighting.curve.points.iter_mut().for_each(|point| point.value += 40.0);
    apart.sky.resolution = Resolution::Full;
    apart.camera.distance = 11.0;
    [sky, bounces, apart]
}

/// Checks that skipping bricks changes no bit. Sheets are streamed in chunks: the ring's layers move, so fetches
/// between them are rounded differently, and nothing else changes. `is_meant` selects the looks and chunk lengths.
fn check_skipping(is_meant: impl Fn(usize, u32) -> bool) {
    let loaded = Dataset::new(scenes::creature(48, DVec3::new(1.0, 1.0, 1.3)));
    for (at, settings) in looks().iter().enumerate() {
        let picture = |options: &RenderOptions| {
            let mut renderer = Renderer::new(&context()).expect("a renderer");
            renderer.render(&loaded, settings, [120, 90], options).expect("a picture")
        };
        let usual = picture(&RenderOptions::default());
        let plodding = picture(&RenderOptions {
            empty_space_skipping: false,
            fill_everything: true,
            ..RenderOptions::default()
        });
        assert_eq!(usual.light, plodding.light, "look {at}: skipping empty space changes the picture");
        assert_eq!(usual.shown, plodding.shown, "look {at}: skipping empty space changes what is shown");
        let parts = picture(&RenderOptions { light_parts: 3, ..RenderOptions::default() });
        assert_eq!(usual.light, parts.light, "look {at}: cutting chunks into parts changes the picture");
        for chunk in CHUNKS.into_iter().filter(|&chunk| is_meant(at, chunk)) {
            let chunked = picture(&RenderOptions { chunk: Some(chunk), ..RenderOptions::default() });
            let differences = usual.light.iter().flatten().zip(chunked.light.iter().flatten());
            let worst = differences.map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
            assert!(worst <= F16_STEP, "look {at}: chunks of {chunk} slabs change the picture by {worst}");
        }
    }
}

#[test]
fn the_same_settings_give_the_same_bytes() {
    let (loaded, settings) = (loaded(), three_lights());
    let picture = || render(&mut Renderer::new(&context()).expect("a renderer"), &loaded, &settings, SIZE);
    let first = picture();
    assert_eq!(first, picture());
    // Also after unrelated work on the same renderer.
    let mut renderer = Renderer::new(&context()).expect("a renderer");
    let mut other = settings.clone();
    other.lights[0].position = [0.0, 0.0, 1.0];
    other.transfer.points[2].opacity = 0.9;
    render(&mut renderer, &loaded, &other, [30, 70]);
    attenuation(&mut renderer, &loaded, &other, 1);
    assert_eq!(first, render(&mut renderer, &loaded, &settings, SIZE));
}

/// Previews take shortcuts; a light volume that they share with pictures must not contain any.
#[test]
fn previews_leave_nothing_behind_that_pictures_would_not_make() {
    let middle = |[x, y, z]: [usize; 3]| [x, y, z].iter().all(|c| (20..28).contains(c));
    let (loaded, mut settings) = (Dataset::new(scenes::block(48, middle)), three_lights());
    // Even the thinnest tail of a kernel attenuates light.
    for (point, at) in settings.transfer.points.iter_mut().zip(1..) {
        (point.value, point.opacity) = (f64::from(at) / 2.0, if at == 1 { 0.0 } else { 0.3 });
    }
    settings.shadows.resolution = Resolution::Quarter;
    let fresh = render(&mut Renderer::new(&context()).expect("a renderer"), &loaded, &settings, SIZE);
    let mut renderer = Renderer::new(&context()).expect("a renderer");
    let request = Request {
        volume: loaded.volume().id(),
        settings: settings.clone(),
        size: SIZE.map(|n| n / 4),
        coarse: Some(Resolution::Quarter),
    };
    let options = RenderOptions { preview: true, ..RenderOptions::default() };
    let mut job = renderer.begin(&loaded, request, &options).expect("a job");
    while job.step().expect("a step") {}
    assert_eq!(render(&mut renderer, &loaded, &settings, SIZE), fresh);
    assert_eq!(renderer.light_rebuilds(), [1, 1, 1], "the picture looks up what the preview filled");
}

/// The margin around the filled part of a light volume is fully lit; it is cleared once, and again only where another
/// transfer function had it filled before.
#[test]
fn what_is_lit_around_a_light_volume_stays_so_until_it_is_filled() {
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
        for (point, at) in settings.transfer.points.iter_mut().zip(0..) {
            (point.value, point.opacity) = (onset + 0.1 * f64::from(at), if at == 0 { 0.0 } else { 0.3 });
        }
        // Filled for a fine picture, and looked up by a coarse one.
        for size in [[256, 192], [16, 12]] {
            let settings = settings.clone();
            let volume = loaded.volume().id();
            let request = Request { volume, settings, size, coarse: Some(Resolution::Half) };
            let options = RenderOptions { preview: true, ..RenderOptions::default() };
            let mut job = renderer.begin(&loaded, request, &options).expect("a job");
            while job.step().expect("a step") {}
        }
        renderer.read_light().expect("light")
    };
    let mut renderer = Renderer::new(&context()).expect("a renderer");
    // The haze is hidden, visible, and hidden again: often enough that textures are reused.
    let onsets = [[1.5; 4], [0.5; 4], [1.5; 4]];
    for (at, onset) in onsets.into_iter().flatten().enumerate() {
        let place = [(at as f64).cos(), (at as f64).sin(), 1.5];
        let fresh = preview(&mut Renderer::new(&context()).expect("a renderer"), place, onset);
        assert!(fresh == preview(&mut renderer, place, onset), "preview {at} differs from a fresh one");
    }
}
