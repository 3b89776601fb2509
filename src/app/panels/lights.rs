//! Section "Lights".

use eframe::egui::{self, Ui};
use glam::DVec3;

use super::super::text::common::{DEGREES, TIMES};
use super::super::text::{self, Named};
use super::Panels;
use super::controls::{Number, choice, color, row, switch, unlabelled};
use crate::app::common::commands::Command;
use crate::app::common::theme;
use crate::model::{Camera, Hood, Light, LightKind, LightLock, LightShape, MAX_LIGHTS, MAX_NAME, Settings};

const KINDS: [(LightKind, Named); 2] =
    [(LightKind::Parallel, text::lights::PARALLEL), (LightKind::Perspective, text::lights::PERSPECTIVE)];

const LOCKS: [(LightLock, Named); 2] =
    [(LightLock::Scene, text::lights::WITH_VOLUME), (LightLock::Camera, text::lights::WITH_CAMERA)];

const SHAPES: [(LightShape, Named); 4] = [
    (LightShape::Point, text::lights::POINT),
    (LightShape::Disc, text::lights::DISC),
    (LightShape::Rectangle, text::lights::RECTANGLE),
    (LightShape::Ball, text::lights::BALL),
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
            if selected && body(ui, &mut lights[index], camera, panels.commands) {
                removed = Some(index);
            }
        });
    }
    if let Some(index) = removed {
        panels.settings.lights.remove(index);
        *panels.selected_light = index.saturating_sub(1);
    }
    let room = panels.settings.lights.len() < MAX_LIGHTS;
    let button = ui.add_enabled(room, egui::Button::new(text::lights::ADD.name));
    if button.on_hover_text(text::lights::ADD.tip).clicked() {
        panels.commands.push(Command::AddLight);
    }
}

/// Switch, colour and name. Whether the user selected it.
fn head(ui: &mut Ui, light: &mut Light, index: usize, selected: bool) -> bool {
    ui.horizontal(|ui| {
        let on = ui.name_inputs(text::lights::switch(&light.name), |ui| ui.checkbox(&mut light.on, ""));
        on.on_hover_text(text::lights::ON_TIP);
        color(ui, &text::lights::color(index + 1), &mut light.color);
        let name = if light.name.is_empty() { text::lights::UNNAMED } else { &light.name };
        let name = egui::RichText::new(name);
        let name = if selected { name.color(theme::accent(ui.visuals())).strong() } else { name };
        ui.selectable_label(selected, name).on_hover_text(text::lights::SELECT_TIP).clicked()
    })
    .inner
}

/// Everything else. Whether the light is to be removed.
fn body(ui: &mut Ui, light: &mut Light, camera: &Camera, commands: &mut Vec<Command>) -> bool {
    let fresh = Light::default();
    row(ui, text::lights::NAME, |ui| {
        let field = egui::TextEdit::singleline(&mut light.name)
            .char_limit(MAX_NAME)
            .hint_text(text::lights::NAME_HINT);
        ui.add(field.desired_width(ui.available_width() - theme::RESET_WIDTH));
    });
    choice(ui, text::lights::KIND, &mut light.kind, &KINDS);
    Number::new(text::lights::INTENSITY, 0.0..=4.0).show(ui, &mut light.intensity, fresh.intensity);
    if light.kind == LightKind::Perspective {
        let mut position = DVec3::from(light.position);
        let mut distance = position.length();
        let field = Number::new(text::lights::DISTANCE, 0.1..=20.0).log();
        if field.show(ui, &mut distance, 3.0).changed() {
            position = position.normalize_or(DVec3::Z) * distance;
            light.position = position.into();
        }
        hood(ui, &mut light.hood);
    }
    shape(ui, light);
    let mut lock = light.lock;
    choice(ui, text::lights::LOCK, &mut lock, &LOCKS);
    if lock != light.lock {
        light.set_lock(lock, camera);
    }
    unlabelled(ui, |ui| {
        let headlight = text::lights::HEADLIGHT;
        if ui.button(headlight.name).on_hover_text(headlight.tip).clicked() {
            light.lock = LightLock::Camera;
            light.position = [0.0, 0.0, DVec3::from(light.position).length().max(2.0)];
        }
        let suggest = text::lights::SUGGEST;
        if ui.button(suggest.name).on_hover_text(suggest.tip).clicked() {
            commands.push(Command::SuggestLight);
        }
    });
    let density = Number::new(text::lights::DENSITY, 0.01..=4.0).unit(TIMES).log();
    density.show(ui, &mut light.density_scale, fresh.density_scale);
    switch(ui, text::lights::CASTS_SHADOWS, &mut light.casts_shadows);
    ui.button(text::lights::REMOVE.name).on_hover_text(text::lights::REMOVE.tip).clicked()
}

/// What shines, and how large it is.
fn shape(ui: &mut Ui, light: &mut Light) {
    let fresh = Light::default();
    choice(ui, text::lights::SHAPE, &mut light.shape, &SHAPES);
    if light.shape == LightShape::Point {
        return;
    }
    match light.kind {
        LightKind::Parallel => {
            let angle = Number::new(text::lights::ANGLE, 0.0..=60.0).unit(DEGREES).decimals(1);
            angle.show(ui, &mut light.angle_deg, fresh.angle_deg);
        }
        LightKind::Perspective => {
            Number::new(text::lights::SIZE, 0.0..=4.0).show(ui, &mut light.size, fresh.size);
        }
    }
    if light.shape == LightShape::Rectangle {
        let aspect = Number::new(text::lights::ASPECT, 0.1..=10.0).log();
        aspect.show(ui, &mut light.aspect, fresh.aspect);
        let turn = Number::new(text::lights::TURN, -180.0..=180.0).unit(DEGREES).decimals(0);
        turn.show(ui, &mut light.turn_deg, fresh.turn_deg);
    }
}

/// A lampshade.
fn hood(ui: &mut Ui, hood: &mut Hood) {
    let fresh = Hood::default();
    switch(ui, text::lights::HOOD, &mut hood.on);
    if hood.on {
        let cone = Number::new(text::lights::CONE, 1.0..=89.0).unit(DEGREES).decimals(1);
        cone.show(ui, &mut hood.half_angle_deg, fresh.half_angle_deg);
        let rim = Number::new(text::lights::RIM, 0.0..=45.0).unit(DEGREES).decimals(1);
        rim.show(ui, &mut hood.rim_deg, fresh.rim_deg);
    }
}

/// Adds a light to the upper left of the viewer and gives its index.
pub(in crate::app) fn add_light(settings: &mut Settings) -> Option<usize> {
    let index = settings.lights.len();
    (index < MAX_LIGHTS).then(|| {
        settings.lights.push(Light {
            name: text::lights::numbered(index + 1),
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
