//! Pictures of clouds and slabs against those of another renderer, whose figures `tests/oracle/light/mitsuba_scenes.py`
//! has written: of the GPU, of the f64 reference, and of the path tracer that other tests trust.

use chiaroscuro_reference::{Reference, ReferenceOptions};
use chiaroscuro_render::{RenderOptions, Renderer};
use chiaroscuro_scene::{
    Camera, DensityRange, LightGeometry, Projection, ScatteringSettings, Settings, ShadowSettings, SkyMode,
    SkySettings, srgb_from_linear,
};
use chiaroscuro_volume::{Samples, Volume};
use glam::DVec3;

use super::all_light::trace_picture;
use crate::against_reference::mutations::assert_in_shader;
use crate::common::{Dataset, damaged_renderer, new_renderer};
use crate::scenes::{self, linear_extinction, make_isotropic};
use crate::thresholds::{OUTSIDE_HARD, OUTSIDE_MEAN, OUTSIDE_SQUARES, OUTSIDE_TRACED};

/// Figures of the other renderer.
const FIGURES: &str = include_str!("../../oracle/light/mitsuba.tsv");

/// Number of voxels along an edge of the volumes.
const N: usize = 24;

/// Number of squares along an edge of the pictures, of which means are compared.
const SQUARES: usize = 4;

/// Number of pixels along an edge of the GPU's pictures.
const PIXELS: u32 = 96;

/// Figures of one colour of a scene.
struct OutsideFigures {
    scene: String,
    channel: usize,
    mean: f64,
    squares: Vec<f64>,
}

/// Figures of all scenes, in the order of the table.
fn figures() -> Vec<OutsideFigures> {
    let rows = FIGURES.lines().filter(|line| !line.starts_with('#'));
    rows.map(|row| {
        let mut fields = row.split('\t');
        let scene = fields.next().expect("a scene").to_owned();
        let channel = "rgb".find(fields.next().expect("a channel")).expect("r, g or b");
        let numbers: Vec<f64> = fields.map(|field| field.parse().expect("a number")).collect();
        OutsideFigures { scene, channel, mean: numbers[0], squares: numbers[2..].to_vec() }
    })
    .collect()
}

/// Volume of a scene: the numbers of `voxels` in the script.
fn volume(scene: &str) -> Volume {
    let thick = if scene.starts_with("slab") { 16 } else { 8 };
    let value = |at: usize| {
        let [x, y, z] = [at % N, at / N % N, at / (N * N)];
        if !scene.starts_with("cloud") {
            let inside = x.min(y) >= 3 && x.max(y) < N - 3 && (2 * z + 1).abs_diff(N) < thick;
            return if inside { 255 } else { 0 };
        }
        let centred = DVec3::from([x, y, z].map(|c| (2.0 * c as f64 + 1.0 - N as f64) / N as f64));
        let [x, y, z] = [x, y, z].map(|c| c as f64);
        let waves =
            0.6 + 0.4 * (0.9 * x + 1.0).sin() * (0.8 * y + 2.0).sin() + 0.3 * (0.7 * z + 0.2 * x + 3.0).sin();
        let density = (1.3 * (1.0 - centred.length_squared()) * waves).clamp(0.0, 1.0);
        (255.0 * density + 0.5).floor() as u8
    };
    let values = Samples::U8((0..N * N * N).map(value).collect());
    Volume::with_spacing(scene, [N; 3], DVec3::ONE, values).expect("a volume")
}

/// Settings of a scene: what its name says, as in the script.
fn settings(scene: &str) -> Settings {
    let fov: f64 = Camera::default().fov_y_deg;
    let per_voxel = match scene.split('-').next() {
        Some("cloud") => 0.6,
        Some("slab") => 0.2,
        _ => 1.0,
    };
    let mut settings = Settings {
        camera: Camera {
            projection: Projection::Orthographic,
            azimuth_deg: 35.0,
            elevation_deg: 25.0,
            distance: 1.1 / (0.5 * fov).to_radians().tan(),
            ..Camera::default()
        },
        lights: Vec::new(),
        ..scenes::look()
    }
    .with_transfer(linear_extinction(per_voxel))
    .with_range(DensityRange::Full);
    make_isotropic(&mut settings);
    settings.shadows.least_blocks = ShadowSettings::default().least_blocks;
    if scene.contains("sun") {
        settings.lights = vec![scenes::light(LightGeometry::Parallel, [1.0, 0.3, 2.0])];
    } else {
        settings.sky = SkySettings { mode: SkyMode::White, intensity: 1.0, ..SkySettings::default() };
    }
    let (albedo, color) = match scene.rsplit('-').next().expect("an albedo") {
        "color" => (0.95, [1.0, 0.8, 0.4]),
        percent => (percent.parse::<f64>().expect("a number") / 100.0, [1.0; 3]),
    };
    for point in &mut settings.layer_mut().transfer.points {
        point.color = color.map(|c| srgb_from_linear(c) as f32);
    }
    // As many bounces as the presets of clouds have.
    settings.scattering = ScatteringSettings { bounces: 6, albedo, ..ScatteringSettings::default() };
    settings
}

/// Means of the squares of one colour of a square picture.
fn square_means(picture: &[f64]) -> Vec<f64> {
    let edge = picture.len().isqrt();
    let each = edge / SQUARES;
    let mean = |square: usize| {
        let [x, y] = [square % SQUARES * each, square / SQUARES * each];
        let sum: f64 = (0..each * each).map(|at| picture[(y + at / each) * edge + x + at % each]).sum();
        sum / (each * each) as f64
    };
    (0..SQUARES * SQUARES).map(mean).collect()
}

/// Relative difference of a picture's mean, and root mean square difference of its squares over the mean.
fn differences(picture: &[f64], figures: &OutsideFigures) -> [f64; 2] {
    let found = square_means(picture);
    let mean = found.iter().sum::<f64>() / found.len() as f64;
    let squares: f64 = found.iter().zip(&figures.squares).map(|(a, b)| (a - b).powi(2)).sum();
    [mean / figures.mean - 1.0, (squares / found.len() as f64).sqrt() / figures.mean]
}

/// Limits of both differences: that of squares is wider for a hard slab with an optical depth of 1 within a voxel, the
/// smallest block.
fn limits(scene: &str) -> [f64; 2] {
    if scene.starts_with("hard") { OUTSIDE_HARD } else { [OUTSIDE_MEAN, OUTSIDE_SQUARES] }
}

/// One colour of a picture of the GPU.
fn drawn(renderer: &mut Renderer, settings: &Settings, figures: &OutsideFigures) -> Vec<f64> {
    let loaded = Dataset::new(volume(&figures.scene));
    let picture = renderer.render(&loaded, settings, [PIXELS; 2], &RenderOptions::default());
    picture.expect("a picture").linear.iter().map(|texel| f64::from(texel[figures.channel])).collect()
}

#[test]
fn pictures_are_those_of_another_renderer() {
    let mut renderer = new_renderer();
    let mut failures = Vec::new();
    for figures in figures() {
        let settings = settings(&figures.scene);
        let [mean, squares] = differences(&drawn(&mut renderer, &settings, &figures), &figures);
        println!("{} {}: mean {mean:+.4}, squares {squares:.4}", figures.scene, figures.channel);
        let [most, most_squares] = limits(&figures.scene);
        if mean.abs() > most || squares > most_squares {
            failures.push(format!("{} {}: {mean} {squares}", figures.scene, figures.channel));
        }
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

#[test]
fn the_references_pictures_are_those_of_another_renderer() {
    for figures in
        figures().iter().filter(|figures| ["cloud-sun-99", "cloud-sky-90"].contains(&&*figures.scene))
    {
        let volume = volume(&figures.scene);
        let settings = settings(&figures.scene);
        let settings = settings.resolved_for(&volume);
        let reference = Reference::new(&volume, &settings, ReferenceOptions::default());
        let picture = reference.picture([32; 2], &reference.attenuations());
        let picture: Vec<f64> = picture.iter().map(|texel| texel[figures.channel]).collect();
        let [mean, squares] = differences(&picture, figures);
        println!("{}: mean {mean:+.4}, squares {squares:.4}", figures.scene);
        assert!(
            mean.abs() <= OUTSIDE_MEAN && squares <= OUTSIDE_SQUARES,
            "{}: {mean} {squares}",
            figures.scene
        );
    }
}

#[test]
fn the_path_tracers_pictures_are_those_of_another_renderer() {
    for figures in figures().iter().filter(|figures| figures.scene.starts_with("cloud")) {
        let loaded = Dataset::new(volume(&figures.scene));
        let traced = trace_picture(&loaded, &settings(&figures.scene), 32, 256);
        let picture: Vec<f64> =
            traced.iter().map(|[a, b]| 0.5 * (a[figures.channel] + b[figures.channel])).collect();
        let [mean, squares] = differences(&picture, figures);
        println!("{} {}: mean {mean:+.4}, squares {squares:.4}", figures.scene, figures.channel);
        assert!(
            mean.abs() <= OUTSIDE_TRACED && squares <= OUTSIDE_SQUARES,
            "{}: {mean} {squares}",
            figures.scene
        );
    }
}

/// Light of another measure, and a series that ends early, are noticed.
#[test]
fn mistakes_of_measure_are_noticed() {
    let all = figures();
    let figures = all.iter().find(|figures| figures.scene == "cloud-sun-99").expect("a cloud");
    let settings = settings(&figures.scene);
    let differs = |what: &str, renderer: &mut Renderer, settings: &Settings| {
        let [mean, squares] = differences(&drawn(renderer, settings, figures), figures);
        println!("{what}: mean {mean:+.4}, squares {squares:.4}");
        assert!(
            mean.abs() > OUTSIDE_MEAN || squares > OUTSIDE_SQUARES,
            "{what} is not noticed: {mean} {squares}"
        );
    };
    let mistakes = [
        ("eye/eye_pass.wgsl", "shading.amid * relative_phase_function", "relative_phase_function"),
        (
            "scattered_light/single_scattering.wgsl",
            "light += whole.color * (0.25 *",
            "light += whole.color * (0.0625 *",
        ),
    ];
    for (shader, from, to) in mistakes {
        assert_in_shader(shader, from);
        differs(to, &mut damaged_renderer(from, to), &settings);
    }
    let mut renderer = new_renderer();
    let mut wrong = settings.clone();
    wrong.scattering.bounces = 1;
    differs("one bounce alone", &mut renderer, &wrong);
    let mut wrong = settings.clone();
    wrong.scattering.albedo *= 0.98;
    differs("less albedo", &mut renderer, &wrong);
}
