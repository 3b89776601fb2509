//! Command `chiaroscuro replay`: reproduces a picture from its embedded record, and compares the two.

use std::path::PathBuf;

use clap::Args;

use super::CliError;
use super::outputs::{keep_apart, print_line, warn_line};
use super::scene::{LoadArgs, corrected};
use crate::data::{Dataset, plain};
use crate::export::{Rows, check_picture, marks, picture_size, read_picture, read_record, write_picture};
use crate::gpu::{Distance, Renderer};
use crate::model::{PresetError, Record, Settings, VolumePlace, VolumeRecord};

/// Maximum length of a path in a message, in characters.
const LONGEST_PATH: usize = 4096;

/// Arguments of `replay`.
#[derive(Debug, Args)]
pub(super) struct ReplayArgs {
    /// A PNG or EXR picture that this program has exported
    picture: PathBuf,
    /// The volume, if it is not where it was
    #[arg(long, value_name = "FILE")]
    volume: Option<PathBuf>,
    /// Open the volume wherever the picture says that it is
    #[arg(long)]
    trust_paths: bool,
    /// Write the new picture
    #[arg(short, long, value_name = "OUT")]
    output: Option<PathBuf>,
    /// Replace a file that this program has not made
    #[arg(long, requires = "output")]
    force: bool,
    /// Fail (exit code 1) unless both pictures are the same byte for byte
    #[arg(long)]
    check: bool,
    #[command(flatten)]
    load: LoadArgs,
}

/// Returns the volume of a picture, if it may be opened: pictures come from untrusted sources and could name any
/// file.
fn source_of(args: &ReplayArgs, stated: &VolumeRecord) -> Result<PathBuf, CliError> {
    let refused = |why: &'static str, help: &'static str| {
        let volume = plain(&stated.source, LONGEST_PATH);
        Err(CliError::VolumeElsewhere { picture: args.picture.clone(), volume, why, help })
    };
    match stated.place(args.picture.parent()) {
        VolumePlace::Builtin(name) => Ok(name.into()),
        VolumePlace::Beside(path) => Ok(path),
        VolumePlace::Elsewhere(path) if args.trust_paths => Ok(path),
        VolumePlace::Elsewhere(_) => {
            refused("it is not in the picture's folder", "--trust-paths opens it, --volume FILE another")
        }
        VolumePlace::Never(why) => refused(why, "--volume FILE names one"),
    }
}

/// Renders the picture again and prints the distance of both.
pub(super) fn run(args: &ReplayArgs) -> Result<(), CliError> {
    let path = args.picture.display().to_string();
    let unusable = |why: String| CliError::Replay { path: path.clone(), why };
    let text = read_record(&args.picture)?.ok_or_else(|| unusable("it carries no settings".to_owned()))?;
    let preset = |source: PresetError| CliError::Preset { what: "picture", path: path.clone(), source };
    let record = Record::read(&text).map_err(preset)?;
    let how =
        record.picture.clone().ok_or_else(|| unusable("it does not say how large it was".to_owned()))?;
    let stated = record.volume.as_ref();
    let source = match (&args.volume, stated) {
        (Some(volume), _) => volume.clone(),
        (None, Some(stated)) => source_of(args, stated)?,
        (None, None) => return Err(unusable("it does not say of which volume".to_owned())),
    };
    if let Some(output) = &args.output {
        keep_apart(&[&args.picture, &source], &[output], args.force)?;
    }
    let (volume, context) = args.load.open_chosen(&source, stated.map(|stated| &stated.choice))?;
    if stated.is_some_and(|of| !of.is_of(volume.opened_id())) {
        return Err(unusable(format!("{} is another volume than the one that it shows", source.display())));
    }
    let by = record.corrections_of(volume.opened_id()).unwrap_or_default();
    let volume = corrected(&source, volume, &by)?;
    let (settings, warnings) = record.apply(&Settings::default(), &volume.ranges()).map_err(preset)?;
    let settings = Settings { volume: by, ..settings };
    for warning in warnings {
        warn_line(&format!("warning: {warning} ({path})"));
    }
    let loaded = Dataset::new(volume);
    if how.adapter != context.description() {
        warn_line(&format!("made on {}, again on {}", how.adapter, context.description()));
    }
    if how.version != env!("CARGO_PKG_VERSION") {
        warn_line(&format!("made by version {}, again by {}", how.version, env!("CARGO_PKG_VERSION")));
    }
    let shot = how.shot.within_limits();
    // Checked before the picture is decoded.
    let size = picture_size(&args.picture)?;
    if size != shot.size {
        return Err(unusable(format!("it is {size:?} pixels and not {:?}", shot.size)));
    }
    let (_, before) = read_picture(&args.picture)?;
    if let Some(output) = &args.output {
        check_picture(output, &shot)?;
    }
    let mut renderer = Renderer::new(&context)?;
    let mut again = renderer.bands(&loaded, &settings, &shot).all()?;
    marks(&shot, &settings, loaded.volume()).lay_over(&shot, 0, &mut again);
    let again = again.as_written(&shot);
    if let Some(output) = &args.output {
        let mut rows = Some(again.clone());
        write_picture::<CliError>(output, &shot, Some(&text), &mut || Ok(rows.take()))?;
    }
    if again == before {
        print_line("identical")?;
        return Ok(());
    }
    let Distance { rmse, largest } = match (&before, &again) {
        (Rows::Bytes(before), Rows::Bytes(again)) => Distance::between(before, again),
        _ => Distance::between_values(&before.values(), &again.values()),
    };
    let maker = if record.is_earlier() { "made by an earlier version, " } else { "" };
    let words = format!("{maker}different: RMSE {rmse:.3} of 255, largest difference {largest}");
    if args.check {
        return Err(CliError::Differs(words));
    }
    print_line(&words)?;
    Ok(())
}
