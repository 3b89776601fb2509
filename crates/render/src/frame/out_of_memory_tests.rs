//! Out-of-memory tests of the renderer, with a failure injected at each texture or buffer allocation.

use crate::pipelines::shader_library::ShaderLibrary;
use crate::{GpuContext, GpuError, RenderOptions, Renderer};
use chiaroscuro_files::fault::{self, FaultEvent, InjectedFault};
use chiaroscuro_scene::{
    LightDirection, LightStorage, RenderEngine, Settings, SkyMode, first_look, key_and_fill,
};
use chiaroscuro_volume::{Dataset, LoadControl};
use chiaroscuro_volume_io::{LoadOptions, open};

const SIZE: [u32; 2] = [24, 18];

/// Maximum difference, in steps of a byte, of a picture without the gradient texture from one with it.
///
/// Where kernels are stretched, normals from the texture are interpolated, and here pixels are as large as voxels.
/// The largest difference seen is 11.
const MAX_GRADIENT_DIFFERENCE: u8 = 16;

/// Runs `draw` with the `k`-th allocation from now on refused. Returns the result, and `true` if that allocation was
/// reached.
fn with_refusal(
    k: u64,
    draw: impl FnOnce() -> Result<Vec<u8>, GpuError>,
) -> (Result<Vec<u8>, GpuError>, bool) {
    let before = fault::count_so_far(FaultEvent::Allocation);
    fault::set_faults(vec![InjectedFault::OutOfMemory(before + k)]);
    let result = draw();
    let came = fault::count_so_far(FaultEvent::Allocation) >= before + k;
    fault::set_faults(Vec::new());
    (result, came)
}

/// Checks that every refused allocation gives an out-of-memory error, neither a panic nor a wrong picture, and that
/// the renderer's next picture is right. Tries each `every`-th allocation.
fn check_refusals(settings: &Settings, dataset: &Dataset, every: usize) {
    let context = GpuContext::headless().expect("an adapter");
    let shaders = ShaderLibrary::new(&context);
    let new = || Renderer::with_shaders(&context, shaders.clone()).expect("a renderer");
    let options = RenderOptions::default();
    let expected = new().render_display(dataset, settings, SIZE, &options).expect("a picture");
    let mut refused = 0;
    for k in (1..).step_by(every) {
        let mut renderer = new();
        let (result, came) = with_refusal(k, || renderer.render_display(dataset, settings, SIZE, &options));
        if !came {
            assert!(result.expect("nothing was refused") == expected);
            break;
        }
        let again =
            renderer.render_display(dataset, settings, SIZE, &options).expect("memory is there again");
        match result {
            Err(GpuError::OutOfMemory { .. }) => {
                refused += 1;
                assert!(again == expected, "allocation {k}");
            }
            // The renderer did without the refused texture of gradients, and continues to.
            Ok(picture) => {
                let most = picture.iter().zip(&expected).map(|(a, b)| a.abs_diff(*b)).max();
                assert!(
                    most <= Some(MAX_GRADIENT_DIFFERENCE) && again == picture,
                    "allocation {k}: {most:?}"
                );
            }
            Err(other) => panic!("allocation {k}: {other}"),
        }
    }
    assert!(refused * every > 10, "{refused} refusals were noticed");
}

fn scene() -> (Dataset, Settings) {
    let volume = open("builtin:chair:16", &LoadOptions::default(), &LoadControl::new()).expect("a volume");
    let dataset = Dataset::new(volume);
    let mut settings = first_look::first_settings(dataset.volume(), dataset.histogram());
    // Lights near the eye: grazing light amplifies small differences of normals.
    settings.lights =
        key_and_fill(&settings.camera, LightDirection { off_axis_deg: 40.0, clock_deg: -45.0 }).to_vec();
    (dataset, settings)
}

#[test]
fn memory_can_be_refused_anywhere_in_a_gathered_picture() {
    let (dataset, mut settings) = scene();
    settings.shadows.storage = LightStorage::Combined;
    settings.floor.on = true;
    check_refusals(&settings, &dataset, 1);
}

/// Each slab takes buffers of its own and in the same order, so a sample of the allocations suffices.
#[test]
fn memory_can_be_refused_here_and_there_in_a_scattered_picture() {
    let (dataset, mut settings) = scene();
    settings.sampling.engine = RenderEngine::Scatter;
    check_refusals(&settings, &dataset, 5);
}

/// Sky visibility and scattered light have textures and buffers of their own.
#[test]
fn memory_can_be_refused_anywhere_under_a_sky() {
    let (dataset, mut settings) = scene();
    settings.sky.mode = SkyMode::Gradient;
    settings.scattering.bounces = 1;
    settings.shadows.storage = LightStorage::Combined;
    settings.floor.on = true;
    check_refusals(&settings, &dataset, 1);
}

#[test]
#[ignore = "each of hundreds of allocations: a minute"]
fn memory_can_be_refused_anywhere_in_a_scattered_picture() {
    let (dataset, mut settings) = scene();
    settings.sampling.engine = RenderEngine::Scatter;
    check_refusals(&settings, &dataset, 1);
}
