//! Windows over the picture: dialogs, tool windows and their answers.

use std::sync::Arc;

use eframe::egui;

use crate::app::common::commands::Command;
use crate::app::windows::files::Purpose;
use crate::app::windows::slices::SliceLook;
use crate::app::windows::{export, light_slice, recovery, roomy};
use crate::app::{App, text};

impl App {
    /// Shows the windows over the picture, and acts on the answers that they return.
    pub(in crate::app) fn windows(
        &mut self,
        frame: &eframe::Frame,
        ctx: &egui::Context,
        commands: &mut Vec<Command>,
    ) {
        if let Some(answer) = self.recovery.ui(ctx) {
            self.memory.settle();
            if let recovery::Answer::GoOn(look) = answer {
                self.open_record(&look, ctx);
            }
            self.open_what_waits(ctx);
        }
        self.history_list(ctx, commands);
        self.quit.ui(ctx, self.export.is_busy());
        if let Some(answer) = self.lost_again.ui(ctx, self.viewport.context().is_software()) {
            self.answer_loss(answer, ctx);
        }
        if self.contact_sheet.is_due() {
            let subject = self.subject();
            if let Err(err) = self.contact_sheet.start(subject, ctx) {
                self.messages.error(text::messages::LOOKS_NOT_TRIED, err);
            }
        }
        if let Err(err) = self.contact_sheet.ui(ctx, commands) {
            self.messages.error(text::messages::LOOKS_NOT_TRIED, err);
        }
        if let Some(described) = self.raw_dialog.ui(ctx) {
            self.open_described(&described, ctx);
        }
        match self.roomy.ui(ctx) {
            None => {}
            Some(roomy::Answer::Cancel) => self.pending = None,
            Some(roomy::Answer::Read { source, reading }) => {
                self.start_loading(&source, *reading, ctx);
            }
        }
        if let Some((purpose, path)) = self.files.ui(ctx) {
            self.chosen(purpose, &path, ctx);
        }
        let volume = self.viewport.dataset().map(|dataset| Arc::clone(dataset.volume()));
        let drawn = volume.as_ref().filter(|_| self.slices.open).map(|volume| self.settings.as_drawn(volume));
        let transfer = drawn.as_ref().map_or(&self.settings.transfer, |drawn| &drawn.transfer);
        let look = SliceLook { transfer, labels: &self.settings.labels };
        self.slices.ui(ctx, volume.as_ref(), self.volume.as_ref(), look);
        let scene = light_slice::Scene {
            settings: &self.settings,
            dataset: self.viewport.dataset(),
            context: self.viewport.context(),
            at_rest: self.is_complete(),
        };
        match self.light_slice.ui(ctx, &scene) {
            Ok(false) => {}
            Ok(true) => self.files.ask(Purpose::ExportLight, frame, ctx),
            Err(err) => self.messages.error(text::messages::LIGHT_VOLUME_NOT_SHOWN, err),
        }
        let is_anatomical = self.volume.as_ref().is_some_and(|volume| volume.is_anatomical);
        match self.export.ui(ctx, self.viewport_size(), is_anatomical) {
            None => {}
            Some(export::Request::Choose) => self.files.ask(Purpose::ExportPicture, frame, ctx),
            Some(export::Request::Export) => self.start_export(ctx),
            Some(export::Request::NoFolder(why)) => self.messages.error(text::export::NO_FOLDER, why),
        }
    }
}
