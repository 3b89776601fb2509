//! Windows over the picture: dialogs, tool windows and their answers.

use std::sync::Arc;

use eframe::egui;

use crate::app::common::commands::AppCommand;
use crate::app::windows::device_loss::DeviceLossAnswer;
use crate::app::windows::file_dialogs::FileDialogPurpose;
use crate::app::windows::slices::SliceLook;
use crate::app::windows::{export, light_slice, recovery};
use crate::app::{App, text};
use chiaroscuro_scene::QualityPreset;

impl App {
    /// Shows the windows over the picture, and acts on the answers that they return.
    pub(crate) fn show_windows(
        &mut self,
        frame: &eframe::Frame,
        ctx: &egui::Context,
        commands: &mut Vec<AppCommand>,
    ) {
        if let Some(answer) = self.dialogs.recovery.ui(ctx) {
            self.editor.memory.acknowledge_crashes();
            if let recovery::RecoveryAnswer::Restore(look) = answer {
                self.opener(ctx).open_record(&look);
            }
            self.opener(ctx).open_deferred();
        }
        self.windows.history.show(ctx, &self.editor.document, commands);
        self.dialogs.quit.ui(ctx, self.windows.export.is_busy());
        if let Some(answer) = self.dialogs.device_loss.ui(ctx, self.editor.viewport.context().is_software()) {
            self.answer_loss(answer, ctx);
        }
        if self.windows.contact_sheet.needs_start() {
            let subject = self.editor.export_subject();
            if let Err(err) = self.windows.contact_sheet.start(subject, ctx) {
                self.editor.messages.error(text::messages::LOOKS_NOT_TRIED, err);
            }
        }
        if let Err(err) = self.windows.contact_sheet.ui(ctx, commands) {
            self.editor.messages.error(text::messages::LOOKS_NOT_TRIED, err);
        }
        self.opener(ctx).show_questions();
        if let Some((purpose, path)) = self.dialogs.files.typed_path_ui(ctx) {
            self.handle_chosen_file(purpose, &path, ctx);
        }
        let volume = self.editor.viewport.dataset().map(|dataset| Arc::clone(dataset.volume()));
        let settings_as_drawn = volume
            .as_ref()
            .filter(|_| self.windows.slices.open)
            .map(|volume| self.editor.document.settings.resolved_for(volume));
        let transfer = settings_as_drawn
            .as_ref()
            .map_or(&self.editor.document.settings.transfer, |drawn| &drawn.transfer);
        let look = SliceLook { transfer, labels: &self.editor.document.settings.labels };
        self.windows.slices.ui(ctx, volume.as_ref(), self.editor.document.volume.as_ref(), look);
        let scene = light_slice::LightSliceContext {
            settings: &self.editor.document.settings,
            dataset: self.editor.viewport.dataset(),
            context: self.editor.viewport.context(),
            is_idle: !self.opening.is_opening() && self.editor.is_complete(),
        };
        match self.windows.light_slice.ui(ctx, &scene) {
            Ok(false) => {}
            Ok(true) => self.dialogs.files.open_dialog(FileDialogPurpose::ExportLight, frame, ctx),
            Err(err) => self.editor.messages.error(text::messages::LIGHT_VOLUME_NOT_SHOWN, err),
        }
        let is_anatomical = self.editor.document.is_anatomical();
        match self.windows.export.ui(ctx, self.picture.available_size(), is_anatomical) {
            None => {}
            Some(export::ExportRequest::ChooseFile) => {
                self.dialogs.files.open_dialog(FileDialogPurpose::ExportPicture, frame, ctx);
            }
            Some(export::ExportRequest::Export) => self.windows.start_export(&mut self.editor, ctx),
            Some(export::ExportRequest::FileManagerFailed(why)) => {
                self.editor.messages.error(text::export::NO_FOLDER, why);
            }
        }
    }

    /// Executes the user's answer after the device was lost again within a short time.
    fn answer_loss(&mut self, answer: DeviceLossAnswer, ctx: &egui::Context) {
        match answer {
            DeviceLossAnswer::TryAgain => self.restore_volume(ctx),
            DeviceLossAnswer::LowerQuality => {
                QualityPreset::Fast.apply(&mut self.editor.document.settings);
                self.restore_volume(ctx);
            }
            DeviceLossAnswer::UseCpu => {
                self.device.wants_cpu = true;
                self.device.close_for_successor(&self.editor.memory, ctx);
            }
            DeviceLossAnswer::Quit => ctx.send_viewport_cmd(egui::ViewportCommand::Close),
        }
    }

    /// Shows the volume again that the earlier window had open.
    fn restore_volume(&mut self, ctx: &egui::Context) {
        let dataset = self.device.handed_over_dataset.take();
        self.opener(ctx).restore(dataset);
    }
}
