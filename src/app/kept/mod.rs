//! Kept views and looks: the strip of thumbnails below the picture, and the commands on its items.

mod strip;
mod thumbnails;

use eframe::egui;

pub(in crate::app) use self::strip::Strip;
use super::App;
use super::common::commands::Command;
use crate::app::text;
use crate::model::{Camera, Kept, KeptLook, KeptThing, ObjectTurn, Settings, Variant};

/// Returns the first numbered name that no kept item has.
fn free_name(settings: &Settings, name: impl Fn(usize) -> String) -> String {
    let is_taken = |wanted: &str| settings.kept.iter().any(|kept| kept.name == wanted);
    // Of n + 1 names, at least one is not among n kept items.
    (1..=settings.kept.len() + 1).map(name).find(|name| !is_taken(name)).unwrap_or_default()
}

impl App {
    /// Keeps the current view (camera) under a new name.
    pub(in crate::app) fn keep_view(&mut self) {
        let name = free_name(&self.settings, text::kept::view_name);
        self.keep_in_strip(Kept::view(name, &self.settings.camera));
    }

    /// Keeps the current look (all settings) under a new name.
    pub(in crate::app) fn keep_look_in_strip(&mut self) {
        let name = free_name(&self.settings, text::kept::look_name);
        self.keep_in_strip(Kept::look(name, &self.settings));
    }

    fn keep_in_strip(&mut self, kept: Kept) {
        let note = text::kept::kept(&kept.name);
        let has_room = self.settings.keep(kept);
        self.has_kept(has_room, note);
    }

    /// Keeps the current view under a digit key.
    pub(in crate::app) fn keep_view_under(&mut self, digit: u8) {
        let name = free_name(&self.settings, |number| {
            // Named after its digit, if that name is free.
            text::kept::view_name(if number == 1 { digit.into() } else { number })
        });
        let has_room = self.settings.keep_view_under(digit, name);
        self.has_kept(has_room, text::kept::view_kept(digit));
    }

    fn has_kept(&mut self, has_room: bool, note: String) {
        if has_room {
            self.layout.kept = true;
            self.messages.note(note);
        } else {
            self.messages.error(text::kept::NO_ROOM, String::new());
        }
    }

    /// Goes to the item kept under a digit, or notes that there is none.
    pub(in crate::app) fn go_to_digit(&mut self, digit: u8, ctx: &egui::Context) {
        match self.settings.kept.iter().position(|kept| kept.digit == Some(digit)) {
            Some(at) => self.go_to_kept(at, false, ctx),
            None => self.messages.note(text::kept::nothing_under(digit)),
        }
    }

    /// Applies a kept item: a view moves the camera; a look changes the settings, and also the camera if `with_view`.
    pub(in crate::app) fn go_to_kept(&mut self, at: usize, with_view: bool, ctx: &egui::Context) {
        let Some(kept) = self.settings.kept.get(at).cloned() else { return };
        if let Some(look) = kept.as_look() {
            self.settings = self.settings.with_look(look);
            self.keep_balanced.accept(&self.settings);
        }
        if with_view || kept.as_look().is_none() {
            self.look_as(kept.camera(), Command::GoToKept(at, with_view), ctx);
        }
    }

    /// Moves the camera to a kept view. If the object stands another way up in it, the room is turned first.
    fn look_as(&mut self, camera: &Camera, command: Command, ctx: &egui::Context) {
        if camera.up != self.settings.camera.up {
            if !self.first_look_stands_on(camera.up, Some(command), ctx) {
                return;
            }
            self.settings.turn_object(ObjectTurn::Upright(camera.up));
            self.settings.floor.height = self.defaults.floor.height;
        }
        self.settings.camera.clone_from(camera);
    }

    /// Replaces a kept item by the current view or look, keeping its name.
    pub(in crate::app) fn replace_kept(&mut self, at: usize) {
        let Some(kept) = self.settings.kept.get(at) else { return };
        let what = match kept.what {
            KeptThing::View(_) => KeptThing::View(self.settings.camera.clone()),
            KeptThing::Look(_) => KeptThing::Look(KeptLook::new(&self.settings)),
        };
        if !self.settings.keep_instead(at, what) {
            self.messages.error(text::kept::NO_ROOM, String::new());
        }
    }

    /// Compares two views or looks on either side of a divider: two kept ones, or the current picture (`None`) and a
    /// kept one.
    pub(in crate::app) fn compare_kept(&mut self, left: Option<usize>, right: usize) {
        let variant = |at: usize| {
            self.settings.kept.get(at).map(|kept| match kept.as_look() {
                Some(look) => Variant::Look(Box::new(look.clone())),
                None => Variant::View(Box::new(kept.camera().clone())),
            })
        };
        let name = |at: usize| self.settings.kept.get(at).map(|kept| kept.name.clone());
        let names = [left.and_then(name), name(right)];
        let left = match left {
            Some(at) => variant(at),
            None => Some(Variant::Current),
        };
        if let Some((left, right)) = left.zip(variant(right)) {
            (self.compare.on, self.compare.left, self.compare.right) = (true, left, right);
            self.compare.names = names;
        }
    }

    /// Shows the strip of kept items, if it is visible and a volume is open.
    pub(in crate::app) fn kept_strip(&mut self, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
        self.draw_kept(ui.ctx());
        if self.layout.kept && self.volume.is_some() {
            self.strip.show(ui, &mut self.settings, commands);
        }
    }

    /// Renders missing thumbnails of kept items while nothing else is being computed.
    fn draw_kept(&mut self, ctx: &egui::Context) {
        self.strip.thumbnails.take(ctx);
        if !self.layout.kept {
            return;
        }
        let id = self.viewport.dataset().map(|dataset| dataset.volume().content_id());
        let Some(wanted) = self.strip.thumbnails.wanted(&self.settings, id) else { return };
        if self.is_complete()
            && !self.export.is_busy()
            && let Some(subject) = self.subject()
            && let Err(err) = self.strip.thumbnails.start(wanted, subject, ctx)
        {
            log::warn!("small pictures of what is kept are not made: {err}");
        }
    }
}
