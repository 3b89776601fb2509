//! File dialog of the desktop, run on a thread of its own; its result tells a chosen file from a dialog that failed
//! to open.

use std::io;
use std::path::PathBuf;
use std::pin::Pin;
use std::time::{Duration, Instant};

use eframe::egui;

use super::{Purpose, desktop};
use crate::app::common::shortcuts;
use crate::app::text;
use crate::app::worker::task::Work;
use crate::data::load::endings;
use crate::model::{EXPORTED, IMPORTED};

/// Shortest time in which a user can read a dialog and close it: a dialog that closes sooner was never open.
const SHORTEST: Duration = Duration::from_millis(400);

/// Longest time that a desktop takes to show a dialog. Until then, a request for another one is refused.
const SLOWEST: Duration = Duration::from_secs(2);

/// Outcome of a file dialog.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Answer {
    Chosen(PathBuf),
    Cancelled,
    /// The desktop has no file dialog, or could not show it.
    NoDialog,
}

type Choosing = Pin<Box<dyn Future<Output = Option<rfd::FileHandle>> + Send>>;

/// File dialog that was requested and has not been answered.
#[derive(Debug)]
pub(super) struct Dialog {
    pub purpose: Purpose,
    asked: Instant,
    /// True once the window has lost the keyboard focus: to the dialog, unless the user went elsewhere.
    was_seen: bool,
    work: Work<Answer>,
}

impl Dialog {
    /// Requests a dialog from the desktop.
    ///
    /// # Errors
    /// If no thread can be started for it.
    pub(super) fn open(purpose: Purpose, frame: &eframe::Frame, ctx: &egui::Context) -> io::Result<Self> {
        let choosing = choosing(purpose, frame);
        let task = move || {
            if !desktop::has_file_dialog() {
                return Answer::NoDialog;
            }
            // Measured from here and not from the request, because frames of the window may take long.
            let shown = Instant::now();
            match pollster::block_on(choosing) {
                Some(file) => Answer::Chosen(file.path().to_owned()),
                None if shown.elapsed() < SHORTEST => Answer::NoDialog,
                None => Answer::Cancelled,
            }
        };
        let work = Work::start("file-dialog", ctx, task)?;
        Ok(Self { purpose, asked: Instant::now(), was_seen: false, work })
    }

    /// Returns true if the dialog is on screen, or may still appear.
    pub(super) fn may_be_open(&self) -> bool {
        self.was_seen || self.asked.elapsed() < SLOWEST
    }

    /// Observes the keyboard focus. While the desktop decides what to show, letters are no commands: the user may be
    /// typing a path already.
    pub(super) fn watch(&mut self, ctx: &egui::Context) {
        let is_left = |event: &egui::Event| matches!(event, egui::Event::WindowFocused(false));
        self.was_seen |= ctx.input(|input| !input.focused || input.events.iter().any(is_left));
        if !self.was_seen && self.may_be_open() {
            shortcuts::reserve_letters(ctx);
        }
    }

    /// Returns the outcome of the dialog, once.
    pub(super) fn answer(&self) -> Option<Answer> {
        let answer = self.work.take()?.unwrap_or_else(|panic| {
            log::warn!("the file dialog failed: {panic}");
            Answer::NoDialog
        });
        Some(answer.unless_unseen(self.was_seen))
    }
}

impl Answer {
    /// Turns a cancellation without loss of focus into a failure: a dialog that fails late also reports cancellation,
    /// but a dialog that the user has cancelled took the focus.
    fn unless_unseen(self, was_seen: bool) -> Self {
        if self == Self::Cancelled && !was_seen { Self::NoDialog } else { self }
    }
}

/// Future of the file chosen in the dialog for a purpose. Some systems show the dialog at once, others when it is
/// awaited.
fn choosing(purpose: Purpose, frame: &eframe::Frame) -> Choosing {
    let dialog = rfd::AsyncFileDialog::new().set_title(purpose.question().title).set_parent(frame);
    match purpose {
        Purpose::OpenVolume | Purpose::VolumeOfLook => {
            // Filters match the part after the last dot.
            let filters: Vec<&str> =
                endings().into_iter().filter_map(|ending| ending.rsplit('.').next()).collect();
            let dialog = dialog.add_filter(text::files::VOLUMES, &filters);
            Box::pin(dialog.add_filter(text::files::ALL_FILES, &["*"]).pick_file())
        }
        Purpose::OpenFolder => Box::pin(dialog.pick_folder()),
        Purpose::LoadSettings | Purpose::CompareSettings => {
            let endings = ["json", "png", "exr", "gif", "mp4"];
            Box::pin(dialog.add_filter(text::files::SETTINGS_AND_PICTURES, &endings).pick_file())
        }
        Purpose::Surroundings => {
            let endings = ["hdr", "exr", "png", "jpg", "jpeg"];
            Box::pin(dialog.add_filter(text::files::PANORAMAS, &endings).pick_file())
        }
        Purpose::ImportTransfer => {
            Box::pin(dialog.add_filter(text::files::TRANSFER_FUNCTIONS, &IMPORTED).pick_file())
        }
        Purpose::ExportTransfer => {
            let dialog = dialog.add_filter(text::files::TRANSFER_FUNCTIONS, &EXPORTED);
            Box::pin(dialog.set_file_name("colors.json").save_file())
        }
        Purpose::SaveSettings => {
            let dialog = dialog.add_filter(text::files::SETTINGS, &["json"]);
            Box::pin(dialog.set_file_name("settings.json").save_file())
        }
        Purpose::ExportPicture => {
            let dialog = dialog.add_filter(text::files::PICTURES, &["png", "exr", "gif", "mp4"]);
            Box::pin(dialog.set_file_name("picture.png").save_file())
        }
        Purpose::ExportKept => {
            let dialog = dialog.add_filter(text::files::PICTURES, &["png"]);
            Box::pin(dialog.set_file_name("contact-sheet.png").save_file())
        }
        Purpose::ExportLight => {
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
    fn answer_of(answer: &Answer, has_keyboard: bool) -> Answer {
        let ctx = egui::Context::default();
        let given = answer.clone();
        let work = Work::start("dialog", &ctx, move || given).unwrap();
        let mut dialog =
            Dialog { purpose: Purpose::OpenVolume, asked: Instant::now(), was_seen: false, work };
        let input = egui::RawInput { focused: has_keyboard, ..egui::RawInput::default() };
        let mut output = ctx.run_ui(input, |ui| dialog.watch(ui.ctx()));
        output.textures_delta.clear();
        assert!(dialog.may_be_open(), "it may still come");
        assert_eq!(shortcuts::are_letters_reserved(&ctx), has_keyboard, "a path may be typed already");
        loop {
            if let Some(answer) = dialog.answer() {
                return answer;
            }
            std::thread::sleep(Duration::from_millis(1));
        }
    }

    #[test]
    fn a_dialog_that_nobody_has_seen_was_not_cancelled() {
        let chosen = Answer::Chosen("a.nrrd".into());
        for has_keyboard in [false, true] {
            assert_eq!(answer_of(&chosen, has_keyboard), chosen);
            assert_eq!(answer_of(&Answer::NoDialog, has_keyboard), Answer::NoDialog);
        }
        assert_eq!(answer_of(&Answer::Cancelled, false), Answer::Cancelled);
        assert_eq!(answer_of(&Answer::Cancelled, true), Answer::NoDialog, "it has failed, however late");
    }
}
