//! Section "Compare" of the side panel: two looks of one scene, side by side.

use eframe::egui::{self, Ui};

use super::super::text::{self, ControlText};
use super::controls::{row, switch_row, unlabelled_row};
use crate::app::common::commands::AppCommand;
use crate::app::viewport::compare::Compare;
use chiaroscuro_scene::{ComparisonVariant, Settings};

/// Shows the section "Compare" of the side panel.
pub(super) fn show(
    ui: &mut Ui,
    compare: &mut Compare,
    settings: &mut Settings,
    commands: &mut Vec<AppCommand>,
) {
    switch_row(ui, text::comparison::ON, &mut compare.on);
    ui.add_enabled_ui(compare.on, |ui| {
        let [left, right] = compare.side_names();
        side(ui, text::comparison::LEFT, &mut compare.left, &left);
        side(ui, text::comparison::RIGHT, &mut compare.right, &right);
        switch_row(ui, text::comparison::DIFFERENCE, &mut compare.difference);
    });
    unlabelled_row(ui, |ui| {
        let keep = text::comparison::KEEP;
        if ui.button(keep.name).on_hover_text(keep.tooltip).clicked() {
            compare.start_with(settings.clone());
        }
    });
    unlabelled_row(ui, |ui| {
        let with_file = text::comparison::WITH_FILE;
        if ui.button(with_file.name).on_hover_text(with_file.tooltip).clicked() {
            commands.push(AppCommand::CompareWithFile);
        }
    });
    if let ComparisonVariant::Look(_) | ComparisonVariant::View(_) = &compare.right {
        unlabelled_row(ui, |ui| {
            let take = text::comparison::TAKE_RIGHT;
            if ui.button(take.name).on_hover_text(take.tooltip).clicked() {
                *settings = compare.right.apply(settings);
            }
        });
    }
}

fn side(ui: &mut Ui, named: ControlText, variant: &mut ComparisonVariant, called: &str) {
    row(ui, named, |ui| {
        let combo = egui::ComboBox::from_id_salt(named.name).selected_text(called).width(120.0).truncate();
        let shown = combo.show_ui(ui, |ui| {
            for choice in ComparisonVariant::WITHOUT_DATA {
                let label = text::comparison::variant_name(&choice);
                ui.selectable_value(variant, choice, label);
            }
            if let ComparisonVariant::Look(_) | ComparisonVariant::View(_) = variant {
                ui.selectable_label(true, called).clicked();
            }
        });
        let name = text::comparison::look_list_name(named.name);
        shown.response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::ComboBox, true, &name));
    });
}
