//! Kernels stretched to the pixel where pixels are wider than voxels (P §4): detail finer than a pixel becomes even,
//! and uniform material is unchanged.

use crate::common::{Dataset, render, shaders};
use crate::scenes::{self, axis_camera, linear_extinction, make_isotropic};
use crate::thresholds::{STRETCHED_CONTRAST, STRETCHED_FLICKER, STRETCHED_FOG};
use chiaroscuro_render::Renderer;
use chiaroscuro_scene::{Camera, OpacityLength, RenderEngine, Settings};

const N: usize = 96;
/// Width and height of the picture, at 4.3 voxels per pixel: no multiple of the checkerboard's period of four.
const PIXELS: u32 = 22;

fn renderer(stretches: bool) -> Renderer {
    let mut shaders = shaders().with_full_precision();
    if !stretches {
        let level = "clamp(log2(max(stretch, 1e-9)), 0.0, MAX_STRETCH_LEVEL)";
        shaders = shaders.with_mutation(level, "0.0 * stretch");
    }
    Renderer::with_shaders(&shaders.context().clone(), shaders).expect("a renderer")
}

/// Opacities of the middle 10 × 10 pixels of pictures from a camera that pans by an eighth of a pixel.
fn panned_frames(renderer: &mut Renderer, engine: RenderEngine, loaded: &Dataset) -> Vec<Vec<f64>> {
    let pixel = 2.0 / f64::from(PIXELS);
    // Scattering takes a software adapter seconds per picture.
    (0..if engine == RenderEngine::Scatter { 3 } else { 8 })
        .map(|step| {
            let mut settings = Settings {
                camera: Camera {
                    target: [pixel * f64::from(step) / 8.0, 0.0, pixel * f64::from(step) / 16.0],
                    distance: 1.0,
                    // The picture is as high as the volume.
                    fov_y_deg: 90.0,
                    ..axis_camera(-90.0, 0.0)
                },
                ..Settings::default()
            }
            .with_transfer(linear_extinction(0.005))
            .with_opacity_unit(OpacityLength::Voxels(1.0));
            make_isotropic(&mut settings);
            settings.sampling.engine = engine;
            settings.lights[0].casts_shadows = false;
            let picture = render(renderer, loaded, &settings, [PIXELS; 2]);
            let middle = |at: &usize| {
                let (i, j) = (at % PIXELS as usize, at / PIXELS as usize);
                (6..16).contains(&i) && (6..16).contains(&j)
            };
            (0..picture.linear.len()).filter(middle).map(|at| f64::from(picture.linear[at][3])).collect()
        })
        .collect()
}

/// Contrast of a frame, (brightest − darkest) / (brightest + darkest); and flicker of one pixel over the frames, the
/// standard deviation over the mean.
fn contrast_and_flicker(frames: &[Vec<f64>]) -> (f64, f64) {
    let contrast = |frame: &Vec<f64>| {
        let (low, high) = frame.iter().fold((f64::INFINITY, 0f64), |(a, b), &v| (a.min(v), b.max(v)));
        (high - low) / (high + low)
    };
    let flicker = |pixel: usize| {
        let mean = frames.iter().map(|frame| frame[pixel]).sum::<f64>() / frames.len() as f64;
        let squares = frames.iter().map(|frame| (frame[pixel] - mean).powi(2)).sum::<f64>();
        (squares / frames.len() as f64).sqrt() / mean
    };
    let worst = |values: &mut dyn Iterator<Item = f64>| values.fold(0f64, f64::max);
    (worst(&mut frames.iter().map(contrast)), worst(&mut (0..frames[0].len()).map(flicker)))
}

/// No. 10: A checkerboard finer than the pixels neither shows nor flickers, and without the stretch it does both; fog
/// is as opaque with the stretch as without.
#[test]
fn stretched_kernels_hide_what_is_finer_than_a_pixel() {
    // Columns along the view, each two voxels wide.
    let board = Dataset::new(scenes::block(N, |[x, _, z]| (x / 2 + z / 2) % 2 == 0));
    let fog = Dataset::new(scenes::block(N, |_| true));
    let (mut stretched, mut plain) = (renderer(true), renderer(false));
    let (aliased, flickers) = contrast_and_flicker(&panned_frames(&mut plain, RenderEngine::Gather, &board));
    assert!(aliased > STRETCHED_CONTRAST && flickers > STRETCHED_FLICKER, "the test sees no aliasing");
    let mean = |frames: Vec<Vec<f64>>| frames.iter().flatten().sum::<f64>() / frames.len() as f64;
    let plain_fog = mean(panned_frames(&mut plain, RenderEngine::Gather, &fog));
    for engine in [RenderEngine::Gather, RenderEngine::Scatter] {
        let (contrast, flicker) = contrast_and_flicker(&panned_frames(&mut stretched, engine, &board));
        println!(
            "{engine:?}: contrast {contrast:.4}, flicker {flicker:.4}; without {aliased:.4}, {flickers:.4}"
        );
        assert!(contrast <= STRETCHED_CONTRAST, "{engine:?}: contrast {contrast}");
        assert!(flicker <= STRETCHED_FLICKER, "{engine:?}: flicker {flicker}");
        let ratio = mean(panned_frames(&mut stretched, engine, &fog)) / plain_fog;
        println!("{engine:?}: fog {ratio:.5}");
        assert!((ratio - 1.0).abs() <= STRETCHED_FOG, "{engine:?}: {ratio}");
    }
}
