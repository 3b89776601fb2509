//! Section "Floor": the floor on which shadows fall.

use eframe::egui::Ui;

use super::super::text;
use super::Panels;
use super::controls::{Number, color, row, switch};

/// Shows the section.
pub(super) fn show(ui: &mut Ui, panels: &mut Panels<'_>) {
    let (floor, defaults) = (&mut panels.settings.floor, &panels.defaults.floor);
    switch(ui, text::floor::ON, &mut floor.on);
    let mm = panels.volume.map_or(1.0, |volume| volume.scene.mm_per_unit);
    ui.add_enabled_ui(floor.on, |ui| {
        let (mut height_mm, reach) =
            (floor.height * mm, panels.volume.map_or(1.0, |v| v.scene.support_radius()));
        let before_mm = height_mm;
        let height = Number::new(text::floor::HEIGHT, -reach * mm..=reach * mm);
        height.unit(text::common::MM).decimals(1).show(ui, &mut height_mm, defaults.height * mm);
        if height_mm != before_mm {
            floor.height = height_mm / mm;
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
