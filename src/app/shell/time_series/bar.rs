//! Bar under the picture with the time steps of a series: slider, playback and speed.

use eframe::egui;

use super::TimeSeries;
use super::playback::RATES;
use crate::app::common::theme;
use crate::app::text::{ControlText, time_series as text};

/// Width of the slider where there is room, in points.
const SLIDER_WIDTH: std::ops::RangeInclusive<f32> = 80.0..=420.0;

/// Width of the controls beside the slider, in points.
const OTHER_WIDTH: f32 = 620.0;

fn button(ui: &mut egui::Ui, ControlText { name, tooltip }: ControlText) -> egui::Response {
    ui.button(name).on_hover_text(tooltip)
}

/// Shows a button with a sign, which is known to screen readers by its tooltip.
fn sign_button(ui: &mut egui::Ui, sign: ControlText) -> bool {
    let response = button(ui, sign);
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, sign.tooltip));
    response.clicked()
}

impl TimeSeries {
    /// Shows the bar, if the open volume is one of several time steps.
    pub(crate) fn show_bar(&mut self, ui: &mut egui::Ui) {
        if self.steps().is_none() {
            return;
        }
        let panel = egui::Panel::bottom("time").resizable(false).frame(theme::panel(ui));
        panel.show(ui, |ui| ui.horizontal_wrapped(|ui| self.controls(ui)));
    }

    fn controls(&mut self, ui: &mut egui::Ui) {
        let Some(steps) = self.steps().cloned() else { return };
        let count = steps.count();
        let now_s = ui.input(|input| input.time);
        if sign_button(ui, text::PREVIOUS) {
            self.step(false);
        }
        let (play, is_playing) =
            if self.playback.is_playing() { (text::PAUSE, true) } else { (text::PLAY, false) };
        if button(ui, play).clicked() {
            self.set_playing(!is_playing, now_s);
        }
        if sign_button(ui, text::NEXT) {
            self.step(true);
        }
        let mut number = self.wanted + 1;
        let free = ui.available_width() - OTHER_WIDTH;
        ui.spacing_mut().slider_width = free.clamp(*SLIDER_WIDTH.start(), *SLIDER_WIDTH.end());
        let slider = egui::Slider::new(&mut number, 1..=count).integer();
        let response = ui.name_inputs(text::STEP.name, |ui| ui.add(slider).on_hover_text(text::STEP.tooltip));
        if response.changed() {
            self.go_to(number - 1);
        }
        ui.label(text::step_of(self.on_screen, count, &steps.name(self.on_screen)));
        if self.wanted != self.shown && !self.playback.is_playing() {
            ui.weak(text::is_read(self.wanted));
        }
        ui.separator();
        let rate = egui::DragValue::new(&mut self.playback.rate).range(RATES).speed(0.1).max_decimals(1);
        let rate = rate.suffix(text::RATE_UNIT);
        ui.name_inputs(text::RATE.name, |ui| ui.add(rate).on_hover_text(text::RATE.tooltip));
        ui.checkbox(&mut self.playback.is_loop, text::LOOP.name).on_hover_text(text::LOOP.tooltip);
        match self.measuring.progress() {
            Some(progress) => {
                ui.weak(text::range_progress(progress.done, progress.total));
                if ui.button(text::CANCEL_RANGE).clicked() {
                    self.measuring.discard();
                }
            }
            None => self.wants_range |= button(ui, text::RANGE).clicked(),
        }
        if self.is_of_files && button(ui, text::CLOSE).clicked() {
            self.close();
        }
    }
}
