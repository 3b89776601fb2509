//! Orientation of the object: turning it upright, reframing the first look, remembering the up axis.
//!
//! A thread frames the first look in a pass over all voxels.

use std::collections::VecDeque;
use std::io;

use eframe::egui;

use super::Document;
use crate::app::common::commands::AppCommand;
use crate::app::persistence::PersistentState;
use crate::app::worker::jobs::{JobKind, JobSlot};
use chiaroscuro_scene::{Camera, CameraLightRotation, ObjectRotation, SceneAxis, Settings, first_look};
use chiaroscuro_volume::Dataset;

/// Continuation after the first look has been framed.
#[derive(Debug)]
enum AfterFraming {
    /// Turns the object by turning camera and lights about it.
    Turn(ObjectRotation, CameraLightRotation),
    /// Runs a command that needs the first look, if any.
    Run(Option<AppCommand>),
}

/// Inputs of a first look that is being framed for another orientation.
#[derive(Debug)]
struct FramingInputs {
    /// First look before the turn.
    first_look: Settings,
    /// Up axis of the current look when framing began.
    up: SceneAxis,
    then: AfterFraming,
}

/// Turn of the object in progress, and the queue of further commands.
#[derive(Debug, Default)]
pub(crate) struct OrientationTasks {
    framing: JobSlot<Settings, FramingInputs>,
    waiting: VecDeque<AppCommand>,
}

impl OrientationTasks {
    /// Returns true while a turn is in progress.
    pub(crate) fn is_busy(&self) -> bool {
        self.framing.is_running()
    }
}

/// Returns true if two cameras frame the same, apart from the rounding error of framing again.
pub(super) fn has_same_framing(a: &Camera, b: &Camera) -> bool {
    let apart = glam::DVec3::from(a.target).distance(b.target.into()) + (a.distance - b.distance).abs();
    apart < 1e-6
}

impl Document {
    /// Turns the object over or upright, back on the floor and framed as it was. The voxels stay in place: camera and
    /// lights turn.
    pub(crate) fn turn_object(
        &mut self,
        turn: ObjectRotation,
        dataset: Option<Dataset>,
        ctx: &egui::Context,
    ) -> io::Result<()> {
        if self.orientation.is_busy() {
            self.orientation.waiting.push_back(AppCommand::TurnObject(turn));
            return Ok(());
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
        self.frame_first_look(turned, AfterFraming::Turn(turn, room), dataset, ctx)
    }

    /// Returns true if the first look has the up axis of the settings, wherever these come from. Otherwise it is
    /// turned, and `then` is executed afterwards.
    pub(crate) fn ensure_first_look_up(
        &mut self,
        then: Option<AppCommand>,
        dataset: Option<Dataset>,
        ctx: &egui::Context,
    ) -> io::Result<bool> {
        self.ensure_first_look_up_axis(self.settings.camera.up, then, dataset, ctx)
    }

    /// Returns true if the first look has this up axis. Otherwise it is turned, and `then` is executed afterwards.
    pub(crate) fn ensure_first_look_up_axis(
        &mut self,
        up: SceneAxis,
        then: Option<AppCommand>,
        dataset: Option<Dataset>,
        ctx: &egui::Context,
    ) -> io::Result<bool> {
        if self.defaults.camera.up == up || dataset.is_none() {
            return Ok(true);
        }
        if self.orientation.is_busy() {
            self.orientation.waiting.extend(then);
        } else {
            let mut turned = self.defaults.clone();
            turned.rotate_object(ObjectRotation::MakeUpright(up));
            self.frame_first_look(turned, AfterFraming::Run(then), dataset, ctx)?;
        }
        Ok(false)
    }

    /// Starts framing the object in a first look that was turned.
    fn frame_first_look(
        &mut self,
        mut turned: Settings,
        then: AfterFraming,
        dataset: Option<Dataset>,
        ctx: &egui::Context,
    ) -> io::Result<()> {
        let Some(dataset) = dataset else { return Ok(()) };
        let (first_look, up) = (self.defaults.clone(), self.settings.camera.up);
        let inputs = FramingInputs { first_look, up, then };
        self.orientation.framing.start(JobKind::Framing, ctx, inputs, move |_| {
            first_look::frame_object(&mut turned, dataset.volume());
            turned
        })
    }

    /// Takes over the framed first look from its thread, and remembers the up axis after a turn. Returns the commands
    /// that have waited for it, and the error if framing has failed.
    pub(crate) fn finish_framing(
        &mut self,
        memory: &mut PersistentState,
    ) -> (Vec<AppCommand>, Result<(), String>) {
        let (mut commands, mut result) = (Vec::new(), Ok(()));
        let Some((inputs, framed)) = self.orientation.framing.take_ended() else {
            return (commands, result);
        };
        // An undo or the light placement may have intervened.
        let is_of_this = inputs.first_look == self.defaults && inputs.up == self.settings.camera.up;
        match (framed, inputs.then) {
            (Err(panic), _) => result = Err(panic),
            (Ok(_), AfterFraming::Turn(turn, _)) if !is_of_this => {
                commands.push(AppCommand::TurnObject(turn));
            }
            (Ok(framed), AfterFraming::Turn(_, room)) => {
                self.apply_turn(room, framed);
                self.remember_up(memory);
            }
            (Ok(framed), AfterFraming::Run(command)) => {
                if is_of_this {
                    self.defaults = framed;
                }
                commands.extend(command);
            }
        }
        commands.extend(self.orientation.waiting.drain(..));
        (commands, result)
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
    }

    /// Remembers the up axis for the volume's folder. An anatomical orientation says nothing about other files.
    pub(crate) fn remember_up(&self, memory: &mut PersistentState) {
        if let Some(volume) = self.volume.as_ref().filter(|volume| !volume.is_anatomical) {
            memory.remember_up(&volume.source, self.settings.camera.up);
        }
    }
}
