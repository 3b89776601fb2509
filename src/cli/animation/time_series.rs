//! Command `chiaroscuro time-series`: an animation of the time steps of a volume, all with the look of one of them.

use std::ops::Range;

use clap::{Args, ValueEnum};

use super::frame_selection::FrameRange;
use super::frame_writer::{AnimationArgs, AnimationLength, FrameWriter};
use super::step_reader::StepReader;
use crate::cli::CliError;
use crate::cli::scene::{PagedDataset, SceneArgs};
use chiaroscuro_render::Renderer;
use chiaroscuro_scene::{DensityRange, Settings};
use chiaroscuro_volume::{Dataset, DensityMapping};

/// Degrees of a whole turn.
const WHOLE_TURN_DEG: f64 = 360.0;

/// Arguments of `time-series`.
#[derive(Debug, Args)]
#[command(
    after_help = "The steps are those that FILE holds, or otherwise the files of its folder whose names differ \
    from that of FILE in one number alone, the last. The look is that of the first step, of the step that --frame \
    selects, or of FILE among numbered files."
)]
pub(crate) struct TimeSeriesArgs {
    #[command(flatten)]
    scene: SceneArgs,
    #[command(flatten)]
    animation: AnimationArgs,
    /// Draw only the time steps from A to B, the first of which is 0, as an animation of their own
    #[arg(long, value_name = "A..B")]
    steps: Option<FrameRange>,
    /// Time steps per second of an animated file
    #[arg(long, default_value_t = 10, value_parser = clap::value_parser!(u16).range(1..=120))]
    rate: u16,
    /// Turn the camera evenly by this angle from the first step to the last
    #[arg(long, value_name = "DEGREES", default_value_t = 0.0, allow_negative_numbers = true, value_parser = parse_angle)]
    turn: f64,
    /// Steps whose values determine the colours and the automatic look
    #[arg(long, value_enum, default_value_t = SeriesRange::All)]
    range: SeriesRange,
}

/// Steps of a series whose ranges of values count, as named on the command line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum SeriesRange {
    /// All steps, of which at most 16 are read for it, spread evenly
    All,
    /// Only the step that is opened
    Open,
}

/// Parses a finite angle in degrees.
fn parse_angle(text: &str) -> Result<f64, String> {
    let angle = text.trim().parse().ok().filter(|angle: &f64| angle.is_finite());
    angle.ok_or_else(|| format!("expected an angle in degrees such as 360 or -90, found {text:?}"))
}

/// Renders the time steps of a volume, or some of them.
pub(crate) fn run(args: &TimeSeriesArgs) -> Result<(), CliError> {
    let TimeSeriesArgs { scene, animation, steps, rate, turn, range } = args;
    animation.check_output()?;
    // Reading takes long, so what is known before is checked before: every series has a first frame.
    animation.keep_apart(scene, [], 1)?;
    let (opened, context) = scene.load_step(steps.map_or(0, FrameRange::first) as usize)?;
    let reader = StepReader::new(scene, &opened, &context)?;
    let animated = animated_steps(*steps, reader.count())?;
    let frames = animated.end - animated.start;
    let selection = animation.selection(None, frames)?;
    animation.keep_apart(scene, reader.paths(), frames)?;
    let shown = match range {
        SeriesRange::Open => opened,
        SeriesRange::All => reader.with_series_ranges(&opened, |done, count| {
            animation.print_progress(&format!("range of values: step {done} of {count}"));
        })?,
    };
    let look = scene.look(&shown)?;
    let mut renderer = Renderer::new(&context)?;
    let settings = with_typed_ranges(look.settings(&mut renderer, &shown)?, &shown);
    let length = AnimationLength { frames, rate: *rate, unit: "step", selection };
    let mut writer = FrameWriter::create(animation, length, context.description())?;
    let last = f64::from(frames.saturating_sub(1).max(1));
    for frame in writer.frames() {
        let index = (animated.start + frame) as usize;
        let step = reader.dataset(&shown, index)?;
        let record = reader.record(&step, index, animation.record_folder());
        let settings = settings.at_turntable_angle(None, turn / WHOLE_TURN_DEG * f64::from(frame) / last);
        writer.draw(frame, &mut renderer, PagedDataset::in_memory(step), &settings, &record)?;
    }
    writer.finish()
}

/// Returns the indices of the steps that are animated, out of `count`.
///
/// # Errors
/// Returns an error if steps are named that do not exist.
fn animated_steps(steps: Option<FrameRange>, count: u32) -> Result<Range<u32>, CliError> {
    let Some(steps) = steps else { return Ok(0..count) };
    steps.within(count).ok_or_else(|| {
        CliError::Usage(format!(
            "--steps: there are the time steps 0 to {}, and no step {}; give steps among them",
            count - 1,
            steps.last()
        ))
    })
}

/// Returns settings with the ranges of values that they show of a dataset as numbers: the record of a frame then
/// shows its step as the frame does, while the step alone has other ranges.
fn with_typed_ranges(mut settings: Settings, shown: &Dataset) -> Settings {
    let mut first = Some(settings.shown_content(&shown.volume().ranges()));
    for (layer, field) in settings.layers.iter_mut().zip(shown.fields().iter()) {
        let mapping = first.take().unwrap_or_else(|| layer.density_mapping(&field.volume().ranges()));
        if let DensityMapping::Range(range) = mapping
            && range.span().is_finite()
            && range.span() > 0.0
        {
            layer.range = DensityRange::Typed(range);
        }
    }
    settings
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angles_are_finite_numbers() {
        assert_eq!(parse_angle("-90"), Ok(-90.0));
        assert_eq!(parse_angle(" 7.5 "), Ok(7.5));
        for wrong in ["", "nan", "inf", "half"] {
            assert!(parse_angle(wrong).unwrap_err().contains("degrees"), "{wrong}");
        }
    }

    #[test]
    fn steps_that_are_not_there_are_told() {
        let steps = |text: &str, count: u32| animated_steps(Some(text.parse().unwrap()), count);
        assert_eq!(animated_steps(None, 5).unwrap(), 0..5);
        assert_eq!(steps("1..3", 5).unwrap(), 1..4);
        let message = steps("1..5", 5).unwrap_err().to_string();
        assert!(message.contains("0 to 4") && message.contains("no step 5"), "{message}");
    }
}
