//! Layout of the main window: which panels and tool windows are shown. egui itself stores their sizes, the open
//! sections, and the zoom factor.

pub(super) mod outer_panels;

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use eframe::egui::{self, Key, Modifiers, ThemePreference};
use serde::{Deserialize, Serialize};

use super::common::dock;
use super::common::reveal::{self, SettingPlace};
use super::shell::messages::MessageLog;
use super::shell::tool_windows::ToolWindows;
use crate::app::text;
use crate::app::windows::slices::plane::ViewingConvention;

/// Key under which the layout is stored in egui's persistent storage.
const LAYOUT_KEY: &str = "layout";

/// Panels and tool windows that are shown, as stored between runs.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub(crate) struct WindowLayout {
    /// True if the side panel is shown.
    pub side: bool,
    /// True if the transfer function editor is shown.
    pub transfer: bool,
    /// True if the strip of kept views and looks is shown.
    pub kept: bool,
    /// Titles of the tools that are docked beside the picture while they are open.
    pub docked: BTreeSet<String>,
    /// True if the export window has been docked by default; false in layouts stored before it was.
    #[serde(default)]
    has_docked_export: bool,
    /// True if the window "Slices" is open.
    pub slices: bool,
    /// True if the window with slices of light volumes is open.
    pub light_slice: bool,
    /// Side of the screen on which slices of a body show its right side.
    pub slice_convention: ViewingConvention,
    /// Folder of the last export, where the next one is proposed.
    pub exports: Option<PathBuf>,
    /// Colour theme: dark, light, or that of the system.
    theme: ThemePreference,
    /// True while only the picture is shown, until the user leaves that mode; not stored.
    #[serde(skip)]
    pub picture_only: bool,
}

impl Default for WindowLayout {
    fn default() -> Self {
        Self {
            side: true,
            transfer: true,
            kept: false,
            // As a floating window it would cover the picture that is exported.
            docked: [text::export::TITLE.to_owned()].into(),
            has_docked_export: true,
            slices: false,
            light_slice: false,
            slice_convention: ViewingConvention::default(),
            exports: None,
            theme: ThemePreference::Dark,
            picture_only: false,
        }
    }
}

impl WindowLayout {
    /// Restores the layout of the last run; the default layout if none is stored or the stored one is damaged.
    pub(crate) fn restore(storage: Option<&dyn eframe::Storage>) -> Self {
        let stored: Option<Self> = storage.and_then(|storage| eframe::get_value(storage, LAYOUT_KEY));
        stored.map(Self::with_docked_export).unwrap_or_default()
    }

    /// Docks the export window in a layout that was stored before it was docked by default; later layouts keep the
    /// user's choice.
    fn with_docked_export(mut self) -> Self {
        if !self.has_docked_export {
            self.docked.insert(text::export::TITLE.to_owned());
            self.has_docked_export = true;
        }
        self
    }

    /// Applies the chosen colour theme and the docked tools to the window.
    pub(crate) fn apply(&self, ctx: &egui::Context) {
        ctx.set_theme(self.theme);
        dock::set_docked(ctx, &self.docked);
    }

    /// Takes note of the colour theme, which the user may have changed.
    fn observe_theme(&mut self, ctx: &egui::Context) {
        self.theme = ctx.options(|options| options.theme_preference);
    }

    /// Takes note of the tools that are open and docked.
    fn observe_tools(&mut self, ctx: &egui::Context, windows: &ToolWindows) {
        self.docked = dock::docked_titles(ctx);
        (self.slices, self.light_slice) = (windows.slices.open, windows.light_slice.open);
        self.slice_convention = windows.slices.convention;
    }

    /// Stores the layout for the next run.
    pub(crate) fn store(&self, storage: &mut dyn eframe::Storage) {
        eframe::set_value(storage, LAYOUT_KEY, self);
    }
}

impl WindowLayout {
    /// Opens a section and the side panel when its feature is switched on, unless only the picture is shown.
    pub(crate) fn show_section(&mut self, ctx: &egui::Context, section: &'static str, is_on: bool) {
        self.side |= is_on && !self.picture_only;
        reveal::show_section(ctx, section, is_on);
    }

    /// Reveals a setting in its section, and shows the panel of the section.
    pub(crate) fn reveal(&mut self, place: SettingPlace, ctx: &egui::Context) {
        let is_of_editor = [text::transfer::TITLE, text::labels::TITLE].contains(&place.section);
        *(if is_of_editor { &mut self.transfer } else { &mut self.side }) = true;
        self.picture_only = false;
        reveal::reveal(ctx, place);
    }

    /// Remembers the folder of an exported file, where the next one is proposed.
    pub(crate) fn remember_export(&mut self, path: &Path) {
        self.exports = std::path::absolute(path).ok().and_then(|path| Some(path.parent()?.to_owned()));
    }

    /// Switches between the picture alone and the panels, and notes which key brings the panels back.
    pub(crate) fn toggle_picture_only(&mut self, messages: &mut MessageLog) {
        self.picture_only ^= true;
        if self.picture_only {
            messages.note(text::messages::PICTURE_ONLY);
        }
    }

    /// Leaves the picture-only mode if Escape was pressed and no drag or widget has consumed the key.
    pub(crate) fn leave_picture_only(&mut self, ctx: &egui::Context) {
        let is_free = self.picture_only && ctx.dragged_id().is_none();
        if is_free && ctx.input_mut(|input| input.consume_key(Modifiers::NONE, Key::Escape)) {
            self.picture_only = false;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn export_is_docked_once_in_earlier_layouts() {
        let earlier: WindowLayout = serde_json::from_str(r#"{"docked": ["Slices"]}"#).unwrap();
        let mut layout = earlier.with_docked_export();
        assert!(layout.docked.contains(text::export::TITLE) && layout.docked.contains("Slices"));
        layout.docked.clear();
        let text = serde_json::to_string(&layout).unwrap();
        let again: WindowLayout = serde_json::from_str(&text).unwrap();
        assert!(again.with_docked_export().docked.is_empty(), "the user has let it float");
    }

    #[test]
    fn stored_layout_is_restored() {
        let mut layout = WindowLayout { side: false, slices: true, ..WindowLayout::default() };
        layout.picture_only = true;
        let text = serde_json::to_string(&layout).unwrap();
        let again: WindowLayout = serde_json::from_str(&text).unwrap();
        assert_eq!(
            again,
            WindowLayout { side: false, slices: true, ..WindowLayout::default() },
            "and the panels are there"
        );
        let newer: WindowLayout = serde_json::from_str(r#"{"transfer": false, "more": 1}"#).unwrap();
        assert!(newer.side && !newer.transfer);
    }
}
