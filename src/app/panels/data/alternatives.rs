//! Rows of the section "Data" for files of several volumes: series, channels and time steps.

use eframe::egui::{self, Ui};

use super::super::controls::{row, switch_row, unlabelled_row};
use crate::app::common::alternatives::Alternatives;
use crate::app::common::commands::AppCommand;
use crate::app::common::volume_facts::VolumeFacts;
use crate::app::text;
use chiaroscuro_scene::SamplingSettings;
use chiaroscuro_volume::{ChoiceAspect, FileDimension};

/// Width of a step button, in points.
const STEP_WIDTH: f32 = 20.0;

/// Shows a row for each aspect in which the file has several volumes.
pub(super) fn show(
    ui: &mut Ui,
    volume: &VolumeFacts,
    sampling: &mut SamplingSettings,
    commands: &mut Vec<AppCommand>,
) {
    for aspect in ChoiceAspect::ALL {
        let Some(alternatives) = Alternatives::new(&volume.held, aspect) else { continue };
        alternative_row(ui, aspect, &alternatives, commands);
        if aspect == ChoiceAspect::Dimension(FileDimension::Level) && alternatives.current() > 0 {
            switch_row(ui, text::chooser::FINER_LEVELS, &mut sampling.finer_levels);
        }
        if aspect.is_shown_together(alternatives.count()) {
            let (name, tooltip) = if alternatives.has_colors() {
                (text::chooser::COLORS.name, text::chooser::COLORS.tooltip.to_owned())
            } else {
                (text::chooser::TOGETHER, text::chooser::together_tooltip(alternatives.count()))
            };
            unlabelled_row(ui, |ui| {
                if ui.button(name).on_hover_text(tooltip).clicked() {
                    commands.push(AppCommand::ShowTogether(aspect));
                }
            });
        }
    }
}

fn alternative_row(
    ui: &mut Ui,
    aspect: ChoiceAspect,
    all: &Alternatives<'_>,
    commands: &mut Vec<AppCommand>,
) {
    let (index, count) = (all.current(), all.count());
    row(ui, text::chooser::row(aspect), |ui| {
        let steps = 2.0 * (STEP_WIDTH + ui.spacing().item_spacing.x);
        // One point less, because widths are rounded up.
        let width = ui.available_width() - steps - 1.0;
        ui.add_enabled_ui(index > 0, |ui| step_button(ui, aspect, false, commands));
        let present = text::chooser::current_item(index, count, &all.name(index));
        let button = egui::Button::new(&present).truncate();
        let button = ui.add_sized([width, ui.spacing().interact_size.y], button);
        if button.on_hover_text(text::chooser::command(aspect)).clicked() {
            commands.push(AppCommand::ShowChooser(aspect));
        }
        ui.add_enabled_ui(index + 1 < count, |ui| step_button(ui, aspect, true, commands));
    });
}

fn step_button(ui: &mut Ui, aspect: ChoiceAspect, is_forward: bool, commands: &mut Vec<AppCommand>) {
    let sign = if is_forward { text::chooser::FORWARD } else { text::chooser::BACK };
    let name = text::chooser::step(aspect, is_forward);
    let size = [STEP_WIDTH, ui.spacing().interact_size.y];
    let button = ui.add_sized(size, egui::Button::new(sign).small());
    let is_there = ui.is_enabled();
    button.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, is_there, &name));
    if button.on_hover_text(&name).clicked() {
        commands.push(AppCommand::StepChoice(aspect, is_forward));
    }
}
