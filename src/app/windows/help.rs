//! Help windows: "Keys and mouse" and "About".

use eframe::egui;

use crate::app::common::frame;
use crate::app::common::shortcuts::{SHORTCUTS, key_text};
use crate::app::text;
use crate::app::viewport::Facts;
use crate::model::SceneAxis;

/// Size of the tables of keys and mouse, in points.
const TABLES: egui::Vec2 = egui::vec2(980.0, 626.0);

/// Table of two columns: gesture or key, and effect.
fn table(ui: &mut egui::Ui, name: &str, rows: impl IntoIterator<Item = (String, String)>) {
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
pub(crate) struct Help {
    /// True if "Keys and mouse" is open.
    pub keys: bool,
    /// True if "About" is open.
    pub about: bool,
}

impl Help {
    /// Shows the open windows; the names of some commands state which axis of the scene points up.
    pub(crate) fn ui(&mut self, ctx: &egui::Context, facts: &Facts, up: SceneAxis) {
        // All of it if the window is large enough, else with scroll bars.
        let room = frame::room(ctx);
        let size = TABLES.min(room.size() - egui::vec2(80.0, 60.0));
        let window = egui::Window::new(text::help::KEYS_AND_MOUSE)
            .open(&mut self.keys)
            .resizable(false)
            .collapsible(false);
        let window = window.constrain_to(room).default_pos([40.0, 40.0]);
        let shown = window.fixed_size(size).show(ctx, |ui| {
            egui::ScrollArea::both().auto_shrink(false).show(ui, |ui| {
                ui.horizontal_top(|ui| {
                    let mouse = text::help::MOUSE;
                    table(ui, "mouse", mouse.map(|(what, effect)| (what.to_owned(), effect.to_owned())));
                    let keys: Vec<_> = SHORTCUTS
                        .into_iter()
                        .map(|(key, command)| (key_text(ctx, key), command.label_with(up).into_owned()))
                        .collect();
                    let (first, second) = keys.split_at(keys.len().div_ceil(2));
                    for (name, part) in [("keys", first), ("more_keys", second)] {
                        ui.separator();
                        table(ui, name, part.iter().cloned());
                    }
                });
            });
        });
        self.keys &= !frame::is_left(ctx, shown.as_ref().map(|shown| &shown.response));
        let window =
            egui::Window::new(text::help::ABOUT).open(&mut self.about).resizable(false).collapsible(false);
        let window = window.constrain_to(frame::room(ctx));
        let shown = window.default_pos([420.0, 50.0]).show(ctx, |ui| {
            ui.strong(text::help::program(env!("CARGO_PKG_VERSION")));
            ui.label(text::help::PURPOSE);
            ui.label(text::help::AFTER);
            ui.separator();
            ui.label(text::help::adapter(&facts.adapter));
            ui.label(text::help::interface(&facts.driver));
            if facts.software {
                ui.label(text::help::SOFTWARE_ADAPTER);
            }
        });
        self.about &= !frame::is_left(ctx, shown.as_ref().map(|shown| &shown.response));
    }
}
