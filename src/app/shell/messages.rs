//! What went wrong, or went well, in the status bar; details on click, never in the way.
//!
//! The bar is always there, so that a message does not change the size of the picture.

use eframe::egui::{self, RichText};

use crate::app::common::frame;
use crate::app::common::theme;
use crate::app::text;
use crate::data::{plain, without_controls};

/// How long a note stays; errors stay until they are dismissed.
const NOTE_S: f64 = 5.0;

/// Characters of a message in the bar: more than the widest screen shows.
const LONGEST_SHORT: usize = 500;

/// Characters of the details: two long paths, and what is said of them.
const LONGEST_DETAILS: usize = 10_000;

/// A message to the user.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Message {
    short: String,
    details: String,
    is_error: bool,
}

impl Message {
    /// What is said in a row: what happened, and the first reason for it.
    fn words(&self) -> String {
        match self.details.lines().next().map(str::trim) {
            Some(reason) if !reason.is_empty() => format!("{}: {reason}", self.short),
            _ => self.short.clone(),
        }
    }
}

/// The latest message and the errors so far.
#[derive(Debug, Default)]
pub(crate) struct Messages {
    current: Option<Message>,
    expanded: bool,
    /// When the note goes, in seconds of the window's clock; set when it is first shown.
    until_s: Option<f64>,
    /// Since the last volume was opened, for automation.
    errors: Vec<String>,
    /// The latest since then, also when it has gone.
    note: Option<String>,
}

impl Messages {
    /// Something went wrong.
    pub(crate) fn error(&mut self, short: impl Into<String>, details: impl Into<String>) {
        let (short, details) = (short.into(), details.into());
        log::error!("{short}: {details}");
        self.errors.push(plain(&short, LONGEST_SHORT));
        self.show(Message { short, details, is_error: true });
    }

    /// Something worth knowing.
    pub(crate) fn note(&mut self, short: impl Into<String>) {
        let short = short.into();
        self.note = Some(plain(&short, LONGEST_SHORT));
        self.show(Message { short, details: String::new(), is_error: false });
    }

    fn show(&mut self, Message { short, details, is_error }: Message) {
        // Names and errors come from files, and a label of any length takes as long to lay out.
        let short = plain(&short, LONGEST_SHORT);
        let details = without_controls(&details).chars().take(LONGEST_DETAILS).collect();
        self.expanded = false;
        self.until_s = None;
        self.current = Some(Message { short, details, is_error });
    }

    /// A new volume is there: what was said before is over.
    pub(crate) fn clear(&mut self) {
        *self = Self::default();
    }

    /// What is being said is over; what went wrong stays known.
    pub(crate) fn dismiss(&mut self) {
        self.current = None;
    }

    /// Errors so far.
    pub(crate) fn errors(&self) -> &[String] {
        &self.errors
    }

    /// The latest note, which may be over.
    pub(crate) fn latest_note(&self) -> Option<&str> {
        self.note.as_deref()
    }

    /// Shows the message in a row from the right to the left, if there is anything to say; whether there is.
    pub(crate) fn ui(&mut self, ui: &mut egui::Ui) -> bool {
        let Some(message) = &self.current else { return false };
        let now_s = ui.input(|input| input.time);
        let mut over = false;
        if !message.is_error {
            let until_s = *self.until_s.get_or_insert(now_s + NOTE_S);
            over = now_s >= until_s;
            ui.request_repaint_after(std::time::Duration::from_secs_f64((until_s - now_s).max(0.0)));
        }
        let color = if message.is_error { ui.visuals().error_fg_color } else { theme::accent(ui.visuals()) };
        over |= ui.small_button(text::messages::DISMISS).clicked();
        if !message.details.is_empty() && ui.small_button(text::messages::DETAILS).clicked() {
            self.expanded ^= true;
        }
        // What is left of the row is the message's, which is cut rather than its buttons.
        ui.with_layout(egui::Layout::left_to_right(egui::Align::Center), |ui| {
            ui.separator();
            let words = message.words();
            let label = egui::Label::new(RichText::new(&words).color(color)).truncate();
            ui.add(label).on_hover_text(&words);
        });
        if self.expanded {
            let above_bar = egui::vec2(8.0, -36.0);
            let shown = egui::Window::new(text::messages::WHAT_HAPPENED)
                .open(&mut self.expanded)
                .collapsible(false)
                .anchor(egui::Align2::LEFT_BOTTOM, above_bar)
                .show(ui.ctx(), |ui| ui.label(&message.details));
            self.expanded &= !frame::is_left(ui.ctx(), shown.as_ref().map(|shown| &shown.response));
        }
        if over {
            self.current = None;
        }
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn foreign_words_are_harmless_and_short() {
        let mut messages = Messages::default();
        messages.error("a\u{1b}[2J\nb".to_owned() + &"x".repeat(1 << 20), "c\u{202e}\n".repeat(1 << 20));
        let Message { short, details, .. } = messages.current.clone().unwrap();
        assert!(short.starts_with("a·[2J·bxx") && details.starts_with("c·\nc·\n"), "{short} {details}");
        let length = |text: &str| text.chars().count();
        // One more says that it was cut.
        assert_eq!((length(&short), length(&details)), (LONGEST_SHORT + 1, LONGEST_DETAILS));
        assert_eq!(messages.errors(), [short]);
        let said = |details: &str| {
            let details = details.to_owned();
            Message { short: "not exported".to_owned(), details, is_error: true }.words()
        };
        assert_eq!(said(""), "not exported");
        assert_eq!(said("/a/b.png: no such folder\nmore"), "not exported: /a/b.png: no such folder");
    }
}
