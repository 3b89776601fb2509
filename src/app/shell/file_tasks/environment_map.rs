//! Reading of environment maps that light the scene.

use std::path::Path;

use eframe::egui;

use super::ReadPurpose;
use crate::app::{App, text};
use chiaroscuro_media::read_environment_map;

impl App {
    /// Reads an environment map on a thread and lights the scene by it; supersedes one that is still being read.
    pub fn read_environment_map(&mut self, path: &Path, ctx: &egui::Context) {
        let read = |path: &Path| read_environment_map(path).map_err(|err| err.to_string());
        self.read_file(ReadPurpose::Surroundings, path, ctx, read, |app, read, _ctx| match read {
            Ok(surroundings) => {
                app.editor.document.settings.apply_environment_map(&surroundings);
                app.editor.document.selected_light = 0;
                let has_light = surroundings.light.is_some();
                app.editor
                    .messages
                    .note(text::messages::environment_map_applied(&surroundings.name, has_light));
            }
            Err(why) => app.report_read_failure(text::messages::ENVIRONMENT_MAP_NOT_READ, why),
        });
    }
}
