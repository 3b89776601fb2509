//! Undo and redo of the look, with a message about each step.

use eframe::egui;

use super::LookEditor;
use crate::app::text;

impl LookEditor {
    /// Goes the given number of steps forward, or back if it is negative; see [`Self::undo_or_redo`].
    pub(crate) fn go_steps(&mut self, steps: i32, has_status_bar: bool, ctx: &egui::Context) {
        // Only the last step shows a message.
        for _ in 1..steps.unsigned_abs() {
            self.take_step(steps < 0, ctx);
        }
        if steps != 0 {
            self.undo_or_redo(steps < 0, has_status_bar, ctx);
        }
    }

    /// Takes one step back or forward and shows it in the status bar, or as a note if there is none.
    pub(crate) fn undo_or_redo(&mut self, is_back: bool, has_status_bar: bool, ctx: &egui::Context) {
        let what = self.document.history.describe_next(&self.document.history_step(), is_back);
        self.take_step(is_back, ctx);
        if let Some(what) = what {
            let words = text::messages::undone(is_back, &what);
            if has_status_bar {
                self.messages.note_step(&words);
            } else {
                self.messages.note(words.clone());
            }
            self.document.history.set_last_step(words, &self.document.settings);
        }
    }

    /// Takes a step as [`Self::undo_or_redo`] does, without a message.
    fn take_step(&mut self, is_back: bool, ctx: &egui::Context) {
        // Only a step that has turned the object changes the remembered up axis.
        if self.document.take_step(is_back) {
            self.ensure_first_look_up(None, ctx);
            self.document.remember_up(&mut self.memory);
        }
    }
}
