//! Orientation of the object: turning it upright, reframing the first look, remembering the up axis.
//!
//! A thread frames the first look in a pass over all voxels.

use std::collections::VecDeque;

use eframe::egui;

use crate::app::common::commands::AppCommand;
use crate::app::worker::background_task::BackgroundTask;
use crate::app::{App, text};
use chiaroscuro_scene::{Camera, CameraLightRotation, ObjectRotation, SceneAxis, Settings, first_look};

/// Continuation after the first look has been framed.
#[derive(Debug)]
enum AfterFraming {
    /// Turns the object by turning camera and lights about it.
    Turn(ObjectRotation, CameraLightRotation),
    /// Runs a command that needs the first look, if any.
    Run(Option<AppCommand>),
}

/// First look that is being framed for another orientation.
#[derive(Debug)]
struct FramingTask {
    work: BackgroundTask<Settings>,
    /// First look before the turn.
    first_look: Settings,
    /// Up axis of the current look when framing began.
    up: SceneAxis,
    then: AfterFraming,
}

/// Turn of the object in progress, and the queue of further commands.
#[derive(Debug, Default)]
pub(crate) struct OrientationTasks {
    framing: Option<FramingTask>,
    waiting: VecDeque<AppCommand>,
}

impl OrientationTasks {
    /// Returns true while a turn is in progress.
    pub(crate) fn is_busy(&self) -> bool {
        self.framing.is_some()
    }
}

/// Returns true if two cameras frame the same, apart from the rounding error of framing again.
pub(super) fn has_same_framing(a: &Camera, b: &Camera) -> bool {
    let apart = glam::DVec3::from(a.target).distance(b.target.into()) + (a.distance - b.distance).abs();
    apart < 1e-6
}

impl App {
    /// Turns the object over or upright, back on the floor and framed as it was. The voxels stay in place: camera and
    /// lights turn.
    pub(crate) fn turn_object(&mut self, turn: ObjectRotation, ctx: &egui::Context) {
        if self.orientation_task.is_busy() {
            return self.orientation_task.waiting.push_back(AppCommand::TurnObject(turn));
        }
        let room = self.settings.camera.rotation_for(turn);
        let mut turned = self.defaults.clone();
        if turned.camera.up == self.settings.camera.up {
            turned.rotate_camera_and_lights(room);
        } else {
            let mut seen = self.settings.clone();
            seen.rotate_camera_and_lights(room);
            turned.rotate_object(ObjectRotation::MakeUpright(seen.camera.up));
        }
        self.frame_first_look(turned, AfterFraming::Turn(turn, room), ctx);
    }

    /// Returns true if the first look has the up axis of the settings, wherever these come from. Otherwise it is
    /// turned, and `then` is executed afterwards.
    pub(crate) fn ensure_first_look_up(&mut self, then: Option<AppCommand>, ctx: &egui::Context) -> bool {
        self.ensure_first_look_up_axis(self.settings.camera.up, then, ctx)
    }

    /// Returns true if the first look has this up axis. Otherwise it is turned, and `then` is executed afterwards.
    pub(crate) fn ensure_first_look_up_axis(
        &mut self,
        up: SceneAxis,
        then: Option<AppCommand>,
        ctx: &egui::Context,
    ) -> bool {
        if self.defaults.camera.up == up || self.viewport.dataset().is_none() {
            return true;
        }
        if self.orientation_task.is_busy() {
            self.orientation_task.waiting.extend(then);
        } else {
            let mut turned = self.defaults.clone();
            turned.rotate_object(ObjectRotation::MakeUpright(up));
            self.frame_first_look(turned, AfterFraming::Run(then), ctx);
        }
        false
    }

    /// Starts framing the object in a first look that was turned.
    fn frame_first_look(&mut self, mut turned: Settings, then: AfterFraming, ctx: &egui::Context) {
        let Some(dataset) = self.viewport.dataset() else { return };
        let task = move || {
            first_look::frame_object(&mut turned, dataset.volume());
            turned
        };
        let (of, up) = (self.defaults.clone(), self.settings.camera.up);
        match BackgroundTask::start("framing", ctx, task) {
            Ok(work) => self.orientation_task.framing = Some(FramingTask { work, first_look: of, up, then }),
            Err(err) => self.messages.error(text::messages::TURN_FAILED, err.to_string()),
        }
    }

    /// Takes over the framed first look from its thread. Returns the commands that have waited for it.
    pub(crate) fn finish_framing(&mut self) -> Vec<AppCommand> {
        let Some(framing) = &self.orientation_task.framing else { return Vec::new() };
        let Some(framed) = framing.work.take_result() else { return Vec::new() };
        // An undo or the light placement may have intervened.
        let is_of_this = framing.first_look == self.defaults && framing.up == self.settings.camera.up;
        let Some(FramingTask { then, .. }) = self.orientation_task.framing.take() else { return Vec::new() };
        let mut commands = Vec::new();
        match (framed, then) {
            (Err(panic), _) => self.messages.error(text::messages::TURN_FAILED, panic),
            (Ok(_), AfterFraming::Turn(turn, _)) if !is_of_this => {
                commands.push(AppCommand::TurnObject(turn));
            }
            (Ok(framed), AfterFraming::Turn(_, room)) => self.apply_turn(room, framed),
            (Ok(framed), AfterFraming::Run(command)) => {
                if is_of_this {
                    self.defaults = framed;
                }
                commands.extend(command);
            }
        }
        commands.extend(self.orientation_task.waiting.drain(..));
        commands
    }

    /// Applies a turn of the room, together with the first look framed for it.
    fn apply_turn(&mut self, room: CameraLightRotation, framed: Settings) {
        let was_framed = has_same_framing(&self.settings.camera, &self.defaults.camera);
        self.settings.rotate_camera_and_lights(room);
        self.defaults = framed;
        self.settings.floor.height = self.defaults.floor.height;
        if was_framed {
            self.settings.camera.copy_framing(&self.defaults.camera);
        }
        self.remember_up();
    }

    /// Remembers the up axis for the volume's folder. An anatomical orientation says nothing about other files.
    pub(crate) fn remember_up(&mut self) {
        if let Some(volume) = self.volume.as_ref().filter(|volume| !volume.is_anatomical) {
            self.memory.remember_up(&volume.source, self.settings.camera.up);
        }
    }
}
