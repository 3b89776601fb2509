//! Drawing and writing of the frames of an animation: into one file, or into a folder in which several programs may
//! draw.

use std::ops::Range;
use std::path::{Path, PathBuf};

use clap::Args;

use super::frame_selection::{AnimationPart, FrameRange, FrameSelection, is_drawn};
use crate::cli::CliError;
use crate::cli::output::{print_line, warn_empty_picture, warn_line};
use crate::cli::scene::{PagedDataset, SceneArgs, parse_size};
use chiaroscuro_media::{Animation, AnimationFormat, AnimationSpec, FrameFolder, PixelRows, frame_names};
use chiaroscuro_render::{PartPages, Renderer};
use chiaroscuro_scene::{ImageRecord, ImageSpec, LookRecord, Settings, VolumeRecord};

/// Arguments for the frames of an animation and the place where they are written.
#[derive(Debug, Args)]
pub(super) struct AnimationArgs {
    /// Animated PNG, GIF or MP4 (needs ffmpeg) to write, or a folder for one PNG file per frame
    #[arg(short, long, value_name = "OUT.png|OUT.gif|OUT.mp4|FOLDER")]
    output: PathBuf,
    /// Width and height in pixels
    #[arg(long, value_name = "WxH", default_value = "640x480", value_parser = parse_size)]
    size: [u32; 2],
    /// Draw only part K of N of the frames into a folder, as one of N programs; frames that are there stay
    #[arg(long, value_name = "K/N")]
    part: Option<AnimationPart>,
    /// Leave the background out (straight alpha)
    #[arg(long)]
    transparent: bool,
    /// Print the progress on standard error
    #[arg(long)]
    progress: bool,
}

impl AnimationArgs {
    /// Rejects standard output, and a file where only some of the frames are drawn.
    pub(super) fn check_output(&self) -> Result<(), CliError> {
        if self.output == Path::new("-") {
            let why =
                "an animation is written to a file or a folder; only single pictures go to standard output";
            return Err(CliError::Usage(format!("--output: {why}")));
        }
        if self.part.is_some() { self.check_folder() } else { Ok(()) }
    }

    /// Rejects a file where only some of the frames are drawn.
    fn check_folder(&self) -> Result<(), CliError> {
        if self.is_folder() {
            return Ok(());
        }
        let why = "some frames of an animation are written into a folder; give a name without extension";
        Err(CliError::Usage(format!("--output: {why}")))
    }

    /// Selects the frames of `--part`, or otherwise those of `only`; `None` if all are drawn.
    ///
    /// # Errors
    /// Returns an error if these frames do not exist, or are to be written into a file.
    pub(super) fn selection(
        &self,
        only: Option<FrameRange>,
        frames: u32,
    ) -> Result<Option<FrameSelection>, CliError> {
        let selection = FrameSelection::from_args(self.part, only, frames)?;
        if selection.is_some() {
            self.check_folder()?;
        }
        Ok(selection)
    }

    /// Rejects an output of so many frames that would replace an input of the scene or a file in `further`, as
    /// [`SceneArgs::keep_apart`] does.
    pub(super) fn keep_apart<'p>(
        &self,
        scene: &'p SceneArgs,
        further: impl IntoIterator<Item = &'p Path>,
        frames: u32,
    ) -> Result<(), CliError> {
        let files = self.files(frames);
        scene.keep_apart_from(further, &files.iter().map(PathBuf::as_path).collect::<Vec<_>>())
    }

    /// Returns true if each frame is a file of its own.
    fn is_folder(&self) -> bool {
        AnimationFormat::from_path(&self.output) == AnimationFormat::Folder
    }

    /// Returns the files to which an animation of so many frames is written.
    fn files(&self, frames: u32) -> Vec<PathBuf> {
        if self.is_folder() { frame_names(&self.output, frames) } else { vec![self.output.clone()] }
    }

    /// Returns the folder that paths of volumes in records are relative to.
    pub(super) fn record_folder(&self) -> Option<&Path> {
        AnimationFormat::record_folder(&self.output)
    }

    /// Prints a line about the progress on standard error, if that is wanted.
    pub(super) fn print_progress(&self, text: &str) {
        if self.progress {
            warn_line(text);
        }
    }
}

/// Length of an animation, and the frames of it that this program draws.
#[derive(Debug, Clone, Copy)]
pub(super) struct AnimationLength {
    /// Number of all frames.
    pub(super) frames: u32,
    /// Frames per second.
    pub(super) rate: u16,
    /// Word for a frame in the progress, such as "step".
    pub(super) unit: &'static str,
    /// Frames that are drawn; `None` if all are.
    pub(super) selection: Option<FrameSelection>,
}

/// Destination of the frames.
enum FrameDestination {
    /// File or folder of all frames, one after the other.
    Animation(Animation),
    /// Folder of which some frames are written.
    Folder(FrameFolder),
}

/// Writer of the frames of an animation, which draws those that are not there.
pub(super) struct FrameWriter<'a> {
    args: &'a AnimationArgs,
    length: AnimationLength,
    destination: FrameDestination,
    drawn: Range<u32>,
    files: Vec<PathBuf>,
    image_spec: ImageSpec,
    image_record: ImageRecord,
    /// True while no frame showed anything of its volume.
    is_empty: bool,
}

impl<'a> FrameWriter<'a> {
    /// Begins the animation: an unfinished file leaves nothing behind.
    ///
    /// # Errors
    /// When the file or folder cannot be written.
    pub(super) fn create(
        args: &'a AnimationArgs,
        length: AnimationLength,
        adapter: String,
    ) -> Result<Self, CliError> {
        let AnimationLength { frames, rate, selection, .. } = length;
        let AnimationArgs { size, transparent, .. } = *args;
        let spec = AnimationSpec { size, frames, rate, transparent };
        let destination = match selection {
            None => FrameDestination::Animation(Animation::create(&args.output, &spec)?),
            Some(_) => FrameDestination::Folder(FrameFolder::create(&args.output, &spec)?),
        };
        let drawn = selection.map_or(0..frames, FrameSelection::range);
        let image_spec = ImageSpec { transparent, ..ImageSpec::new(size) };
        Ok(Self {
            args,
            length,
            destination,
            // With more programs than frames, some have nothing to do.
            is_empty: !drawn.is_empty(),
            drawn,
            files: args.files(frames),
            image_spec,
            image_record: ImageRecord::new(image_spec, adapter),
        })
    }

    /// Returns the numbers of the frames that are drawn.
    pub(super) fn frames(&self) -> Range<u32> {
        self.drawn.clone()
    }

    /// Returns the size of the frames, and whether their background is left out.
    pub(super) fn image_spec(&self) -> ImageSpec {
        self.image_spec
    }

    /// Draws a frame and writes it with its record, unless a program that draws some of the frames finds it there.
    ///
    /// # Arguments
    /// * `shown`: dataset with its pages of finer levels, if it has any.
    /// * `volume`: record of the volume in the dataset.
    pub(super) fn draw(
        &mut self,
        frame: u32,
        renderer: &mut Renderer,
        PagedDataset { dataset, record: finer_levels, of_parts }: PagedDataset<'_>,
        settings: &Settings,
        volume: &VolumeRecord,
    ) -> Result<(), CliError> {
        let size = self.image_spec.size;
        let image_record = ImageRecord { finer_levels, ..self.image_record.clone() };
        let record = LookRecord::to_json(settings, Some(volume), Some(&image_record));
        if let FrameDestination::Folder(_) = &self.destination
            && is_drawn(&self.files[frame as usize], size, &record)
        {
            self.is_empty = false;
            return Ok(());
        }
        let pages = of_parts.map(|cache| PartPages::new(cache, |_| true));
        let mut bands = renderer.bands(&dataset, settings, &self.image_spec).with_pages(pages);
        // Frames have 8 bits per channel.
        let PixelRows::Bytes(pixels) = bands.all()? else { return Ok(()) };
        self.is_empty = self.is_empty && bands.is_empty();
        match &mut self.destination {
            FrameDestination::Animation(file) => file.add(&pixels, &record)?,
            FrameDestination::Folder(folder) => folder.write(frame, &pixels, &record)?,
        }
        let AnimationLength { frames, unit, .. } = self.length;
        self.args.print_progress(&format!("{unit} {} of {frames}", frame + 1));
        Ok(())
    }

    /// Completes the file, and prints its name.
    ///
    /// # Errors
    /// When the file or standard output cannot be written.
    pub(super) fn finish(self) -> Result<(), CliError> {
        if self.is_empty {
            warn_empty_picture();
        }
        if let FrameDestination::Animation(file) = self.destination {
            file.finish()?;
        }
        print_line(&format!("{}", self.args.output.display()))
    }
}
