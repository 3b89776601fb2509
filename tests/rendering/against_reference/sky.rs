//! Sky light against the reference: moments of sky visibility, and pictures under a sky.

use chiaroscuro_reference::{Reference, ReferenceFault, ReferenceOptions, SkyVisibility};
use chiaroscuro_scene::{
    ClassificationOrder, ClipEffect, CropBox, LightStorage, LightVolumeResolution, LitSides, OpacityLength,
    RenderEngine, Settings, ShadowAlgorithm, SkyMode, SkySettings,
};
use chiaroscuro_volume::{Dataset, Volume};
use glam::DVec3;

use super::check_volume;
use super::mutations::assert_in_shader;
use super::presence::{two_lobes, waves};
use crate::common::{damaged_renderer, new_renderer};
use crate::compare::{channels_f32, compare};
use crate::scenes;
use crate::thresholds::{SKY_MOMENTS, SKY_MOMENTS_AT_SURFACES};

const N: usize = 22;

/// Look under a coloured sky that is tilted to one side.
fn under_a_sky(settings: Settings) -> Settings {
    let sky = SkySettings {
        mode: SkyMode::Gradient,
        intensity: 0.9,
        zenith: [0.7, 0.8, 1.0],
        horizon: [0.9, 0.8, 0.7],
        ground: [0.3, 0.2, 0.1],
        tilt_deg: 35.0,
        turn_deg: 120.0,
        directions: 12,
        ..SkySettings::default()
    };
    Settings { sky, ..settings }
}

fn creature() -> Volume {
    scenes::creature(N, DVec3::new(1.0, 1.0, 1.4))
}

fn cut() -> Settings {
    let mut settings = under_a_sky(scenes::look());
    settings.cuts.crop =
        CropBox { on: true, low: [0.0, 0.2, 0.0], high: [0.6, 1.0, 0.9], effect: ClipEffect::Removed };
    settings
}

/// Look whose material has surfaces in front of which rays start.
fn dense() -> Settings {
    under_a_sky(scenes::look()).with_opacity_unit(OpacityLength::Voxels(0.2))
}

/// Look as of [`dense`], whose material has no surfaces.
fn fog() -> Settings {
    let mut settings = dense();
    settings.shading.surface_gradient = 10.0;
    settings
}

/// Sky-visibility moments of a reference in the memory layout of the GPU.
fn gpu_layout(visibility: &SkyVisibility) -> Vec<f64> {
    let [x, y, z] = &visibility.first_moment;
    let of = |at: usize| [x[at], y[at], z[at], visibility.mean_transmittance[at]];
    (0..visibility.mean_transmittance.len()).flat_map(of).collect()
}

fn visibility_moments(volume: &Volume, settings: &Settings) -> Vec<f64> {
    let mut renderer = new_renderer();
    channels_f32(
        &renderer.sky_visibility(&Dataset::new(volume.clone()), settings).expect("moments are read back"),
    )
}

#[test]
fn sky_visibility_agrees_with_the_reference() {
    for (what, volume, settings) in [
        ("creature", creature(), under_a_sky(scenes::look())),
        ("cut", creature(), cut()),
        ("missing voxels", waves(N, DVec3::ONE, true), under_a_sky(two_lobes())),
        ("dense", creature(), dense()),
        ("fog", creature(), fog()),
    ] {
        for resolution in
            [LightVolumeResolution::Full, LightVolumeResolution::Half, LightVolumeResolution::Quarter]
        {
            for classification in [ClassificationOrder::Post, ClassificationOrder::Pre] {
                let mut settings = settings.clone();
                settings.sky.resolution = resolution;
                settings.sampling.classification = classification;
                let expected =
                    Reference::new(&volume, &settings, ReferenceOptions::default()).sky_visibility();
                let what = format!("{what}, {resolution:?}, {classification:?}");
                let limit =
                    if settings.shading.has_surfaces() { SKY_MOMENTS_AT_SURFACES } else { SKY_MOMENTS };
                compare(&what, &visibility_moments(&volume, &settings), &gpu_layout(&expected), limit)
                    .expect("the same");
            }
        }
    }
}

#[test]
fn mistakes_are_detected() {
    let (volume, settings) = (creature(), under_a_sky(scenes::look()));
    let right = visibility_moments(&volume, &settings);
    let of = |settings: &Settings, fault: ReferenceFault| {
        let options = ReferenceOptions { fault, ..ReferenceOptions::default() };
        gpu_layout(&Reference::new(&volume, settings, options).sky_visibility())
    };
    let differs = |what: &str, wrong: &[f64]| {
        assert!(compare(what, &right, wrong, SKY_MOMENTS).is_err(), "{what} is not noticed");
    };
    differs("shifted by half a voxel", &of(&settings, ReferenceFault::ShiftedKernel));
    let mut denser = settings.clone();
    denser.sky.density_scale = 1.05;
    differs("5 % denser", &of(&denser, ReferenceFault::None));
    let mut cut = settings.clone();
    cut.cuts.crop = CropBox { on: true, high: [0.8, 1.0, 1.0], ..CropBox::default() };
    differs("not cut", &of(&cut, ReferenceFault::None));
    let mut fewer = settings.clone();
    fewer.sky.directions = 6;
    differs("half of the directions", &of(&fewer, ReferenceFault::None));
    let mirrored: Vec<f64> =
        of(&settings, ReferenceFault::None).chunks(4).flat_map(|m| [-m[0], -m[1], -m[2], m[3]]).collect();
    differs("light from the other side", &mirrored);
}

#[test]
fn mistakes_in_where_rays_are_followed_are_noticed() {
    let (volume, mut settings) = (creature(), under_a_sky(scenes::look()));
    settings.sky.resolution = LightVolumeResolution::Full;
    // Without surfaces, in front of which rays are followed everywhere in so small a volume.
    settings.shading.surface_gradient = 10.0;
    let right = visibility_moments(&volume, &settings);
    let mistakes = [
        ("sky/sweep.wgsl", "end - 1.0", "end - 2.0"),
        ("sky/sweep.wgsl", "v.x), first)", "v.x), first + 1.0)"),
        ("sky/sweep.wgsl", "rays.first_tile + tile.y * columns", "tile.y * columns"),
        ("sky/moments.wgsl", "listed * 8u + lane % 8u", "listed * 8u"),
        ("sky/extinction_blocks.wgsl", "id + 1u", "id"),
    ];
    for (shader, from, to) in mistakes {
        assert_in_shader(shader, from);
        let mut renderer = damaged_renderer(from, to);
        let found =
            renderer.sky_visibility(&Dataset::new(volume.clone()), &settings).expect("moments are read back");
        let found = channels_f32(&found);
        assert!(compare(to, &found, &right, SKY_MOMENTS).is_err(), "{shader}: {to:?} is not noticed");
    }
}

#[test]
fn mistakes_in_surfaces_are_noticed() {
    let (volume, settings) = (creature(), dense());
    let right = visibility_moments(&volume, &settings);
    let mistakes = [
        ("sky/surfaces.wgsl", "0.5 * (f32(k - CENTRE)", "0.5 * (f32(k + 1 - CENTRE)"),
        ("sky/surfaces.wgsl", "b + 1.5 * side", "b + 1.0 * side"),
        ("sky/surfaces.wgsl", "depths[k] - 0.5 * most", "depths[k] - 0.6 * most"),
        ("sky/surfaces.wgsl", "SURFACE_DEPTH = 1.5", "SURFACE_DEPTH = 1.7"),
        ("sky/moments.wgsl", "MAX_START_SLICES = 2.0", "MAX_START_SLICES = 1.5"),
        ("sky/moments.wgsl", "return dot(abs(normal)", "return -0.1 + dot(abs(normal)"),
        ("sky/moments.wgsl", "0.5 * (light - mean)", "0.45 * (light - mean)"),
        ("sky/surfaces.wgsl", "(1.0 - cosine), 4.0 * cosine", "(1.0 - cosine), 4.1 * cosine"),
        ("sky/surfaces.wgsl", "BURIED_OPACITY = 0.9", "BURIED_OPACITY = 0.05"),
        ("sky/sharpened_blocks.wgsl", "(most - own)", "0.8 * (most - own)"),
        ("sky/extinction_blocks.wgsl", "blocks.max_depth", "1.2 * blocks.max_depth"),
        ("sky/sweep.wgsl", "max(depth, 0.0)", "abs(depth)"),
        ("sky/moments.wgsl", "saturate((most - 0.5)", "saturate((most + 1.5)"),
        ("sky/moments.wgsl", "geometry.along_z, n", "geometry.along_y, n"),
    ];
    for (shader, from, to) in mistakes {
        assert_in_shader(shader, from);
        let mut renderer = damaged_renderer(from, to);
        let found =
            renderer.sky_visibility(&Dataset::new(volume.clone()), &settings).expect("moments are read back");
        assert!(compare(to, &channels_f32(&found), &right, SKY_MOMENTS).is_err(), "{to:?} is not noticed");
    }
}

#[test]
fn pictures_under_a_sky() {
    let check = |what: &str, settings: &Settings| check_volume(what, creature(), settings, None);
    let lit = under_a_sky(scenes::look());
    check("under a sky", &lit);
    check("cut", &cut());
    check("dense", &dense());
    let mut white = lit.clone();
    white.sky.mode = SkyMode::White;
    white.shading.sides = LitSides::Two;
    white.shadows.strength = 0.7;
    check("white, both sides", &white);
    let mut open = lit.clone();
    open.shadows.algorithm = ShadowAlgorithm::Off;
    check("nothing in its way", &open);
    let mut direct = lit.clone();
    direct.shadows.algorithm = ShadowAlgorithm::Direct;
    check("rays to the light", &direct);
    let mut quarter = lit.clone();
    (quarter.sky.resolution, quarter.lights[0].on) = (LightVolumeResolution::Quarter, false);
    check("coarse, and no other light", &quarter);
    let mut scattered = lit.clone();
    scattered.sampling.engine = RenderEngine::Scatter;
    check("scattered", &scattered);
    check_volume("missing voxels", waves(N, DVec3::ONE, true), &under_a_sky(two_lobes()), None);
}

/// Combined lights do not contain the sky, which is added beside them.
#[test]
fn combined_lights_keep_the_sky() {
    let mut settings = under_a_sky(scenes::look());
    settings.shading.specular = 0.0;
    settings.lights[0].intensity = 1e-6;
    let mut renderer = new_renderer();
    let dataset = Dataset::new(creature());
    let mut picture = |storage| {
        settings.shadows.storage = storage;
        channels_f32(&crate::common::render(&mut renderer, &dataset, &settings, super::SIZE).linear)
    };
    let (own, combined) = (picture(LightStorage::PerLight), picture(LightStorage::Combined));
    compare("combined", &combined, &own, crate::thresholds::SAME_WEIGHTS).expect("the same");
}
