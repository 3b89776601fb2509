//! Command `chiaroscuro render`: renders one picture to a file.

use std::path::PathBuf;

use clap::Args;
use serde_json::json;

use super::CliError;
use super::image_args::ImageArgs;
use super::outputs::{destination, finish, hand_over, warn_line, warn_of_nothing};
use super::scene::SceneArgs;
use crate::data::fingerprint;
use crate::export::{Destination, check_picture, check_writable, marks, write_atomically, write_picture};
use crate::gpu::{RenderOptions, Renderer, dark_share, mean_luminance};
use crate::model::{PictureRecord, Record, VolumeRecord, tells_maker};

/// Arguments of `render`.
#[derive(Debug, Args)]
pub(super) struct RenderArgs {
    #[command(flatten)]
    scene: SceneArgs,
    /// PNG or EXR file to write
    #[arg(short, long, value_name = "OUT.png|OUT.exr")]
    output: PathBuf,
    #[command(flatten)]
    shot: ImageArgs,
    /// Also write what it took, and all settings, as JSON: of the picture drawn at once, with a sample per pixel
    #[arg(long, value_name = "REPORT.json")]
    report: Option<PathBuf>,
    /// Say what is being done
    #[arg(long)]
    progress: bool,
}

/// Renders one picture, and a report if requested.
pub(super) fn run(args: &RenderArgs) -> Result<(), CliError> {
    let say = |text: &str| {
        if args.progress {
            warn_line(text);
        }
    };
    let written: Vec<_> = std::iter::once(&args.output).chain(&args.report).map(PathBuf::as_path).collect();
    args.scene.keep_apart(&written)?;
    let output = destination(&args.output, "png")?;
    let report_to = args.report.as_deref().map(|path| destination(path, "json")).transpose()?;
    let shot = args.shot.spec(output.path());
    check_picture(output.path(), &shot)?;
    for to in std::iter::once(&output).chain(&report_to) {
        check_writable(to.path())?;
    }
    say("loading the volume");
    let (loaded, context) = args.scene.load()?;
    let look = args.scene.look(&loaded)?;
    let mut renderer = Renderer::new(&context)?;
    say("finding the look");
    let settings = look.settings(&mut renderer, &loaded)?;
    say("rendering");
    let mut report = None;
    if args.report.is_some() {
        // The report measures a whole picture including light volumes, so the renderer starts without caches.
        renderer = Renderer::new(&context)?;
        let options = RenderOptions { timed: true, ..RenderOptions::default() };
        let picture = renderer.render(&loaded, &settings, shot.size, &options)?;
        let took = renderer.report();
        report = Some(json!({
            "adapter": context.info.name,
            "driver": format!("{} {}", context.info.driver, context.info.driver_info),
            "image_size": shot.size,
            "volume_dims": loaded.volume().dims(),
            "volume_file_dims": loaded.volume().file_dims(),
            "stages_ms": {
                "upload": took.upload_ms,
                "bricks": took.bricks_ms,
                "light_march": took.light_march_ms,
                "light_backproject": took.light_backproject_ms,
                "light_raycast": took.light_raycast_ms,
                "eye": took.eye_ms,
                "readback": took.readback_ms,
            },
            "light_rebuilds": renderer.light_rebuilds(),
            "slabs": took.slabs,
            "splats": renderer.splats()?,
            "peak_gpu_bytes": took.peak_gpu_bytes,
            "mean_luminance": mean_luminance(&picture.light),
            "dark_share": dark_share(&picture.light, settings.output.exposure),
            "settings_hash": format!("{:016x}", fingerprint(&serde_json::to_string(&settings).unwrap_or_default())),
            "settings": settings,
        }));
    }
    let volume = VolumeRecord::new(args.scene.source(), loaded.volume().opened_id(), output.folder())
        .choosing(loaded.volume().held().choice());
    let how = PictureRecord::new(shot, context.description());
    let record = Record::text(&settings, Some(&volume), Some(&how));
    let mut bands = renderer.bands(&loaded, &settings, &shot);
    let (layer, mut first) = (marks(&shot, &settings, loaded.volume()), 0);
    let mut rows = || -> Result<_, CliError> {
        let (done, total) = bands.progress();
        if total > 1 && done < total {
            say(&format!("part {} of {total}", done + 1));
        }
        let mut rows = bands.next_rows()?;
        if let Some(rows) = &mut rows {
            layer.lay_over(&shot, first, rows);
            first += rows.count(&shot);
        }
        Ok(rows)
    };
    write_picture(output.path(), &shot, Some(&record), &mut rows)?;
    if bands.is_empty() {
        warn_of_nothing();
    }
    // A report without its picture would be misleading, so it is written last.
    let is_told = report_to.as_ref().is_some_and(Destination::is_standard_output);
    if let Some((to, report)) = report_to.zip(report) {
        write_atomically(to.path(), format!("{:#}\n", tells_maker(report)).as_bytes())?;
        hand_over(to)?;
    }
    if is_told { hand_over(output) } else { finish(output) }
}
