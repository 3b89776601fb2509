//! How the window is laid out: which panels are there. Their sizes, sections that are open, and how large everything is,
//! the window toolkit keeps by itself.

mod around;
mod over;

use std::collections::BTreeSet;
use std::path::PathBuf;

use eframe::egui::{self, Key, Modifiers, ThemePreference};
use serde::{Deserialize, Serialize};

use super::App;
use super::common::dock;
use crate::app::text;
use crate::app::windows::slices::plane::Convention;

/// The name under which it is kept beside what the window toolkit keeps.
const NAME: &str = "layout";

/// Which panels are there.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub(crate) struct Layout {
    /// The side panel is there.
    pub side: bool,
    /// The transfer function editor is there.
    pub transfer: bool,
    /// The strip of kept views and looks is there.
    pub kept: bool,
    /// Tools that are docked beside the picture when they are open.
    pub docked: BTreeSet<String>,
    /// Cuts through the data are shown, and those through light volumes.
    pub slices: bool,
    pub light_slice: bool,
    /// Side on which cuts through a body show its right.
    pub slice_convention: Convention,
    /// The folder where the last export went.
    pub exports: Option<PathBuf>,
    /// Dark, light, or as the system is.
    theme: ThemePreference,
    /// Nothing but the picture, until the user leaves that.
    #[serde(skip)]
    pub picture_only: bool,
}

impl Default for Layout {
    fn default() -> Self {
        Self {
            side: true,
            transfer: true,
            kept: false,
            // Over the picture it would lie on what is exported.
            docked: [text::export::TITLE.to_owned()].into(),
            slices: false,
            light_slice: false,
            slice_convention: Convention::default(),
            exports: None,
            theme: ThemePreference::Dark,
            picture_only: false,
        }
    }
}

impl Layout {
    /// As it was left, and the usual one where none is kept or what is kept is damaged.
    pub(crate) fn kept(storage: Option<&dyn eframe::Storage>) -> Self {
        storage.and_then(|storage| eframe::get_value(storage, NAME)).unwrap_or_default()
    }

    /// Gives the window the colours that were chosen.
    pub(crate) fn apply(&self, ctx: &egui::Context) {
        ctx.set_theme(self.theme);
        dock::set_docked(ctx, &self.docked);
    }

    /// Keeps it for the next run.
    pub(crate) fn keep(&self, storage: &mut dyn eframe::Storage) {
        eframe::set_value(storage, NAME, self);
    }
}

impl App {
    /// Shows the picture alone, or the panels again; says how to come back.
    pub(in crate::app) fn toggle_picture_only(&mut self) {
        self.layout.picture_only ^= true;
        if self.layout.picture_only {
            self.messages.note(text::messages::PICTURE_ONLY);
        }
    }

    /// Leaves the picture alone when Escape was pressed, and nothing else has taken that.
    pub(in crate::app) fn leave_picture_only(&mut self, ctx: &egui::Context) {
        let is_free = self.layout.picture_only && ctx.dragged_id().is_none();
        if is_free && ctx.input_mut(|input| input.consume_key(Modifiers::NONE, Key::Escape)) {
            self.layout.picture_only = false;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_kept_of_a_layout_is_found_again() {
        let mut layout = Layout { side: false, slices: true, ..Layout::default() };
        layout.picture_only = true;
        let text = serde_json::to_string(&layout).unwrap();
        let again: Layout = serde_json::from_str(&text).unwrap();
        assert_eq!(
            again,
            Layout { side: false, slices: true, ..Layout::default() },
            "and the panels are there"
        );
        let newer: Layout = serde_json::from_str(r#"{"transfer": false, "more": 1}"#).unwrap();
        assert!(newer.side && !newer.transfer);
    }
}
