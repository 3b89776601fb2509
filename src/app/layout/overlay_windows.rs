//! Windows over the picture: dialogs, tool windows and their answers.

use eframe::egui;

use crate::app::common::commands::AppCommand;
use crate::app::windows::device_loss::DeviceLossAnswer;
use crate::app::windows::{ToolRequest, ToolScene, recovery};
use crate::app::App;
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
        self.windows.show_contact_sheet(&mut self.editor, ctx, commands);
        self.opener(ctx).show_questions();
        if let Some((purpose, path)) = self.dialogs.files.typed_path_ui(ctx) {
            self.handle_chosen_file(purpose, &path, ctx);
        }
        let scene = ToolScene {
            settings: &self.editor.document.settings,
            volume: self.editor.document.volume.as_ref(),
            dataset: self.editor.viewport.dataset(),
            context: self.editor.viewport.context(),
            picture_size: self.picture.available_size(),
            is_idle: !self.opening.is_opening() && self.editor.is_complete(),
        };
        let requests = self.windows.scene_tools().map(|tool| tool.show(ctx, &scene));
        for request in requests.into_iter().flatten() {
            match request {
                ToolRequest::AskFile(purpose) => self.dialogs.files.open_dialog(purpose, frame, ctx),
                ToolRequest::Export => self.windows.start_export(&mut self.editor, ctx),
                ToolRequest::Report(headline, details) => self.editor.messages.error(headline, details),
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
