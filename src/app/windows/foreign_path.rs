//! The question that is asked before a look from outside opens a volume that the user has never opened.

use std::path::PathBuf;

use eframe::egui;

use crate::app::common::frame;
use crate::app::text;
use crate::data::plain;
use crate::model::Record;

/// Characters of a path that are shown: whoever is asked must see all of it.
const LONGEST_PATH: usize = 4096;

/// What the user answered.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Answer {
    /// Open it.
    Open,
    /// Ask for another file.
    Choose,
    /// Only the look.
    NotNow,
}

/// A look whose volume is not opened without a question.
#[derive(Debug)]
struct Asked {
    record: Record,
    /// What can be opened; nothing if it never is.
    path: Option<PathBuf>,
    /// What the look says of it, and why it is not opened as if nothing were.
    shown: String,
    why: &'static str,
}

/// State of the window.
#[derive(Debug, Default)]
pub(crate) struct ForeignPath {
    asked: Option<Asked>,
}

impl ForeignPath {
    /// Asks whether a file is to be opened for a look.
    pub(crate) fn ask(&mut self, path: PathBuf, record: Record) {
        let shown = plain(&path.to_string_lossy(), LONGEST_PATH);
        self.asked = Some(Asked { record, path: Some(path), shown, why: text::foreign_path::OUTSIDE });
    }

    /// Says that what a look names is never opened.
    pub(crate) fn refuse(&mut self, named: &str, why: &'static str, record: Record) {
        self.asked = Some(Asked { record, path: None, shown: plain(named, LONGEST_PATH), why });
    }

    /// Whether it is being asked.
    pub(crate) fn asks(&self) -> bool {
        self.asked.is_some()
    }

    /// The look that was asked about, and what it says of its volume; the window closes.
    pub(crate) fn take(&mut self) -> Option<(Record, Option<PathBuf>)> {
        self.asked.take().map(|asked| (asked.record, asked.path))
    }

    /// Shows the window, if it is open. Gives what the user answered.
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
