//! Window with the list of all messages.

use std::time::Instant;

use eframe::egui::{self, RichText};

use super::MessageLog;
use crate::app::common::overlay_windows;
use crate::app::text;

impl MessageLog {
    /// Shows the message list, if it is open.
    pub(crate) fn list(&mut self, ctx: &egui::Context) {
        if !self.list_open {
            return;
        }
        self.list_seen = Some(Instant::now());
        let window = egui::Window::new(text::messages::LIST).open(&mut self.list_open).collapsible(false);
        let window = window.default_size([460.0, 260.0]).constrain_to(overlay_windows::window_area(ctx));
        let shown = window.show(ctx, |ui| {
            if self.history.is_empty() {
                ui.weak(text::messages::NO_MESSAGES);
            }
            egui::ScrollArea::vertical().auto_shrink(false).stick_to_bottom(true).show(ui, |ui| {
                for (when, message) in &self.history {
                    ui.horizontal_top(|ui| {
                        ui.weak(text::persistence::age(when.elapsed()));
                        ui.vertical(|ui| {
                            let mut short = RichText::new(message.one_line());
                            if message.is_error {
                                short = short.color(ui.visuals().error_fg_color);
                            }
                            ui.add(egui::Label::new(short).wrap());
                            // The first line is part of the headline.
                            let more: Vec<&str> = message.details.lines().skip(1).collect();
                            if !more.is_empty() {
                                ui.add(egui::Label::new(RichText::new(more.join("\n")).weak()).wrap());
                            }
                        });
                    });
                }
            });
        });
        self.list_open &= !overlay_windows::escape_closes(ctx, shown.as_ref().map(|shown| &shown.response));
    }
}
