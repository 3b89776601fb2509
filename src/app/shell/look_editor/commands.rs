//! Commands that change the look and need more than the document: the volume that is shown, or messages.

use eframe::egui;

use super::LookEditor;
use crate::app::common::commands::AppCommand;
use crate::app::viewport::mouse_navigation::OrbitDrag;
use crate::app::{panels, text};
use chiaroscuro_scene::{ObjectRotation, Preset, RenderMode, StandardView};
use chiaroscuro_volume::KindName;

impl LookEditor {
    /// Switches the crop box on or off, and returns true if it is on.
    pub(crate) fn toggle_crop(&mut self) -> bool {
        let crop = &mut self.document.settings.cuts.crop;
        crop.on ^= true;
        crop.on
    }

    /// Switches the clip plane on or off, and returns true if it is on.
    pub(crate) fn toggle_plane(&mut self) -> bool {
        let plane = &mut self.document.settings.cuts.plane;
        plane.on ^= true;
        plane.on
    }

    /// Shows or hides the floor under the volume, and returns true if it is shown.
    pub(crate) fn toggle_floor(&mut self) -> bool {
        let floor = &mut self.document.settings.floor;
        floor.on ^= true;
        floor.on
    }

    /// Hides the table under a body, or shows it again, and returns true if it is hidden.
    pub(crate) fn toggle_table(&mut self) -> bool {
        if let Some(dataset) = self.viewport.dataset() {
            self.document.settings.toggle_table(dataset.volume());
        }
        self.document.settings.volume.hidden_table.is_some()
    }

    /// Removes the selected layer with its volume, unless it is the first one, whose grid the others have.
    pub(crate) fn remove_layer(&mut self) {
        match self.document.selected_layer {
            0 => self.messages.note(text::data::FIRST_LAYER_STAYS),
            index => self.document.remove_layer(index),
        }
    }

    /// Shows the volume in a render mode, and names it; a surface lies at `value`, if there is one.
    pub(crate) fn use_render_mode(&mut self, kind: RenderMode, value: Option<f64>) {
        let settings = &mut self.document.settings;
        if !settings.layer().labels.is_empty() {
            self.messages.note(text::shading::LABELS_ARE_MATTER);
            return;
        }
        settings.mode.kind = kind;
        if kind == RenderMode::Surface && value.is_some() {
            settings.mode.isovalue = value;
        }
        self.messages.note(text::shading::mode_note(kind));
    }

    /// Switches the comparison of two looks on or off, and returns true if it is on.
    pub(crate) fn toggle_compare(&mut self) -> bool {
        let compare = &mut self.viewport.compare;
        compare.on ^= true;
        compare.on
    }

    /// Resets the camera to that of the first look.
    pub(crate) fn reset_view(&mut self, ctx: &egui::Context) {
        if self.ensure_first_look_up(Some(AppCommand::ResetView), ctx) {
            self.document.reset_view();
        }
    }

    /// Frames the visible object from the current direction.
    pub(crate) fn frame_all(&mut self, ctx: &egui::Context) {
        if self.can_frame(AppCommand::FrameAll, ctx) {
            self.document.frame_object(self.viewport.dataset().as_ref());
        }
    }

    /// Looks at the object from a standard view.
    pub(crate) fn look_from(&mut self, view: StandardView, ctx: &egui::Context) {
        if self.can_frame(AppCommand::LookFrom(view), ctx) {
            self.document.set_standard_view(view);
            self.document.frame_object(self.viewport.dataset().as_ref());
        }
    }

    /// Orbits the camera by 90° about the vertical, as if the object turned.
    pub(crate) fn rotate_object(&mut self, ctx: &egui::Context) {
        if self.can_frame(AppCommand::RotateObject, ctx) {
            let outline = self.document.outline(self.viewport.dataset().as_ref());
            let camera = &mut self.document.settings.camera;
            let orbit = OrbitDrag::begin(camera, outline.as_deref());
            camera.orbit(90.0, 0.0);
            orbit.keep_in_frame(camera, outline.as_deref());
        }
    }

    /// Turns the object over, or upright.
    pub(crate) fn turn_object(&mut self, turn: ObjectRotation, ctx: &egui::Context) {
        let started = self.document.turn_object(turn, self.viewport.dataset(), ctx);
        self.messages.report(text::messages::TURN_FAILED, started);
    }

    /// Makes the automatic transfer function or table of labels for the current kind of data.
    pub(crate) fn use_automatic_transfer(&mut self, ctx: &egui::Context) {
        let started = self.document.use_automatic_transfer(self.viewport.dataset(), ctx);
        self.messages.report(text::messages::LOOK_NOT_MADE, started);
    }

    /// Makes a first look for a kind of data, or for the volume's own kind if `None`.
    pub(crate) fn treat_as(&mut self, kind: Option<KindName>, ctx: &egui::Context) {
        let started = self.document.treat_as(kind, self.viewport.dataset(), ctx);
        self.messages.report(text::messages::LOOK_NOT_MADE, started);
    }

    /// Applies a preset of the library.
    pub(crate) fn use_preset(&mut self, preset: &Preset) {
        let Some(volume) = self.document.selected_volume() else { return };
        // A preset has one layer, which is for the first field.
        let selected_first = self.document.settings.clone().with_first_exchanged(volume.layer);
        match preset.apply(&selected_first, &volume.ranges) {
            Ok(settings) => self.document.settings = settings.with_first_exchanged(volume.layer),
            Err(err) => self.messages.error(text::messages::PRESET_NOT_APPLIED, err.to_string()),
        }
    }

    /// Adds a light beside the camera, and selects it.
    pub(crate) fn add_light(&mut self) {
        if let Some(index) = panels::add_light(&mut self.document.settings) {
            self.document.selected_light = index;
        }
    }

    /// Saves the view in the strip. Returns true if there was room for it.
    pub(crate) fn save_view(&mut self) -> bool {
        let note = self.document.save_current_view();
        self.report_saved(note)
    }

    /// Saves the look in the strip. Returns true if there was room for it.
    pub(crate) fn save_look(&mut self) -> bool {
        let note = self.document.save_current_look();
        self.report_saved(note)
    }

    /// Saves the view under a digit. Returns true if there was room for it.
    pub(crate) fn save_view_under(&mut self, digit: u8) -> bool {
        let note = self.document.save_view_under(digit);
        self.report_saved(note)
    }

    /// Shows the note about an item that was saved, or that there was no room for it.
    fn report_saved(&mut self, note: Option<String>) -> bool {
        let is_saved = note.is_some();
        match note {
            Some(note) => self.messages.note(note),
            None => self.messages.error(text::saved_views::TOO_MANY, String::new()),
        }
        is_saved
    }

    /// Replaces a saved view or look by the current one.
    pub(crate) fn replace_saved(&mut self, at: usize) {
        if !self.document.replace_saved_item(at) {
            self.messages.error(text::saved_views::TOO_MANY, String::new());
        }
    }

    /// Goes to the item saved under a digit, or notes that there is none.
    pub(crate) fn apply_saved_digit(&mut self, digit: u8, ctx: &egui::Context) {
        match self.document.saved_index_of_digit(digit) {
            Some(index) => self.apply_saved(index, false, ctx),
            None => self.messages.note(text::saved_views::digit_is_empty(digit)),
        }
    }

    /// Applies a saved item; see [`Document::apply_saved_item`](crate::app::document::Document::apply_saved_item).
    pub(crate) fn apply_saved(&mut self, at: usize, with_view: bool, ctx: &egui::Context) {
        let applied = self.document.apply_saved_item(at, with_view, self.viewport.dataset(), ctx);
        self.messages.report(text::messages::TURN_FAILED, applied);
    }

    /// Compares two saved views or looks, or the picture (`None`) with one.
    pub(crate) fn compare_saved(&mut self, left: Option<usize>, right: usize) {
        self.viewport.compare.start_with_saved(&self.document.settings, left, right);
    }
}
