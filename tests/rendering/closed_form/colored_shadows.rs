//! Coloured shadows in closed form: the Beer–Lambert law for each colour of light.

use chiaroscuro_render::{RenderOptions, WorkOptions, plan::RenderRequest};
use chiaroscuro_scene::{RenderEngine, ShadowAlgorithm};

use super::{base, renderer, with_both_engines};
use crate::common::Dataset;
use crate::scenes;
use crate::thresholds::{MIN_COMPARED_LIGHT, RAY_BEER_LAMBERT};

with_both_engines! {
    each_colour_is_absorbed_by_itself
}

/// Shares of the extinction that red, green and blue light meet: extinctions as 0.1 to 1 to 3.
const EXTINCTION_SHARES: [f64; 3] = [1.0 / 30.0, 1.0 / 3.0, 1.0];

/// The sRGB colour that has these shares: 1 − t·(c − min) / max, with a blue of 0 and t of 29/30.
fn glass_color() -> [f32; 3] {
    [1.0, (2.0 / 3.0) / (29.0 / 30.0), 0.0].map(|linear| chiaroscuro_scene::srgb_from_linear(linear) as f32)
}

/// Behind d voxels of a block of extinction μ, e^(−μ·s·d) remains of light of a colour that meets a share s of it:
/// the ratio of a light volume at two positions does not depend on kernels.
fn each_colour_is_absorbed_by_itself(engine: RenderEngine) {
    let (n, face, per_voxel) = (48, 8, 0.25);
    let loaded =
        Dataset::new(scenes::block(n, |[x, y, z]| [x, y, z].iter().all(|c| (face..n - face).contains(c))));
    for algorithm in [ShadowAlgorithm::Splat, ShadowAlgorithm::Raycast] {
        let mut settings = base(engine, per_voxel);
        settings.shadows.algorithm = algorithm;
        settings.shadows.transmission = 29.0 / 30.0;
        for point in &mut settings.layer_mut().transfer.points {
            point.color = glass_color();
        }
        let mut renderer = renderer();
        let options =
            RenderOptions::from(WorkOptions { fill_all_light_voxels: true, ..WorkOptions::default() });
        renderer.draw(&loaded, &settings, [8, 8], &options).expect("the light volume is filled");
        let volume = loaded.id();
        let request =
            RenderRequest { volume, settings: settings.clone(), size: [8, 8], preview_resolution: None };
        let found = renderer.attenuation(&request, 0).expect("it is read back").expect("there is one");
        let at = |z: usize| found.colors[n / 2 + n * (n / 2 + n * z)].map(f64::from);
        let first = n - face - 4;
        for z in face + 3..first {
            for (color, met) in EXTINCTION_SHARES.into_iter().enumerate() {
                let expected = (-per_voxel * met * (first - z) as f64).exp();
                let ratio = at(z)[color] / at(first)[color];
                if at(z)[color] > MIN_COMPARED_LIGHT {
                    // Half a step of a half float at either end.
                    let tolerance = RAY_BEER_LAMBERT + 2.0 / 2048.0;
                    let error = (ratio / expected - 1.0).abs();
                    assert!(
                        error < tolerance,
                        "{algorithm:?}, colour {color}, z {z}: {ratio}, not {expected}"
                    );
                }
            }
        }
    }
}
