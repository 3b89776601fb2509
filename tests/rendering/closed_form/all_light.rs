//! All light against a path tracer: area lights, a sky and multiple scattering, compared with pictures that are
//! traced without light volumes, sheets, blocks, fixed directions or counted bounces.
//!
//! Units: radiance 1 is that of white paper which a light of intensity 1 faces, so that light has the irradiance π, and
//! matter that scatters in all directions alike returns albedo · colour · π/4π of it. The path tracer itself is compared
//! with another renderer's figures (`outside_renderer.rs`).

use chiaroscuro_render::{RenderOptions, Renderer, plan::picture_frame};
use chiaroscuro_scene::{
    DensityRange, LightGeometry, LightSettings, LightShape, LightVolumeResolution, Projection, QualityPreset,
    ScatteringSettings, SceneLight, Settings, ShadowSettings, SkyMode, SkyRadiance, SkySettings, SlabMode,
    srgb_from_linear,
};
use chiaroscuro_volume::{Downsampling, LoadControl, Portion, Samples, Volume, VolumeChoice};
use chiaroscuro_volume_io::{LoadOptions, open};
use glam::DVec3;
use rayon::prelude::*;

use crate::common::{Dataset, new_renderer};
use crate::path_tracing::{RandomNumbers, TracedMaterial};
use crate::scenes::{self, make_isotropic};
use crate::thresholds::{ALL_LIGHT, ALL_LIGHT_DEFAULTS};

/// Width and height of pictures in pixels, each one ray: pixels are narrower than voxels, so that no kernel is
/// stretched.
const PICTURE_EDGE: u32 = 64;

/// Edge in pixels of the squares whose means are compared: their noise is a quarter of a pixel's.
const SQUARE_EDGE: u32 = 4;

/// Edge of an enlarged pixel in maps of errors, in pixels.
const PIXEL_SCALE: u32 = 4;

/// Number of voxels along the edges of volumes.
const N: usize = 24;

/// Largest value of air in the scan of a tooth.
const AIR: f64 = 90.0;

/// Path weight below which a path is terminated.
const MIN_PATH_WEIGHT: f64 = 1e-3;

/// Look with a distant disc, a ball light, and a sky of three colours over material of all densities that scatters
/// and glows.
fn look() -> Settings {
    let mut settings = scenes::look();
    make_isotropic(&mut settings);
    settings.layer_mut().range = DensityRange::Full;
    settings.shadows.least_blocks = ShadowSettings::default().least_blocks;
    settings.camera.projection = Projection::Orthographic;
    settings.shading.emission = 0.05;
    let light = |kind, position| scenes::light(kind, position);
    settings.lights = vec![
        LightSettings {
            shape: LightShape::Disc,
            angle_deg: 25.0,
            ..light(LightGeometry::Parallel, [1.3, -0.8, 1.7])
        },
        LightSettings {
            intensity: 0.6,
            color: [1.0, 0.7, 0.4],
            ..light(LightGeometry::Perspective, [-2.2, 1.8, 2.4])
        },
    ];
    settings.sky = SkySettings { mode: SkyMode::Gradient, intensity: 0.6, ..SkySettings::default() };
    settings.scattering = ScatteringSettings { bounces: 8, albedo: 0.9, ..ScatteringSettings::default() };
    for point in &mut settings.layer_mut().transfer.points {
        // Half of the light is absorbed within two voxels at most.
        point.opacity *= 0.35;
    }
    settings
}

/// Path tracer of a scene.
struct ScenePathTracer<'a> {
    material: TracedMaterial,
    settings: &'a Settings,
    index_from_scene: glam::DAffine3,
    /// Sample points of each light, and its linear colour.
    lights: Vec<(Vec<SceneLight>, [f64; 3])>,
    sky: Option<SkyRadiance>,
    /// Distance beyond all material, in scene units.
    far: f64,
}

impl ScenePathTracer<'_> {
    /// Mean radiance over all directions of the light that arrives directly at an index-space point, from a random
    /// point of each light: E/4π, with an irradiance E of π times the light's colour.
    fn direct(&self, random: &mut RandomNumbers, point: DVec3) -> [f64; 3] {
        let mut sum = [0.0; 3];
        for (points, color) in &self.lights {
            let light = &points[(random.next_uniform() * points.len() as f64) as usize];
            let place = self.index_from_scene.inverse().transform_point3(point);
            let (towards, distance) = match light.kind {
                LightGeometry::Parallel => (light.direction(), self.far),
                LightGeometry::Perspective => {
                    let away = DVec3::from(light.position) - place;
                    (away.normalize(), away.length())
                }
            };
            let step = self.index_from_scene.transform_vector3(towards);
            let left = self.material.transmittance(random, point, step, distance);
            let irradiance = std::f64::consts::PI * left;
            (0..3).for_each(|c| sum[c] += color[c] * irradiance / (4.0 * std::f64::consts::PI));
        }
        sum
    }

    /// Radiance of one path that reaches the eye along a ray.
    fn path(&self, lots: &mut RandomNumbers, origin: DVec3, along: DVec3, length: f64) -> [f64; 3] {
        let Some(mut point) = self.material.first_interaction(lots, origin, along, length) else {
            return [0.0; 3];
        };
        let Settings { shading, scattering, .. } = self.settings;
        let mut weight = [1.0; 3];
        let mut sum = [0.0; 3];
        loop {
            // Matter emits `emission` times its colour, and scatters albedo times its colour of what arrives.
            let color = self.material.color(point);
            let direct = self.direct(lots, point);
            for c in 0..3 {
                let emitted = weight[c] * color[c] * shading.emission;
                weight[c] *= color[c] * scattering.albedo;
                sum[c] += emitted + weight[c] * direct[c];
            }
            let towards = lots.next_direction();
            let step = self.index_from_scene.transform_vector3(towards);
            let Some(next) = self.material.first_interaction(lots, point, step, self.far) else {
                for c in 0..3 {
                    sum[c] += weight[c]
                        * self.sky.map_or(0.0, |sky| (sky.mean[c] + sky.slope[c].dot(towards)).max(0.0));
                }
                return sum;
            };
            if weight.iter().all(|&weight| weight < MIN_PATH_WEIGHT) {
                return sum;
            }
            point = next;
        }
    }
}

/// Two unbiased estimates of each pixel, each with half of the paths.
pub(super) fn trace_picture(
    loaded: &Dataset,
    settings: &Settings,
    edge: u32,
    paths: u32,
) -> Vec<[[f64; 3]; 2]> {
    let scene = loaded.volume().scene();
    let linear = |light: &LightSettings| {
        light.color.map(|c| chiaroscuro_scene::linear_from_srgb(f64::from(c)) * light.intensity)
    };
    let points =
        |light: &LightSettings| light.resolve(&settings.camera).sample_lights(settings.shadows.area.samples);
    let tracer = ScenePathTracer {
        material: TracedMaterial::new(loaded, settings),
        settings,
        index_from_scene: scene.index_from_scene,
        lights: settings.lights.iter().map(|light| (points(light), linear(light))).collect(),
        sky: settings.sky.radiance(settings.camera.up),
        far: 2.0 * scene.support_radius(),
    };
    let frame = picture_frame(settings, &scene, [edge; 2]);
    let length = frame.slab * f64::from(frame.slab_count);
    (0..edge * edge)
        .into_par_iter()
        .map(|pixel| {
            let [i, j] = [f64::from(pixel % edge), f64::from(pixel / edge)];
            let mut lots = RandomNumbers(u64::from(pixel) << 32);
            let (origin, along) = (frame.point(i, j, frame.first_depth), frame.direction.at(i, j));
            [(); 2].map(|()| {
                let mut sum = [0.0; 3];
                for _ in 0..paths / 2 {
                    let light = tracer.path(&mut lots, origin, along, length);
                    (0..3).for_each(|c| sum[c] += light[c]);
                }
                sum.map(|sum| sum / f64::from(paths / 2))
            })
        })
        .collect()
}

/// Means of the squares of a picture.
fn square_means(light: &[[f64; 3]]) -> Vec<[f64; 3]> {
    let edge = PICTURE_EDGE / SQUARE_EDGE;
    let mean = |square: u32| {
        let mut sum = [0.0; 3];
        for pixel in 0..SQUARE_EDGE * SQUARE_EDGE {
            let x = square % edge * SQUARE_EDGE + pixel % SQUARE_EDGE;
            let y = square / edge * SQUARE_EDGE + pixel / SQUARE_EDGE;
            let texel = light[(x + PICTURE_EDGE * y) as usize];
            (0..3).for_each(|c| sum[c] += texel[c] / f64::from(SQUARE_EDGE * SQUARE_EDGE));
        }
        sum
    };
    (0..edge * edge).map(mean).collect()
}

/// Linear light of a rendered picture.
fn render_light(renderer: &mut Renderer, loaded: &Dataset, settings: &Settings) -> Vec<[f64; 3]> {
    let picture =
        renderer.render(loaded, settings, [PICTURE_EDGE; 2], &RenderOptions::default()).expect("a picture");
    picture.linear.iter().map(|&[r, g, b, _]| [r, g, b].map(f64::from)).collect()
}

/// Row of small pictures for inspection: the finest, the default and the traced one, and the errors of the first two,
/// four times amplified and around grey.
fn comparison_row(fine: &[[f64; 3]], usual: &[[f64; 3]], truth: &[[f64; 3]]) -> image::RgbImage {
    let differ = |found: &[[f64; 3]]| -> Vec<[f64; 3]> {
        let apart = |(a, b): (&[f64; 3], &[f64; 3])| std::array::from_fn(|c| 0.2 + 4.0 * (a[c] - b[c]));
        found.iter().zip(truth).map(apart).collect()
    };
    let tiles = [fine.to_vec(), usual.to_vec(), truth.to_vec(), differ(fine), differ(usual)];
    image::RgbImage::from_fn(
        tiles.len() as u32 * PICTURE_EDGE * PIXEL_SCALE,
        PICTURE_EDGE * PIXEL_SCALE,
        |x, y| {
            let [column, row] = [x / PIXEL_SCALE, y / PIXEL_SCALE];
            let light = tiles[(column / PICTURE_EDGE) as usize]
                [(column % PICTURE_EDGE + PICTURE_EDGE * row) as usize];
            image::Rgb(light.map(|c| (255.0 * srgb_from_linear(c.clamp(0.0, 1.0)) + 0.5) as u8))
        },
    )
}

/// Root mean square difference of a picture from the truth, over its mean. The two estimates have independent noise,
/// so that the product of both differences is free of it in the mean.
fn relative_error(
    renderer: &mut Renderer,
    loaded: &Dataset,
    settings: &Settings,
    [a, b]: &[Vec<[f64; 3]>; 2],
) -> f64 {
    let (mut products, mut mean) = (0.0, 0.0);
    let found = square_means(&render_light(renderer, loaded, settings));
    for ((found, a), b) in found.iter().zip(a).zip(b) {
        for c in 0..3 {
            products += (found[c] - a[c]) * (found[c] - b[c]);
            mean += 0.5 * (a[c] + b[c]);
        }
    }
    let count = (3 * found.len()) as f64;
    (products / count).max(0.0).sqrt() / (mean / count)
}

/// Settings with everything at the finest.
fn finest_settings(settings: &Settings) -> Settings {
    let mut settings = settings.clone();
    // Rays from every sample to every point of a light exceed the loop limits of software drivers.
    QualityPreset::Fine.apply(&mut settings);
    // Within slabs of a voxel the colour of thin material changes.
    (settings.sampling.slabs, settings.sampling.slab) = (SlabMode::Even, 0.25);
    settings.sky.resolution = LightVolumeResolution::Full;
    settings.scattering.resolution = LightVolumeResolution::Full;
    settings.scattering.bounces = 12;
    settings.shadows.area.resolution = LightVolumeResolution::Full;
    settings
}

/// Blobs of all densities that thin out before the faces of the grid, where renderers clip them.
fn clouds(seed: u64) -> Volume {
    let noise = scenes::noise(N, seed);
    let values = (0..N * N * N).map(|at| {
        let place = [at % N, at / N % N, at / N / N];
        let centred = DVec3::from(place.map(|c| (c as f64 + 0.5) / N as f64 * 2.0 - 1.0));
        let [x, y, z] = place;
        (noise.value(x, y, z) * (1.25 * (1.0 - centred.length_squared())).clamp(0.0, 1.0)) as u8
    });
    Volume::with_spacing("clouds", [N; 3], DVec3::ONE, Samples::U8(values.collect())).expect("a volume")
}

fn check(name: &str, loaded: &Dataset, paths: u32) {
    let usual = check_finest(name, loaded, paths, &look());
    assert!(usual <= ALL_LIGHT_DEFAULTS, "{name}: {usual}");
}

/// Checks the picture at the finest settings; returns the error of the default settings.
fn check_finest(name: &str, loaded: &Dataset, paths: u32, settings: &Settings) -> f64 {
    let truth = trace_picture(loaded, settings, PICTURE_EDGE, paths);
    let mean: Vec<_> = truth.iter().map(|[a, b]| std::array::from_fn(|c| 0.5 * (a[c] + b[c]))).collect();
    let truth = [0, 1].map(|half| square_means(&truth.iter().map(|pixel| pixel[half]).collect::<Vec<_>>()));
    let mut renderer = new_renderer();
    let [ours, usual] =
        [finest_settings(settings), settings.clone()].map(|look| render_light(&mut renderer, loaded, &look));
    let map = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("all-light-{name}.png"));
    comparison_row(&ours, &usual, &mean).save(&map).expect("written");
    let mut off = |settings: &Settings| relative_error(&mut renderer, loaded, settings, &truth);
    let (fine, usual) = (off(&finest_settings(settings)), off(settings));
    let mut without = finest_settings(settings);
    without.scattering.bounces = 0;
    let without = off(&without);
    let mut brighter = finest_settings(settings);
    brighter.sky.intensity *= 1.1;
    let brighter = off(&brighter);
    println!(
        "{name}: off by {fine:.4} at full resolution, {usual:.4} at the defaults; {without:.4} without bounces, \
         {brighter:.4} under a sky a tenth brighter"
    );
    assert!(
        without > ALL_LIGHT && brighter > ALL_LIGHT,
        "{name}: mistakes are not noticed: {without} {brighter}"
    );
    assert!(fine <= ALL_LIGHT, "{name}: {fine}");
    usual
}

#[test]
fn all_light_is_that_of_a_path_tracer() {
    check("creature", &Dataset::new(scenes::creature(N, DVec3::ONE)), 768);
}

/// Two more volumes, and more paths.
#[test]
#[ignore = "takes minutes"]
fn all_light_is_that_of_a_path_tracer_in_other_volumes() {
    check("creature", &Dataset::new(scenes::creature(N, DVec3::ONE)), 3072);
    check("clouds 5", &Dataset::new(clouds(5)), 3072);
    check("clouds 8", &Dataset::new(clouds(8)), 3072);
}

/// Scan of a tooth with a quarter of its voxels along each axis, if available.
#[test]
#[ignore = "takes minutes"]
fn all_light_is_that_of_a_path_tracer_in_a_scan() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data/raw");
    let path = folder.join("tooth_103x94x161_uint8.raw");
    if !path.exists() {
        println!("NOT RUN: there is no {}", path.display());
        return;
    }
    let quarter = Portion { thinning: Downsampling::Average(4), ..Portion::default() };
    let choice = VolumeChoice { portion: Some(quarter), ..VolumeChoice::default() };
    let options = LoadOptions { choice, ..LoadOptions::default() };
    let volume = open(&path, &options, &LoadControl::new()).expect("a volume");
    // Without the surrounding air, which ends with the grid: there renderers clip by the share of the kernel, and the
    // path tracer by densities.
    let mut settings = look();
    for point in &mut settings.layer_mut().transfer.points {
        point.value = AIR + point.value.max(0.0) * (255.0 - AIR) / 255.0;
    }
    let usual = check_finest("tooth", &Dataset::new(volume), 3072, &settings);
    assert!(usual <= ALL_LIGHT_DEFAULTS, "{usual}");
}
