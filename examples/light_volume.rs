//! Example that computes the light at every voxel of an array, as an array: `cargo run --example light_volume`
#![expect(clippy::print_stdout, reason = "it says what it made")]

use std::error::Error;

use chiaroscuro_render::{GpuContext, RenderOptions, Renderer, WorkOptions, plan::RenderRequest};
use chiaroscuro_scene::{
    ControlPoint, LightSettings, LightStorage, OpacityInterpolation, OpacityLength, Settings,
    TransferFunction,
};
use chiaroscuro_volume::{Dataset, Samples, Volume};

fn main() -> Result<(), Box<dyn Error>> {
    // Voxels of 1 mm, x fastest: a full block of 12³ in the middle of 32³ empty ones.
    let n = 32;
    let is_full = |i: usize| [i % n, i / n % n, i / n / n].iter().all(|c| (10..22).contains(c));
    let voxels = (0..n * n * n).map(|i| if is_full(i) { 1.0_f32 } else { 0.0 }).collect();
    let volume = Volume::with_spacing("block", [n; 3], glam::DVec3::ONE, Samples::F32(voxels))?;
    let dataset = Dataset::new(volume);

    // Light from above (+z); a full voxel absorbs a tenth of it per millimetre.
    let opacity = |value, opacity| ControlPoint::new(value, [1.0; 3], opacity);
    let mut settings = Settings {
        lights: vec![LightSettings { position: [0.0, 0.0, 3.0], ..LightSettings::default() }],
        ..Settings::default()
    }
    .with_transfer(TransferFunction {
        points: vec![opacity(0.0, 0.0), opacity(1.0, 0.1)],
        interpolation: OpacityInterpolation::Extinction,
        ..TransferFunction::default()
    })
    .with_opacity_unit(OpacityLength::Mm(1.0));
    // One volume per light, not combined with others.
    settings.shadows.storage = LightStorage::PerLight;

    // Light volumes are filled while a picture is drawn, here of a few pixels, and here everywhere, not only where it
    // needs them.
    let mut renderer = Renderer::new(&GpuContext::headless()?)?;
    let (size, options) =
        ([8, 8], RenderOptions::from(WorkOptions { fill_all_light_voxels: true, ..WorkOptions::default() }));
    renderer.draw(&dataset, &settings, size, &options)?;
    let request = RenderRequest { volume: dataset.id(), settings, size, preview_resolution: None };
    let light = renderer.attenuation(&request, 0)?.ok_or("the light casts no shadows")?;

    // 0 is dark, 1 fully lit, x fastest. Each value covers `divisor` voxels of the array along an axis.
    let [nx, ny, nz] = light.dims;
    println!("{nx} × {ny} × {nz} values; from above, through the middle of the block:");
    for z in (0..nz).rev().step_by(3) {
        let value = light.values[(z * ny + ny / 2) * nx + nx / 2];
        println!("z = {:>2} mm  {value:.3} {}", z * light.divisor, "█".repeat((40.0 * value) as usize));
    }
    Ok(())
}
