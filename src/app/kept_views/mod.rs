//! Kept views and looks in the window: the strip of thumbnails below the picture, and the commands on its items.

mod strip;
mod thumbnails;

use eframe::egui;

pub(crate) use self::strip::KeptStrip;
use super::App;
use super::common::commands::AppCommand;
use super::viewport::compare::Compare;
use crate::app::text;
use chiaroscuro_scene::{ComparisonVariant, Settings};

/// Compares two views or looks on either side of a divider: two kept ones, or the current picture (`None`) and a kept
/// one.
pub(crate) fn compare_kept_items(
    compare: &mut Compare,
    settings: &Settings,
    left: Option<usize>,
    right: usize,
) {
    let variant = |at: usize| {
        settings.kept.get(at).map(|kept| match kept.as_look() {
            Some(look) => ComparisonVariant::Look(Box::new(look.clone())),
            None => ComparisonVariant::View(Box::new(kept.camera().clone())),
        })
    };
    let name = |at: usize| settings.kept.get(at).map(|kept| kept.name.clone());
    let names = [left.and_then(name), name(right)];
    let left = match left {
        Some(at) => variant(at),
        None => Some(ComparisonVariant::Current),
    };
    if let Some((left, right)) = left.zip(variant(right)) {
        (compare.on, compare.left, compare.right) = (true, left, right);
        compare.names = names;
    }
}

impl App {
    /// Shows the strip after an item was saved, and its note; or that there was no room for it.
    pub(crate) fn report_kept_item(&mut self, note: Option<String>) {
        if let Some(note) = note {
            self.layout.kept = true;
            self.messages.note(note);
        } else {
            self.messages.error(text::saved_views::TOO_MANY, String::new());
        }
    }

    /// Goes to the item kept under a digit, or notes that there is none.
    pub(crate) fn apply_kept_digit(&mut self, digit: u8, ctx: &egui::Context) {
        match self.document.saved_index_of_digit(digit) {
            Some(index) => self.apply_kept_item(index, false, ctx),
            None => self.messages.note(text::saved_views::digit_is_empty(digit)),
        }
    }

    /// Applies a kept item; see [`Document::apply_saved_item`](super::document::Document::apply_saved_item).
    pub(crate) fn apply_kept_item(&mut self, at: usize, with_view: bool, ctx: &egui::Context) {
        let applied = self.document.apply_saved_item(at, with_view, self.viewport.dataset(), ctx);
        self.messages.report(text::messages::TURN_FAILED, applied);
    }

    /// Shows the strip of kept items, if it is visible and a volume is open.
    pub(crate) fn show_kept_strip(&mut self, ui: &mut egui::Ui, commands: &mut Vec<AppCommand>) {
        self.render_missing_thumbnails(ui.ctx());
        if self.layout.kept && self.document.volume.is_some() {
            self.panels.kept_strip.show(ui, &mut self.document.settings, commands);
        }
    }

    /// Renders missing thumbnails of kept items while nothing else is being computed.
    fn render_missing_thumbnails(&mut self, ctx: &egui::Context) {
        self.panels.kept_strip.thumbnails.collect(ctx);
        if !self.layout.kept {
            return;
        }
        let id = self.viewport.dataset().map(|dataset| dataset.volume().content_id());
        let Some(wanted) = self.panels.kept_strip.thumbnails.missing(&self.document.settings, id) else {
            return;
        };
        if self.is_complete()
            && !self.windows.export.is_busy()
            && let Some(subject) = self.export_subject()
            && let Err(err) = self.panels.kept_strip.thumbnails.start(wanted, subject, ctx)
        {
            log::warn!("thumbnails of saved views and looks cannot be rendered: {err}");
        }
    }
}
