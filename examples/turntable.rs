//! Example that exports a turntable animation: `cargo run --example turntable -- [OUT.png|OUT.gif]`
#![expect(clippy::print_stdout, reason = "it says what it made")]

use std::error::Error;
use std::path::PathBuf;

use chiaroscuro_media::{Animation, AnimationSpec};
use chiaroscuro_render::{GpuContext, RenderOptions, Renderer, first_look};
use chiaroscuro_scene::LookRecord;
use chiaroscuro_volume::{Dataset, synthetic};

fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args()
        .nth(1)
        .map_or_else(|| std::env::temp_dir().join("chiaroscuro-turntable.gif"), PathBuf::from);
    let dataset = Dataset::new(synthetic::builtin("chair", Some(32))?);
    let mut renderer = Renderer::new(&GpuContext::headless()?)?;
    let settings = first_look(&mut renderer, &dataset)?;

    // The extension decides: GIF, animated PNG, MP4 (if ffmpeg is installed), or a folder of pictures.
    let animation_spec = AnimationSpec { size: [160, 120], frames: 24, rate: 12, transparent: false };
    let mut file = Animation::create(&path, &animation_spec)?;
    for frame in 0..animation_spec.frames {
        // `Some(0)` instead of `None` turns the first light. The light volumes of the first picture serve all others:
        // lights of the scene stay in place when the camera turns.
        let settings = settings.at_turntable_angle(None, f64::from(frame) / f64::from(animation_spec.frames));
        let shown =
            renderer.render_display(&dataset, &settings, animation_spec.size, &RenderOptions::default())?;
        // Formats with metadata get the settings, so that each picture can be rendered again.
        file.add(&shown, &LookRecord::to_json(&settings, None, None))?;
    }
    // Until then no file of that name exists.
    file.finish()?;
    let fills = renderer.light_rebuilds();
    println!(
        "{}: {} pictures; light volumes were filled {fills:?} times",
        path.display(),
        animation_spec.frames
    );
    Ok(())
}
