//! Dialog that asks before the window closes during an export.

use eframe::egui::{self, ViewportCommand};

use crate::app::text;

/// State of quitting during an export.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
enum Wish {
    /// The user does not want to quit.
    #[default]
    Stay,
    /// The user is being asked.
    Asked,
    /// Quit when the export is done.
    After,
    /// Quit at once, cancelling the export.
    Now,
}

/// State of the dialog for quitting.
#[derive(Debug, Default)]
pub(crate) struct Quit {
    wish: Wish,
}

impl Quit {
    /// Keeps the main window open while an export runs, asks the user, and then closes it. Called in each frame.
    pub(crate) fn ui(&mut self, ctx: &egui::Context, is_exporting: bool) {
        let is_closing = ctx.input(|input| input.viewport().close_requested());
        if is_closing && is_exporting && self.wish != Wish::Now {
            ctx.send_viewport_cmd(ViewportCommand::CancelClose);
            self.wish = Wish::Asked;
        }
        if !is_exporting && std::mem::take(&mut self.wish) == Wish::After {
            ctx.send_viewport_cmd(ViewportCommand::Close);
        }
        if self.wish != Wish::Asked {
            return;
        }
        let window = egui::Window::new(text::memory::EXPORTING).collapsible(false).resizable(false);
        window.anchor(egui::Align2::CENTER_CENTER, egui::Vec2::ZERO).show(ctx, |ui| {
            ui.label(text::memory::EXPORTING_WHY);
            ui.horizontal(|ui| {
                if ui.button(text::memory::STAY).clicked() {
                    self.wish = Wish::Stay;
                }
                if ui.button(text::memory::QUIT_AFTER).clicked() {
                    self.wish = Wish::After;
                }
                if ui.button(text::memory::QUIT_NOW).clicked() {
                    self.wish = Wish::Now;
                    ctx.send_viewport_cmd(ViewportCommand::Close);
                }
            });
        });
        if ctx.input(|input| input.key_pressed(egui::Key::Escape)) {
            self.wish = Wish::Stay;
        }
    }
}
