//! History window: the list of undo steps with their changes.

use eframe::egui;

use crate::app::common::commands::AppCommand;
use crate::app::common::overlay_windows;
use crate::app::document::Document;
use crate::app::document::history::{HistoryStep, HistorySteps};
use crate::app::text;

/// Cached list, and the step for which it was made.
#[derive(Debug, Default)]
pub(crate) struct HistoryWindow {
    /// True while the window is open.
    pub open: bool,
    listed_for: Option<HistoryStep>,
    steps: HistorySteps,
}

impl HistoryWindow {
    /// Shows the window, if it is open.
    pub(crate) fn show(&mut self, ctx: &egui::Context, document: &Document, commands: &mut Vec<AppCommand>) {
        if !self.open {
            self.listed_for = None;
            return;
        }
        let now = document.history_step();
        // Listing takes every step: not during a drag, which is no step yet.
        let is_new = self.listed_for.is_none() || ctx.dragged_id().is_none();
        if is_new && self.listed_for.as_ref() != Some(&now) {
            self.steps = document.history.list_steps(&now);
            self.listed_for = Some(now);
        }
        let HistorySteps { names, current: taken } = &self.steps;
        let window = egui::Window::new(text::history::TITLE).open(&mut self.open).collapsible(false);
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
        self.open &= !overlay_windows::escape_closes(ctx, shown.as_ref().map(|shown| &shown.response));
    }
}
