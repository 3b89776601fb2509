//! Commands that change the look and need more than the document: threads, messages, or the section of a setting.

use eframe::egui;

use crate::app::common::commands::AppCommand;
use crate::app::common::reveal::{self, SettingPlace};
use crate::app::kept_views::compare_kept_items;
use crate::app::viewport::mouse_navigation::OrbitDrag;
use crate::app::windows::contact_sheet::ContactSheetKind;
use crate::app::{App, panels, text};
use chiaroscuro_scene::{ObjectRotation, Preset, StandardView};
use chiaroscuro_volume::KindName;

impl App {
    /// Opens a section and the side panel when its feature is switched on, unless only the picture is shown.
    fn show_section(&mut self, ctx: &egui::Context, section: &'static str, is_on: bool) {
        self.layout.side |= is_on && !self.layout.picture_only;
        reveal::show_section(ctx, section, is_on);
    }

    /// Reveals a setting in its section, and shows the panel of the section.
    pub(super) fn reveal(&mut self, place: SettingPlace, ctx: &egui::Context) {
        let is_of_editor = [text::transfer::TITLE, text::labels::TITLE].contains(&place.section);
        *(if is_of_editor { &mut self.layout.transfer } else { &mut self.layout.side }) = true;
        self.layout.picture_only = false;
        reveal::reveal(ctx, place);
    }

    /// Switches the crop box on or off.
    pub(super) fn toggle_crop(&mut self, ctx: &egui::Context) {
        self.document.settings.cuts.crop.on ^= true;
        self.show_section(ctx, text::sections::CUTS, self.document.settings.cuts.crop.on);
    }

    /// Switches the clip plane on or off.
    pub(super) fn toggle_plane(&mut self, ctx: &egui::Context) {
        self.document.settings.cuts.plane.on ^= true;
        self.show_section(ctx, text::sections::CUTS, self.document.settings.cuts.plane.on);
    }

    /// Shows or hides the floor under the volume.
    pub(super) fn toggle_floor(&mut self, ctx: &egui::Context) {
        self.document.settings.floor.on ^= true;
        self.show_section(ctx, text::sections::FLOOR, self.document.settings.floor.on);
    }

    /// Switches the comparison of two looks on or off.
    pub(super) fn toggle_compare(&mut self, ctx: &egui::Context) {
        self.picture.compare.on ^= true;
        self.show_section(ctx, text::sections::COMPARE, self.picture.compare.on);
    }

    /// Compares two saved views or looks, or the picture (`None`) with one.
    pub(super) fn compare_saved(&mut self, left: Option<usize>, right: usize, ctx: &egui::Context) {
        compare_kept_items(&mut self.picture.compare, &self.document.settings, left, right);
        reveal::show_section(ctx, text::sections::COMPARE, true);
    }

    /// Resets the camera to that of the first look.
    pub(super) fn reset_view(&mut self, ctx: &egui::Context) {
        if self.ensure_first_look_up(Some(AppCommand::ResetView), ctx) {
            self.document.reset_view();
        }
    }

    /// Shows the contact sheet of looks, which derive from the first look; it must have the current up axis.
    pub(super) fn try_looks(&mut self, ctx: &egui::Context) {
        if self.ensure_first_look_up(Some(AppCommand::TryLooks), ctx) {
            self.windows.contact_sheet.open(ContactSheetKind::Looks);
        }
    }

    /// Frames the visible object from the current direction.
    pub(super) fn frame_all(&mut self, ctx: &egui::Context) {
        if self.can_frame(AppCommand::FrameAll, ctx) {
            self.document.frame_object(self.viewport.dataset().as_ref());
        }
    }

    /// Looks at the object from a standard view.
    pub(super) fn look_from(&mut self, view: StandardView, ctx: &egui::Context) {
        if self.can_frame(AppCommand::LookFrom(view), ctx) {
            self.document.set_standard_view(view);
            self.document.frame_object(self.viewport.dataset().as_ref());
        }
    }

    /// Orbits the camera by 90° about the vertical, as if the object turned.
    pub(super) fn rotate_object(&mut self, ctx: &egui::Context) {
        if self.can_frame(AppCommand::RotateObject, ctx) {
            let outline = self.document.outline(self.viewport.dataset().as_ref());
            let camera = &mut self.document.settings.camera;
            let orbit = OrbitDrag::begin(camera, outline.as_deref());
            camera.orbit(90.0, 0.0);
            orbit.keep_in_frame(camera, outline.as_deref());
        }
    }

    /// Turns the object over, or upright.
    pub(super) fn turn_object(&mut self, turn: ObjectRotation, ctx: &egui::Context) {
        let started = self.document.turn_object(turn, self.viewport.dataset(), ctx);
        self.messages.report(text::messages::TURN_FAILED, started);
    }

    /// Makes the automatic transfer function or table of labels for the current kind of data.
    pub(super) fn use_automatic_transfer(&mut self, ctx: &egui::Context) {
        let started = self.document.use_automatic_transfer(self.viewport.dataset(), ctx);
        self.messages.report(text::messages::LOOK_NOT_MADE, started);
    }

    /// Makes a first look for a kind of data, or for the volume's own kind if `None`.
    pub(super) fn treat_as(&mut self, kind: Option<KindName>, ctx: &egui::Context) {
        let started = self.document.treat_as(kind, self.viewport.dataset(), ctx);
        self.messages.report(text::messages::LOOK_NOT_MADE, started);
    }

    /// Applies a preset of the library.
    pub(super) fn use_preset(&mut self, preset: &Preset) {
        let Some(volume) = &self.document.volume else { return };
        match preset.apply(&self.document.settings, &volume.ranges) {
            Ok(settings) => self.document.settings = settings,
            Err(err) => self.messages.error(text::messages::PRESET_NOT_APPLIED, err.to_string()),
        }
    }

    /// Adds a light beside the camera, and selects it.
    pub(super) fn add_light(&mut self) {
        if let Some(index) = panels::add_light(&mut self.document.settings) {
            self.document.selected_light = index;
        }
    }

    /// Saves the view in the strip.
    pub(super) fn save_view(&mut self) {
        let note = self.document.save_current_view();
        self.report_kept_item(note);
    }

    /// Saves the look in the strip.
    pub(super) fn save_look(&mut self) {
        let note = self.document.save_current_look();
        self.report_kept_item(note);
    }

    /// Saves the view under a digit.
    pub(super) fn save_view_under(&mut self, digit: u8) {
        let note = self.document.save_view_under(digit);
        self.report_kept_item(note);
    }

    /// Replaces a saved view or look by the current one.
    pub(super) fn replace_kept_item(&mut self, at: usize) {
        if !self.document.replace_saved_item(at) {
            self.messages.error(text::saved_views::TOO_MANY, String::new());
        }
    }
}
