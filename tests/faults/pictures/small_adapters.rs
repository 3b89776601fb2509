//! Tests of adapters with lower limits: a volume is shown at full resolution, downsampled, or refused with a message.

use chiaroscuro_render::{
    GpuContext, GpuError, RenderOptions, Renderer, device_descriptor, downsample_to_fit,
};
use chiaroscuro_scene::{LightSimplification, RenderEngine, first_look};
use chiaroscuro_volume::{Dataset, LoadControl};
use chiaroscuro_volume_io::{LoadOptions, open};

use super::relations::mean_steps;

const SIZE: [u32; 2] = [96, 72];

/// Largest difference from the picture of the full adapter at the same resolution, in 255ths on the mean.
const MAX_MEAN_DIFFERENCE: f64 = 2.0;

/// Longest axis of a volume, largest buffer and largest binding, in MiB. WebGPU guarantees 2048 texels, 256 MiB and
/// 128 MiB; drivers without enough memory report less.
const ADAPTER_LIMITS: [(u32, u64, u64); 8] = [
    (2048, 256, 128),
    (2048, 256, 1),
    (2048, 16, 128),
    (2048, 1, 1),
    (256, 256, 128),
    (256, 16, 1),
    (64, 256, 128),
    (64, 1, 1),
];

/// Opens this machine's adapter with lower limits.
fn limited_context((longest, buffer, binding): (u32, u64, u64)) -> GpuContext {
    let descriptor = wgpu::InstanceDescriptor::new_without_display_handle_from_env();
    let instance = wgpu::Instance::new(descriptor);
    let adapters = pollster::block_on(instance.enumerate_adapters(wgpu::Backends::PRIMARY));
    let adapter_name = GpuContext::headless().expect("an adapter").info.name;
    let adapter =
        adapters.into_iter().find(|adapter| adapter.get_info().name == adapter_name).expect("it is there");
    let mut descriptor = device_descriptor(&adapter);
    let limits = &mut descriptor.required_limits;
    limits.max_texture_dimension_3d = limits.max_texture_dimension_3d.min(longest);
    limits.max_buffer_size = limits.max_buffer_size.min(buffer << 20);
    limits.max_storage_buffer_binding_size = limits.max_storage_buffer_binding_size.min(binding << 20);
    let (device, queue) = pollster::block_on(adapter.request_device(&descriptor)).expect("less than it can");
    GpuContext::new(&adapter, device, queue).expect("the same features")
}

/// Draws volumes by both engines with these limits.
fn check_limits(names: &[&str], limits: &[(u32, u64, u64)]) {
    let full = GpuContext::headless().expect("an adapter");
    let mut full_renderer = Renderer::new(&full).expect("a renderer");
    let contexts = limits.iter().map(|&limits| (limits, limited_context(limits))).collect::<Vec<_>>();
    let (mut shown, mut reduced, mut refused) = (0, 0, 0);
    for name in names {
        let volume = || open(name, &LoadOptions::default(), &LoadControl::new()).expect("a volume");
        let dataset = Dataset::new(volume());
        for engine in [RenderEngine::Gather, RenderEngine::Scatter] {
            // Point lights, whose volumes have the full resolution.
            let first = first_look::first_settings(dataset.volume(), dataset.histogram());
            let mut settings = LightSimplification::ALL.apply(&first);
            settings.sampling.engine = engine;
            // Refusals come before any work; large volumes that are not refused would take too long.
            if dataset.volume().dims()[0] > 200 && engine == RenderEngine::Scatter {
                continue;
            }
            let draw = |renderer: &mut Renderer, dataset: &Dataset| {
                renderer.render_display(dataset, &settings, SIZE, &RenderOptions::default())
            };
            let expected = draw(&mut full_renderer, &dataset).expect("a picture");
            for (limits, context) in &contexts {
                let what = format!("{name}, {engine:?}, {limits:?}");
                let result = downsample_to_fit(context, volume()).and_then(|fitting| {
                    let is_whole = fitting.dims() == dataset.volume().dims();
                    let mut renderer = Renderer::new(context)?;
                    Ok((draw(&mut renderer, &Dataset::new(fitting))?, is_whole))
                });
                match result {
                    Ok((picture, true)) => {
                        shown += 1;
                        let apart = mean_steps(&picture, &expected);
                        assert!(apart <= MAX_MEAN_DIFFERENCE, "{what}: {apart} steps");
                    }
                    Ok((picture, false)) => {
                        reduced += 1;
                        let is_empty = picture.chunks(4).all(|pixel| pixel == &picture[..4]);
                        assert!(!is_empty, "{what}: nothing is to be seen");
                    }
                    Err(err @ (GpuError::OverLimit { .. } | GpuError::OutOfMemory { .. })) => {
                        refused += 1;
                        println!("{what}: {err}");
                    }
                    Err(other) => panic!("{what}: {other}"),
                }
                context.check().expect("nothing is complained about later");
            }
        }
    }
    println!("small adapters: {shown} shown, {reduced} with fewer voxels, {refused} refused");
    assert!(shown > 0 && refused > 0);
}

#[test]
fn volumes_are_shown_or_refused_by_a_small_adapter() {
    check_limits(&["builtin:chair:20", "builtin:sphere:100"], &ADAPTER_LIMITS[7..]);
}

#[test]
#[ignore = "eight adapters: minutes"]
fn volumes_are_shown_or_refused_by_small_adapters() {
    let names = ["builtin:chair:20", "builtin:chair:56", "builtin:sphere:100", "builtin:chair:300"];
    check_limits(&names, &ADAPTER_LIMITS);
}
