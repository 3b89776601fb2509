//! Section "Compare": two looks of one scene, side by side.

use eframe::egui::{self, Ui};

use super::super::commands::Command;
use super::super::compare::Compare;
use super::controls::{row, switch};
use crate::model::{Settings, Variant};

/// Shows the section.
pub(super) fn show(ui: &mut Ui, compare: &mut Compare, settings: &mut Settings, commands: &mut Vec<Command>) {
    let tip = "Shows two looks in one picture: drag the line between them (C)";
    switch(ui, "Compare two looks", tip, &mut compare.on);
    ui.add_enabled_ui(compare.on, |ui| {
        side(ui, "Left", &mut compare.left);
        side(ui, "Right", &mut compare.right);
        let tip = "What lies between the two, eight times as bright; grey where they differ evenly";
        switch(ui, "Show the difference", tip, &mut compare.difference);
    });
    row(ui, "", "Compares later changes with the look as it is now", |ui| {
        let keep = ui.button("Keep this look on the right");
        if keep.on_hover_text("Then change something: the left side follows, the right side stays").clicked()
        {
            compare.with(settings.clone());
        }
    });
    row(ui, "", "Settings or a preset, laid over the look as it is now", |ui| {
        if ui.button("Compare with a file…").clicked() {
            commands.push(Command::CompareWithFile);
        }
    });
    if let Variant::Look(kept) = &compare.right {
        row(ui, "", "Makes the right look the current one", |ui| {
            if ui.button("Take the right look").clicked() {
                let camera = settings.camera.clone();
                *settings = Settings { camera, ..Settings::clone(kept) };
            }
        });
    }
}

fn side(ui: &mut Ui, label: &'static str, variant: &mut Variant) {
    row(ui, label, "Which look is on this side", |ui| {
        let combo = egui::ComboBox::from_id_salt(label).selected_text(variant.label()).width(120.0);
        let shown = combo.show_ui(ui, |ui| {
            for choice in Variant::PLAIN {
                let text = choice.label();
                ui.selectable_value(variant, choice, text);
            }
            if let Variant::Look(_) = variant {
                ui.selectable_label(true, variant.label()).clicked();
            }
        });
        shown
            .response
            .widget_info(|| egui::WidgetInfo::labeled(egui::Role::ComboBox, true, format!("{label} look")));
    });
}
