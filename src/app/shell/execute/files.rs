//! Commands on files: dialogs, sessions and exports.

use std::path::Path;

use eframe::egui;

use crate::app::windows::file_dialogs::{self, FileDialogPurpose};
use crate::app::{App, text};

impl App {
    /// Asks for a file in a dialog of the desktop.
    pub(super) fn ask_file(
        &mut self,
        purpose: FileDialogPurpose,
        frame: &eframe::Frame,
        ctx: &egui::Context,
    ) {
        self.dialogs.files.open_dialog(purpose, frame, ctx);
    }

    /// Saves the session to its file, or asks for a file.
    pub(super) fn save_session(&mut self, frame: &eframe::Frame, ctx: &egui::Context) {
        match self.editor.session_to_save() {
            Some(path) => self.editor.save_settings(&path),
            None => self.ask_file(FileDialogPurpose::SaveSettings, frame, ctx),
        }
    }

    /// Shows the export dialog for pictures and turntables.
    pub(super) fn open_export(&mut self) {
        let size = self.viewport_size();
        self.windows.export.open(size, self.layout.exports.as_deref(), self.editor.document.volume_name());
    }

    pub(crate) fn viewport_size(&self) -> [u32; 2] {
        // Before there is a picture: the resolution of the smallest common screens.
        self.picture.canvas.map_or([1280, 720], |canvas| canvas.available_size.map(|n| n.max(1)))
    }

    /// Handles a file that was chosen in a dialog or typed.
    pub(crate) fn handle_chosen_file(
        &mut self,
        purpose: FileDialogPurpose,
        path: &Path,
        ctx: &egui::Context,
    ) {
        match purpose {
            FileDialogPurpose::OpenVolume | FileDialogPurpose::OpenFolder => self.opener(ctx).open(path),
            FileDialogPurpose::VolumeOfLook => self.opener(ctx).open_for_look(path),
            FileDialogPurpose::ExportPicture => self.windows.export.set_path(path),
            FileDialogPurpose::SaveSettings => self.editor.save_settings(path),
            FileDialogPurpose::ExportKept => {
                if let Some(subject) = self.editor.export_subject()
                    && let Err(err) = self.windows.export.export_kept_sheet(subject, path, ctx)
                {
                    self.editor.messages.error(text::messages::PICTURE_NOT_EXPORTED, err);
                }
            }
            FileDialogPurpose::ExportLight => {
                let Some(dataset) = self.editor.viewport.dataset() else { return };
                match self.windows.light_slice.export(path, dataset.volume()) {
                    Ok(()) => self.editor.messages.note(text::messages::exported(path)),
                    Err(err) => self.editor.messages.error(text::messages::LIGHT_VOLUME_NOT_EXPORTED, err),
                }
            }
            FileDialogPurpose::LoadSettings => self.opener(ctx).load_settings(path),
            FileDialogPurpose::EnvironmentMap => self.read_environment_map(path, ctx),
            FileDialogPurpose::ImportTransfer => self.import_transfer(path, ctx),
            FileDialogPurpose::ExportTransfer => {
                match file_dialogs::export_transfer_file(
                    path,
                    &self.editor.document.settings,
                    &self.editor.document.value_ranges(),
                ) {
                    Ok(()) => self.editor.messages.note(text::messages::written(path)),
                    Err(err) => self.editor.messages.error(text::messages::TRANSFER_NOT_WRITTEN, err),
                }
            }
            FileDialogPurpose::CompareSettings => self.opener(ctx).compare_with_file(path),
        }
    }

    pub(crate) fn start_export(&mut self, ctx: &egui::Context) {
        if let Some(subject) = self.editor.export_subject()
            && let Err(err) = self.windows.export.start(subject, ctx)
        {
            self.editor.messages.error(text::messages::PICTURE_NOT_EXPORTED, err);
        }
    }

    pub(super) fn copy_picture(&mut self, ctx: &egui::Context) {
        if self.windows.export.is_busy() {
            self.editor.messages.note(text::messages::EXPORT_RUNS);
        } else if let Some(subject) = self.editor.export_subject()
            && let Err(err) = self.windows.export.copy_to_clipboard(subject, self.viewport_size(), ctx)
        {
            self.editor.messages.error(text::messages::PICTURE_NOT_COPIED, err);
        }
    }
}
