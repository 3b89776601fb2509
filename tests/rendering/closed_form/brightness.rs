//! Constant brightness: while camera or light turn, and with balanced shadows.

use chiaroscuro_render::mean_luminance;
use chiaroscuro_scene::{LightGeometry, RenderEngine};
use glam::DVec3;

use super::{base, renderer, with_both_engines};
use crate::common::{Dataset, full_attenuation, render};
use crate::scenes::{self, axis_camera};
use crate::thresholds::{BALANCED, ROTATION_RANGE, ROTATION_STEP};

with_both_engines! {
    turning_does_not_change_brightness
}

/// No. 7: A ball looks the same from everywhere: no popping while the camera or the light turns.
fn turning_does_not_change_brightness(engine: RenderEngine) {
    let loaded = Dataset::new(scenes::ball(32, DVec3::splat(15.5), 11.0));
    let mut settings = base(engine, 0.25);
    settings.shading.ambient = 1.0;
    settings.lights.clear();
    let mut renderer = renderer();
    let mut by_camera = Vec::new();
    for degree in 0..=90 {
        settings.camera = axis_camera(f64::from(degree), 30.0);
        let picture = render(&mut renderer, &loaded, &settings, [64, 64]);
        by_camera.push(picture.linear.iter().map(|texel| f64::from(texel[1])).sum::<f64>() / 4096.0);
    }
    assert_steady("camera", &by_camera);
    let mut by_light = Vec::new();
    for degree in (0..=90).step_by(3) {
        let angle = f64::from(degree).to_radians();
        settings.lights = vec![scenes::light(LightGeometry::Parallel, [angle.cos(), angle.sin(), 0.6])];
        let volume = full_attenuation(&mut renderer, &loaded, &settings, 0);
        // Within the ball: the mean over the grid would include the length of the shadow.
        let inside: Vec<f64> = (0..volume.len())
            .filter(|at| {
                let p = DVec3::new((at % 32) as f64, (at / 32 % 32) as f64, (at / 1024) as f64);
                p.distance(DVec3::splat(15.5)) < 11.0
            })
            .map(|at| f64::from(volume[at]))
            .collect();
        by_light.push(inside.iter().sum::<f64>() / inside.len() as f64);
    }
    let mean = by_light.iter().sum::<f64>() / by_light.len() as f64;
    let range = peak_to_peak(&by_light) / mean;
    println!("turning the light: range {range:.5}");
    assert!(range <= ROTATION_RANGE, "turning the light changes the light volume by {range}");
}

fn peak_to_peak(values: &[f64]) -> f64 {
    values.iter().copied().fold(f64::MIN, f64::max) - values.iter().copied().fold(f64::MAX, f64::min)
}

fn assert_steady(what: &str, means: &[f64]) {
    let mean = means.iter().sum::<f64>() / means.len() as f64;
    let range = peak_to_peak(means) / mean;
    let step = means.windows(2).map(|pair| (pair[1] - pair[0]).abs()).fold(0.0, f64::max) / mean;
    println!("turning the {what}: range {range:.5}, largest step {step:.5}");
    assert!(range <= ROTATION_RANGE && step <= ROTATION_STEP, "{what}: range {range}, step {step}");
}

/// Measurement of the balance and of the darkness of shadows.
#[test]
fn balanced_pictures_are_as_bright_as_unshadowed_ones() {
    let loaded = Dataset::new(scenes::creature(48, DVec3::ONE));
    let mut renderer = renderer();
    let mut settings = scenes::look();
    let plain = mean_luminance(&render(&mut renderer, &loaded, &settings, [160, 120]).linear);
    settings.shadows.balance =
        chiaroscuro_render::measure_balance(&mut renderer, &loaded, &settings).expect("balance");
    let with = mean_luminance(&render(&mut renderer, &loaded, &settings, [160, 120]).linear);
    settings.shadows.algorithm = chiaroscuro_scene::ShadowAlgorithm::Off;
    let without = mean_luminance(&render(&mut renderer, &loaded, &settings, [160, 120]).linear);
    println!("shadows, unbalanced {plain:.4}, balanced {with:.4}, none {without:.4}");
    assert!((with / without - 1.0).abs() < BALANCED, "{with} against {without}");
    assert!(plain < without, "shadows take light away");
}
