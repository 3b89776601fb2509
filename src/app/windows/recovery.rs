//! Crash recovery dialog, which offers the autosaved looks of runs that crashed.

use std::path::PathBuf;
use std::time::SystemTime;

use eframe::egui::{self, TextureHandle, TextureOptions, vec2};

use crate::app::common::overlay_windows;
use crate::app::persistence::EarlierRun;
use crate::app::text;

/// Longer edge of a thumbnail, in points.
const THUMBNAIL_EDGE: f32 = 128.0;

/// Look of a crashed run that is offered.
struct RecoveryOffer {
    look: PathBuf,
    name: String,
    picture: Option<TextureHandle>,
}

/// Answer of the user to the dialog.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum RecoveryAnswer {
    /// Restore the look in this file.
    Restore(PathBuf),
    /// Restore none of the looks.
    Dismiss,
}

/// State of the dialog, which is open while there are offers.
#[derive(Default)]
pub(crate) struct RecoveryDialog {
    offers: Vec<RecoveryOffer>,
}

impl RecoveryDialog {
    /// Creates the dialog with the looks of all runs that crashed.
    pub(crate) fn from_runs(runs: &[EarlierRun], ctx: &egui::Context) -> Self {
        let crashed = runs.iter().filter(|run| run.crashed);
        let offers = crashed.map(|run| RecoveryOffer {
            look: run.look.clone(),
            name: run_name(run),
            picture: run
                .picture()
                .map(|picture| ctx.load_texture("earlier look", picture, TextureOptions::LINEAR)),
        });
        Self { offers: offers.collect() }
    }

    /// Returns true while the dialog waits for an answer.
    pub(crate) fn is_open(&self) -> bool {
        !self.offers.is_empty()
    }

    /// Shows the dialog while there are offers, and returns the answer once.
    pub(crate) fn ui(&mut self, ctx: &egui::Context) -> Option<RecoveryAnswer> {
        if self.offers.is_empty() {
            return None;
        }
        let mut answer = None;
        let mut open = true;
        let window = egui::Window::new(text::persistence::RECOVERY_TITLE).open(&mut open);
        let window = window.collapsible(false).resizable(false);
        let window = window.pivot(egui::Align2::CENTER_CENTER).default_pos(ctx.content_rect().center());
        let window = window.constrain_to(overlay_windows::window_area(ctx));
        window.show(ctx, |ui| {
            ui.label(text::persistence::RECOVERY_WHY);
            for offer in &self.offers {
                ui.separator();
                ui.horizontal(|ui| {
                    if let Some(picture) = &offer.picture {
                        let size = vec2(THUMBNAIL_EDGE, THUMBNAIL_EDGE).min(picture.size_vec2());
                        ui.add(egui::Image::new(picture).fit_to_exact_size(size).corner_radius(4));
                    }
                    ui.vertical(|ui| {
                        ui.label(&offer.name);
                        if ui.button(text::persistence::REOPEN).clicked() {
                            answer = Some(RecoveryAnswer::Restore(offer.look.clone()));
                        }
                    });
                });
            }
            ui.separator();
            if ui.button(text::persistence::NOT_NOW).on_hover_text(text::persistence::NOT_NOW_TIP).clicked() {
                answer = Some(RecoveryAnswer::Dismiss);
            }
        });
        if !open || ctx.input(|input| input.key_pressed(egui::Key::Escape)) {
            answer = Some(RecoveryAnswer::Dismiss);
        }
        if answer.is_some() {
            self.offers.clear();
        }
        answer
    }
}

/// Name of an earlier run in a list: its source, and how long ago it ended.
pub(crate) fn run_name(run: &EarlierRun) -> String {
    let ago = SystemTime::now().duration_since(run.when).unwrap_or_default();
    text::persistence::earlier_look(&run.source, ago)
}
