//! Metamorphic relations: pictures of random scenes before and after a change that must not be seen, or that changes
//! every pixel in a known way. Nobody has to know the right picture.
//!
//! A relation tells what a closed form cannot: that a mirrored scene has mirrored shadows, that empty space around a
//! volume casts none, and that half a light twice is a light.

mod lights;
mod mistakes;
mod placement;
mod random_scenes;
mod symmetries;
mod values;

use std::ops::Range;

use chiaroscuro_render::{RenderOptions, Renderer};
use chiaroscuro_scene::Settings;
use chiaroscuro_volume::{Dataset, Samples, Volume};
use glam::DVec3;

use crate::common::new_renderer;
use crate::thresholds::DisplayLimit;

/// Pixels along an edge of a picture: small volumes need no more.
const EDGE: u32 = 96;

/// Seeds of the scenes of a quick run: together they have every kind of light, both projections, a sky, bounces,
/// coloured shadows, a cut, and stretched voxels.
const FEW_SEEDS: Range<u64> = 0..3;

/// Seeds of the scenes of a long run.
const MANY_SEEDS: Range<u64> = 3..24;

/// Volume and settings, in a form that can be turned, mirrored, padded and scaled.
#[derive(Debug, Clone)]
struct TestScene {
    dims: [usize; 3],
    spacing: DVec3,
    /// Value of each voxel, x fastest: whole numbers from 0 to 255.
    values: Vec<u8>,
    settings: Settings,
}

impl TestScene {
    fn dataset(&self) -> Dataset {
        self.dataset_of(Samples::U8(self.values.clone()))
    }

    fn dataset_of(&self, samples: Samples) -> Dataset {
        let volume = Volume::with_spacing("scene", self.dims, self.spacing, samples);
        Dataset::new(volume.expect("a volume"))
    }

    /// Length of a scene unit in millimetres: half of the longest edge.
    fn mm_per_unit(&self) -> f64 {
        (self.spacing * DVec3::from(self.dims.map(|n| n as f64))).max_element() / 2.0
    }
}

/// Picture in display values, 0 … 255 but not rounded: red, green, blue and opacity.
type DisplayPicture = Vec<[f64; 4]>;

fn draw_dataset(renderer: &mut Renderer, loaded: &Dataset, settings: &Settings) -> DisplayPicture {
    let picture = renderer
        .render(loaded, settings, [EDGE; 2], &RenderOptions::default())
        .expect("the picture is rendered");
    let encoded = |c: f32| {
        let c = f64::from(c).clamp(0.0, 1.0);
        255.0 * if c <= 0.003_130_8 { 12.92 * c } else { 1.055 * c.powf(1.0 / 2.4) - 0.055 }
    };
    picture
        .linear
        .iter()
        .map(|&[r, g, b, a]| [encoded(r), encoded(g), encoded(b), 255.0 * f64::from(a)])
        .collect()
}

fn draw(renderer: &mut Renderer, scene: &TestScene) -> DisplayPicture {
    draw_dataset(renderer, &scene.dataset(), &scene.settings)
}

/// Difference of two pictures in display values.
#[derive(Debug, Clone, Copy)]
struct DisplayDifference {
    /// Root mean square over the pixels that show something in either picture.
    rms: f64,
    /// Largest difference of a colour or of opacity.
    worst: f64,
    /// Difference of the means of all colours.
    mean: f64,
}

fn display_difference(actual: &[[f64; 4]], expected: &[[f64; 4]]) -> DisplayDifference {
    assert_eq!(actual.len(), expected.len(), "pictures of the same size");
    let (mut squares, mut count, mut worst, mut sum) = (0.0, 0.0, 0.0_f64, 0.0);
    for (a, b) in actual.iter().zip(expected) {
        if a[3].max(b[3]) < 0.5 {
            continue;
        }
        for c in 0..4 {
            let off = a[c] - b[c];
            worst = if off.is_nan() { f64::INFINITY } else { worst.max(off.abs()) };
            squares += off * off;
            count += 1.0;
            sum += if c < 3 { off } else { 0.0 };
        }
    }
    assert!(count > 4.0 * 500.0, "something is seen");
    DisplayDifference { rms: f64::sqrt(squares / count), worst, mean: f64::abs(sum / (0.75 * count)) }
}

/// Compares two pictures with a limit; an error says by how much they differ.
fn agree(
    what: &str,
    actual: &[[f64; 4]],
    expected: &[[f64; 4]],
    limit: DisplayLimit,
) -> Result<DisplayDifference, String> {
    let found = display_difference(actual, expected);
    println!("{what}: rms {:.4}, worst {:.3}, mean {:.4}", found.rms, found.worst, found.mean);
    if found.rms <= limit.rms && found.worst <= limit.worst && found.mean <= limit.mean {
        Ok(found)
    } else {
        Err(format!("{what}: {found:?}, but {limit:?}"))
    }
}

/// Changed scene, with the picture that is expected of it.
struct SceneVariant {
    name: &'static str,
    scene: TestScene,
    /// Voxels in another number format, if not the scene's.
    samples: Option<Samples>,
    /// Picture that is expected, from that of the scene as it was.
    expected: fn(&DisplayPicture) -> DisplayPicture,
}

impl SceneVariant {
    /// Creates the variant of a scene that must look the same.
    fn same(name: &'static str, scene: TestScene) -> Self {
        Self { name, scene, samples: None, expected: DisplayPicture::clone }
    }

    fn expecting(self, expected: fn(&DisplayPicture) -> DisplayPicture) -> Self {
        Self { expected, ..self }
    }
}

/// Draws each scene and its variants, and asserts that they agree.
fn check_relation(
    seeds: Range<u64>,
    limit: DisplayLimit,
    variants: impl Fn(&TestScene) -> Vec<SceneVariant>,
) {
    check_prepared(seeds, limit, |_| (), variants);
}

/// Same for scenes that are prepared before either picture.
fn check_prepared(
    seeds: Range<u64>,
    limit: DisplayLimit,
    prepare: impl Fn(&mut Settings),
    variants: impl Fn(&TestScene) -> Vec<SceneVariant>,
) {
    let mut renderer = new_renderer();
    let mut failures = Vec::new();
    for seed in seeds {
        let mut scene = random_scenes::random_scene(seed);
        prepare(&mut scene.settings);
        let before = draw(&mut renderer, &scene);
        for SceneVariant { name, scene: changed, samples, expected } in variants(&scene) {
            let loaded = samples.map_or_else(|| changed.dataset(), |samples| changed.dataset_of(samples));
            let found = draw_dataset(&mut renderer, &loaded, &changed.settings);
            failures.extend(agree(&format!("{seed}: {name}"), &found, &expected(&before), limit).err());
        }
    }
    assert!(failures.is_empty(), "{failures:#?}");
}
