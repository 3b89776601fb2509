//! Brightness against a path tracer of single scattering in dense material: the visible point and its transmittance
//! to the light are both sampled at random, without steps and without slabs.

use chiaroscuro_render::{RenderOptions, plan::picture_frame};
use chiaroscuro_scene::{
    LightGeometry, OpacityLength, Projection, QualityPreset, Settings, ShadowAlgorithm, SkyMode,
    first_look::{self, FirstLookOptions},
};
use chiaroscuro_volume::{KindName, synthetic::builtin};
use rayon::prelude::*;

use crate::common::{Dataset, new_renderer};
use crate::path_tracing::{RandomNumbers, TracedMaterial};
use crate::scenes::{self, make_isotropic};
use crate::thresholds::{TRACED_EXACT, TRACED_STANDARD};

/// Width and height of pictures in pixels: pixels are narrower than voxels, so that no kernel is stretched.
const PICTURE_EDGE: u32 = 160;

/// Number of paths per pixel.
const PATHS_PER_PIXEL: u32 = 32;

/// Mean over all pixels of the light at their first interaction, and its uncertainty.
fn traced_mean(loaded: &Dataset, settings: &Settings) -> (f64, f64) {
    let volume = loaded.volume();
    let scene = volume.scene();
    let material = TracedMaterial::new(loaded, settings);
    let frame = picture_frame(settings, &scene, [PICTURE_EDGE; 2]);
    let light = settings.lights[0].resolve(&settings.camera);
    let to_light = scene.index_from_scene.transform_vector3(light.direction());
    let first = frame.first_depth;
    let length = frame.slab * f64::from(frame.slab_count);
    // Two estimates of each pixel: their difference gives the noise of the mean.
    let estimates: Vec<[f64; 2]> = (0..PICTURE_EDGE * PICTURE_EDGE)
        .into_par_iter()
        .map(|pixel| {
            let [i, j] = [f64::from(pixel % PICTURE_EDGE), f64::from(pixel / PICTURE_EDGE)];
            let mut random = RandomNumbers(u64::from(pixel) << 32);
            let mut path = || {
                let eye = (frame.point(i, j, first), frame.direction.at(i, j));
                let met = material.first_interaction(&mut random, eye.0, eye.1, length);
                met.map_or(0.0, |point| {
                    material.transmittance(&mut random, point, to_light, 2.0 * scene.support_radius())
                })
            };
            [(); 2].map(|()| {
                (0..PATHS_PER_PIXEL / 2).map(|_| path()).sum::<f64>() / f64::from(PATHS_PER_PIXEL / 2)
            })
        })
        .collect();
    let count = estimates.len() as f64;
    let mean = estimates.iter().flatten().sum::<f64>() / (2.0 * count);
    let squares: f64 = estimates.iter().map(|[a, b]| (a - b).powi(2)).sum();
    (mean, 0.5 * squares.sqrt() / count)
}

/// The mean of pictures of box, sphere and cloud, white and dense, equals the path tracer's.
#[test]
fn pictures_are_as_bright_as_a_path_tracers() {
    let mut renderer = new_renderer();
    for name in ["box", "sphere", "cloud"] {
        let loaded = Dataset::new(builtin(name, Some(64)).expect("a built-in volume"));
        // A ramp of opacities, also for the box, which is a mask.
        let wishes = FirstLookOptions { data_kind: Some(KindName::Scalar), ..FirstLookOptions::default() };
        let mut settings = first_look::first_settings_with(loaded.volume(), loaded.histogram(), wishes);
        settings.sky.mode = SkyMode::Off;
        settings.layer_mut().transfer =
            first_look::transfer_for_kind(loaded.volume(), loaded.histogram(), Some(KindName::Scalar));
        scenes::use_earlier_first_look(&mut settings);
        make_isotropic(&mut settings);
        settings.camera.projection = Projection::Orthographic;
        settings.lights = vec![scenes::light(LightGeometry::Parallel, [-2.2, -1.2, 1.6])];
        // More than half of the light is absorbed within a voxel.
        settings.layer_mut().opacity_unit = OpacityLength::Voxels(1.0);
        for point in &mut settings.layer_mut().transfer.points {
            point.opacity = point.opacity.min(1.0 - (-0.84_f64).exp());
            point.color = [1.0; 3];
        }
        let mut mean = |settings: &Settings| {
            let picture = renderer
                .render(&loaded, settings, [PICTURE_EDGE; 2], &RenderOptions::default())
                .expect("a picture");
            let sum = |channel: usize| -> f64 {
                picture.linear.iter().map(|texel| f64::from(texel[channel])).sum()
            };
            [sum(0), sum(3)].map(|sum| sum / f64::from(PICTURE_EDGE * PICTURE_EDGE))
        };
        let (expected, doubt) = traced_mean(&loaded, &settings);
        // Material under unattenuated light.
        let mut unshadowed = settings.clone();
        unshadowed.shadows.algorithm = ShadowAlgorithm::Off;
        let [full, opaque] = mean(&unshadowed);
        let mut off = |quality: QualityPreset, density_scale: f64| {
            let mut settings = settings.clone();
            settings.lights[0].density_scale = density_scale;
            quality.apply(&mut settings);
            mean(&settings)[0] / (full / opaque) / expected - 1.0
        };
        let [fast, standard, fine, exact] = QualityPreset::ALL.map(|quality| off(quality, 1.0));
        println!(
            "{name}: traced {expected:.5} ± {:.2} %, off by {fast:+.4} fast, {standard:+.4} standard, {fine:+.4} fine, {exact:+.4} exact",
            100.0 * doubt / expected
        );
        let damaged = off(QualityPreset::Exact, 0.95);
        assert!(damaged.abs() > TRACED_EXACT, "{name}: thinner shadows are noticed: {damaged}");
        assert!(standard.abs() <= TRACED_STANDARD, "{name}: {standard}");
        assert!(exact.abs() <= TRACED_EXACT, "{name}: {exact}");
    }
}
