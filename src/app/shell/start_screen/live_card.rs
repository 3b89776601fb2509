//! Live card: the scene under the pointer, rendered in its card while its first light sweeps once from side to side.

use std::f64::consts::TAU;
use std::path::PathBuf;
use std::sync::mpsc;
use std::time::{Duration, Instant};

use eframe::egui::{self, ColorImage, TextureHandle, TextureOptions};
use glam::{DQuat, DVec3};

use crate::app::windows::contact_sheet::quick_settings;
use crate::app::windows::export::{ExportScene, ExportWorker};
use crate::app::worker::jobs::{JobControl, JobKind, JobSlot};
use chiaroscuro_render::GpuContext;
use chiaroscuro_scene::{ImageSpec, Preset, Settings};
use chiaroscuro_volume::{Dataset, synthetic};

/// Duration of a sweep: to one side, through a half circle to the other in half of this time, and back.
const SWEEP: Duration = Duration::from_secs(4);

/// Largest angle of the light from its place, in degrees: a half circle from side to side.
const SWEEP_DEG: f64 = 90.0;

/// Card under the pointer.
pub(super) struct PointedCard {
    /// Preset that is the scene.
    pub scene: Preset,
    /// Name of the scene's volume.
    pub volume: &'static str,
    /// Size of the picture in the card, in physical pixels.
    pub size: [u32; 2],
}

/// Pictures of a scene that are being rendered.
struct LiveFrames {
    volume: &'static str,
    frames: mpsc::Receiver<ColorImage>,
}

/// Scene of the card under the pointer, and its latest picture.
#[derive(Default)]
pub(super) struct LiveCard {
    task: JobSlot<Result<(), String>, LiveFrames>,
    /// Scene that was swept last, and its picture once there is one: a card rests until the pointer has left it.
    shown: Option<(&'static str, Option<TextureHandle>)>,
}

impl LiveCard {
    /// Returns the live picture of a scene, if it is the one under the pointer.
    pub(super) fn picture(&self, volume: &str) -> Option<&TextureHandle> {
        self.shown.as_ref().filter(|(name, _)| *name == volume)?.1.as_ref()
    }

    /// Takes the pictures that have arrived, and starts to render the scene of the card under the pointer.
    pub(super) fn update(&mut self, card: &PointedCard, context: &GpuContext, ctx: &egui::Context) {
        self.take_frames(ctx);
        let PointedCard { scene, volume, size } = *card;
        if self.shown.as_ref().is_some_and(|(name, _)| *name == volume) {
            return;
        }
        // One at a time, because each opens a device of its own; a cancelled one ends with its frame.
        self.task.cancel();
        self.shown = None;
        if self.task.is_running() {
            return;
        }
        let (sender, frames) = mpsc::channel();
        let (context, wake) = (context.clone(), ctx.clone());
        let render = move |job: &JobControl| {
            let send = |picture: ColorImage| {
                // The receiver is gone when the pointer has left.
                drop(sender.send(picture));
                wake.request_repaint();
            };
            render_sweep(&scene, volume, size, context, job, &send)
        };
        // Without a thread the card keeps its picture.
        if self.task.start(JobKind::SceneCard, ctx, LiveFrames { volume, frames }, render).is_ok() {
            self.shown = Some((volume, None));
        }
    }

    /// Ends the rendering, and shows the scene's own picture again.
    pub(super) fn rest(&mut self) {
        // The result of a rendering that has ended is dropped, so that its last picture does not arrive later.
        self.task.take_ended();
        self.task.cancel();
        self.shown = None;
    }

    /// Shows the latest of the pictures that have arrived, if they are of the scene under the pointer.
    fn take_frames(&mut self, ctx: &egui::Context) {
        let ended = self.task.take_ended();
        let task = ended.as_ref().map(|(task, _)| task).or(self.task.inputs());
        let Some(task) = task else { return };
        let latest = task.frames.try_iter().last();
        if let (Some(picture), Some((volume, texture))) = (latest, &mut self.shown)
            && *volume == task.volume
        {
            match texture {
                Some(texture) => texture.set(picture, TextureOptions::LINEAR),
                None => *texture = Some(ctx.load_texture("live card", picture, TextureOptions::LINEAR)),
            }
        }
        if let Some((task, Err(why))) = ended {
            // The card keeps its picture; opening the scene reports what is wrong.
            log::warn!("{} is not shown live: {why}", task.volume);
        }
    }
}

/// Renders a scene at a size in pixels while its first light sweeps, as many frames as there is time for, and then at
/// rest; `send` gets each.
fn render_sweep(
    scene: &Preset,
    volume: &'static str,
    size: [u32; 2],
    context: GpuContext,
    job: &JobControl,
    send: &dyn Fn(ColorImage),
) -> Result<(), String> {
    let dataset = Dataset::new(synthetic::builtin(volume, None).map_err(|err| err.to_string())?);
    let settings = scene.apply(&Settings::default(), &dataset.volume().ranges());
    let settings = settings.map_err(|err| err.to_string())?;
    let subject = ExportScene {
        context,
        dataset,
        first_look: settings.clone(),
        settings,
        source: PathBuf::from(format!("builtin:{volume}")),
        selected_light: 0,
        outline: None,
        series: None,
        file: None,
    };
    if job.token().is_cancelled() {
        return Ok(());
    }
    let mut worker = ExportWorker::new(&subject)?;
    let mut render = |settings: &Settings| {
        let shown = worker.render(&subject, settings, &ImageSpec::new(size))?;
        send(ColorImage::from_rgba_unmultiplied(size.map(|n| n as usize), &shown));
        Ok::<_, String>(())
    };
    let quick = quick_settings(&subject.settings);
    // The first frame compiles shaders; the sweep begins after it.
    render(&quick)?;
    let begin = Instant::now();
    while !job.token().is_cancelled() && begin.elapsed() < SWEEP {
        render(&with_light_swept(&quick, begin.elapsed().as_secs_f64() / SWEEP.as_secs_f64()))?;
    }
    if job.token().is_cancelled() { Ok(()) } else { render(&subject.settings) }
}

/// Returns settings with the first light turned about the vertical, at a share of the sweep, 0 … 1: at its place at
/// both ends.
fn with_light_swept(settings: &Settings, share: f64) -> Settings {
    let mut swept = settings.clone();
    let angle = (SWEEP_DEG * (share * TAU).sin()).to_radians();
    let Settings { camera, lights, .. } = &mut swept;
    if let Some(light) = lights.first_mut() {
        let turn = DQuat::from_axis_angle(camera.up.direction(), angle);
        let position = turn * DVec3::from(light.resolve(camera).position);
        light.set_scene_position(position, camera);
    }
    swept
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_light_goes_from_side_to_side_and_home() {
        let settings = Settings::default();
        let position = |share: f64| DVec3::from(with_light_swept(&settings, share).lights[0].position);
        let home = DVec3::from(settings.lights[0].position);
        assert!((position(0.0) - home).length() < 1e-9 && (position(1.0) - home).length() < 1e-9);
        let flat = |at: DVec3| DVec3::new(at.x, at.y, 0.0);
        let (one, other) = (position(0.25), position(0.75));
        assert!((flat(one) + flat(other)).length() < 1e-9, "a half circle apart: {one} {other}");
        for share in [0.1, 0.4, 0.6, 0.9] {
            assert!((position(share).length() - home.length()).abs() < 1e-9, "{share}");
            assert!((position(share).z - home.z).abs() < 1e-9, "{share}");
        }
        let dark = Settings { lights: Vec::new(), ..settings };
        assert_eq!(with_light_swept(&dark, 0.3), dark);
    }
}
