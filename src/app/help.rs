//! The windows "Keys and mouse" and "About".

use eframe::egui;

use super::commands::{SHORTCUTS, key_text};
use super::viewport::Facts;

/// What the mouse does, in the picture and in the editor.
const MOUSE: [(&str, &str); 18] = [
    ("Drag the picture", "orbit"),
    ("Double click on the volume", "turn about what is there"),
    ("Hold L and drag", "turn the selected light"),
    ("Arrow keys, with Shift ten times", "turn it by a degree"),
    ("Ctrl+Shift+1 … 9, Ctrl+1 … 9", "keep a view, look that way again"),
    ("Shift-drag or middle drag", "pan"),
    ("Right-drag the picture", "level and window of the curve"),
    ("Wheel", "nearer to the pointer, or further"),
    ("Drag a light's handle", "move the light"),
    ("Wheel on a perspective light's handle", "its distance"),
    ("Drag the square on a hood's cone", "open or close the hood"),
    ("Drag the sides of the crop box", "see less, or more again"),
    ("Drag or wheel on the clip plane's square", "move it; turn it by the arrow"),
    ("Drag the line between two looks", "see more of one of them"),
    ("Click in the transfer function", "add a point"),
    ("Drag around points, or click with Shift", "select several"),
    ("Drag a point, or arrow keys", "move what is selected"),
    ("Double click, or Delete", "remove it"),
];

/// Room that keys and mouse take.
const TABLES: egui::Vec2 = egui::vec2(960.0, 524.0);

/// Two columns: what is done, and what happens.
fn table(ui: &mut egui::Ui, name: &str, rows: impl IntoIterator<Item = (String, String)>) {
    egui::Grid::new(name).num_columns(2).striped(true).spacing([16.0, 4.0]).show(ui, |ui| {
        for (what, effect) in rows {
            ui.label(what);
            ui.label(effect.trim_end_matches('…'));
            ui.end_row();
        }
    });
}

/// Which of the windows are open.
#[derive(Debug, Default)]
pub(super) struct Help {
    /// "Keys and mouse".
    pub keys: bool,
    /// "About".
    pub about: bool,
}

impl Help {
    /// Shows the windows that are open.
    pub(super) fn ui(&mut self, ctx: &egui::Context, facts: &Facts) {
        // All of it where the window has room, else with scroll bars.
        let size = TABLES.min(ctx.content_rect().size() - egui::vec2(90.0, 130.0));
        let window =
            egui::Window::new("Keys and mouse").open(&mut self.keys).resizable(false).collapsible(false);
        window.default_pos([40.0, 50.0]).fixed_size(size).show(ctx, |ui| {
            egui::ScrollArea::both().auto_shrink(false).show(ui, |ui| {
                ui.horizontal_top(|ui| {
                    table(ui, "mouse", MOUSE.map(|(what, effect)| (what.to_owned(), effect.to_owned())));
                    let keys: Vec<_> = SHORTCUTS
                        .into_iter()
                        .map(|(key, command)| (key_text(ctx, key), command.label().into_owned()))
                        .collect();
                    let (first, second) = keys.split_at(keys.len().div_ceil(2));
                    for (name, part) in [("keys", first), ("more keys", second)] {
                        ui.separator();
                        table(ui, name, part.iter().cloned());
                    }
                });
            });
        });
        let window =
            egui::Window::new("About Chiaroscuro").open(&mut self.about).resizable(false).collapsible(false);
        window.default_pos([420.0, 50.0]).show(ctx, |ui| {
            ui.strong(format!("Chiaroscuro {}", env!("CARGO_PKG_VERSION")));
            ui.label("See the shape of volume data: true volumetric shadows by sheet-buffer splatting.");
            ui.label("After Splatting With Shadows (Nulkar and Mueller, 2001).");
            ui.separator();
            ui.label(format!("Graphics adapter {}", facts.adapter));
            ui.label(format!("Interface {}", facts.driver));
            if facts.software {
                ui.label("This is a software adapter: previews are coarser, the final picture is the same.");
            }
        });
    }
}
