//! Import of transfer functions of other programs.

use std::path::Path;

use eframe::egui;

use super::Reason;
use crate::app::windows::files;
use crate::app::{App, text};
use crate::model::LabelTable;

impl App {
    /// Reads a transfer function of another program on a thread and applies it to the look.
    pub fn import_transfer(&mut self, path: &Path, ctx: &egui::Context) {
        let range = files::exchanged_range(&self.settings, &self.value_ranges());
        let read = move |path: &Path| files::import_transfer(path, range);
        self.read_file(Reason::Transfer, path, ctx, read, |app, read, _ctx| match read {
            Ok(function) => {
                app.settings.transfer = function;
                app.settings.labels = LabelTable::default();
            }
            Err(why) => app.say_not_read(text::messages::TRANSFER_NOT_IMPORTED, why),
        });
    }
}
