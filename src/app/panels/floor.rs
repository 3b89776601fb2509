//! Section "Floor" of the side panel: the plane on which shadows fall.

use eframe::egui::Ui;

use super::super::text;
use super::PanelContext;
use super::controls::{NumberRow, color_button, row, switch_row};

/// Shows the section "Floor" of the side panel.
pub(super) fn show(ui: &mut Ui, panels: &mut PanelContext<'_>) {
    let unit = panels.scene_unit();
    let reach = panels.volume.map_or(1.0, |volume| volume.scene.support_radius());
    let (floor, defaults) = (&mut panels.settings.floor, &panels.first_look.floor);
    switch_row(ui, text::floor::ON, &mut floor.on);
    // If the object stands another way up than at first, the height of the first look does not apply.
    let is_up = panels.settings.camera.up == panels.first_look.camera.up;
    let first_height = if is_up { defaults.height } else { floor.height };
    ui.add_enabled_ui(floor.on, |ui| {
        let height = NumberRow::new(text::floor::HEIGHT, -reach..=reach);
        height.show_length(ui, &mut floor.height, first_height, unit);
        let radius = NumberRow::new(text::floor::RADIUS, 0.5..=20.0).logarithmic();
        radius.show_length(ui, &mut floor.radius, defaults.radius, unit);
        let opacity = NumberRow::new(text::floor::OPACITY, 0.0..=1.0);
        opacity.show(ui, &mut floor.opacity, defaults.opacity);
        let named = text::floor::COLOR;
        row(ui, named, |ui| {
            ui.add_enabled_ui(!floor.shadow_only, |ui| color_button(ui, named.name, &mut floor.color));
        });
        switch_row(ui, text::floor::SHADOW_ALONE, &mut floor.shadow_only);
    });
}
