//! Undo and redo of settings.

use eframe::egui;
use eframe::egui::util::undoer::{self, Undoer};

use crate::model::Settings;

/// Seconds without a change after which a step can be undone.
const STABLE_S: f32 = 0.4;

/// The settings as they were.
#[derive(Debug)]
pub(super) struct History {
    undoer: Undoer<Settings>,
}

impl Default for History {
    fn default() -> Self {
        let settings = undoer::Settings { stable_time: STABLE_S, ..undoer::Settings::default() };
        Self { undoer: Undoer::with_settings(settings) }
    }
}

impl History {
    /// Takes note of the settings, except while something is dragged: a drag is one step.
    pub(super) fn observe(&mut self, ctx: &egui::Context, settings: &Settings) {
        if ctx.dragged_id().is_none() {
            self.undoer.feed_state(ctx.input(|input| input.time), settings);
        }
        if self.undoer.is_in_flux() {
            ctx.request_repaint_after(std::time::Duration::from_secs_f32(STABLE_S));
        }
    }

    /// Whether there is a step back.
    pub(super) fn can_undo(&self, settings: &Settings) -> bool {
        self.undoer.has_undo(settings)
    }

    /// Whether there is a step forward.
    pub(super) fn can_redo(&self, settings: &Settings) -> bool {
        self.undoer.has_redo(settings)
    }

    /// One step back.
    pub(super) fn undo(&mut self, settings: &mut Settings) {
        if let Some(before) = self.undoer.undo(settings) {
            settings.clone_from(before);
        }
    }

    /// One step forward again.
    pub(super) fn redo(&mut self, settings: &mut Settings) {
        if let Some(after) = self.undoer.redo(settings) {
            settings.clone_from(after);
        }
    }
}
