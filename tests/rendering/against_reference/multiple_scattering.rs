//! Multiple scattering against the reference: the volume of scattered light, and pictures.

use chiaroscuro_reference::{BouncedLight, Reference, ReferenceFault, ReferenceOptions};
use chiaroscuro_render::plan::UniformLightColor;
use chiaroscuro_scene::{
    ClassificationOrder, ClipEffect, CropBox, DensityRange, LightGeometry, LightSettings, LightShape,
    LightVolumeResolution, LitSides, RenderEngine, ScatteringSettings, Settings, ShadowAlgorithm, SkyMode,
    SkySettings, Spotlight,
};
use chiaroscuro_volume::{Dataset, Volume};
use glam::DVec3;

use super::check_volume;
use super::mutations::assert_in_shader;
use super::presence::{two_lobes, waves};
use crate::common::damaged_renderer;
use crate::compare::{channels_f32, compare};
use crate::scenes;
use crate::thresholds::{LIGHT_BY_WALKS, SCATTERED_LIGHT};

const N: usize = 22;

fn with_scattering(settings: Settings) -> Settings {
    let scattering =
        ScatteringSettings { bounces: 4, albedo: 0.8, directions: 12, ..ScatteringSettings::default() };
    Settings { scattering, ..settings }
}

fn creature() -> Volume {
    scenes::creature(N, DVec3::new(1.0, 1.0, 1.4))
}

/// Look with three lights, one of them an area light, a sky, and emission.
fn look_with_all_light() -> Settings {
    let mut settings = with_scattering(scenes::look());
    settings.lights[0].color = [1.0, 0.8, 0.6];
    settings.lights.push(LightSettings {
        shape: LightShape::Disc,
        size: 0.4,
        hood: Spotlight { on: true, ..Spotlight::default() },
        ..scenes::light(LightGeometry::Perspective, [-1.0, 1.4, 0.9])
    });
    settings.lights.push(LightSettings {
        casts_shadows: false,
        intensity: 0.3,
        ..scenes::light(LightGeometry::Parallel, [0.3, 0.2, -1.0])
    });
    settings.sky =
        SkySettings { mode: SkyMode::Gradient, tilt_deg: 20.0, directions: 12, ..SkySettings::default() };
    settings.shading.emission = 0.2;
    settings
}

fn cut() -> Settings {
    let mut settings = with_scattering(scenes::look());
    settings.cuts.crop =
        CropBox { on: true, low: [0.0, 0.2, 0.0], high: [0.6, 1.0, 0.9], effect: ClipEffect::Removed };
    settings
}

/// Look with lights of one colour and grey material, for which the renderer traces one channel in place of three.
fn one_color() -> Settings {
    const COLOR: [f32; 3] = [0.6, 1.0, 0.8];
    let mut settings = look_with_all_light();
    settings.shading.emission = 0.0;
    settings.layer_mut().transfer.points.iter_mut().for_each(|point| point.color = [0.8; 3]);
    settings.lights.iter_mut().for_each(|light| light.color = COLOR);
    (settings.sky.zenith, settings.sky.horizon, settings.sky.ground) = (COLOR, [0.0; 3], [0.0; 3]);
    assert!(UniformLightColor::detect(&settings).is_some(), "it does not count as one colour");
    settings
}

/// Look with lamps alone: without a sky, blocks of single voxels are means over themselves.
fn without_sky() -> Settings {
    let mut settings = look_with_all_light();
    settings.sky.mode = SkyMode::Off;
    settings
}

/// Scattered light of a reference in the memory layout of the GPU.
fn gpu_layout(bounced: &BouncedLight) -> Vec<f64> {
    let [r, g, b] = &bounced.light;
    (0..r.len()).flat_map(|at| [r[at], g[at], b[at], 1.0]).collect()
}

fn light(volume: &Volume, settings: &Settings) -> Vec<f64> {
    damaged_light(("\u{0}", ""), volume, settings)
}

/// Scattered light of a renderer with a text in its shaders replaced.
fn damaged_light((from, to): (&str, &str), volume: &Volume, settings: &Settings) -> Vec<f64> {
    let mut renderer = damaged_renderer(from, to);
    channels_f32(
        &renderer.scattered_light(&Dataset::new(volume.clone()), settings).expect("light is read back"),
    )
}

#[test]
fn light_that_has_bounced_is_what_the_reference_says() {
    for (what, volume, settings) in [
        ("creature", creature(), with_scattering(scenes::look())),
        ("everything", creature(), look_with_all_light()),
        ("of one colour", creature(), one_color()),
        ("under lamps alone", creature(), without_sky()),
        ("cut", creature(), cut()),
        ("missing voxels", waves(N, DVec3::ONE, true), with_scattering(two_lobes())),
    ] {
        for (resolution, classification) in [
            (LightVolumeResolution::Full, ClassificationOrder::Post),
            (LightVolumeResolution::Half, ClassificationOrder::Pre),
            (LightVolumeResolution::Quarter, ClassificationOrder::Post),
        ] {
            let mut settings = settings.clone();
            settings.scattering.resolution = resolution;
            settings.sampling.classification = classification;
            let expected = Reference::new(&volume, &settings, ReferenceOptions::default()).bounced_light();
            let what = format!("{what}, {resolution:?}, {classification:?}");
            compare(&what, &light(&volume, &settings), &gpu_layout(&expected), SCATTERED_LIGHT)
                .expect("the same");
        }
    }
}

#[test]
fn mistakes_are_detected() {
    let volume = creature();
    let mut settings = look_with_all_light();
    settings.scattering.resolution = LightVolumeResolution::Half;
    let right = light(&volume, &settings);
    let of = |settings: &Settings, fault: ReferenceFault| {
        let options = ReferenceOptions { fault, ..ReferenceOptions::default() };
        gpu_layout(&Reference::new(&volume, settings, options).bounced_light())
    };
    let differs = |what: &str, change: &dyn Fn(&mut Settings)| {
        let mut wrong = settings.clone();
        change(&mut wrong);
        let wrong = of(&wrong, ReferenceFault::None);
        assert!(compare(what, &right, &wrong, SCATTERED_LIGHT).is_err(), "{what} is not noticed");
    };
    assert!(
        compare("shifted", &right, &of(&settings, ReferenceFault::ShiftedKernel), SCATTERED_LIGHT).is_err()
    );
    differs("5 % more is scattered", &|settings| settings.scattering.albedo *= 1.05);
    differs("5 % denser", &|settings| settings.scattering.density_scale *= 1.05);
    differs("one bounce alone", &|settings| settings.scattering.bounces = 1);
    differs("half of the directions", &|settings| settings.scattering.directions = 6);
    differs("no light of its own", &|settings| settings.shading.emission = 0.0);
    differs("no hood", &|settings| settings.lights[1].hood.on = false);
    differs("a shadow of a light without", &|settings| settings.lights[2].casts_shadows = true);
    differs("another colour", &|settings| settings.lights[0].color = [1.0; 3]);
    differs("no sky", &|settings| settings.sky.mode = SkyMode::Off);
    differs("upside down", &|settings| settings.sky.tilt_deg = 160.0);
    differs("another transfer function", &|settings| {
        settings.layer_mut().transfer.points.iter_mut().for_each(|point| point.color[1] *= 0.9);
    });
}

#[test]
fn mistakes_in_light_of_one_color_are_noticed() {
    let volume = creature();
    let mut settings = one_color();
    settings.scattering.resolution = LightVolumeResolution::Quarter;
    let right = light(&volume, &settings);
    let mistakes = [
        ("scattered_light/result.wgsl", "sum.r * bounce.color", "vec3f(sum.r)"),
        ("scattered_light/sweep.wgsl", "return rays.incoming_radiance.r;", "return 0.0;"),
        ("scattered_light/sweep.wgsl", "return found.g;", "return found.r;"),
        (
            "scattered_light/source.wgsl",
            "vec4f(emission.r, extinction, 0.0, 0.0)",
            "vec4f(emission.r, 0.5 * extinction, 0.0, 0.0)",
        ),
        ("scattered_light/single_scattering.wgsl", "return found.g;", "return found.r;"),
    ];
    for (shader, from, to) in mistakes {
        assert_in_shader(shader, from);
        let damaged = damaged_light((from, to), &volume, &settings);
        assert!(compare(to, &damaged, &right, SCATTERED_LIGHT).is_err(), "{shader}: {to:?} is not noticed");
    }
}

/// Blocks of single voxels, which are means over themselves, and what sweeps spread between rays.
#[test]
fn mistakes_in_blocks_of_single_voxels_are_noticed() {
    let volume = scenes::block(14, |at| at.iter().all(|c| (4..10).contains(c)));
    let mut settings =
        without_sky().with_transfer(scenes::linear_extinction(1.0)).with_range(DensityRange::Full);
    settings.scattering.resolution = LightVolumeResolution::Full;
    let right = light(&volume, &settings);
    for (shader, from, to) in [
        ("scattered_light/blocks.wgsl", "side * blocks.offset", "side * 0.0"),
        ("scattered_light/received_light.wgsl", "SPREAD * spread", "0.0 * spread"),
    ] {
        assert_in_shader(shader, from);
        let damaged = damaged_light((from, to), &volume, &settings);
        assert!(compare(to, &damaged, &right, SCATTERED_LIGHT).is_err(), "{shader}: {to:?} is not noticed");
    }
}

#[test]
fn pictures_with_light_that_bounces() {
    let check = |what: &str, settings: &Settings| check_volume(what, creature(), settings, None);
    let lit = with_scattering(scenes::look());
    check("bouncing", &lit);
    check("cut", &cut());
    check("everything", &look_with_all_light());
    let mut two = lit.clone();
    (two.shading.sides, two.scattering.strength) = (LitSides::Two, 2.5);
    check("both sides, brighter", &two);
    let mut direct = lit.clone();
    direct.shadows.algorithm = ShadowAlgorithm::Direct;
    check("rays to the light", &direct);
    let mut scattered = lit.clone();
    scattered.sampling.engine = RenderEngine::Scatter;
    check("scattered", &scattered);
    let mut forward = lit.clone();
    (forward.scattering.anisotropy, forward.scattering.bounces) = (0.6, 0);
    forward.shading.surface_gradient = 0.5;
    check("forward", &forward);
    forward.scattering.anisotropy = -0.4;
    check("back", &forward);
}

/// All light within material, scattered or not. Random walks are independent of rays through blocks, bounces and
/// diffusion.
#[test]
fn light_agrees_with_random_walks() {
    const WALKS: u32 = 20_000;
    let cloud = |seed: u64| scenes::noise(16, seed);
    for (what, seed, per_voxel, albedo) in
        [("thin", 1, 0.15, 0.95), ("even", 2, 0.5, 0.9), ("dense", 3, 0.8, 0.8)]
    {
        let volume = cloud(seed);
        let mut settings = with_scattering(scenes::look());
        settings.layer_mut().transfer = scenes::linear_extinction(per_voxel);
        settings.layer_mut().transfer.points[1].color = [1.0, 0.8, 0.5];
        settings.lights[0].color = [1.0, 0.9, 0.8];
        settings.sky = SkySettings { mode: SkyMode::Gradient, ..SkySettings::default() };
        settings.shading.emission = 0.1;
        settings.scattering = ScatteringSettings {
            bounces: 12,
            albedo,
            directions: 48,
            resolution: LightVolumeResolution::Full,
            ..ScatteringSettings::default()
        };
        let reference = Reference::new(&volume, &settings, ReferenceOptions::default());
        let medium = reference.medium();
        let before = reference.unscattered_light(&medium, 64);
        let found = light(&volume, &settings);
        // Every 311th block, some of them at the faces of the grid.
        let at: Vec<usize> = (0..medium.extinction.len()).step_by(311).collect();
        let mut squares = 0.0;
        let mut sum = 0.0;
        for &at in &at {
            let walked = reference.light_by_walks(&medium, at, WALKS, seed);
            for c in 0..3 {
                squares += (before[c][at] + found[4 * at + c] - walked[c]).powi(2);
                sum += walked[c];
            }
        }
        let count = 3.0 * at.len() as f64;
        let share = (squares / count).sqrt() / (sum / count);
        println!("{what}: rmse {:.2} % of the mean, {:.4}", 100.0 * share, sum / count);
        assert!(share <= LIGHT_BY_WALKS, "{what}: {share}");
    }
}
