//! Notification over the picture, and the window of its details.

use std::time::Duration;

use eframe::egui::{self, Align2, Id, Order, Rect, RichText, vec2};

use super::{MessageLog, NOTE_S};
use crate::app::common::overlay_windows;
use crate::app::text;

/// Distance from the top of the picture, in points: below the light chips and the captions of a comparison.
const TOP_DISTANCE: f32 = 40.0;

/// Width reserved for the buttons of the notification, in points.
const BUTTONS_WIDTH: f32 = 150.0;

/// Maximum width of the notification, in points.
const MAX_WIDTH: f32 = 620.0;

impl MessageLog {
    /// Shows the current message over the picture, if there is one.
    pub(crate) fn notice(&mut self, ctx: &egui::Context, picture: Rect) {
        let Some(message) = &self.current else { return };
        let now_s = ctx.input(|input| input.time);
        let mut over = false;
        if !message.is_error {
            let until_s = *self.until_s.get_or_insert(now_s + NOTE_S);
            over = now_s >= until_s;
            ctx.request_repaint_after(Duration::from_secs_f64((until_s - now_s).max(0.0)));
        }
        let place = picture.center_top() + vec2(0.0, TOP_DISTANCE.min(picture.height() / 4.0));
        let area = egui::Area::new(Id::unique("notice"))
            .order(Order::Foreground)
            .fixed_pos(place)
            .pivot(Align2::CENTER_TOP)
            .constrain_to(ctx.content_rect());
        let shown = area.show(ctx, |ui| {
            egui::Frame::popup(ui.style()).show(ui, |ui| {
                let font = egui::TextStyle::Body.resolve(ui.style());
                let color = ui.visuals().text_color();
                let needed =
                    ui.painter().layout_no_wrap(message.one_line(), font, color).size().x + BUTTONS_WIDTH;
                ui.set_width(needed.min(MAX_WIDTH).min(picture.width() - 24.0).max(BUTTONS_WIDTH));
                ui.horizontal(|ui| {
                    ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                        over |= ui.small_button(text::messages::DISMISS).clicked();
                        if !message.details.is_empty() && ui.small_button(text::messages::DETAILS).clicked() {
                            self.expanded ^= true;
                        }
                        // The message gets the rest of the row, and is truncated rather than its buttons.
                        ui.with_layout(egui::Layout::left_to_right(egui::Align::Center), |ui| {
                            let words = message.one_line();
                            let mut rich = RichText::new(&words);
                            if message.is_error {
                                rich = rich.color(ui.visuals().error_fg_color);
                            }
                            ui.add(egui::Label::new(rich).truncate()).on_hover_text(&words);
                        });
                    });
                });
            });
        });
        // Stays while the pointer is on it, so that it can be read.
        if shown.response.contains_pointer() && !message.is_error {
            self.until_s = Some(now_s + NOTE_S);
        }
        if self.expanded {
            let shown = egui::Window::new(text::messages::DETAILS_TITLE)
                .open(&mut self.expanded)
                .collapsible(false)
                .constrain_to(overlay_windows::window_area(ctx))
                .default_pos(picture.center_top() + vec2(-200.0, TOP_DISTANCE + 40.0))
                .show(ctx, |ui| ui.label(&message.details));
            self.expanded &=
                !overlay_windows::escape_closes(ctx, shown.as_ref().map(|shown| &shown.response));
        }
        if over {
            self.current = None;
        }
    }
}
