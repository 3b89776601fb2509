//! Results of worker threads, and errors of the renderer.

use eframe::egui;

use crate::app::windows::export::ExportOutcome;
use crate::app::windows::file_dialogs::FileDialogPurpose;
use crate::app::{App, text};
use chiaroscuro_render::GpuError;

impl App {
    /// Collects the results that worker threads have finished.
    pub(crate) fn collect_results(&mut self, ctx: &egui::Context) {
        self.opener(ctx).take_outcome();
        self.opener(ctx).take_neighbour();
        self.editor.finish_kind_task(ctx);
        self.opener(ctx).finish_file_tasks();
        self.drop_pictures_of_replaced();
        self.editor.take_balances(ctx);
        match self.windows.export.take_result() {
            None => {}
            Some(Ok(ExportOutcome::File(path))) => {
                self.layout.exports =
                    std::path::absolute(&path).ok().and_then(|path| Some(path.parent()?.to_owned()));
                self.editor.messages.note(text::messages::exported(&path));
            }
            Some(Ok(ExportOutcome::Picture(picture))) => {
                ctx.copy_image(picture);
                self.editor.messages.note(text::messages::PICTURE_COPIED);
            }
            Some(Ok(ExportOutcome::Cancelled)) => self.editor.messages.note(text::messages::EXPORT_CANCELLED),
            Some(Err(err)) => self.editor.messages.error(text::messages::PICTURE_NOT_EXPORTED, err),
        }
        if self.dialogs.files.take_refused() {
            self.editor.messages.note(text::files::DIALOG_IS_OPEN);
        }
        if let Some((purpose, path)) = self.dialogs.files.take_choice(ctx) {
            self.handle_chosen_file(purpose, &path, ctx);
            if purpose == FileDialogPurpose::ExportPicture {
                // The desktop's file dialog has already asked before overwriting.
                self.windows.export.allow_replacing(&path);
            }
        }
    }

    /// Handles an error of the renderer. After the loss of the device, another window takes the place of this one.
    pub(crate) fn handle_render_error(&mut self, err: &GpuError, ctx: &egui::Context) {
        if self.editor.viewport.is_lost() {
            self.close_for_successor(ctx);
        } else {
            self.editor.messages.error(text::messages::NOT_RENDERED, err.to_string());
        }
    }
}
