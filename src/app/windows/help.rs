//! Help windows: "Keys and mouse" and "About".

use eframe::egui;

use crate::app::common::overlay_windows;
use crate::app::common::shortcuts::{SHORTCUTS, key_text};
use crate::app::text;
use crate::app::viewport::RendererStatus;
use chiaroscuro_scene::SceneAxis;

/// Size of the tables of keys and mouse, in points.
const KEYS_WINDOW_SIZE: egui::Vec2 = egui::vec2(980.0, 626.0);

/// Table of two columns: gesture or key, and effect.
fn two_column_table(ui: &mut egui::Ui, name: &str, rows: impl IntoIterator<Item = (String, String)>) {
    egui::Grid::new(name).num_columns(2).striped(true).spacing([16.0, 4.0]).show(ui, |ui| {
        for (what, effect) in rows {
            ui.label(what);
            ui.label(effect.trim_end_matches('…'));
            ui.end_row();
        }
    });
}

/// Help windows that are open.
#[derive(Debug, Default)]
pub(crate) struct HelpWindows {
    /// True if "Keys and mouse" is open.
    pub keys_open: bool,
    /// True if "About" is open.
    pub about_open: bool,
}

impl HelpWindows {
    /// Shows the open windows; the names of some commands state which axis of the scene points up.
    pub(crate) fn ui(&mut self, ctx: &egui::Context, facts: &RendererStatus, up: SceneAxis) {
        // All of it if the window is large enough, else with scroll bars.
        let room = overlay_windows::window_area(ctx);
        let size = KEYS_WINDOW_SIZE.min(room.size() - egui::vec2(80.0, 60.0));
        let window = egui::Window::new(text::help::KEYS_AND_MOUSE)
            .open(&mut self.keys_open)
            .resizable(false)
            .collapsible(false);
        let window = window.constrain_to(room).default_pos([40.0, 40.0]);
        let shown = window.fixed_size(size).show(ctx, |ui| {
            egui::ScrollArea::both().auto_shrink(false).show(ui, |ui| {
                ui.horizontal_top(|ui| {
                    let mouse = text::help::MOUSE;
                    two_column_table(
                        ui,
                        "mouse",
                        mouse.map(|(what, effect)| (what.to_owned(), effect.to_owned())),
                    );
                    let keys: Vec<_> = SHORTCUTS
                        .into_iter()
                        .map(|(key, command)| (key_text(ctx, key), command.label_with(up).into_owned()))
                        .collect();
                    let (first, second) = keys.split_at(keys.len().div_ceil(2));
                    for (name, part) in [("keys", first), ("more_keys", second)] {
                        ui.separator();
                        two_column_table(ui, name, part.iter().cloned());
                    }
                });
            });
        });
        self.keys_open &= !overlay_windows::escape_closes(ctx, shown.as_ref().map(|shown| &shown.response));
        let window = egui::Window::new(text::help::ABOUT)
            .open(&mut self.about_open)
            .resizable(false)
            .collapsible(false);
        let window = window.constrain_to(overlay_windows::window_area(ctx));
        let shown = window.default_pos([420.0, 50.0]).show(ctx, |ui| {
            ui.strong(text::help::program(env!("CARGO_PKG_VERSION")));
            ui.label(text::help::PURPOSE);
            ui.label(text::help::AFTER);
            ui.separator();
            ui.label(text::help::adapter(&facts.adapter));
            ui.label(text::help::interface(&facts.driver));
            if facts.is_software {
                ui.label(text::help::SOFTWARE_ADAPTER);
            }
        });
        self.about_open &= !overlay_windows::escape_closes(ctx, shown.as_ref().map(|shown| &shown.response));
    }
}
