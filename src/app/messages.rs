//! The line at the bottom that says what went wrong; details on click, never in the way.

use eframe::egui::{self, RichText};

use super::theme;

/// A message to the user.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Message {
    short: String,
    details: String,
    is_error: bool,
}

/// The latest message and the errors so far.
#[derive(Debug, Default)]
pub(super) struct Messages {
    current: Option<Message>,
    expanded: bool,
    /// Since the last volume was opened, for automation.
    errors: Vec<String>,
}

impl Messages {
    /// Something went wrong.
    pub(super) fn error(&mut self, short: impl Into<String>, details: impl Into<String>) {
        let (short, details) = (short.into(), details.into());
        log::error!("{short}: {details}");
        self.errors.push(short.clone());
        self.show(Message { short, details, is_error: true });
    }

    /// Something worth knowing.
    pub(super) fn note(&mut self, short: impl Into<String>) {
        self.show(Message { short: short.into(), details: String::new(), is_error: false });
    }

    fn show(&mut self, message: Message) {
        self.expanded = false;
        self.current = Some(message);
    }

    /// A new volume is there: what was said before is over.
    pub(super) fn clear(&mut self) {
        *self = Self::default();
    }

    /// Errors so far.
    pub(super) fn errors(&self) -> &[String] {
        &self.errors
    }

    /// Shows the line, if there is anything to say.
    pub(super) fn ui(&mut self, ui: &mut egui::Ui) {
        let Some(message) = &self.current else { return };
        let mut closed = false;
        egui::Panel::bottom("message").resizable(false).show(ui, |ui| {
            ui.horizontal(|ui| {
                let color = if message.is_error { ui.visuals().error_fg_color } else { theme::ACCENT };
                ui.label(RichText::new(&message.short).color(color));
                if !message.details.is_empty() && ui.small_button("Details").clicked() {
                    self.expanded ^= true;
                }
                closed = ui.small_button("Dismiss").clicked();
            });
            if self.expanded {
                ui.label(&message.details);
            }
        });
        if closed {
            self.current = None;
        }
    }
}
