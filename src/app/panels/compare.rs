//! Section "Compare" of the side panel: two looks of one scene, side by side.

use eframe::egui::{self, Ui};

use super::super::text::{self, Named};
use super::controls::{row, switch, unlabelled};
use crate::app::common::commands::Command;
use crate::app::viewport::compare::Compare;
use crate::model::{Settings, Variant};

/// Shows the section "Compare" of the side panel.
pub(super) fn show(ui: &mut Ui, compare: &mut Compare, settings: &mut Settings, commands: &mut Vec<Command>) {
    switch(ui, text::compared::ON, &mut compare.on);
    ui.add_enabled_ui(compare.on, |ui| {
        let [left, right] = compare.called();
        side(ui, text::compared::LEFT, &mut compare.left, &left);
        side(ui, text::compared::RIGHT, &mut compare.right, &right);
        switch(ui, text::compared::DIFFERENCE, &mut compare.difference);
    });
    unlabelled(ui, |ui| {
        let keep = text::compared::KEEP;
        if ui.button(keep.name).on_hover_text(keep.tip).clicked() {
            compare.with(settings.clone());
        }
    });
    unlabelled(ui, |ui| {
        let with_file = text::compared::WITH_FILE;
        if ui.button(with_file.name).on_hover_text(with_file.tip).clicked() {
            commands.push(Command::CompareWithFile);
        }
    });
    if let Variant::Look(_) | Variant::View(_) = &compare.right {
        unlabelled(ui, |ui| {
            let take = text::compared::TAKE_RIGHT;
            if ui.button(take.name).on_hover_text(take.tip).clicked() {
                *settings = compare.right.of(settings);
            }
        });
    }
}

fn side(ui: &mut Ui, named: Named, variant: &mut Variant, called: &str) {
    row(ui, named, |ui| {
        let combo = egui::ComboBox::from_id_salt(named.name).selected_text(called).width(120.0).truncate();
        let shown = combo.show_ui(ui, |ui| {
            for choice in Variant::PLAIN {
                let label = text::compared::variant(&choice);
                ui.selectable_value(variant, choice, label);
            }
            if let Variant::Look(_) | Variant::View(_) = variant {
                ui.selectable_label(true, called).clicked();
            }
        });
        let name = text::compared::look(named.name);
        shown.response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::ComboBox, true, &name));
    });
}
