//! Kept views and looks: the strip of thumbnails below the picture, and the commands on its items.

mod strip;
mod thumbnails;

use eframe::egui;

pub(crate) use self::strip::KeptStrip;
use super::App;
use super::common::commands::AppCommand;
use crate::app::text;
use chiaroscuro_scene::{
    Camera, ComparisonVariant, ObjectRotation, SavedContent, SavedEntry, SavedLook, Settings,
};

/// Returns the first numbered name that no kept item has.
fn free_name(settings: &Settings, name: impl Fn(usize) -> String) -> String {
    let is_taken = |wanted: &str| settings.kept.iter().any(|kept| kept.name == wanted);
    // Of n + 1 names, at least one is not among n kept items.
    (1..=settings.kept.len() + 1).map(name).find(|name| !is_taken(name)).unwrap_or_default()
}

impl App {
    /// Keeps the current view (camera) under a new name.
    pub(crate) fn keep_current_view(&mut self) {
        let name = free_name(&self.settings, text::saved_views::view_name);
        self.add_kept_item(SavedEntry::view(name, &self.settings.camera));
    }

    /// Keeps the current look (all settings) under a new name.
    pub(crate) fn keep_current_look(&mut self) {
        let name = free_name(&self.settings, text::saved_views::look_name);
        self.add_kept_item(SavedEntry::look(name, &self.settings));
    }

    fn add_kept_item(&mut self, kept: SavedEntry) {
        let note = text::saved_views::saved(&kept.name);
        let fits = self.settings.save_entry(kept);
        self.report_kept_item(fits, note);
    }

    /// Keeps the current view under a digit key.
    pub(crate) fn keep_view_under(&mut self, digit: u8) {
        let name = free_name(&self.settings, |number| {
            // Named after its digit, if that name is free.
            text::saved_views::view_name(if number == 1 { digit.into() } else { number })
        });
        let has_room = self.settings.save_view_for_digit(digit, name);
        self.report_kept_item(has_room, text::saved_views::view_saved(digit));
    }

    fn report_kept_item(&mut self, has_room: bool, note: String) {
        if has_room {
            self.layout.kept = true;
            self.messages.note(note);
        } else {
            self.messages.error(text::saved_views::TOO_MANY, String::new());
        }
    }

    /// Goes to the item kept under a digit, or notes that there is none.
    pub(crate) fn apply_kept_digit(&mut self, digit: u8, ctx: &egui::Context) {
        match self.settings.kept.iter().position(|kept| kept.digit == Some(digit)) {
            Some(index) => self.apply_kept_item(index, false, ctx),
            None => self.messages.note(text::saved_views::digit_is_empty(digit)),
        }
    }

    /// Applies a kept item: a view moves the camera; a look changes the settings, and also the camera if `with_view`.
    pub(crate) fn apply_kept_item(&mut self, at: usize, with_view: bool, ctx: &egui::Context) {
        let Some(kept) = self.settings.kept.get(at).cloned() else { return };
        if let Some(look) = kept.as_look() {
            self.settings = self.settings.with_saved_look(look);
            self.keep_balanced.accept(&self.settings);
        }
        if with_view || kept.as_look().is_none() {
            self.move_camera_to(kept.camera(), AppCommand::GoToSaved(at, with_view), ctx);
        }
    }

    /// Moves the camera to a kept view. If the object stands another way up in it, the room is turned first.
    fn move_camera_to(&mut self, camera: &Camera, command: AppCommand, ctx: &egui::Context) {
        if camera.up != self.settings.camera.up {
            if !self.ensure_first_look_up_axis(camera.up, Some(command), ctx) {
                return;
            }
            self.settings.rotate_object(ObjectRotation::MakeUpright(camera.up));
            self.settings.floor.height = self.defaults.floor.height;
        }
        self.settings.camera.clone_from(camera);
    }

    /// Replaces a kept item by the current view or look, keeping its name.
    pub(crate) fn replace_kept_item(&mut self, at: usize) {
        let Some(kept) = self.settings.kept.get(at) else { return };
        let what = match kept.what {
            SavedContent::View(_) => SavedContent::View(self.settings.camera.clone()),
            SavedContent::Look(_) => SavedContent::Look(SavedLook::new(&self.settings)),
        };
        if !self.settings.replace_saved(at, what) {
            self.messages.error(text::saved_views::TOO_MANY, String::new());
        }
    }

    /// Compares two views or looks on either side of a divider: two kept ones, or the current picture (`None`) and a
    /// kept one.
    pub(crate) fn compare_kept_items(&mut self, left: Option<usize>, right: usize) {
        let variant = |at: usize| {
            self.settings.kept.get(at).map(|kept| match kept.as_look() {
                Some(look) => ComparisonVariant::Look(Box::new(look.clone())),
                None => ComparisonVariant::View(Box::new(kept.camera().clone())),
            })
        };
        let name = |at: usize| self.settings.kept.get(at).map(|kept| kept.name.clone());
        let names = [left.and_then(name), name(right)];
        let left = match left {
            Some(at) => variant(at),
            None => Some(ComparisonVariant::Current),
        };
        if let Some((left, right)) = left.zip(variant(right)) {
            (self.compare.on, self.compare.left, self.compare.right) = (true, left, right);
            self.compare.names = names;
        }
    }

    /// Shows the strip of kept items, if it is visible and a volume is open.
    pub(crate) fn show_kept_strip(&mut self, ui: &mut egui::Ui, commands: &mut Vec<AppCommand>) {
        self.render_missing_thumbnails(ui.ctx());
        if self.layout.kept && self.volume.is_some() {
            self.kept_strip.show(ui, &mut self.settings, commands);
        }
    }

    /// Renders missing thumbnails of kept items while nothing else is being computed.
    fn render_missing_thumbnails(&mut self, ctx: &egui::Context) {
        self.kept_strip.thumbnails.collect(ctx);
        if !self.layout.kept {
            return;
        }
        let id = self.viewport.dataset().map(|dataset| dataset.volume().content_id());
        let Some(wanted) = self.kept_strip.thumbnails.missing(&self.settings, id) else { return };
        if self.is_complete()
            && !self.export.is_busy()
            && let Some(subject) = self.export_subject()
            && let Err(err) = self.kept_strip.thumbnails.start(wanted, subject, ctx)
        {
            log::warn!("thumbnails of saved views and looks cannot be rendered: {err}");
        }
    }
}
