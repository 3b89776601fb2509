//! Command `chiaroscuro replay`: reproduces a picture from its embedded record, and compares the two.

use std::path::PathBuf;

use clap::Args;

use super::CliError;
use super::output::{check_overwrites, print_line, warn_empty_picture, warn_line};
use super::process::StageTimes;
use super::scene::{FinerLevelArgs, LoadArgs, PageReader, add_layer, apply_corrections};
use chiaroscuro_files::sanitised;
use chiaroscuro_media::{
    PixelRows, check_picture, marks_layer, picture_size, read_picture, read_record, write_picture,
};
use chiaroscuro_render::{PartPages, PictureDistance, Renderer};
use chiaroscuro_scene::{AppliedSettings, LookRecord, PresetError, Settings, VolumeLocation, VolumeRecord};
use chiaroscuro_volume::{Dataset, DatasetField, LevelRule};

/// Maximum length of a path in a message, in characters.
const MAX_PATH_CHARS: usize = 4096;

/// Arguments of `replay`.
#[derive(Debug, Args)]
pub(super) struct ReplayArgs {
    /// PNG or EXR picture exported by this program
    picture: PathBuf,
    /// Volume of the picture, if it is not at the recorded path
    #[arg(long, value_name = "FILE")]
    volume: Option<PathBuf>,
    /// Open the volume at the recorded path, even outside the folder of the picture
    #[arg(long)]
    trust_paths: bool,
    /// Write the new picture to this file
    #[arg(short, long, value_name = "OUT")]
    output: Option<PathBuf>,
    /// Replace a file that was not written by this program
    #[arg(long, requires = "output")]
    force: bool,
    /// Fail (exit code 1) unless all pixels of the two pictures are identical
    #[arg(long)]
    check: bool,
    #[command(flatten)]
    load: LoadArgs,
    #[command(flatten)]
    finer: FinerLevelArgs,
}

/// Returns the volume of a picture, if it may be opened: pictures come from untrusted sources and could name any
/// file.
fn trusted_volume_path(args: &ReplayArgs, volume_record: &VolumeRecord) -> Result<PathBuf, CliError> {
    let refused = |why: &'static str, help: &'static str| {
        let volume = sanitised(&volume_record.source, MAX_PATH_CHARS);
        Err(CliError::UntrustedVolumePath { picture: args.picture.clone(), volume, why, help })
    };
    match volume_record.location(args.picture.parent()) {
        VolumeLocation::Builtin(name) => Ok(name.into()),
        VolumeLocation::InRecordFolder(path) => Ok(path),
        VolumeLocation::OtherFolder(path) if args.trust_paths => Ok(path),
        VolumeLocation::OtherFolder(_) => refused(
            "it is not in the picture's folder",
            "--trust-paths opens it, --volume FILE opens another",
        ),
        VolumeLocation::Refused(why) => refused(why, "use --volume FILE to choose one"),
    }
}

/// Renders the picture again and prints the distance of both.
pub(super) fn run(args: &ReplayArgs) -> Result<(), CliError> {
    let path = args.picture.display().to_string();
    let unusable = |why: String| CliError::Replay { path: path.clone(), why };
    let text = read_record(&args.picture)?.ok_or_else(|| unusable("it carries no settings".to_owned()))?;
    let preset = |source: PresetError| CliError::Preset { what: "picture", path: path.clone(), source };
    let record = LookRecord::parse(&text).map_err(preset)?;
    let picture_record =
        record.image.clone().ok_or_else(|| unusable("it does not record its size".to_owned()))?;
    let stated = record.volume.as_ref();
    let source = match (&args.volume, stated) {
        (Some(volume), _) => volume.clone(),
        (None, Some(stated)) => trusted_volume_path(args, stated)?,
        (None, None) => return Err(unusable("it does not record its volume".to_owned())),
    };
    if let Some(output) = &args.output {
        check_overwrites(&[&args.picture, &source], &[output], args.force)?;
    }
    let (volume, context) = args.load.open(
        &source,
        stated.map(|stated| &stated.choice),
        &mut StageTimes::from_now(),
        // Ranges of values are those of the picture.
        if picture_record.finer_levels.is_some() { args.finer.level_rule() } else { LevelRule::Finest },
    )?;
    if stated.is_some_and(|of| !of.matches_content(volume.opened_id())) {
        return Err(unusable(format!("{} is another volume than that of the picture", source.display())));
    }
    let by = record.corrections_for(volume.opened_id()).unwrap_or_default();
    let volume = apply_corrections(&source, volume, &by)?;
    let AppliedSettings { settings, warnings } =
        record.apply(&Settings::default(), &volume.ranges()).map_err(preset)?;
    let settings = Settings { volume: by, ..settings };
    for warning in warnings {
        warn_line(&format!("warning: {warning} ({path})"));
    }
    let mut loaded = Dataset::new(volume);
    for layer in stated.into_iter().flat_map(|stated| &stated.layers) {
        let source = trusted_volume_path(args, layer)?;
        loaded = add_layer(&loaded, &source, &layer.choice)?;
        let is_same = loaded.fields().last().and_then(DatasetField::origin);
        if !is_same.is_some_and(|origin| layer.matches_content(origin.opened_id)) {
            return Err(unusable(format!("{} is another volume than that of the layer", source.display())));
        }
    }
    if picture_record.adapter != context.description() {
        warn_line(&format!(
            "originally rendered on {}, now on {}",
            picture_record.adapter,
            context.description()
        ));
    }
    if picture_record.version != env!("CARGO_PKG_VERSION") {
        warn_line(&format!(
            "originally rendered by version {}, now by {}",
            picture_record.version,
            env!("CARGO_PKG_VERSION")
        ));
    }
    let image_spec = picture_record.image.clamped();
    // Checked before the picture is decoded.
    let size = picture_size(&args.picture)?;
    if size != image_spec.size {
        return Err(unusable(format!(
            "its size is {size:?} pixels and not {:?} as recorded",
            image_spec.size
        )));
    }
    let before = read_picture(&args.picture)?.rows;
    if let Some(output) = &args.output {
        check_picture(output, &image_spec)?;
    }
    let mut reader = None;
    if let Some(record) = &picture_record.finer_levels {
        let (finer, options) = (args.finer.clone().for_record(record), args.load.load_options()?);
        reader = Some(PageReader::new(&finer, &source, &options, &loaded, &settings)?);
    }
    let mut of_parts = None;
    if let Some(reader) = &mut reader {
        let paged = reader.read_for(&settings, &image_spec, &|_| ())?;
        (loaded, of_parts) = (paged.dataset, paged.of_parts);
    }
    let mut renderer = Renderer::new(&context)?;
    let pages = of_parts.map(|cache| PartPages::new(cache, |_| true));
    let mut bands = renderer.bands(&loaded, &settings, &image_spec).with_pages(pages);
    let mut again = bands.all()?;
    if bands.is_empty() {
        warn_empty_picture();
    }
    marks_layer(&image_spec, &settings, loaded.volume()).composite_over(&image_spec, 0, &mut again);
    let again = again.after_round_trip(&image_spec);
    if let Some(output) = &args.output {
        let mut rows = Some(again.clone());
        write_picture::<CliError>(output, &image_spec, Some(&text), &mut || Ok(rows.take()))?;
    }
    if again == before {
        print_line("identical")?;
        return Ok(());
    }
    let PictureDistance { rmse, max: largest } = match (&before, &again) {
        (PixelRows::Bytes(before), PixelRows::Bytes(again)) => PictureDistance::between_bytes(before, again),
        _ => PictureDistance::between_values(&before.values(), &again.values()),
    };
    let maker = if record.has_earlier_schema() { "made by an earlier version, " } else { "" };
    let words = format!("{maker}different: RMSE {rmse:.3} of 255, largest difference {largest}");
    if args.check {
        return Err(CliError::ReplayDiffers(words));
    }
    print_line(&words)?;
    Ok(())
}
