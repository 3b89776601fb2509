//! Tiled rendering, supersampling, and pictures of more than 8 bits.

use chiaroscuro_media::PixelRows;
use chiaroscuro_render::Renderer;
use chiaroscuro_scene::{
    Background, FloorSettings, ImageSpec, PixelFormat, Projection, RenderEngine, SamplingSettings, Settings,
    ShadowAlgorithm,
};
use glam::DVec3;

use crate::common::{Dataset, new_renderer};
use crate::scenes;
use crate::thresholds::{EIGHT_BITS, HALF_STEP, MIN_ROUNDING, SAMPLED_BACKGROUND, TILES, TONE_MAP};

/// Size of the picture: no multiple of a part's edge, and neither square.
const SIZE: [u32; 2] = [93, 70];

/// Look with everything that depends on the position of a pixel: a vertical background gradient, a floor.
fn look() -> Settings {
    let mut settings = scenes::look();
    settings.output.background = Background { top: [0.9, 0.2, 0.1], bottom: [0.1, 0.3, 0.8] };
    settings.floor = FloorSettings { on: true, height: -0.9, ..FloorSettings::default() };
    // Parts with more rays at edges have tests of their own.
    settings.output.antialiasing = 1;
    settings
}

fn picture(
    renderer: &mut Renderer,
    loaded: &Dataset,
    settings: &Settings,
    image_spec: &ImageSpec,
    (edge, samples): (u32, u32),
) -> Vec<f32> {
    let mut bands = renderer.bands_with_limits(loaded, settings, image_spec, edge, samples);
    let rows = bands.all().expect("the picture is rendered");
    assert_eq!(matches!(rows, PixelRows::Bytes(_)), image_spec.depth == PixelFormat::Eight);
    rows.values()
}

fn largest_difference(left: &[f32], right: &[f32]) -> f64 {
    assert_eq!(left.len(), right.len());
    left.iter().zip(right).map(|(a, b)| f64::from((a - b).abs())).fold(0.0, f64::max)
}

/// Tests every look with one depth, and every depth with one look.
#[test]
fn tiles_equal_the_whole_picture() {
    check_parts(|name, depth| name == "perspective" || depth == PixelFormat::Sixteen);
}

#[test]
#[ignore = "long: every look with every depth; script/test --all runs it"]
fn parts_are_the_whole_picture_at_every_depth() {
    check_parts(|_, _| true);
}

/// Compares parts with the whole for the looks and depths that `is_selected` selects.
fn check_parts(is_selected: impl Fn(&str, PixelFormat) -> bool) {
    let loaded = Dataset::new(scenes::creature(40, DVec3::new(1.0, 0.8, 1.6)));
    let mut renderer = new_renderer();
    let mut orthographic = look();
    orthographic.camera.projection = Projection::Orthographic;
    let mut direct = look();
    direct.shadows.algorithm = ShadowAlgorithm::Direct;
    let scatter = Settings {
        sampling: SamplingSettings { engine: RenderEngine::Scatter, ..look().sampling },
        ..look()
    };
    for (name, settings) in
        [("perspective", look()), ("orthographic", orthographic), ("direct", direct), ("scatter", scatter)]
    {
        let depths = [PixelFormat::Eight, PixelFormat::Sixteen, PixelFormat::Linear];
        for depth in depths.into_iter().filter(|&depth| is_selected(name, depth)) {
            let image_spec = ImageSpec { depth, ..ImageSpec::new(SIZE) };
            let whole = picture(&mut renderer, &loaded, &settings, &image_spec, (4096, 1 << 20));
            let fills = renderer.light_rebuilds().to_vec();
            // Bands of whole rows, and bands in columns.
            for parts in [(4096, 93 * 16), (40, 1 << 20), (33, 33 * 9)] {
                let found = picture(&mut renderer, &loaded, &settings, &image_spec, parts);
                let apart = largest_difference(&found, &whole);
                println!("{name} {depth:?} {parts:?}: {apart:.2e}");
                // A rounded step of 8 bits, or the difference from positions in 32 bits.
                let limit = if depth == PixelFormat::Eight { EIGHT_BITS } else { TILES };
                assert!(apart <= limit, "{name} {depth:?} {parts:?}: {apart}");
            }
            assert_eq!(renderer.light_rebuilds(), fills, "parts share their light volumes");
        }
    }
}

#[test]
fn parts_that_lie_elsewhere_are_noticed() {
    let loaded = Dataset::new(scenes::creature(40, DVec3::ONE));
    let mut renderer = new_renderer();
    let image_spec = ImageSpec { depth: PixelFormat::Sixteen, ..ImageSpec::new(SIZE) };
    let whole = picture(&mut renderer, &loaded, &look(), &image_spec, (4096, 1 << 20));
    // One pixel further right is the smallest error that parts can have.
    let shifted: Vec<f32> = whole.iter().skip(4).chain(&whole[..4]).copied().collect();
    assert!(largest_difference(&shifted, &whole) > 50.0 * TILES);
}

#[test]
fn samples_are_the_mean_of_a_finer_picture() {
    let loaded = Dataset::new(scenes::creature(40, DVec3::ONE));
    let mut renderer = new_renderer();
    for samples in [2, 3] {
        for transparent in [false, true] {
            let image_spec =
                ImageSpec { depth: PixelFormat::Linear, transparent, samples, ..ImageSpec::new(SIZE) };
            let found = picture(&mut renderer, &loaded, &look(), &image_spec, (4096, 93 * 9 * 20));
            let finer = ImageSpec { size: SIZE.map(|n| n * samples), samples: 1, ..image_spec };
            // The background has one colour: otherwise it is evaluated at the pixel's centre, not averaged.
            let finer = picture(&mut renderer, &loaded, &look(), &finer, (4096, 1 << 20));
            let mean = means(&finer, samples as usize);
            let limit = if transparent { TILES } else { SAMPLED_BACKGROUND };
            let apart = largest_difference(&found, &mean);
            assert!(apart < limit, "{samples} {transparent}: {apart}");
        }
    }
}

/// Means over squares of `n` pixels of a picture [`SIZE`] times as large.
fn means(finer: &[f32], n: usize) -> Vec<f32> {
    let [width, height] = SIZE.map(|edge| edge as usize);
    let value = |i: usize, j: usize, c: usize| {
        let at = |a: usize, b: usize| finer[4 * ((j * n + b) * width * n + i * n + a) + c];
        let sum: f32 = (0..n).flat_map(|b| (0..n).map(move |a| (a, b))).map(|(a, b)| at(a, b)).sum();
        sum / (n * n) as f32
    };
    (0..height)
        .flat_map(|j| (0..width).map(move |i| (i, j)))
        .flat_map(|(i, j)| (0..4).map(move |c| (i, j, c)))
        .map(|(i, j, c)| value(i, j, c))
        .collect()
}

#[test]
fn sixteen_bits_are_between_the_steps_of_eight() {
    let loaded = Dataset::new(scenes::creature(40, DVec3::ONE));
    let mut renderer = new_renderer();
    let whole = (4096, 1 << 20);
    for transparent in [false, true] {
        let image_spec = ImageSpec { transparent, ..ImageSpec::new(SIZE) };
        let coarse = picture(&mut renderer, &loaded, &look(), &image_spec, whole);
        let fine = ImageSpec { depth: PixelFormat::Sixteen, ..image_spec };
        let fine = picture(&mut renderer, &loaded, &look(), &fine, whole);
        let apart = largest_difference(&coarse, &fine);
        // In front of a background, which is dithered, a whole step.
        assert!(apart < if transparent { HALF_STEP } else { EIGHT_BITS }, "{apart}");
        assert!(apart > MIN_ROUNDING, "nothing lies between: {apart}");
    }
}

#[test]
fn linear_light_is_what_the_display_shows() {
    let loaded = Dataset::new(scenes::creature(40, DVec3::ONE));
    let mut renderer = new_renderer();
    let mut settings = look();
    settings.output.tone_map = chiaroscuro_scene::ToneMap::Clip;
    settings.floor.on = false;
    let whole = (4096, 1 << 20);
    let image_spec = ImageSpec { depth: PixelFormat::Linear, ..ImageSpec::new(SIZE) };
    let linear = picture(&mut renderer, &loaded, &settings, &image_spec, whole);
    let shown = ImageSpec { depth: PixelFormat::Sixteen, ..image_spec };
    let shown = picture(&mut renderer, &loaded, &settings, &shown, whole);
    let srgb = |c: f32| if c <= 0.003_130_8 { c * 12.92 } else { 1.055 * c.powf(1.0 / 2.4) - 0.055 };
    // Nothing is brighter than white here, so that clipping and blending commute.
    assert!(linear.iter().all(|&value| value <= 1.0));
    let expected: Vec<f32> =
        linear.chunks(4).flat_map(|c| [srgb(c[0]), srgb(c[1]), srgb(c[2]), c[3]]).collect();
    let apart = largest_difference(&shown, &expected);
    assert!(apart < TONE_MAP, "{apart}");
}
