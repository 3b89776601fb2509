//! Windows over the picture, with their state: tool windows, and dialogs that ask the user.

use std::path::{Path, PathBuf};

use eframe::egui;

use super::history::HistoryWindow;
use super::look_editor::LookEditor;
use super::messages::MessageLog;
use crate::app::common::alternatives::Alternatives;
use crate::app::common::commands::AppCommand;
use crate::app::text;
use crate::app::windows::SceneTool;
use crate::app::windows::contact_sheet::ContactSheetWindow;
use crate::app::windows::device_loss::DeviceLossDialog;
use crate::app::windows::export::{ExportOutcome, ExportWindow};
use crate::app::windows::file_dialogs::FileDialogs;
use crate::app::windows::help::HelpWindows;
use crate::app::windows::light_slice::LightSliceWindow;
use crate::app::windows::palette::CommandPalette;
use crate::app::windows::quit_dialog::QuitDialog;
use crate::app::windows::recovery::RecoveryDialog;
use crate::app::windows::slices::SlicesWindow;
use crate::app::windows::volume_chooser::VolumeChooser;
use chiaroscuro_volume::ChoiceAspect;

/// State of the tool windows.
#[derive(Debug, Default)]
pub(crate) struct ToolWindows {
    /// Export of pictures, with the export in progress.
    pub export: ExportWindow,
    /// Palette that finds commands by name.
    pub palette: CommandPalette,
    /// Contact sheet of suggested looks and lights.
    pub contact_sheet: ContactSheetWindow,
    /// List of undo steps.
    pub history: HistoryWindow,
    /// Window of orthogonal slices with its cursor.
    pub slices: SlicesWindow,
    /// Slices of a light volume.
    pub light_slice: LightSliceWindow,
    /// Chooser of the open file's volumes.
    pub volume_chooser: VolumeChooser,
    /// Help on keys and mouse, and facts about the program.
    pub help: HelpWindows,
}

impl ToolWindows {
    /// Lists the tools that read the scene, in the order in which they are shown.
    pub(crate) fn scene_tools(&mut self) -> [&mut dyn SceneTool; 3] {
        [&mut self.slices, &mut self.light_slice, &mut self.export]
    }

    /// Shows the contact sheet, if it is open, and renders its pictures when they are due.
    pub(crate) fn show_contact_sheet(
        &mut self,
        editor: &mut LookEditor,
        ctx: &egui::Context,
        commands: &mut Vec<AppCommand>,
    ) {
        if self.contact_sheet.needs_start() {
            let subject = editor.export_subject();
            if let Err(err) = self.contact_sheet.start(subject, ctx) {
                editor.messages.error(text::messages::LOOKS_NOT_TRIED, err);
            }
        }
        if let Err(err) = self.contact_sheet.ui(ctx, commands) {
            editor.messages.error(text::messages::LOOKS_NOT_TRIED, err);
        }
    }

    /// Opens the chooser of an aspect of the open file, or notes that there is nothing to choose.
    pub(crate) fn show_chooser(&mut self, aspect: ChoiceAspect, editor: &mut LookEditor) {
        let held = editor.document.volume.as_ref().map(|volume| &volume.held);
        match held.and_then(|held| Alternatives::new(held, aspect)) {
            Some(all) => self.volume_chooser.open(aspect, &all),
            None => editor.messages.note(text::chooser::single_item(aspect)),
        }
    }

    /// Starts the export that the user has set up.
    pub(crate) fn start_export(&mut self, editor: &mut LookEditor, ctx: &egui::Context) {
        if let Some(subject) = editor.export_subject()
            && let Err(err) = self.export.start(subject, ctx)
        {
            editor.messages.error(text::messages::PICTURE_NOT_EXPORTED, err);
        }
    }

    /// Starts to render a picture of the given size for the clipboard, unless an export runs.
    pub(crate) fn copy_picture(&mut self, size: [u32; 2], editor: &mut LookEditor, ctx: &egui::Context) {
        if self.export.is_busy() {
            editor.messages.note(text::messages::EXPORT_RUNS);
        } else if let Some(subject) = editor.export_subject()
            && let Err(err) = self.export.copy_to_clipboard(subject, size, ctx)
        {
            editor.messages.error(text::messages::PICTURE_NOT_COPIED, err);
        }
    }

    /// Starts to render all kept views and looks into one picture.
    pub(crate) fn export_kept_sheet(&mut self, path: &Path, editor: &mut LookEditor, ctx: &egui::Context) {
        if let Some(subject) = editor.export_subject()
            && let Err(err) = self.export.export_kept_sheet(subject, path, ctx)
        {
            editor.messages.error(text::messages::PICTURE_NOT_EXPORTED, err);
        }
    }

    /// Writes the slice or the volume of light that is shown.
    pub(crate) fn export_light(&self, path: &Path, editor: &mut LookEditor) {
        let Some(dataset) = editor.viewport.dataset() else { return };
        match self.light_slice.export(path, dataset.volume()) {
            Ok(()) => editor.messages.note(text::messages::exported(path)),
            Err(err) => editor.messages.error(text::messages::LIGHT_VOLUME_NOT_EXPORTED, err),
        }
    }

    /// Takes the result of an export and reports it. Returns the file that was written, if it is one.
    pub(crate) fn take_export(&mut self, messages: &mut MessageLog, ctx: &egui::Context) -> Option<PathBuf> {
        match self.export.take_result()? {
            Ok(ExportOutcome::File(path)) => {
                messages.note(text::messages::exported(&path));
                return Some(path);
            }
            Ok(ExportOutcome::Picture(picture)) => {
                ctx.copy_image(picture);
                messages.note(text::messages::PICTURE_COPIED);
            }
            Ok(ExportOutcome::Cancelled) => messages.note(text::messages::EXPORT_CANCELLED),
            Err(err) => messages.error(text::messages::PICTURE_NOT_EXPORTED, err),
        }
        None
    }
}

/// State of the dialogs.
#[derive(Default)]
pub(crate) struct AppDialogs {
    /// File dialogs of the desktop, and the window for typing a path.
    pub files: FileDialogs,
    /// Question about reopening the last session.
    pub recovery: RecoveryDialog,
    /// Question before quitting during an export.
    pub quit: QuitDialog,
    /// Question after the graphics device was lost repeatedly.
    pub device_loss: DeviceLossDialog,
}
