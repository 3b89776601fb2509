//! Crash recovery dialog, which offers the autosaved looks of runs that crashed.

use std::path::PathBuf;
use std::time::SystemTime;

use eframe::egui::{self, TextureHandle, TextureOptions, vec2};

use crate::app::common::frame;
use crate::app::memory::EarlierRun;
use crate::app::text;

/// Longer edge of a thumbnail, in points.
const EDGE: f32 = 128.0;

/// Look of a crashed run that is offered.
struct Offer {
    look: PathBuf,
    name: String,
    picture: Option<TextureHandle>,
}

/// Answer of the user to the dialog.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Answer {
    /// Restore the look in this file.
    GoOn(PathBuf),
    /// Restore none of the looks.
    NotNow,
}

/// State of the dialog, which is open while there are offers.
#[derive(Default)]
pub(crate) struct Recovery {
    offers: Vec<Offer>,
}

impl Recovery {
    /// Creates the dialog with the looks of all runs that crashed.
    pub(crate) fn of(runs: &[EarlierRun], ctx: &egui::Context) -> Self {
        let crashed = runs.iter().filter(|run| run.crashed);
        let offers = crashed.map(|run| Offer {
            look: run.look.clone(),
            name: name(run),
            picture: run
                .picture()
                .map(|picture| ctx.load_texture("earlier look", picture, TextureOptions::LINEAR)),
        });
        Self { offers: offers.collect() }
    }

    /// Returns true while the dialog waits for an answer.
    pub(crate) fn asks(&self) -> bool {
        !self.offers.is_empty()
    }

    /// Shows the dialog while there are offers, and returns the answer once.
    pub(crate) fn ui(&mut self, ctx: &egui::Context) -> Option<Answer> {
        if self.offers.is_empty() {
            return None;
        }
        let mut answer = None;
        let mut open = true;
        let window = egui::Window::new(text::memory::ENDED_BADLY).open(&mut open);
        let window = window.collapsible(false).resizable(false);
        let window = window.pivot(egui::Align2::CENTER_CENTER).default_pos(ctx.content_rect().center());
        let window = window.constrain_to(frame::room(ctx));
        window.show(ctx, |ui| {
            ui.label(text::memory::ENDED_BADLY_WHY);
            for offer in &self.offers {
                ui.separator();
                ui.horizontal(|ui| {
                    if let Some(picture) = &offer.picture {
                        let size = vec2(EDGE, EDGE).min(picture.size_vec2());
                        ui.add(egui::Image::new(picture).fit_to_exact_size(size).corner_radius(4));
                    }
                    ui.vertical(|ui| {
                        ui.label(&offer.name);
                        if ui.button(text::memory::GO_ON).clicked() {
                            answer = Some(Answer::GoOn(offer.look.clone()));
                        }
                    });
                });
            }
            ui.separator();
            if ui.button(text::memory::NOT_NOW).on_hover_text(text::memory::NOT_NOW_TIP).clicked() {
                answer = Some(Answer::NotNow);
            }
        });
        if !open || ctx.input(|input| input.key_pressed(egui::Key::Escape)) {
            answer = Some(Answer::NotNow);
        }
        if answer.is_some() {
            self.offers.clear();
        }
        answer
    }
}

/// Name of an earlier run in a list: its source, and how long ago it ended.
pub(crate) fn name(run: &EarlierRun) -> String {
    let ago = SystemTime::now().duration_since(run.when).unwrap_or_default();
    text::memory::earlier_look(&run.source, ago)
}
