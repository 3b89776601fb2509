//! Command `chiaroscuro turntable`: an animation in which the camera or a light goes once around the volume.

mod frame_selection;

use std::path::{Path, PathBuf};

use clap::Args;

use self::frame_selection::{FrameRange, FrameSelection, TurntablePart, is_drawn};
use super::CliError;
use super::output::{print_line, warn_empty_picture, warn_line};
use super::scene::{SceneArgs, parse_size};
use chiaroscuro_media::{Animation, AnimationFormat, AnimationSpec, FrameFolder, frame_names};
use chiaroscuro_render::{RenderOptions, Renderer};
use chiaroscuro_scene::{ImageRecord, ImageSpec, LookRecord, VolumeRecord};

/// Arguments of `turntable`.
#[derive(Debug, Args)]
pub(super) struct TurntableArgs {
    #[command(flatten)]
    scene: SceneArgs,
    /// Animated PNG, GIF or MP4 (needs ffmpeg) to write, or a folder for one PNG file per frame
    #[arg(short, long, value_name = "OUT.png|OUT.gif|OUT.mp4|FOLDER")]
    output: PathBuf,
    /// Width and height in pixels
    #[arg(long, value_name = "WxH", default_value = "640x480", value_parser = parse_size)]
    size: [u32; 2],
    /// Frames in one turn
    #[arg(long, default_value_t = 72, value_parser = clap::value_parser!(u32).range(2..=3600))]
    frames: u32,
    /// Draw only part K of N of the frames into a folder, as one of N programs; frames that are there stay
    #[arg(long, value_name = "K/N", conflicts_with = "only")]
    part: Option<TurntablePart>,
    /// Draw only the frames from A to B into a folder, the first of which is 0; frames that are there stay
    #[arg(long, value_name = "A..B")]
    only: Option<FrameRange>,
    /// Frames per second of an animated file
    #[arg(long, default_value_t = 24, value_parser = clap::value_parser!(u16).range(1..=120))]
    rate: u16,
    /// Turn this light around the vertical axis instead of the camera; 1 is the first
    #[arg(long, value_name = "N")]
    light: Option<usize>,
    /// Leave the background out (straight alpha)
    #[arg(long)]
    transparent: bool,
    /// Print the progress on standard error
    #[arg(long)]
    progress: bool,
}

/// Destination of the frames.
enum FrameWriter {
    /// File or folder of all frames, one after the other.
    Animation(Animation),
    /// Folder of which some frames are written.
    Folder(FrameFolder),
}

/// Renders the frames of one turn, or some of them.
pub(super) fn run(args: &TurntableArgs) -> Result<(), CliError> {
    let selection = FrameSelection::from_args(args.part, args.only, args.frames)?;
    if selection.is_some() && AnimationFormat::from_path(&args.output) != AnimationFormat::Folder {
        let why = "--output: some frames of a turn are written into a folder; give a name without extension";
        return Err(CliError::Usage(why.to_owned()));
    }
    let mut written = vec![args.output.clone()];
    if AnimationFormat::from_path(&args.output) == AnimationFormat::Folder {
        written = frame_names(&args.output, args.frames);
    }
    args.scene.keep_apart(&written.iter().map(PathBuf::as_path).collect::<Vec<_>>())?;
    if args.output == Path::new("-") {
        let why = "--output: an animation is written to a file or a folder; only single pictures go to standard output";
        return Err(CliError::Usage(why.to_owned()));
    }
    let (loaded, context) = args.scene.load()?;
    let look = args.scene.look(&loaded)?;
    let mut renderer = Renderer::new(&context)?;
    let settings = look.settings(&mut renderer, &loaded)?;
    let light = args.light.map(|number| number.wrapping_sub(1));
    if let Some(index) = light.filter(|&index| index >= settings.lights.len()) {
        let number = index.wrapping_add(1);
        let count = settings.lights.len();
        return Err(CliError::Usage(format!(
            "--light: there are lights 1 to {count}, and no light {number}"
        )));
    }
    let (size, frames, transparent) = (args.size, args.frames, args.transparent);
    let spec = AnimationSpec { size, frames, rate: args.rate, transparent };
    let mut file = match &selection {
        None => FrameWriter::Animation(Animation::create(&args.output, &spec)?),
        Some(_) => FrameWriter::Folder(FrameFolder::create(&args.output, &spec)?),
    };
    let folder = AnimationFormat::record_folder(&args.output);
    let volume = VolumeRecord::new(args.scene.source(), loaded.volume().opened_id(), folder)
        .with_choice(loaded.volume().contents().choice())
        .with_layers_of(&loaded, folder);
    let image_spec = ImageSpec { transparent, ..ImageSpec::new(size) };
    let how = ImageRecord::new(image_spec, context.description());
    let options = RenderOptions::for_image(&image_spec, &settings);
    let drawn = selection.map_or(0..frames, FrameSelection::range);
    // With more programs than frames, some have nothing to do.
    let mut is_empty = !drawn.is_empty();
    for frame in drawn {
        let settings = settings.at_turntable_angle(light, f64::from(frame) / f64::from(args.frames));
        let record = LookRecord::to_json(&settings, Some(&volume), Some(&how));
        if selection.is_some() && is_drawn(&written[frame as usize], size, &record) {
            is_empty = false;
            continue;
        }
        let shown = renderer.render_display(&loaded, &settings, size, &options)?;
        is_empty = is_empty && renderer.is_picture_empty()?;
        match &mut file {
            FrameWriter::Animation(file) => file.add(&shown, &record)?,
            FrameWriter::Folder(folder) => folder.write(frame, &shown, &record)?,
        }
        if args.progress {
            warn_line(&format!("frame {} of {}", frame + 1, args.frames));
        }
    }
    if is_empty {
        warn_empty_picture();
    }
    if let FrameWriter::Animation(file) = file {
        file.finish()?;
    }
    print_line(&format!("{}", args.output.display()))?;
    Ok(())
}
