//! Undo and redo of the look, with a message about each step.

use eframe::egui;

use super::LookEditor;
use crate::app::text;

impl LookEditor {
    /// Goes the given number of steps forward, or back if it is negative, and shows the last one in the status bar, or
    /// as a note if there is none.
    pub(crate) fn go_steps(&mut self, steps: i32, has_status_bar: bool, ctx: &egui::Context) {
        let is_back = steps < 0;
        for _ in 1..steps.unsigned_abs() {
            self.take_step(is_back, ctx);
        }
        if steps == 0 {
            return;
        }
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

    /// Takes one step back or forward, without a message.
    fn take_step(&mut self, is_back: bool, ctx: &egui::Context) {
        // Only a step that has turned the object changes the remembered up axis.
        if self.document.take_step(is_back) {
            self.ensure_first_look_up(None, ctx);
            self.document.remember_up(&mut self.memory);
        }
    }
}
