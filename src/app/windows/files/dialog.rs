//! The desktop's file dialog, asked for on a thread of its own: what was chosen, or that there was none to choose in.

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

/// The shortest that somebody needs to read a dialog and close it: what closes sooner was never open.
const SHORTEST: Duration = Duration::from_millis(400);

/// The longest that a desktop takes to show a dialog. Until then, whoever asks for another one is asked to wait.
const SLOWEST: Duration = Duration::from_secs(2);

/// What came of a dialog.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Answer {
    Chosen(PathBuf),
    Cancelled,
    /// The desktop has none, or could not show it.
    NoDialog,
}

type Choosing = Pin<Box<dyn Future<Output = Option<rfd::FileHandle>> + Send>>;

/// A dialog that was asked for, and has not been answered.
#[derive(Debug)]
pub(super) struct Dialog {
    pub purpose: Purpose,
    asked: Instant,
    /// This window has lost the keyboard since: to the dialog, unless the user went elsewhere.
    was_seen: bool,
    work: Work<Answer>,
}

impl Dialog {
    /// Asks the desktop for a dialog.
    ///
    /// # Errors
    /// When there can be no thread for it.
    pub(super) fn open(purpose: Purpose, frame: &eframe::Frame, ctx: &egui::Context) -> io::Result<Self> {
        let choosing = choosing(purpose, frame);
        let task = move || {
            if !desktop::has_file_dialog() {
                return Answer::NoDialog;
            }
            // From here, and not from when somebody asked: frames of the window may take long.
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

    /// Whether it is on the screen, or may still come.
    pub(super) fn may_be_open(&self) -> bool {
        self.was_seen || self.asked.elapsed() < SLOWEST
    }

    /// Follows who has the keyboard. While the desktop decides what to show, letters are no commands: somebody may be
    /// typing a path already.
    pub(super) fn watch(&mut self, ctx: &egui::Context) {
        let is_left = |event: &egui::Event| matches!(event, egui::Event::WindowFocused(false));
        self.was_seen |= ctx.input(|input| !input.focused || input.events.iter().any(is_left));
        if !self.was_seen && self.may_be_open() {
            shortcuts::reserve_letters(ctx);
        }
    }

    /// What came of it, once.
    pub(super) fn answer(&self) -> Option<Answer> {
        let answer = self.work.take()?.unwrap_or_else(|panic| {
            log::warn!("the file dialog failed: {panic}");
            Answer::NoDialog
        });
        Some(answer.unless_unseen(self.was_seen))
    }
}

impl Answer {
    /// A dialog that fails late says that it was cancelled, too; but a dialog that somebody has cancelled was seen.
    fn unless_unseen(self, was_seen: bool) -> Self {
        if self == Self::Cancelled && !was_seen { Self::NoDialog } else { self }
    }
}

/// What will be chosen in the dialog for a purpose. Some systems show it at once, others when it is waited for.
fn choosing(purpose: Purpose, frame: &eframe::Frame) -> Choosing {
    let dialog = rfd::AsyncFileDialog::new().set_title(purpose.question().title).set_parent(frame);
    match purpose {
        Purpose::OpenVolume | Purpose::VolumeOfLook => {
            // Filters know what follows the last dot.
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

    /// What comes of a dialog that answers so, in a window that has the keyboard or not.
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
