//! Dialog that asks before a look from outside opens a volume that the user has never opened.

use std::path::PathBuf;

use eframe::egui;

use crate::app::common::overlay_windows;
use crate::app::text;
use chiaroscuro_files::sanitised;
use chiaroscuro_scene::LookRecord;

/// Longest path that is shown, in characters: the user must see all of it.
const MAX_PATH_CHARS: usize = 4096;

/// Answer of the user to the dialog.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum UntrustedPathAnswer {
    /// Open the volume that the look names.
    Open,
    /// Ask for another file instead.
    ChooseOther,
    /// Apply the look without its volume.
    LookOnly,
}

/// Look whose volume is not opened without asking.
#[derive(Debug)]
struct UntrustedPath {
    record: LookRecord,
    /// Path that can be opened; `None` if it is never opened.
    path: Option<PathBuf>,
    /// Path as the look names it, made printable, and the reason for asking.
    displayed_path: String,
    reason: &'static str,
}

/// State of the dialog; empty while it is closed.
#[derive(Debug, Default)]
pub(crate) struct UntrustedPathDialog {
    pending: Option<UntrustedPath>,
}

impl UntrustedPathDialog {
    /// Asks whether to open a file for a look.
    pub(crate) fn open(&mut self, path: PathBuf, record: LookRecord) {
        let shown = sanitised(&path.to_string_lossy(), MAX_PATH_CHARS);
        self.pending = Some(UntrustedPath {
            record,
            path: Some(path),
            displayed_path: shown,
            reason: text::foreign_path::OUTSIDE,
        });
    }

    /// Shows that a path named by a look is never opened.
    pub(crate) fn open_refused(&mut self, named: &str, why: &'static str, record: LookRecord) {
        self.pending = Some(UntrustedPath {
            record,
            path: None,
            displayed_path: sanitised(named, MAX_PATH_CHARS),
            reason: why,
        });
    }

    /// Takes the look and the path of its volume, and closes the dialog.
    pub(crate) fn close(&mut self) -> Option<(LookRecord, Option<PathBuf>)> {
        self.pending.take().map(|asked| (asked.record, asked.path))
    }

    /// Shows the dialog, if it is open, and returns the user's answer.
    pub(crate) fn ui(&self, ctx: &egui::Context) -> Option<UntrustedPathAnswer> {
        let asked = self.pending.as_ref()?;
        let (mut open, mut answer) = (true, None);
        let window = egui::Window::new(text::foreign_path::TITLE).open(&mut open);
        let window = window.constrain_to(overlay_windows::window_area(ctx));
        let window = window.collapsible(false).resizable(false).default_pos([140.0, 90.0]);
        let shown = window.show(ctx, |ui| {
            ui.set_max_width(420.0);
            ui.label(asked.reason);
            ui.add(egui::Label::new(egui::RichText::new(&asked.displayed_path).monospace()).wrap());
            ui.horizontal(|ui| {
                let mut button = |words: &str, given: UntrustedPathAnswer| {
                    if ui.button(words).clicked() {
                        answer = Some(given);
                    }
                };
                if asked.path.is_some() {
                    button(text::foreign_path::OPEN, UntrustedPathAnswer::Open);
                }
                button(text::foreign_path::CHOOSE, UntrustedPathAnswer::ChooseOther);
                button(text::foreign_path::NOT_NOW, UntrustedPathAnswer::LookOnly);
            });
        });
        open &= !overlay_windows::escape_closes(ctx, shown.as_ref().map(|shown| &shown.response));
        answer.or_else(|| (!open).then_some(UntrustedPathAnswer::LookOnly))
    }
}
