//! Saved views and looks of the document: adding, replacing, and going to them.

use std::io;

use eframe::egui;

use super::Document;
use crate::app::common::commands::AppCommand;
use crate::app::text;
use chiaroscuro_scene::{Camera, ObjectRotation, SavedContent, SavedEntry, SavedLook, Settings};
use chiaroscuro_volume::Dataset;

/// Returns the first numbered name that no saved item has.
fn free_name(settings: &Settings, name: impl Fn(usize) -> String) -> String {
    let is_taken = |wanted: &str| settings.kept.iter().any(|kept| kept.name == wanted);
    // A free name is always found: there is one more candidate than saved items.
    (1..=settings.kept.len() + 1).map(name).find(|name| !is_taken(name)).unwrap_or_default()
}

impl Document {
    /// Saves the current view (camera) under a new name. Returns a note, or `None` if there is no room.
    pub(crate) fn save_current_view(&mut self) -> Option<String> {
        let name = free_name(&self.settings, text::saved_views::view_name);
        self.add_saved_item(SavedEntry::view(name, &self.settings.camera))
    }

    /// Saves the current look (all settings) under a new name. Returns a note, or `None` if there is no room.
    pub(crate) fn save_current_look(&mut self) -> Option<String> {
        let name = free_name(&self.settings, text::saved_views::look_name);
        self.add_saved_item(SavedEntry::look(name, &self.settings))
    }

    fn add_saved_item(&mut self, saved: SavedEntry) -> Option<String> {
        let note = text::saved_views::saved(&saved.name);
        self.settings.save_entry(saved).then_some(note)
    }

    /// Saves the current view under a digit key. Returns a note, or `None` if there is no room.
    pub(crate) fn save_view_under(&mut self, digit: u8) -> Option<String> {
        let name = free_name(&self.settings, |number| {
            // Named after its digit, if that name is free.
            text::saved_views::view_name(if number == 1 { digit.into() } else { number })
        });
        let has_room = self.settings.save_view_for_digit(digit, name);
        has_room.then(|| text::saved_views::view_saved(digit))
    }

    /// Returns the index of the item that is saved under a digit.
    pub(crate) fn saved_index_of_digit(&self, digit: u8) -> Option<usize> {
        self.settings.kept.iter().position(|kept| kept.digit == Some(digit))
    }

    /// Applies a saved item: a view moves the camera; a look changes the settings, and also the camera if `with_view`.
    pub(crate) fn apply_saved_item(
        &mut self,
        at: usize,
        with_view: bool,
        dataset: Option<Dataset>,
        ctx: &egui::Context,
    ) -> io::Result<()> {
        let Some(kept) = self.settings.kept.get(at).cloned() else { return Ok(()) };
        if let Some(look) = kept.as_look() {
            self.settings = self.settings.with_saved_look(look);
            self.keep_balanced.accept(&self.settings);
        }
        if with_view || kept.as_look().is_none() {
            self.move_camera_to(kept.camera(), AppCommand::GoToSaved(at, with_view), dataset, ctx)?;
        }
        Ok(())
    }

    /// Moves the camera to a saved view. If the object stands another way up in it, the room is turned first.
    fn move_camera_to(
        &mut self,
        camera: &Camera,
        command: AppCommand,
        dataset: Option<Dataset>,
        ctx: &egui::Context,
    ) -> io::Result<()> {
        if camera.up != self.settings.camera.up {
            if !self.ensure_first_look_up_axis(camera.up, Some(command), dataset, ctx)? {
                return Ok(());
            }
            self.settings.rotate_object(ObjectRotation::MakeUpright(camera.up));
            self.settings.floor.height = self.defaults.floor.height;
        }
        self.settings.camera.clone_from(camera);
        Ok(())
    }

    /// Replaces a saved item by the current view or look, keeping its name. Returns false if there is no room.
    pub(crate) fn replace_saved_item(&mut self, at: usize) -> bool {
        let Some(kept) = self.settings.kept.get(at) else { return true };
        let what = match kept.what {
            SavedContent::View(_) => SavedContent::View(self.settings.camera.clone()),
            SavedContent::Look(_) => SavedContent::Look(SavedLook::new(&self.settings)),
        };
        self.settings.replace_saved(at, what)
    }
}
