//! Example that renders a picture without a window: `cargo run --example picture -- [VOLUME [OUT.png]]`
//!
//! VOLUME is a file (RAW, NRRD), or a built-in volume such as `builtin:cloud:64`.
#![expect(clippy::print_stdout, reason = "it says what it made")]

use std::error::Error;
use std::path::PathBuf;

use chiaroscuro_media::export_png;
use chiaroscuro_render::{GpuContext, RenderOptions, Renderer, first_look};
use chiaroscuro_volume::{Dataset, LoadControl};
use chiaroscuro_volume_io::{LoadOptions, open};

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let source = arguments.next().unwrap_or_else(|| "builtin:chair:48".to_owned());
    let path =
        arguments.next().map_or_else(|| std::env::temp_dir().join("chiaroscuro-picture.png"), PathBuf::from);

    // A volume, with data derived from its voxels.
    let dataset = Dataset::new(open(&source, &LoadOptions::default(), &LoadControl::new())?);

    // A device without a window: the fastest, or the one that WGPU_ADAPTER_NAME names.
    let context = GpuContext::headless()?;
    let mut renderer = Renderer::new(&context)?;

    // The settings are the whole look. These are derived from the voxels; every field may be changed.
    let mut settings = first_look(&mut renderer, &dataset)?;
    settings.camera.azimuth_deg += 20.0;
    settings.floor.on = true;

    // RGBA bytes in sRGB, row by row from the top left.
    let size = [320, 240];
    let shown = renderer.render_display(&dataset, &settings, size, &RenderOptions::default())?;
    export_png(size, &shown, false, None, &path)?;
    println!("{}: {source}, on {}", path.display(), context.description());
    Ok(())
}
