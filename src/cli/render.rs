//! Command `chiaroscuro render`: renders one picture to a file.

use std::path::PathBuf;

use clap::Args;
use serde_json::{Value, json};

use super::CliError;
use super::image_args::ImageArgs;
use super::output::{copy_to_stdout, finish_output, open_destination, warn_empty_picture, warn_line};
use super::process::StageTimes;
use super::scene::{FinerLevelArgs, PagedDataset, SceneArgs, say_missing_pages};
use chiaroscuro_files::{
    OutputDestination, check_writable, fingerprint, with_provenance_mark, write_atomically,
};
use chiaroscuro_media::{check_picture, marks_layer, write_picture};
use chiaroscuro_render::{
    BandProgress, GpuContext, PartPages, RenderOptions, Renderer, WorkOptions, dark_fraction, mean_luminance,
};
use chiaroscuro_scene::{ImageRecord, ImageSpec, LookRecord, Settings, VolumeRecord};
use chiaroscuro_volume::Dataset;

/// Arguments of `render`.
#[derive(Debug, Args)]
pub(super) struct RenderArgs {
    #[command(flatten)]
    scene: SceneArgs,
    /// PNG or EXR file to write
    #[arg(short, long, value_name = "OUT.png|OUT.exr")]
    output: PathBuf,
    #[command(flatten)]
    image: ImageArgs,
    #[command(flatten)]
    finer: FinerLevelArgs,
    /// Also write times, memory and all settings to a JSON file; timed without tiling, at one sample per pixel
    #[arg(long, value_name = "REPORT.json")]
    report: Option<PathBuf>,
    /// Print the progress on standard error
    #[arg(long)]
    progress: bool,
}

/// Renders one picture, and a report if requested.
pub(super) fn run(args: &RenderArgs) -> Result<(), CliError> {
    let mut times = StageTimes::new();
    let say = |text: &str| {
        if args.progress {
            warn_line(text);
        }
    };
    let written: Vec<_> = std::iter::once(&args.output).chain(&args.report).map(PathBuf::as_path).collect();
    args.scene.keep_apart(&written)?;
    let output = open_destination(&args.output, "png")?;
    let report_to = args.report.as_deref().map(|path| open_destination(path, "json")).transpose()?;
    let image_spec = args.image.spec(output.path());
    check_picture(output.path(), &image_spec)?;
    for to in std::iter::once(&output).chain(&report_to) {
        check_writable(to.path())?;
    }
    say("loading the volume");
    let (loaded, context) = args.scene.load_timed(&mut times, args.scene.level_rule(args.finer.pool()))?;
    times.end("volume_and_adapter");
    let look = args.scene.look(&loaded)?;
    times.end("first_look");
    let mut renderer = Renderer::new(&context)?;
    say("determining the look");
    let settings = look.settings(&mut renderer, &loaded)?;
    times.end("light_search");
    let shaders = renderer.shaders();
    times.attribute("light_search", "shaders", shaders.compile_ms());
    let mut reader = args.scene.page_reader(&args.finer, loaded, &settings)?;
    let PagedDataset { dataset: loaded, record: finer, of_parts } =
        reader.read_for(&settings, &image_spec, &say)?;
    times.end("finer_levels");
    say("rendering");
    let volume = VolumeRecord::new(args.scene.source(), loaded.volume().opened_id(), output.folder())
        .with_choice(loaded.volume().contents().choice())
        .with_layers_of(&loaded, output.folder());
    let picture_record =
        ImageRecord { finer_levels: finer, ..ImageRecord::new(image_spec, context.description()) };
    let record = LookRecord::to_json(&settings, Some(&volume), Some(&picture_record));
    let pages = of_parts.map(|cache| PartPages::new(cache, |missing| say_missing_pages(&say, missing)));
    let mut bands = renderer.bands(&loaded, &settings, &image_spec).with_pages(pages);
    let (layer, mut first) = (marks_layer(&image_spec, &settings, loaded.volume()), 0);
    let mut rows = || -> Result<_, CliError> {
        times.end("encoding_and_file");
        let BandProgress { drawn, total } = bands.progress();
        if total > 1 && drawn < total {
            say(&format!("part {} of {total}", drawn + 1));
        }
        let mut rows = bands.next_rows()?;
        if let Some(rows) = &mut rows {
            layer.composite_over(&image_spec, first, rows);
            first += rows.count(&image_spec);
        }
        times.end("picture");
        Ok(rows)
    };
    let compiled = shaders.compile_ms();
    write_picture(output.path(), &image_spec, Some(&record), &mut rows)?;
    times.end("encoding_and_file");
    times.attribute("picture", "shaders", shaders.compile_ms() - compiled);
    if bands.is_empty() {
        warn_empty_picture();
    }
    drop(bands);
    let report = match &report_to {
        Some(_) => Some(measured_report(&context, renderer, &loaded, &settings, &image_spec, &times)?),
        None => None,
    };
    // A report without its picture would be misleading, so it is written last.
    let is_told = report_to.as_ref().is_some_and(OutputDestination::is_standard_output);
    if let Some((to, report)) = report_to.zip(report) {
        write_atomically(to.path(), format!("{:#}\n", with_provenance_mark(report)).as_bytes())?;
        copy_to_stdout(to)?;
    }
    if is_told { copy_to_stdout(output) } else { finish_output(output) }
}

/// Draws the picture again as a whole, light volumes included, to measure it, and returns the report; `times` are those
/// from the start of the program to the picture in its file.
fn measured_report(
    context: &GpuContext,
    drawn_with: Renderer,
    loaded: &Dataset,
    settings: &Settings,
    image_spec: &ImageSpec,
    times: &StageTimes,
) -> Result<Value, CliError> {
    let mut renderer = Renderer::with_shaders(context, drawn_with.shaders())?;
    // Frees the textures of the first renderer, so that the adapter holds the volume once.
    drop(drawn_with);
    let options = RenderOptions::from(WorkOptions { timed: true, ..WorkOptions::default() });
    let picture = renderer.render(loaded, settings, image_spec.size, &options)?;
    let took = renderer.report();
    Ok(json!({
        "adapter": context.info.name,
        "driver": format!("{} {}", context.info.driver, context.info.driver_info),
        "image_size": image_spec.size,
        "volume_dims": loaded.volume().dims(),
        "volume_file_dims": loaded.volume().file_dims(),
        "to_picture_ms": times.to_json(),
        "stages_ms": {
            "upload": took.upload_ms,
            "bricks": took.tables_ms,
            "light_march": took.light_march_ms,
            "light_backproject": took.light_backproject_ms,
            "light_raycast": took.light_raycast_ms,
            "eye": took.eye_ms,
            "readback": took.readback_ms,
        },
        "light_rebuilds": renderer.light_rebuilds(),
        "slabs": took.slabs,
        "splats": renderer.splat_count()?,
        "peak_gpu_bytes": took.peak_gpu_bytes,
        "mean_luminance": mean_luminance(&picture.linear),
        "dark_share": dark_fraction(&picture.linear, settings.output.exposure),
        "settings_hash": format!("{:016x}", fingerprint(&serde_json::to_string(settings).unwrap_or_default())),
        "settings": settings,
    }))
}
