//! Window with the list of all messages.

use std::time::Instant;

use eframe::egui::{self, RichText};

use super::Messages;
use crate::app::common::frame;
use crate::app::text;

impl Messages {
    /// Shows the message list, if it is open.
    pub(crate) fn list(&mut self, ctx: &egui::Context) {
        if !self.lists {
            return;
        }
        self.listed = Some(Instant::now());
        let window = egui::Window::new(text::messages::LIST).open(&mut self.lists).collapsible(false);
        let window = window.default_size([460.0, 260.0]).constrain_to(frame::room(ctx));
        let shown = window.show(ctx, |ui| {
            if self.past.is_empty() {
                ui.weak(text::messages::NOTHING_SAID);
            }
            egui::ScrollArea::vertical().auto_shrink(false).stick_to_bottom(true).show(ui, |ui| {
                for (when, message) in &self.past {
                    ui.horizontal_top(|ui| {
                        ui.weak(text::memory::since(when.elapsed()));
                        ui.vertical(|ui| {
                            let mut short = RichText::new(message.words());
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
        self.lists &= !frame::is_left(ctx, shown.as_ref().map(|shown| &shown.response));
    }
}
