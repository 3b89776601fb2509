//! Which way up the object stands: turning it, what the view is reset to then, and what is remembered of it. What the
//! view is reset to is framed on a thread of its own, which goes through all voxels.

use std::collections::VecDeque;

use eframe::egui;

use crate::app::common::commands::Command;
use crate::app::worker::task::Work;
use crate::app::{App, text};
use crate::model::{Camera, ObjectTurn, RoomTurn, SceneAxis, Settings, auto};

/// What is done when the first look stands as it is to.
#[derive(Debug)]
enum Then {
    /// The object is turned.
    Turn(ObjectTurn, RoomTurn),
    /// Something that needs the first look.
    Do(Option<Command>),
}

/// The first look, on its way to where the object stands otherwise.
#[derive(Debug)]
struct Framing {
    work: Work<Settings>,
    /// As it was.
    of: Settings,
    /// How the object stood in the look that is shown.
    up: SceneAxis,
    then: Then,
}

/// Turns of the object that are on their way, one after the other.
#[derive(Debug, Default)]
pub(in crate::app) struct Upright {
    framing: Option<Framing>,
    waiting: VecDeque<Command>,
}

impl Upright {
    /// Whether something is on its way.
    pub(in crate::app) fn is_busy(&self) -> bool {
        self.framing.is_some()
    }
}

/// Whether two cameras frame the same, but for what rounding leaves where a view was framed again.
pub(super) fn is_framed_alike(a: &Camera, b: &Camera) -> bool {
    let apart = glam::DVec3::from(a.target).distance(b.target.into()) + (a.distance - b.distance).abs();
    apart < 1e-6
}

impl App {
    /// Turns the object over or stands it up otherwise, on the floor again and as much in the picture as it was. The
    /// data stay where they are: camera and lights turn.
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

    /// Whether the first look stands as the object does in the settings, wherever these come from. If not, it will, and
    /// then a command is carried out that needs that.
    pub(in crate::app::shell) fn first_look_stands(
        &mut self,
        then: Option<Command>,
        ctx: &egui::Context,
    ) -> bool {
        self.first_look_stands_on(self.settings.camera.up, then, ctx)
    }

    /// Whether an axis of the scene points up in the first look. If not, it will, and then a command is carried out that
    /// needs that.
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

    /// Starts to frame the object as it stands in a first look that was turned.
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

    /// Takes in how the first look is framed. Returns the commands that have waited for it.
    pub(in crate::app) fn take_framed(&mut self) -> Vec<Command> {
        let Some(framing) = &self.upright.framing else { return Vec::new() };
        let Some(framed) = framing.work.take() else { return Vec::new() };
        // Somebody may have gone a step back meanwhile, or the lights may have come to their places.
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

    /// The room has turned, and the first look with it.
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

    /// Remembers for the folder of the volume how it stands. A file that says where the head is says nothing of others.
    pub(in crate::app::shell) fn remember_up(&mut self) {
        if let Some(volume) = self.volume.as_ref().filter(|volume| !volume.is_anatomical) {
            self.memory.stood(&volume.source, self.settings.camera.up);
        }
    }
}
