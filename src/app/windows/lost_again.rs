//! Asks how to go on when the graphics device was lost again soon after it was lost.

use eframe::egui;

use crate::app::text;

/// How to go on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Answer {
    /// As before.
    TryAgain,
    /// With the level of quality that asks least of the device.
    LowerQuality,
    /// On the adapter that is the CPU.
    UseCpu,
    /// Not at all; the look is kept.
    Quit,
}

/// The window that asks.
#[derive(Debug, Default)]
pub(crate) struct LostAgain {
    is_open: bool,
}

impl LostAgain {
    /// Asks from now on.
    pub(crate) fn ask(&mut self) {
        self.is_open = true;
    }

    /// Shows the window while the question is open. Gives the answer, once.
    pub(crate) fn ui(&mut self, ctx: &egui::Context, is_cpu: bool) -> Option<Answer> {
        if !self.is_open {
            return None;
        }
        let mut answer = None;
        let window = egui::Window::new(text::messages::LOST_AGAIN).collapsible(false).resizable(false);
        window.anchor(egui::Align2::CENTER_CENTER, egui::Vec2::ZERO).show(ctx, |ui| {
            ui.label(text::messages::LOST_AGAIN_WHY);
            ui.horizontal(|ui| {
                for (name, choice) in [
                    (text::messages::TRY_AGAIN, Answer::TryAgain),
                    (text::messages::LOWER_QUALITY, Answer::LowerQuality),
                    (text::messages::USE_CPU, Answer::UseCpu),
                    (text::commands::QUIT, Answer::Quit),
                ] {
                    let is_offered = choice != Answer::UseCpu || !is_cpu;
                    if is_offered && ui.button(name).clicked() {
                        answer = Some(choice);
                    }
                }
            });
        });
        self.is_open = answer.is_none();
        answer
    }
}
