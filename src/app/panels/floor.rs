//! Section "Floor": the floor on which shadows fall.

use eframe::egui::Ui;

use super::super::text;
use super::Panels;
use super::controls::{Number, color, row, switch};
use crate::app::common::volume_facts::VolumeFacts;
use crate::app::text::common::LengthUnit;

/// Shows the section.
pub(super) fn show(ui: &mut Ui, panels: &mut Panels<'_>) {
    let (floor, defaults) = (&mut panels.settings.floor, &panels.defaults.floor);
    switch(ui, text::floor::ON, &mut floor.on);
    let unit = panels.volume.map_or_else(|| LengthUnit::showing(1.0, true), VolumeFacts::length_unit);
    let mm = panels.volume.map_or(1.0, |volume| volume.scene.mm_per_unit) / unit.mm;
    ui.add_enabled_ui(floor.on, |ui| {
        let (mut length, reach) =
            (floor.height * mm, panels.volume.map_or(1.0, |v| v.scene.support_radius()));
        let before = length;
        let height = Number::new(text::floor::HEIGHT, -reach * mm..=reach * mm);
        height.unit(unit.suffix).decimals(1).show(ui, &mut length, defaults.height * mm);
        if length != before {
            floor.height = length / mm;
        }
        let radius = Number::new(text::floor::RADIUS, 0.5..=20.0).log();
        radius.show(ui, &mut floor.radius, defaults.radius);
        let opacity = Number::new(text::floor::OPACITY, 0.0..=1.0);
        opacity.show(ui, &mut floor.opacity, defaults.opacity);
        let named = text::floor::COLOR;
        row(ui, named, |ui| {
            ui.add_enabled_ui(!floor.shadow_only, |ui| color(ui, named.name, &mut floor.color));
        });
        switch(ui, text::floor::SHADOW_ALONE, &mut floor.shadow_only);
    });
}
