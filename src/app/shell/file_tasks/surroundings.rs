//! Reading of environment maps that light the scene.

use std::path::Path;

use eframe::egui;

use super::Reason;
use crate::app::{App, text};
use crate::data::read_surroundings;

impl App {
    /// Reads an environment map on a thread and lights the scene by it; supersedes one that is still being read.
    pub fn read_surroundings(&mut self, path: &Path, ctx: &egui::Context) {
        let read = |path: &Path| read_surroundings(path).map_err(|err| err.to_string());
        self.read_file(Reason::Surroundings, path, ctx, read, |app, read, _ctx| match read {
            Ok(surroundings) => {
                app.settings.surround(&surroundings);
                app.selected_light = 0;
                let has_light = surroundings.light.is_some();
                app.messages.note(text::messages::surrounded(&surroundings.name, has_light));
            }
            Err(why) => app.say_not_read(text::messages::SURROUNDINGS_NOT_READ, why),
        });
    }
}
