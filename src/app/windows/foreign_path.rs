//! Dialog that asks before a look from outside opens a volume that the user has never opened.

use std::path::PathBuf;

use eframe::egui;

use crate::app::common::frame;
use crate::app::text;
use crate::data::plain;
use crate::model::Record;

/// Longest path that is shown, in characters: the user must see all of it.
const LONGEST_PATH: usize = 4096;

/// Answer of the user to the dialog.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Answer {
    /// Open the volume that the look names.
    Open,
    /// Ask for another file instead.
    Choose,
    /// Apply the look without its volume.
    NotNow,
}

/// Look whose volume is not opened without asking.
#[derive(Debug)]
struct Asked {
    record: Record,
    /// Path that can be opened; `None` if it is never opened.
    path: Option<PathBuf>,
    /// Path as the look names it, made printable, and the reason for asking.
    shown: String,
    why: &'static str,
}

/// State of the dialog; empty while it is closed.
#[derive(Debug, Default)]
pub(crate) struct ForeignPath {
    asked: Option<Asked>,
}

impl ForeignPath {
    /// Asks whether to open a file for a look.
    pub(crate) fn ask(&mut self, path: PathBuf, record: Record) {
        let shown = plain(&path.to_string_lossy(), LONGEST_PATH);
        self.asked = Some(Asked { record, path: Some(path), shown, why: text::foreign_path::OUTSIDE });
    }

    /// Shows that a path named by a look is never opened.
    pub(crate) fn refuse(&mut self, named: &str, why: &'static str, record: Record) {
        self.asked = Some(Asked { record, path: None, shown: plain(named, LONGEST_PATH), why });
    }

    /// Returns true while the dialog is open.
    pub(crate) fn asks(&self) -> bool {
        self.asked.is_some()
    }

    /// Takes the look and the path of its volume, and closes the dialog.
    pub(crate) fn take(&mut self) -> Option<(Record, Option<PathBuf>)> {
        self.asked.take().map(|asked| (asked.record, asked.path))
    }

    /// Shows the dialog, if it is open, and returns the user's answer.
    pub(crate) fn ui(&self, ctx: &egui::Context) -> Option<Answer> {
        let asked = self.asked.as_ref()?;
        let (mut open, mut answer) = (true, None);
        let window = egui::Window::new(text::foreign_path::TITLE).open(&mut open);
        let window = window.constrain_to(frame::room(ctx));
        let window = window.collapsible(false).resizable(false).default_pos([140.0, 90.0]);
        let shown = window.show(ctx, |ui| {
            ui.set_max_width(420.0);
            ui.label(asked.why);
            ui.add(egui::Label::new(egui::RichText::new(&asked.shown).monospace()).wrap());
            ui.horizontal(|ui| {
                let mut button = |words: &str, given: Answer| {
                    if ui.button(words).clicked() {
                        answer = Some(given);
                    }
                };
                if asked.path.is_some() {
                    button(text::foreign_path::OPEN, Answer::Open);
                }
                button(text::foreign_path::CHOOSE, Answer::Choose);
                button(text::foreign_path::NOT_NOW, Answer::NotNow);
            });
        });
        open &= !frame::is_left(ctx, shown.as_ref().map(|shown| &shown.response));
        answer.or_else(|| (!open).then_some(Answer::NotNow))
    }
}
