//! Orientation of the object: turning it upright, reframing the first look, remembering the up axis.
//!
//! A thread frames the first look in a pass over all voxels.

use std::collections::VecDeque;

use eframe::egui;

use crate::app::common::commands::Command;
use crate::app::worker::task::Work;
use crate::app::{App, text};
use crate::model::{Camera, ObjectTurn, RoomTurn, SceneAxis, Settings, auto};

/// Continuation after the first look has been framed.
#[derive(Debug)]
enum Then {
    /// Turns the object by turning camera and lights about it.
    Turn(ObjectTurn, RoomTurn),
    /// Runs a command that needs the first look, if any.
    Do(Option<Command>),
}

/// First look that is being framed for another orientation.
#[derive(Debug)]
struct Framing {
    work: Work<Settings>,
    /// First look before the turn.
    of: Settings,
    /// Up axis of the current look when framing began.
    up: SceneAxis,
    then: Then,
}

/// Turn of the object in progress, and the queue of further commands.
#[derive(Debug, Default)]
pub(in crate::app) struct Upright {
    framing: Option<Framing>,
    waiting: VecDeque<Command>,
}

impl Upright {
    /// Returns true while a turn is in progress.
    pub(in crate::app) fn is_busy(&self) -> bool {
        self.framing.is_some()
    }
}

/// Returns true if two cameras frame the same, apart from the rounding error of framing again.
pub(super) fn is_framed_alike(a: &Camera, b: &Camera) -> bool {
    let apart = glam::DVec3::from(a.target).distance(b.target.into()) + (a.distance - b.distance).abs();
    apart < 1e-6
}

impl App {
    /// Turns the object over or upright, back on the floor and framed as it was. The voxels stay in place: camera and
    /// lights turn.
    pub(in crate::app::shell) fn turn_object(&mut self, turn: ObjectTurn, ctx: &egui::Context) {
        if self.upright.is_busy() {
            return self.upright.waiting.push_back(Command::TurnObject(turn));
        }
        let room = self.settings.camera.room_turn(turn);
        let mut turned = self.defaults.clone();
        if turned.camera.up == self.settings.camera.up {
            turned.turn_room(room);
        } else {
            let mut seen = self.settings.clone();
            seen.turn_room(room);
            turned.turn_object(ObjectTurn::Upright(seen.camera.up));
        }
        self.frame_first_look(turned, Then::Turn(turn, room), ctx);
    }

    /// Returns true if the first look has the up axis of the settings, wherever these come from. Otherwise it is
    /// turned, and `then` is executed afterwards.
    pub(in crate::app::shell) fn first_look_stands(
        &mut self,
        then: Option<Command>,
        ctx: &egui::Context,
    ) -> bool {
        self.first_look_stands_on(self.settings.camera.up, then, ctx)
    }

    /// Returns true if the first look has this up axis. Otherwise it is turned, and `then` is executed afterwards.
    pub(in crate::app) fn first_look_stands_on(
        &mut self,
        up: SceneAxis,
        then: Option<Command>,
        ctx: &egui::Context,
    ) -> bool {
        if self.defaults.camera.up == up || self.viewport.dataset().is_none() {
            return true;
        }
        if self.upright.is_busy() {
            self.upright.waiting.extend(then);
        } else {
            let mut turned = self.defaults.clone();
            turned.turn_object(ObjectTurn::Upright(up));
            self.frame_first_look(turned, Then::Do(then), ctx);
        }
        false
    }

    /// Starts framing the object in a first look that was turned.
    fn frame_first_look(&mut self, mut turned: Settings, then: Then, ctx: &egui::Context) {
        let Some(dataset) = self.viewport.dataset() else { return };
        let task = move || {
            auto::frame(&mut turned, dataset.volume());
            turned
        };
        let (of, up) = (self.defaults.clone(), self.settings.camera.up);
        match Work::start("framing", ctx, task) {
            Ok(work) => self.upright.framing = Some(Framing { work, of, up, then }),
            Err(err) => self.messages.error(text::messages::NOT_TURNED, err.to_string()),
        }
    }

    /// Takes over the framed first look from its thread. Returns the commands that have waited for it.
    pub(in crate::app) fn take_framed(&mut self) -> Vec<Command> {
        let Some(framing) = &self.upright.framing else { return Vec::new() };
        let Some(framed) = framing.work.take() else { return Vec::new() };
        // An undo or the light placement may have intervened.
        let is_of_this = framing.of == self.defaults && framing.up == self.settings.camera.up;
        let Some(Framing { then, .. }) = self.upright.framing.take() else { return Vec::new() };
        let mut commands = Vec::new();
        match (framed, then) {
            (Err(panic), _) => self.messages.error(text::messages::NOT_TURNED, panic),
            (Ok(_), Then::Turn(turn, _)) if !is_of_this => commands.push(Command::TurnObject(turn)),
            (Ok(framed), Then::Turn(_, room)) => self.turned(room, framed),
            (Ok(framed), Then::Do(command)) => {
                if is_of_this {
                    self.defaults = framed;
                }
                commands.extend(command);
            }
        }
        commands.extend(self.upright.waiting.drain(..));
        commands
    }

    /// Applies a turn of the room, together with the first look framed for it.
    fn turned(&mut self, room: RoomTurn, framed: Settings) {
        let was_framed = is_framed_alike(&self.settings.camera, &self.defaults.camera);
        self.settings.turn_room(room);
        self.defaults = framed;
        self.settings.floor.height = self.defaults.floor.height;
        if was_framed {
            self.settings.camera.frame_as(&self.defaults.camera);
        }
        self.remember_up();
    }

    /// Remembers the up axis for the volume's folder. An anatomical orientation says nothing about other files.
    pub(in crate::app::shell) fn remember_up(&mut self) {
        if let Some(volume) = self.volume.as_ref().filter(|volume| !volume.is_anatomical) {
            self.memory.stood(&volume.source, self.settings.camera.up);
        }
    }
}
