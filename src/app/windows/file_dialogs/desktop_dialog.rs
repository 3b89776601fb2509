//! File dialog of the desktop, run on a thread of its own; its result tells a chosen file from a dialog that failed
//! to open.

use std::io;
use std::path::PathBuf;
use std::pin::Pin;
use std::time::{Duration, Instant};

use eframe::egui;

use super::{FileDialogPurpose, desktop};
use crate::app::common::shortcuts;
use crate::app::text;
use crate::app::worker::jobs::{JobControl, JobHandle, JobKind};
use chiaroscuro_scene::{EXPORT_EXTENSIONS, IMPORT_EXTENSIONS};
use chiaroscuro_volume_io::supported_extensions;

/// Shortest time in which a user can read a dialog and close it: a dialog that closes sooner was never open.
const MIN_OPEN_TIME: Duration = Duration::from_millis(400);

/// Longest time that a desktop takes to show a dialog. Until then, a request for another one is refused.
const MAX_SHOW_DELAY: Duration = Duration::from_secs(2);

/// Outcome of a file dialog.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum FileDialogOutcome {
    Chosen(PathBuf),
    Cancelled,
    /// The desktop has no file dialog, or could not show it.
    NoDialog,
}

type FileDialogFuture = Pin<Box<dyn Future<Output = Option<rfd::FileHandle>> + Send>>;

/// File dialog that was requested and has not been answered.
#[derive(Debug)]
pub(super) struct FileDialog {
    pub purpose: FileDialogPurpose,
    requested: Instant,
    /// True once the window has lost the keyboard focus: to the dialog, unless the user went elsewhere.
    lost_focus: bool,
    work: JobHandle<FileDialogOutcome>,
}

impl FileDialog {
    /// Requests a dialog from the desktop.
    ///
    /// # Errors
    /// If no thread can be started for it.
    pub(super) fn open(
        purpose: FileDialogPurpose,
        frame: &eframe::Frame,
        ctx: &egui::Context,
    ) -> io::Result<Self> {
        let choosing = dialog_future(purpose, frame);
        let task = move |_: &JobControl| {
            if !desktop::has_file_dialog() {
                return FileDialogOutcome::NoDialog;
            }
            // Measured from here and not from the request, because frames of the window may take long.
            let shown = Instant::now();
            match pollster::block_on(choosing) {
                Some(file) => FileDialogOutcome::Chosen(file.path().to_owned()),
                None if shown.elapsed() < MIN_OPEN_TIME => FileDialogOutcome::NoDialog,
                None => FileDialogOutcome::Cancelled,
            }
        };
        let work = JobHandle::start(JobKind::FileDialog, ctx, task)?;
        Ok(Self { purpose, requested: Instant::now(), lost_focus: false, work })
    }

    /// Returns true if the dialog is on screen, or may still appear.
    pub(super) fn may_be_open(&self) -> bool {
        self.lost_focus || self.requested.elapsed() < MAX_SHOW_DELAY
    }

    /// Observes the keyboard focus. While the desktop decides what to show, letters are no commands: the user may be
    /// typing a path already.
    pub(super) fn observe_focus(&mut self, ctx: &egui::Context) {
        let lost_focus = |event: &egui::Event| matches!(event, egui::Event::WindowFocused(false));
        self.lost_focus |= ctx.input(|input| !input.focused || input.events.iter().any(lost_focus));
        if !self.lost_focus && self.may_be_open() {
            shortcuts::reserve_letters(ctx);
        }
    }

    /// Returns the outcome of the dialog, once.
    pub(super) fn take_outcome(&self) -> Option<FileDialogOutcome> {
        let answer = self.work.take_result()?.unwrap_or_else(|panic| {
            log::warn!("the file dialog failed: {panic}");
            FileDialogOutcome::NoDialog
        });
        Some(answer.corrected_for_focus(self.lost_focus))
    }
}

impl FileDialogOutcome {
    /// Turns a cancellation without loss of focus into a failure: a dialog that fails late also reports cancellation,
    /// but a dialog that the user has cancelled took the focus.
    fn corrected_for_focus(self, was_seen: bool) -> Self {
        if self == Self::Cancelled && !was_seen { Self::NoDialog } else { self }
    }
}

/// Future of the file chosen in the dialog for a purpose. Some systems show the dialog at once, others when it is
/// awaited.
fn dialog_future(purpose: FileDialogPurpose, frame: &eframe::Frame) -> FileDialogFuture {
    let dialog = rfd::AsyncFileDialog::new().set_title(purpose.dialog_text().title).set_parent(frame);
    match purpose {
        FileDialogPurpose::OpenVolume | FileDialogPurpose::AddLayer | FileDialogPurpose::VolumeOfLook => {
            // Filters match the part after the last dot.
            let filters: Vec<&str> =
                supported_extensions().into_iter().filter_map(|ending| ending.rsplit('.').next()).collect();
            let dialog = dialog.add_filter(text::files::VOLUMES, &filters);
            Box::pin(dialog.add_filter(text::files::ALL_FILES, &["*"]).pick_file())
        }
        FileDialogPurpose::OpenFolder => Box::pin(dialog.pick_folder()),
        FileDialogPurpose::LoadSettings | FileDialogPurpose::CompareSettings => {
            let endings = ["json", "png", "exr", "gif", "mp4"];
            Box::pin(dialog.add_filter(text::files::SETTINGS_AND_PICTURES, &endings).pick_file())
        }
        FileDialogPurpose::EnvironmentMap => {
            let endings = ["hdr", "exr", "png", "jpg", "jpeg"];
            Box::pin(dialog.add_filter(text::files::ENVIRONMENT_MAPS, &endings).pick_file())
        }
        FileDialogPurpose::ImportTransfer => {
            Box::pin(dialog.add_filter(text::files::TRANSFER_FUNCTIONS, &IMPORT_EXTENSIONS).pick_file())
        }
        FileDialogPurpose::ExportTransfer => {
            let dialog = dialog.add_filter(text::files::TRANSFER_FUNCTIONS, &EXPORT_EXTENSIONS);
            Box::pin(dialog.set_file_name("colors.json").save_file())
        }
        FileDialogPurpose::SaveSettings => {
            let dialog = dialog.add_filter(text::files::SETTINGS, &["json"]);
            Box::pin(dialog.set_file_name("settings.json").save_file())
        }
        FileDialogPurpose::ExportPicture => {
            let dialog = dialog.add_filter(text::files::PICTURES, &["png", "exr", "gif", "mp4"]);
            Box::pin(dialog.set_file_name("picture.png").save_file())
        }
        FileDialogPurpose::ExportKept => {
            let dialog = dialog.add_filter(text::files::PICTURES, &["png"]);
            Box::pin(dialog.set_file_name("contact-sheet.png").save_file())
        }
        FileDialogPurpose::ExportLight => {
            let dialog = dialog.add_filter(text::files::LIGHT_VOLUME, &["nrrd"]);
            let dialog = dialog.add_filter(text::files::SLICE, &["png"]);
            Box::pin(dialog.set_file_name("light.nrrd").save_file())
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Outcome of a dialog with a given answer, in a window that keeps the focus or loses it.
    fn outcome_with_focus(answer: &FileDialogOutcome, has_keyboard: bool) -> FileDialogOutcome {
        let ctx = egui::Context::default();
        let given = answer.clone();
        let work = JobHandle::start(JobKind::FileDialog, &ctx, move |_| given).unwrap();
        let mut dialog = FileDialog {
            purpose: FileDialogPurpose::OpenVolume,
            requested: Instant::now(),
            lost_focus: false,
            work,
        };
        let input = egui::RawInput { focused: has_keyboard, ..egui::RawInput::default() };
        let mut output = ctx.run_ui(input, |ui| dialog.observe_focus(ui.ctx()));
        output.textures_delta.clear();
        assert!(dialog.may_be_open(), "it may still come");
        assert_eq!(shortcuts::are_letters_reserved(&ctx), has_keyboard, "a path may be typed already");
        loop {
            if let Some(answer) = dialog.take_outcome() {
                return answer;
            }
            std::thread::sleep(Duration::from_millis(1));
        }
    }

    #[test]
    fn a_dialog_that_nobody_has_seen_was_not_cancelled() {
        let chosen = FileDialogOutcome::Chosen("a.nrrd".into());
        for has_keyboard in [false, true] {
            assert_eq!(outcome_with_focus(&chosen, has_keyboard), chosen);
            assert_eq!(
                outcome_with_focus(&FileDialogOutcome::NoDialog, has_keyboard),
                FileDialogOutcome::NoDialog
            );
        }
        assert_eq!(outcome_with_focus(&FileDialogOutcome::Cancelled, false), FileDialogOutcome::Cancelled);
        assert_eq!(
            outcome_with_focus(&FileDialogOutcome::Cancelled, true),
            FileDialogOutcome::NoDialog,
            "it has failed, however late"
        );
    }
}
