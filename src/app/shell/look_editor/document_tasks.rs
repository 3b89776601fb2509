//! Tasks of the document on threads (turned and corrected objects, looks for other kinds of data, outlines): their
//! results reach the viewport, and their errors the messages.

use eframe::egui;

use super::LookEditor;
use super::automatic_changes::LookTasks;
use crate::app::common::commands::AppCommand;
use crate::app::text;

impl LookEditor {
    /// Returns true if the first look has the up axis of the settings, wherever these come from. Otherwise it is
    /// turned, and `then` is executed afterwards.
    pub(crate) fn ensure_first_look_up(&mut self, then: Option<AppCommand>, ctx: &egui::Context) -> bool {
        let is_up = self.document.ensure_first_look_up(then, self.viewport.dataset(), ctx);
        self.messages.report(text::messages::TURN_FAILED, is_up)
    }

    /// Returns true if a command that needs the outline can run; otherwise it is queued until the outline is known.
    pub(super) fn can_frame(&mut self, command: AppCommand, ctx: &egui::Context) -> bool {
        self.document.can_frame(command, self.viewport.dataset(), ctx)
    }

    /// Takes over the framed first look from its thread. Returns the commands that have waited for it.
    pub(crate) fn finish_framing(&mut self) -> Vec<AppCommand> {
        let (commands, result) = self.document.finish_framing(&mut self.memory);
        self.messages.report(text::messages::TURN_FAILED, result);
        commands
    }

    /// Takes over an outline from its thread, and starts a search when the window is idle and the look has changed.
    /// Returns the command that has waited for the outline; `is_opening` is true while a file is opened or read.
    pub(crate) fn update_outline(&mut self, is_opening: bool, ctx: &egui::Context) -> Option<AppCommand> {
        self.document.take_outline();
        let dataset = self.viewport.dataset();
        if self.document.knows_outline(dataset.as_ref()) {
            return self.document.take_waiting_command();
        }
        if self.document.is_outline_awaited() || (!is_opening && self.is_complete()) {
            self.document.start_outline_search(dataset, ctx);
        }
        None
    }

    /// Takes over the look for another kind of data from its thread.
    pub(crate) fn finish_kind_task(&mut self, ctx: &egui::Context) {
        let is_new = self.document.finish_kind_task(self.viewport.dataset(), ctx);
        if self.messages.report(text::messages::LOOK_NOT_MADE, is_new) {
            self.look_tasks.light_search.discard();
        }
    }

    /// Shows the volumes that the layers name, where layers were removed or an undo brought them back. Returns true if
    /// others were shown.
    pub(crate) fn update_fields(&mut self) -> bool {
        let Some(shown) = self.viewport.dataset() else { return false };
        let Some(dataset) = self.document.update_fields(&shown) else { return false };
        self.viewport.compare.leave_layered_looks();
        self.viewport.set_dataset(dataset);
        true
    }

    /// Starts correcting the volume as the settings say, and shows the result. Returns true if another volume is shown.
    pub(crate) fn update_corrections(&mut self, ctx: &egui::Context) -> bool {
        let now_s = ctx.input(|input| input.time);
        let corrected = self.document.take_corrected(self.viewport.dataset().as_ref(), now_s);
        let corrected = self.messages.report(text::corrections::CORRECTION_FAILED, corrected);
        let is_corrected = corrected.is_some();
        if let Some(dataset) = corrected {
            // Results in progress belong to the volume before.
            self.look_tasks = LookTasks::default();
            self.viewport.set_dataset(dataset);
            ctx.request_repaint();
        }
        if let Some(dataset) = self.viewport.dataset() {
            let started = self.document.start_correction_if_due(dataset, &mut self.memory, ctx);
            self.messages.report(text::corrections::CORRECTION_FAILED, started);
        }
        is_corrected
    }
}
