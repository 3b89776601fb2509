//! Lighting by surroundings in a picture: read on a thread, since panoramas are large.

use std::path::{Path, PathBuf};

use eframe::egui;

use crate::app::App;
use crate::app::text;
use crate::app::worker::task::Work;
use crate::data::{Surroundings, read_surroundings};

/// A picture that is being read.
pub(crate) type Reading = Work<Result<Surroundings, String>>;

impl App {
    /// Begins to read a picture of surroundings; what was being read is forgotten.
    pub fn read_surroundings(&mut self, path: &Path, ctx: &egui::Context) {
        let path: PathBuf = path.to_owned();
        let task = move || read_surroundings(&path).map_err(|err| err.to_string());
        match Work::start("surroundings", ctx, task) {
            Ok(work) => self.surroundings = Some(work),
            Err(err) => self.messages.error(text::messages::SURROUNDINGS_NOT_READ, err.to_string()),
        }
    }

    /// Lights the scene by what was read.
    pub(crate) fn take_surroundings(&mut self) {
        let Some(result) = self.surroundings.as_ref().and_then(Work::take) else { return };
        self.surroundings = None;
        match result.and_then(|read| read) {
            Ok(surroundings) => {
                self.settings.surround(&surroundings);
                self.selected_light = 0;
                let has_light = surroundings.light.is_some();
                self.messages.note(text::messages::surrounded(&surroundings.name, has_light));
            }
            Err(err) => self.messages.error(text::messages::SURROUNDINGS_NOT_READ, err),
        }
    }
}
