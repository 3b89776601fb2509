//! Section "Lights".

use eframe::egui::{self, Ui};
use glam::DVec3;

use super::super::commands::Command;
use super::super::theme;
use super::Panels;
use super::controls::{Number, choice, color, row, switch};
use crate::model::{Camera, Light, LightKind, MAX_LIGHTS, Settings};

const KINDS: [(LightKind, &str, &str); 2] = [
    (LightKind::Parallel, "Parallel", "Like the sun: shadows have the size of what casts them"),
    (LightKind::Perspective, "Perspective", "Like a lamp at a point: shadows grow with the distance"),
];

/// The list of lights; the selected one is open.
pub(super) fn show(ui: &mut Ui, panels: &mut Panels<'_>) {
    let mut removed = None;
    for index in 0..panels.settings.lights.len() {
        ui.push_id(index, |ui| {
            let selected = *panels.selected_light == index;
            if head(ui, &mut panels.settings.lights[index], index, selected) {
                *panels.selected_light = index;
            }
            if selected && body(ui, &mut panels.settings.lights[index]) {
                removed = Some(index);
            }
        });
    }
    if let Some(index) = removed {
        panels.settings.lights.remove(index);
        *panels.selected_light = index.saturating_sub(1);
    }
    let room = panels.settings.lights.len() < MAX_LIGHTS;
    let button = ui.add_enabled(room, egui::Button::new("Add light"));
    if button.on_hover_text("Adds a light beside the camera; up to eight").clicked() {
        panels.commands.push(Command::AddLight);
    }
}

/// Switch, colour and name. Whether the user selected it.
fn head(ui: &mut Ui, light: &mut Light, index: usize, selected: bool) -> bool {
    ui.horizontal(|ui| {
        let on = ui.name_inputs(format!("{} on", light.name), |ui| ui.checkbox(&mut light.on, ""));
        on.on_hover_text("Switches this light on or off; its shadows are kept");
        color(ui, &format!("Colour of light {}", index + 1), &mut light.color);
        let text = egui::RichText::new(if light.name.is_empty() { "Light" } else { &light.name });
        let text = if selected { text.color(theme::ACCENT).strong() } else { text };
        ui.selectable_label(selected, text)
            .on_hover_text("Select; its handle in the picture is marked")
            .clicked()
    })
    .inner
}

/// Everything else. Whether the light is to be removed.
fn body(ui: &mut Ui, light: &mut Light) -> bool {
    let fresh = Light::default();
    row(ui, "Name", "What this light is called in the list", |ui| {
        let field = egui::TextEdit::singleline(&mut light.name).hint_text("Name of the light");
        ui.add(field.desired_width(ui.available_width() - theme::RESET_WIDTH));
    });
    choice(ui, "Kind", "How the light's rays run", &mut light.kind, &KINDS);
    Number::new("Intensity", 0.0..=4.0, "How bright this light is; costs no new shadows").show(
        ui,
        &mut light.intensity,
        fresh.intensity,
    );
    if light.kind == LightKind::Perspective {
        let mut position = DVec3::from(light.position);
        let mut distance = position.length();
        let tip =
            "From the middle of the volume, whose longest edge is 2 long; near lights spread their shadows";
        if Number::new("Distance", 0.1..=20.0, tip).log().show(ui, &mut distance, 3.0).changed() {
            position = position.normalize_or(DVec3::Z) * distance;
            light.position = position.into();
        }
    }
    let tip = "Whether material attenuates this light; a fill light does without";
    switch(ui, "Casts shadows", tip, &mut light.casts_shadows);
    ui.button("Remove light").on_hover_text("Takes this light away; undo brings it back").clicked()
}

/// Adds a light to the upper left of the viewer and gives its index.
pub(in crate::app) fn add_light(settings: &mut Settings) -> Option<usize> {
    let index = settings.lights.len();
    (index < MAX_LIGHTS).then(|| {
        settings.lights.push(Light {
            name: format!("Light {}", index + 1),
            position: beside_the_eye(&settings.camera),
            intensity: 0.5,
            ..Light::default()
        });
        index
    })
}

fn beside_the_eye(camera: &Camera) -> [f64; 3] {
    let view = camera.scene_from_view();
    ((view.z_axis + 0.6 * view.y_axis + 0.6 * view.x_axis).normalize_or(DVec3::Z) * 3.0).into()
}
