//! Command `chiaroscuro turntable`: an animation in which the camera or a light goes once around the volume.

use clap::Args;

use super::frame_selection::FrameRange;
use super::frame_writer::{AnimationArgs, AnimationLength, FrameWriter};
use crate::cli::CliError;
use crate::cli::process::StageTimes;
use crate::cli::scene::{PoolArgs, SceneArgs};
use chiaroscuro_render::Renderer;
use chiaroscuro_scene::VolumeRecord;

/// Arguments of `turntable`.
#[derive(Debug, Args)]
pub(crate) struct TurntableArgs {
    #[command(flatten)]
    scene: SceneArgs,
    #[command(flatten)]
    animation: AnimationArgs,
    /// Frames in one turn
    #[arg(long, default_value_t = 72, value_parser = clap::value_parser!(u32).range(2..=3600))]
    frames: u32,
    /// Draw only the frames from A to B into a folder, the first of which is 0; frames that are there stay
    #[arg(long, value_name = "A..B", conflicts_with = "part")]
    only: Option<FrameRange>,
    /// Frames per second of an animated file
    #[arg(long, default_value_t = 24, value_parser = clap::value_parser!(u16).range(1..=120))]
    rate: u16,
    /// Turn this light around the vertical axis instead of the camera; 1 is the first
    #[arg(long, value_name = "N")]
    light: Option<usize>,
    #[command(flatten)]
    pool: PoolArgs,
}

/// Renders the frames of one turn, or some of them.
pub(crate) fn run(args: &TurntableArgs) -> Result<(), CliError> {
    let TurntableArgs { scene, animation, frames, only, rate, light, pool } = args;
    animation.check_output()?;
    let selection = animation.selection(*only, *frames)?;
    animation.keep_apart(scene, [], *frames)?;
    let (loaded, context) = scene.load_timed(&mut StageTimes::from_now(), scene.level_rule(pool))?;
    let look = scene.look(&loaded)?;
    let mut renderer = Renderer::new(&context)?;
    let settings = look.settings(&mut renderer, &loaded)?;
    let light = light.map(|number| number.wrapping_sub(1));
    if let Some(index) = light.filter(|&index| index >= settings.lights.len()) {
        let number = index.wrapping_add(1);
        let count = settings.lights.len();
        return Err(CliError::Usage(format!(
            "--light: there are lights 1 to {count}, and no light {number}"
        )));
    }
    let length = AnimationLength { frames: *frames, rate: *rate, unit: "frame", selection };
    let mut writer = FrameWriter::create(animation, length, context.description())?;
    let folder = animation.record_folder();
    let volume = VolumeRecord::new(scene.source(), loaded.volume().opened_id(), folder)
        .with_choice(loaded.volume().contents().choice())
        .with_layers_of(&loaded, folder);
    let mut reader = scene.page_reader(&pool.in_parts(), loaded, &settings)?;
    for frame in writer.frames() {
        let settings = settings.at_turntable_angle(light, f64::from(frame) / f64::from(*frames));
        let shown = reader.read_for(&settings, &writer.image_spec(), &|_| ())?;
        writer.draw(frame, &mut renderer, shown, &settings, &volume)?;
    }
    writer.finish()
}
