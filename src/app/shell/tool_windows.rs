//! Windows over the picture, with their state: tool windows, and dialogs that ask the user.

use super::history::HistoryWindow;
use super::look_editor::LookEditor;
use crate::app::common::alternatives::Alternatives;
use crate::app::text;
use crate::app::windows::contact_sheet::ContactSheetWindow;
use crate::app::windows::device_loss::DeviceLossDialog;
use crate::app::windows::export::ExportWindow;
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
    /// Opens the chooser of an aspect of the open file, or notes that there is nothing to choose.
    pub(crate) fn show_chooser(&mut self, aspect: ChoiceAspect, editor: &mut LookEditor) {
        let held = editor.document.volume.as_ref().map(|volume| &volume.held);
        match held.and_then(|held| Alternatives::new(held, aspect)) {
            Some(all) => self.volume_chooser.open(aspect, &all),
            None => editor.messages.note(text::chooser::single_item(aspect)),
        }
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
