//! History window: the list of undo steps with their changes; a click goes to a step.

use eframe::egui;

use super::{History, HistoryStep};
use crate::app::common::commands::AppCommand;
use crate::app::common::overlay_windows;
use crate::app::{App, text};

/// Descriptions of all steps, the oldest first, and the number of steps that are done, 0 at the start.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct HistorySteps {
    pub names: Vec<String>,
    pub current: usize,
}

/// Cached list, and the step for which it was made.
#[derive(Debug, Default)]
pub(crate) struct HistoryWindow {
    /// True while the window is open.
    pub open: bool,
    listed_for: Option<HistoryStep>,
    steps: HistorySteps,
}

impl History {
    /// Lists all undo and redo steps around `now`.
    pub(super) fn list_steps(&self, now: &HistoryStep) -> HistorySteps {
        let names = |is_back: bool| {
            // A step is known only by taking it, here on a copy.
            let mut history = Self { undoer: self.undoer.clone(), last_step: None };
            let (mut at, mut names) = (now.clone(), Vec::new());
            while if is_back { history.can_undo(&at) } else { history.can_redo(&at) } {
                let before = at.clone();
                let changed = if is_back {
                    history.undo(&mut at);
                    text::change_descriptions::describe_change(&at.settings, &before.settings)
                } else {
                    history.redo(&mut at);
                    text::change_descriptions::describe_change(&before.settings, &at.settings)
                };
                names.push(changed.unwrap_or_else(|| text::change_descriptions::KIND_OF_DATA.to_owned()));
            }
            names
        };
        let mut all = names(true);
        all.reverse();
        let taken = all.len();
        all.extend(names(false));
        HistorySteps { names: all, current: taken }
    }
}

impl App {
    /// Shows the history window, if it is open.
    pub(crate) fn show_history(&mut self, ctx: &egui::Context, commands: &mut Vec<AppCommand>) {
        if !self.history_list.open {
            self.history_list.listed_for = None;
            return;
        }
        let now = self.history_step();
        // Listing takes every step: not during a drag, which is no step yet.
        let is_new = self.history_list.listed_for.is_none() || ctx.dragged_id().is_none();
        if is_new && self.history_list.listed_for.as_ref() != Some(&now) {
            self.history_list.steps = self.history.list_steps(&now);
            self.history_list.listed_for = Some(now);
        }
        let HistorySteps { names, current: taken } = &self.history_list.steps;
        let window =
            egui::Window::new(text::history::TITLE).open(&mut self.history_list.open).collapsible(false);
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
        self.history_list.open &=
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
}
