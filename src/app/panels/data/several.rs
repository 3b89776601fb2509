//! Rows of the section "Data" for files of several volumes: series, channels and time steps.

use eframe::egui::{self, Ui};

use super::super::controls::{row, unlabelled};
use crate::app::common::aspect::Alternatives;
use crate::app::common::commands::Command;
use crate::app::common::volume_facts::VolumeFacts;
use crate::app::text;
use crate::data::load::Aspect;

/// Width of a step button, in points.
const STEP_WIDTH: f32 = 20.0;

/// Shows a row for each aspect in which the file has several volumes.
pub(super) fn show(ui: &mut Ui, volume: &VolumeFacts, commands: &mut Vec<Command>) {
    for aspect in Aspect::ALL {
        let Some(all) = Alternatives::of(&volume.held, aspect) else { continue };
        choice(ui, aspect, &all, commands);
        if all.has_colors() {
            unlabelled(ui, |ui| ui.add(egui::Label::new(text::chooser::NO_COLORS).wrap()));
        }
    }
}

fn choice(ui: &mut Ui, aspect: Aspect, all: &Alternatives<'_>, commands: &mut Vec<Command>) {
    let (at, count) = (all.at(), all.count());
    row(ui, text::chooser::row(aspect), |ui| {
        let steps = 2.0 * (STEP_WIDTH + ui.spacing().item_spacing.x);
        // One point less, because widths are rounded up.
        let width = ui.available_width() - steps - 1.0;
        ui.add_enabled_ui(at > 0, |ui| step(ui, aspect, false, commands));
        let present = text::chooser::present(at, count, &all.name(at));
        let button = egui::Button::new(&present).truncate();
        let button = ui.add_sized([width, ui.spacing().interact_size.y], button);
        if button.on_hover_text(text::chooser::command(aspect)).clicked() {
            commands.push(Command::Choose(aspect));
        }
        ui.add_enabled_ui(at + 1 < count, |ui| step(ui, aspect, true, commands));
    });
}

fn step(ui: &mut Ui, aspect: Aspect, is_forward: bool, commands: &mut Vec<Command>) {
    let sign = if is_forward { text::chooser::FORWARD } else { text::chooser::BACK };
    let name = text::chooser::step(aspect, is_forward);
    let size = [STEP_WIDTH, ui.spacing().interact_size.y];
    let button = ui.add_sized(size, egui::Button::new(sign).small());
    let is_there = ui.is_enabled();
    button.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, is_there, &name));
    if button.on_hover_text(&name).clicked() {
        commands.push(Command::StepChoice(aspect, is_forward));
    }
}
