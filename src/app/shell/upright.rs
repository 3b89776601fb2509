//! Which way up the object stands: turning it, what the view is reset to then, and what is remembered of it.

use crate::app::App;
use crate::model::{Camera, ObjectTurn, auto};

/// Whether two cameras frame the same, but for what rounding leaves where a view was framed again.
fn is_framed_alike(a: &Camera, b: &Camera) -> bool {
    let apart = glam::DVec3::from(a.target).distance(b.target.into()) + (a.distance - b.distance).abs();
    apart < 1e-6
}

impl App {
    /// Turns the object over or stands it up otherwise, on the floor again and as much in the picture as it was. The
    /// data stay where they are: camera and lights turn.
    pub(crate) fn turn_object(&mut self, turn: ObjectTurn) {
        if self.viewport.dataset().is_none() {
            return;
        }
        let was_framed = is_framed_alike(&self.settings.camera, &self.defaults.camera);
        let room = self.settings.camera.room_turn(turn);
        if self.defaults.camera.up == self.settings.camera.up {
            self.defaults.turn_room(room);
            self.frame_defaults();
        }
        self.settings.turn_room(room);
        self.follow_up();
        self.settings.floor.height = self.defaults.floor.height;
        if was_framed {
            self.settings.camera.frame_as(&self.defaults.camera);
        }
        self.remember_up();
    }

    /// Turns what the view is reset to as the object stands in the settings, wherever these come from.
    pub(crate) fn follow_up(&mut self) {
        let up = self.settings.camera.up;
        if self.defaults.camera.up != up {
            self.defaults.turn_object(ObjectTurn::Upright(up));
            self.frame_defaults();
        }
    }

    /// Frames the object as it stands now, for views that are reset.
    fn frame_defaults(&mut self) {
        if let Some(dataset) = self.viewport.dataset() {
            auto::frame(&mut self.defaults, dataset.volume());
        }
    }

    /// Remembers for the folder of the volume how it stands. A file that says where the head is says nothing of others.
    pub(crate) fn remember_up(&mut self) {
        if let Some(volume) = self.volume.as_ref().filter(|volume| !volume.is_anatomical) {
            self.memory.stood(&volume.source, self.settings.camera.up);
        }
    }
}
