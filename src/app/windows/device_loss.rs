//! Dialog after repeated loss of the graphics device, which asks how to go on.

use eframe::egui;

use crate::app::text;

/// Choice of the user after a repeated device loss.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum DeviceLossAnswer {
    /// Continue with the same settings.
    TryAgain,
    /// Continue at the quality level that demands least of the device.
    LowerQuality,
    /// Continue on the CPU adapter (software driver).
    UseCpu,
    /// Quit; the look has been saved.
    Quit,
}

/// State of the dialog: open or closed.
#[derive(Debug, Default)]
pub(crate) struct DeviceLossDialog {
    is_open: bool,
}

impl DeviceLossDialog {
    /// Opens the dialog from the next frame on.
    pub(crate) fn open(&mut self) {
        self.is_open = true;
    }

    /// Returns true while the dialog waits for an answer.
    pub(crate) fn is_open(&self) -> bool {
        self.is_open
    }

    /// Shows the dialog while it is open, and returns the answer once.
    pub(crate) fn ui(&mut self, ctx: &egui::Context, is_cpu: bool) -> Option<DeviceLossAnswer> {
        if !self.is_open {
            return None;
        }
        let mut answer = None;
        let window = egui::Window::new(text::messages::DEVICE_LOST_AGAIN).collapsible(false).resizable(false);
        window.anchor(egui::Align2::CENTER_CENTER, egui::Vec2::ZERO).show(ctx, |ui| {
            ui.label(text::messages::LOST_AGAIN_WHY);
            ui.horizontal(|ui| {
                for (name, choice) in [
                    (text::messages::TRY_AGAIN, DeviceLossAnswer::TryAgain),
                    (text::messages::LOWER_QUALITY, DeviceLossAnswer::LowerQuality),
                    (text::messages::USE_CPU, DeviceLossAnswer::UseCpu),
                    (text::commands::QUIT, DeviceLossAnswer::Quit),
                ] {
                    let is_offered = choice != DeviceLossAnswer::UseCpu || !is_cpu;
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
