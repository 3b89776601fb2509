//! History window: the list of undo steps with their changes; a click goes to a step.

use eframe::egui;

use super::{History, Step};
use crate::app::common::commands::Command;
use crate::app::common::frame;
use crate::app::{App, text};

/// Descriptions of all steps, the oldest first, and the number of steps that are done, 0 at the start.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Steps {
    pub names: Vec<String>,
    pub taken: usize,
}

/// Cached list, and the step for which it was made.
#[derive(Debug, Default)]
pub(crate) struct Listed {
    /// True while the window is open.
    pub open: bool,
    of: Option<Step>,
    steps: Steps,
}

impl History {
    /// Lists all undo and redo steps around `now`.
    pub(super) fn steps(&self, now: &Step) -> Steps {
        let names = |is_back: bool| {
            // A step is known only by taking it, here on a copy.
            let mut history = Self { undoer: self.undoer.clone(), went: None };
            let (mut at, mut names) = (now.clone(), Vec::new());
            while if is_back { history.can_undo(&at) } else { history.can_redo(&at) } {
                let before = at.clone();
                let changed = if is_back {
                    history.undo(&mut at);
                    text::changes::of(&at.settings, &before.settings)
                } else {
                    history.redo(&mut at);
                    text::changes::of(&before.settings, &at.settings)
                };
                names.push(changed.unwrap_or_else(|| text::changes::KIND_OF_DATA.to_owned()));
            }
            names
        };
        let mut all = names(true);
        all.reverse();
        let taken = all.len();
        all.extend(names(false));
        Steps { names: all, taken }
    }
}

impl App {
    /// Shows the history window, if it is open.
    pub(in crate::app) fn history_list(&mut self, ctx: &egui::Context, commands: &mut Vec<Command>) {
        if !self.listed.open {
            self.listed.of = None;
            return;
        }
        let now = self.step();
        // Listing takes every step: not during a drag, which is no step yet.
        let is_new = self.listed.of.is_none() || ctx.dragged_id().is_none();
        if is_new && self.listed.of.as_ref() != Some(&now) {
            self.listed.steps = self.history.steps(&now);
            self.listed.of = Some(now);
        }
        let Steps { names, taken } = &self.listed.steps;
        let window = egui::Window::new(text::history::TITLE).open(&mut self.listed.open).collapsible(false);
        let window =
            window.default_size([260.0, 320.0]).default_pos([40.0, 80.0]).constrain_to(frame::room(ctx));
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
            commands.push(Command::GoSteps(at as i32 - *taken as i32));
        }
        self.listed.open &= !frame::is_left(ctx, shown.as_ref().map(|shown| &shown.response));
    }

    /// Goes the given number of steps forward, or back if it is negative.
    pub(in crate::app) fn go_steps(&mut self, steps: i32, ctx: &egui::Context) {
        // Only the last step shows a message.
        for _ in 1..steps.unsigned_abs() {
            self.take_step(steps < 0, ctx);
        }
        if steps != 0 {
            self.go(steps < 0, ctx);
        }
    }
}
