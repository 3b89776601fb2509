//! Section "Lights".

use eframe::egui::{self, Ui};
use glam::DVec3;

use super::super::commands::Command;
use super::super::theme;
use super::Panels;
use super::controls::{Number, choice, color, row, switch};
use crate::model::{Camera, Hood, Light, LightKind, LightLock, MAX_LIGHTS, Settings};

const KINDS: [(LightKind, &str, &str); 2] = [
    (LightKind::Parallel, "Parallel", "Like the sun: shadows have the size of what casts them"),
    (LightKind::Perspective, "Perspective", "Like a lamp at a point: shadows grow with the distance"),
];

const LOCKS: [(LightLock, &str, &str); 2] = [
    (LightLock::World, "The volume", "The light stays where it is: turning the camera rebuilds no shadows"),
    (
        LightLock::Camera,
        "The camera",
        "The light turns with the camera, like a lamp on the photographer's shoulder",
    ),
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
            let Settings { camera, lights, .. } = &mut *panels.settings;
            if selected && body(ui, &mut lights[index], camera) {
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
        let text = if selected { text.color(theme::accent(ui.visuals())).strong() } else { text };
        ui.selectable_label(selected, text)
            .on_hover_text("Select; its handle in the picture is marked")
            .clicked()
    })
    .inner
}

/// Everything else. Whether the light is to be removed.
fn body(ui: &mut Ui, light: &mut Light, camera: &Camera) -> bool {
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
        hood(ui, &mut light.hood);
    }
    let mut lock = light.lock;
    choice(ui, "Stays with", "What the light keeps its place to while the camera turns", &mut lock, &LOCKS);
    if lock != light.lock {
        light.set_lock(lock, camera);
    }
    row(ui, "", "", |ui| {
        let tip =
            "Puts this light where the eye is, and keeps it there: everything seen is lit, shadows hide";
        if ui.button("Headlight").on_hover_text(tip).clicked() {
            light.lock = LightLock::Camera;
            light.position = [0.0, 0.0, DVec3::from(light.position).length().max(2.0)];
        }
    });
    let tip = "Multiplies how strongly material attenuates this light alone; refills its light volume";
    Number::new("Density", 0.01..=4.0, tip).unit(" ×").log().show(
        ui,
        &mut light.density_scale,
        fresh.density_scale,
    );
    let tip = "Whether material attenuates this light; a fill light does without";
    switch(ui, "Casts shadows", tip, &mut light.casts_shadows);
    ui.button("Remove light").on_hover_text("Takes this light away; undo brings it back").clicked()
}

/// A lampshade.
fn hood(ui: &mut Ui, hood: &mut Hood) {
    let fresh = Hood::default();
    let tip = "A lampshade: the light shines only within a cone around the line to the middle of the volume";
    switch(ui, "Hood", tip, &mut hood.on);
    if hood.on {
        let tip = "From the middle of the cone to where no light is left";
        Number::new("Cone", 1.0..=89.0, tip).unit("°").decimals(1).show(
            ui,
            &mut hood.half_angle_deg,
            fresh.half_angle_deg,
        );
        let tip = "How far inside that the light begins to fade; 0 is a hard edge";
        Number::new("Rim", 0.0..=45.0, tip).unit("°").decimals(1).show(ui, &mut hood.rim_deg, fresh.rim_deg);
    }
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
