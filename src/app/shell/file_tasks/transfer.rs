//! Import of transfer functions of other programs.

use std::path::Path;

use eframe::egui;

use super::ReadPurpose;
use crate::app::windows::file_dialogs;
use crate::app::{App, text};
use chiaroscuro_scene::LabelTable;

impl App {
    /// Reads a transfer function of another program on a thread and applies it to the look.
    pub fn import_transfer(&mut self, path: &Path, ctx: &egui::Context) {
        let range = file_dialogs::transfer_exchange_range(
            &self.editor.document.settings,
            &self.editor.document.value_ranges(),
        );
        let read = move |path: &Path| file_dialogs::import_transfer_file(path, range);
        self.read_file(ReadPurpose::Transfer, path, ctx, read, |app, read, _ctx| match read {
            Ok(function) => {
                app.editor.document.settings.transfer = function;
                app.editor.document.settings.labels = LabelTable::default();
            }
            Err(why) => app.report_read_failure(text::messages::TRANSFER_NOT_IMPORTED, why),
        });
    }
}
