//! What must hold between pictures of whatever scene: random volumes, transfer functions, cameras and lights.

use chiaroscuro::data::{Dataset, Samples, ValueRange, Volume};
use chiaroscuro::gpu::{Context, Picture, RenderOptions, Renderer};
use chiaroscuro::model::{
    ControlPoint, Light, LightKind, Projection, Quality, Record, Settings, ShadowAlgorithm, auto,
};
use glam::{DAffine3, DMat3, DVec3};

use crate::random::Random;

const SIZE: [u32; 2] = [32, 24];

/// How far sums and multiples of light may be apart, as a share of the largest: light volumes hold halves, which are
/// 2⁻¹¹ exact, and a picture looks up a few.
const LINEAR: f32 = 2e-3;

/// Voxels of noise that is smooth enough to have surfaces, and a look at them.
struct Scene {
    dims: [usize; 3],
    voxels: Vec<u8>,
    settings: Settings,
}

fn scene(seed: u64) -> Scene {
    let mut random = Random::new(seed);
    let dims = [(); 3].map(|()| 8 + random.below(10));
    let waves = [(); 6].map(|()| {
        let direction = DVec3::new(share(&mut random), share(&mut random), share(&mut random)) - 0.5;
        (direction * 2.0, share(&mut random) * std::f64::consts::TAU)
    });
    let value = |at: usize| {
        let place = [at % dims[0], at / dims[0] % dims[1], at / dims[0] / dims[1]].map(|n| n as f64);
        let sum: f64 = waves.iter().map(|(wave, phase)| (wave.dot(DVec3::from(place)) + phase).sin()).sum();
        (127.5 + 40.0 * sum).clamp(0.0, 255.0) as u8
    };
    let voxels: Vec<u8> = (0..dims.iter().product()).map(value).collect();
    let dataset = dataset(dims, Samples::U8(voxels.clone()), 1.0);
    let mut settings = auto::first_settings(dataset.volume(), dataset.histogram());
    let quality = [Quality::Fast, Quality::Standard, Quality::Fine][random.below(3)];
    quality.apply(&mut settings);
    settings.shadows.algorithm = [ShadowAlgorithm::Splat, ShadowAlgorithm::Raycast][random.below(2)];
    settings.shadows.first_touch = random.below(4) == 0;
    // Light that is cut at 1 is not linear.
    (settings.shadows.gain, settings.shadows.balance) = (1.0, 1.0);
    (settings.shading.emission, settings.shading.ambient) = (0.0, 0.0);
    settings.camera.azimuth_deg = share(&mut random) * 360.0;
    settings.camera.elevation_deg = share(&mut random) * 180.0 - 90.0;
    settings.camera.projection = [Projection::Perspective, Projection::Orthographic][random.below(2)];
    settings.transfer.points = (0..3 + random.below(4))
        .map(|at| {
            let color = [(); 3].map(|()| share(&mut random) as f32);
            ControlPoint::new(at as f64 * 40.0 + share(&mut random) * 39.0, color, share(&mut random))
        })
        .collect();
    settings.lights = (0..2)
        .map(|_| Light {
            kind: [LightKind::Parallel, LightKind::Perspective][random.below(2)],
            position: [(); 3].map(|()| 6.0 * share(&mut random) - 3.0),
            color: [(); 3].map(|()| share(&mut random) as f32),
            intensity: 0.2 + share(&mut random),
            ..Light::default()
        })
        .collect();
    settings.sanitise();
    Scene { dims, voxels, settings }
}

/// A number from 0 to 1.
fn share(random: &mut Random) -> f64 {
    random.below(1 << 20) as f64 / f64::from(1 << 20)
}

fn dataset(dims: [usize; 3], samples: Samples, spacing_mm: f64) -> Dataset {
    let world = DAffine3::from_mat3(DMat3::from_diagonal(DVec3::splat(spacing_mm)));
    Dataset::new(Volume::new("noise", dims, world, samples).expect("a volume"))
}

/// Draws with one renderer, one scene after another.
struct Studio(Renderer);

impl Studio {
    fn draw(&mut self, dataset: &Dataset, settings: &Settings) -> Picture {
        self.0.render(dataset, settings, SIZE, &RenderOptions::default()).expect("a picture")
    }
}

fn largest(light: &[[f32; 4]]) -> f32 {
    light.iter().flatten().copied().fold(0.0, f32::max)
}

/// The largest difference between the colours of two pictures, as a share of the largest colour.
fn distance(left: &[[f32; 4]], right: &[[f32; 4]]) -> f32 {
    let apart = left.iter().zip(right).flat_map(|(a, b)| [0, 1, 2].map(|c| (a[c] - b[c]).abs()));
    apart.fold(0.0, f32::max) / largest(right).max(1e-6)
}

fn all_relations(seed: u64, studio: &mut Studio) {
    let Scene { dims, voxels, settings } = scene(seed);
    let bytes = dataset(dims, Samples::U8(voxels.clone()), 1.0);
    let first = studio.draw(&bytes, &settings);
    let with = |change: &dyn Fn(&mut Settings)| {
        let mut changed = settings.clone();
        change(&mut changed);
        changed
    };

    // P1: all is finite, light is not negative and alpha a share; also around voxels that are no numbers.
    let mut holes: Vec<f32> = voxels.iter().map(|&voxel| f32::from(voxel)).collect();
    holes[0] = f32::NAN;
    holes[voxels.len() / 2] = f32::INFINITY;
    let holed = studio.draw(&dataset(dims, Samples::F32(holes), 1.0), &settings);
    for picture in [&first, &holed] {
        let is_right = |[r, g, b, a]: &[f32; 4]| {
            [r, g, b].iter().all(|c| c.is_finite() && **c >= 0.0) && (0.0..=1.0 + 1e-5).contains(a)
        };
        assert!(picture.light.iter().all(is_right), "seed {seed}");
    }

    // P3: what is nowhere opaque is not there.
    let clear = with(&|settings| settings.transfer.points.iter_mut().for_each(|point| point.opacity = 0.0));
    assert_eq!(largest(&studio.draw(&bytes, &clear).light), 0.0, "seed {seed}");

    // P4: light is linear in the lights.
    let twice = with(&|settings| settings.lights.iter_mut().for_each(|light| light.intensity *= 2.0));
    let doubled: Vec<_> = first.light.iter().map(|[r, g, b, a]| [2.0 * r, 2.0 * g, 2.0 * b, *a]).collect();
    let apart = distance(&studio.draw(&bytes, &twice).light, &doubled);
    assert!(apart < LINEAR, "seed {seed}: {apart}");
    let [one, other] = [0, 1].map(|at| with(&|settings| settings.lights[at].on = false));
    let (one, other) = (studio.draw(&bytes, &one).light, studio.draw(&bytes, &other).light);
    let sum: Vec<_> =
        one.iter().zip(&other).map(|(a, b)| [a[0] + b[0], a[1] + b[1], a[2] + b[2], a[3]]).collect();
    let apart = distance(&first.light, &sum);
    assert!(apart < LINEAR, "seed {seed}: {apart}");

    // P8: the same voxels twice as far apart are the same picture.
    let larger = studio.draw(&dataset(dims, Samples::U8(voxels.clone()), 2.0), &settings);
    let apart = distance(&larger.light, &first.light);
    assert!(apart < LINEAR, "seed {seed}: {apart}");

    // P13: the same numbers in other types are the same picture.
    let words = Samples::U16(voxels.iter().copied().map(u16::from).collect());
    let floats = Samples::F32(voxels.iter().copied().map(f32::from).collect());
    for samples in [words, floats] {
        let apart = distance(&studio.draw(&dataset(dims, samples, 1.0), &settings).light, &first.light);
        assert!(apart < LINEAR, "seed {seed}: {apart}");
    }

    // P14: a look that was saved is the look.
    let record = Record::read(&Record::text(&settings, None, None)).expect("a record");
    let (read, warnings) = record.apply(&Settings::default(), ValueRange::UNIT).expect("settings");
    assert_eq!((&read, warnings), (&settings, vec![]), "seed {seed}");

    // P2 and P15: after all of that, and after a light that went around, the first picture is the first picture.
    for step in 0..4 {
        let turned = settings.turned(Some(0), f64::from(step) / 4.0);
        studio.draw(&bytes, &turned);
    }
    let again = studio.draw(&bytes, &settings);
    assert!(again.shown == first.shown && again.light == first.light, "seed {seed}");
}

fn relations(seeds: std::ops::Range<u64>) {
    let mut studio = Studio(Renderer::new(&Context::headless().expect("an adapter")).expect("a renderer"));
    let mut seen = 0;
    for seed in seeds.clone() {
        let Scene { dims, voxels, settings } = scene(seed);
        let light = studio.draw(&dataset(dims, Samples::U8(voxels), 1.0), &settings).light;
        seen += usize::from(largest(&light) > 0.02);
        all_relations(seed, &mut studio);
    }
    println!("relations of pictures: seeds {seeds:?}, {seen} with something to see");
    assert!(seen * 2 > (seeds.end - seeds.start) as usize, "{seen} scenes show anything");
}

#[test]
fn pictures_are_related_as_they_must_be() {
    relations(0..3);
}

#[test]
#[ignore = "two hundred scenes: minutes"]
fn pictures_of_many_scenes_are_related_as_they_must_be() {
    relations(0..200);
}

#[test]
fn the_distance_notices_a_difference() {
    let white = [[1.0; 4]; 4];
    let mut other = white;
    other[2][1] = 0.99;
    assert!(distance(&other, &white) > LINEAR && distance(&white, &white) == 0.0);
}
