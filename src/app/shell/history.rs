//! Undo and redo in the window, and the history window: the list of undo steps with their changes.

use eframe::egui;

use crate::app::common::commands::AppCommand;
use crate::app::common::overlay_windows;
use crate::app::document::history::{HistoryStep, HistorySteps};
use crate::app::{App, text};

/// Cached list, and the step for which it was made.
#[derive(Debug, Default)]
pub(crate) struct HistoryWindow {
    /// True while the window is open.
    pub open: bool,
    listed_for: Option<HistoryStep>,
    steps: HistorySteps,
}

impl App {
    /// Shows the history window, if it is open.
    pub(crate) fn show_history(&mut self, ctx: &egui::Context, commands: &mut Vec<AppCommand>) {
        if !self.windows.history.open {
            self.windows.history.listed_for = None;
            return;
        }
        let now = self.document.history_step();
        // Listing takes every step: not during a drag, which is no step yet.
        let is_new = self.windows.history.listed_for.is_none() || ctx.dragged_id().is_none();
        if is_new && self.windows.history.listed_for.as_ref() != Some(&now) {
            self.windows.history.steps = self.document.history.list_steps(&now);
            self.windows.history.listed_for = Some(now);
        }
        let HistorySteps { names, current: taken } = &self.windows.history.steps;
        let window =
            egui::Window::new(text::history::TITLE).open(&mut self.windows.history.open).collapsible(false);
        let window = window
            .default_size([260.0, 320.0])
            .default_pos([40.0, 80.0])
            .constrain_to(overlay_windows::window_area(ctx));
        let mut chosen = None;
        let shown = window.show(ctx, |ui| {
            egui::ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
                if ui.selectable_label(*taken == 0, text::history::START).clicked() {
                    chosen = Some(0);
                }
                for (at, name) in (1..).zip(names) {
                    let mut row = egui::RichText::new(text::history::step(at, name));
                    if at > *taken {
                        row = row.weak();
                    }
                    let row = ui.selectable_label(at == *taken, row);
                    if row.clicked() {
                        chosen = Some(at);
                    }
                }
            });
        });
        if let Some(at) = chosen {
            commands.push(AppCommand::GoSteps(at as i32 - *taken as i32));
        }
        self.windows.history.open &=
            !overlay_windows::escape_closes(ctx, shown.as_ref().map(|shown| &shown.response));
    }

    /// Goes the given number of steps forward, or back if it is negative.
    pub(crate) fn go_steps(&mut self, steps: i32, ctx: &egui::Context) {
        // Only the last step shows a message.
        for _ in 1..steps.unsigned_abs() {
            self.take_step(steps < 0, ctx);
        }
        if steps != 0 {
            self.undo_or_redo(steps < 0, ctx);
        }
    }

    /// Takes one step back or forward and shows it in the status bar.
    pub(super) fn undo_or_redo(&mut self, is_back: bool, ctx: &egui::Context) {
        let what = self.document.history.describe_next(&self.document.history_step(), is_back);
        self.take_step(is_back, ctx);
        if let Some(what) = what {
            let words = text::messages::undone(is_back, &what);
            if self.layout.picture_only {
                // Without panels there is no status bar.
                self.messages.note(words.clone());
            } else {
                self.messages.note_step(&words);
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
