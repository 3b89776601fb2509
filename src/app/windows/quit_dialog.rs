//! Dialog that asks before the window closes during an export.

use eframe::egui::{self, ViewportCommand};

use crate::app::text;

/// State of quitting during an export.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
enum QuitState {
    /// The user does not want to quit.
    #[default]
    Stay,
    /// The user is being asked.
    Asking,
    /// Quit when the export is done.
    AfterExport,
    /// Quit at once, cancelling the export.
    Immediately,
}

/// State of the dialog for quitting.
#[derive(Debug, Default)]
pub(crate) struct QuitDialog {
    state: QuitState,
}

impl QuitDialog {
    /// Keeps the main window open while an export runs, asks the user, and then closes it. Called in each frame.
    pub(crate) fn ui(&mut self, ctx: &egui::Context, is_exporting: bool) {
        let is_closing = ctx.input(|input| input.viewport().close_requested());
        if is_closing && is_exporting && self.state != QuitState::Immediately {
            ctx.send_viewport_cmd(ViewportCommand::CancelClose);
            self.state = QuitState::Asking;
        }
        if !is_exporting && std::mem::take(&mut self.state) == QuitState::AfterExport {
            ctx.send_viewport_cmd(ViewportCommand::Close);
        }
        if self.state != QuitState::Asking {
            return;
        }
        let window = egui::Window::new(text::persistence::EXPORTING).collapsible(false).resizable(false);
        window.anchor(egui::Align2::CENTER_CENTER, egui::Vec2::ZERO).show(ctx, |ui| {
            ui.label(text::persistence::EXPORTING_WHY);
            ui.horizontal(|ui| {
                if ui.button(text::persistence::STAY).clicked() {
                    self.state = QuitState::Stay;
                }
                if ui.button(text::persistence::QUIT_AFTER).clicked() {
                    self.state = QuitState::AfterExport;
                }
                if ui.button(text::persistence::QUIT_NOW).clicked() {
                    self.state = QuitState::Immediately;
                    ctx.send_viewport_cmd(ViewportCommand::Close);
                }
            });
        });
        if ctx.input(|input| input.key_pressed(egui::Key::Escape)) {
            self.state = QuitState::Stay;
        }
    }
}
