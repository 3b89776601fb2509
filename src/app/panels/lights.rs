//! Section "Lights" of the side panel: the list of lights and the settings of the selected one.

use eframe::egui::{self, Ui};
use glam::DVec3;

use super::super::text::common::{DEGREES, TIMES};
use super::super::text::{self, Named};
use super::Panels;
use super::controls::{Number, SceneUnit, choice, color, indented, row, switch, unlabelled};
use crate::app::common::commands::Command;
use crate::app::common::elide::elide_middle;
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

/// Light that the reset buttons restore: the one of the first look with the same name or, if the light was renamed,
/// at the same index; for added lights, their initial state.
fn original(first: &[Light], lights: &[Light], index: usize) -> Light {
    let Some(light) = lights.get(index) else { return Light::default() };
    let is_here = |first: &&Light| lights.iter().any(|light| light.name == first.name);
    let of_first_look = first.iter().find(|first| first.name == light.name);
    let renamed = || first.get(index).filter(|first| !is_here(first));
    let number = || (1..=MAX_LIGHTS).find(|&number| text::lights::numbered(number) == light.name);
    let added = || Light {
        intensity: added_intensity(number().unwrap_or(index + 1)),
        position: [0.0, 0.0, ADDED_DISTANCE],
        ..Light::default()
    };
    of_first_look.or_else(renamed).cloned().unwrap_or_else(added)
}

/// Shows the list of lights, with the settings of the selected one below it.
pub(super) fn show(ui: &mut Ui, panels: &mut Panels<'_>) {
    let mut removed = None;
    let unit = panels.scene_unit();
    for index in 0..panels.settings.lights.len() {
        ui.push_id(index, |ui| {
            let selected = *panels.selected_light == index;
            if head(ui, &mut panels.settings.lights[index], index, selected) {
                *panels.selected_light = index;
            }
            if !selected {
                return;
            }
            let first = original(&panels.defaults.lights, &panels.settings.lights, index);
            let Settings { camera, lights, .. } = &mut *panels.settings;
            if indented(ui, |ui| body(ui, &mut lights[index], (&first, unit), camera, panels.commands)) {
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
    // The tooltip states the cost before the light is added.
    let cost = panels.facts.light_cost().map(|cost| text::shadows::cost(cost.ms, cost.mebibytes));
    if button.on_hover_text(text::lights::add_tip(cost.as_deref())).clicked() {
        panels.commands.push(Command::AddLight);
    }
}

/// Shows switch, colour and name of a light; returns true if the user selected it.
fn head(ui: &mut Ui, light: &mut Light, index: usize, selected: bool) -> bool {
    ui.horizontal(|ui| {
        let on = ui.name_inputs(text::lights::switch(&light.name), |ui| ui.checkbox(&mut light.on, ""));
        on.on_hover_text(text::lights::ON_TIP);
        color(ui, &text::lights::color(index + 1), &mut light.color);
        let whole = if light.name.is_empty() { text::lights::UNNAMED } else { &light.name };
        let room = ui.available_width() - 2.0 * ui.spacing().button_padding.x;
        let name = egui::RichText::new(elide_middle(ui, whole, &egui::TextStyle::Button, room));
        let name = if selected { name.color(theme::accent(ui.visuals())).strong() } else { name };
        let button = ui.add(egui::Button::selectable(selected, name).truncate());
        button.widget_info(|| egui::WidgetInfo::selected(egui::Role::Button, true, selected, whole));
        button.on_hover_text(text::lights::SELECT_TIP).clicked()
    })
    .inner
}

/// Shows all other settings of the selected light; returns true if it is to be removed.
fn body(
    ui: &mut Ui,
    light: &mut Light,
    (first, unit): (&Light, SceneUnit),
    camera: &Camera,
    commands: &mut Vec<Command>,
) -> bool {
    row(ui, text::lights::NAME, |ui| {
        let field = egui::TextEdit::singleline(&mut light.name)
            .char_limit(MAX_NAME)
            .hint_text(text::lights::NAME_HINT);
        ui.add(field.desired_width(ui.available_width() - theme::RESET_WIDTH));
    });
    if choice(ui, text::lights::KIND, &mut light.kind, &KINDS) {
        bring_into_sight(light, camera);
    }
    Number::new(text::lights::INTENSITY, 0.0..=4.0).show(ui, &mut light.intensity, first.intensity);
    if light.kind == LightKind::Perspective {
        let mut position = DVec3::from(light.position);
        let mut distance = position.length();
        let field = Number::new(text::lights::DISTANCE, 0.1..=20.0).log();
        let before = distance;
        field.show_length(ui, &mut distance, DVec3::from(first.position).length(), unit);
        if distance != before {
            position = position.normalize_or(DVec3::Z) * distance;
            light.position = position.into();
        }
        hood(ui, &mut light.hood, &first.hood);
    }
    shape(ui, light, first, unit);
    let mut lock = light.lock;
    choice(ui, text::lights::LOCK, &mut lock, &LOCKS);
    if lock != light.lock {
        light.set_lock(lock, camera);
    }
    unlabelled(ui, |ui| {
        ui.horizontal_wrapped(|ui| {
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
    });
    let density = Number::new(text::lights::DENSITY, 0.01..=4.0).unit(TIMES).log();
    density.show(ui, &mut light.density_scale, first.density_scale);
    switch(ui, text::lights::CASTS_SHADOWS, &mut light.casts_shadows);
    unlabelled(ui, |ui| {
        ui.button(text::lights::REMOVE.name).on_hover_text(text::lights::REMOVE.tip).clicked()
    })
}

/// Rows for the emitter of a light: its shape and size.
fn shape(ui: &mut Ui, light: &mut Light, first: &Light, unit: SceneUnit) {
    choice(ui, text::lights::SHAPE, &mut light.shape, &SHAPES);
    if light.shape == LightShape::Point {
        return;
    }
    match light.kind {
        LightKind::Parallel => {
            let angle = Number::new(text::lights::ANGLE, 0.0..=60.0).unit(DEGREES).decimals(1);
            angle.show(ui, &mut light.angle_deg, first.angle_deg);
        }
        LightKind::Perspective => {
            Number::new(text::lights::SIZE, 0.0..=4.0).show_length(ui, &mut light.size, first.size, unit);
        }
    }
    if light.shape == LightShape::Rectangle {
        let aspect = Number::new(text::lights::ASPECT, 0.1..=10.0).log();
        aspect.show(ui, &mut light.aspect, first.aspect);
        let turn = Number::new(text::lights::TURN, -180.0..=180.0).unit(DEGREES).decimals(0);
        turn.show(ui, &mut light.turn_deg, first.turn_deg);
    }
}

/// Rows for the spotlight cone (hood) of a positional light.
fn hood(ui: &mut Ui, hood: &mut Hood, first: &Hood) {
    switch(ui, text::lights::HOOD, &mut hood.on);
    if hood.on {
        let cone = Number::new(text::lights::CONE, 1.0..=89.0).unit(DEGREES).decimals(1);
        cone.show(ui, &mut hood.half_angle_deg, first.half_angle_deg);
        let rim = Number::new(text::lights::RIM, 0.0..=45.0).unit(DEGREES).decimals(1);
        rim.show(ui, &mut hood.rim_deg, first.rim_deg);
    }
}

/// Moves a light that has just become positional into the visible part of the scene, along the line from the centre.
fn bring_into_sight(light: &mut Light, camera: &Camera) {
    // In shares of a square picture: away from its border and from the overlays there.
    let is_seen = |position: DVec3| {
        let inside = |at: f64| (0.1..=0.9).contains(&at);
        camera.pixel_from_scene(position, 1.0, 1.0).is_some_and(|(x, y, _)| inside(x) && inside(y))
    };
    if light.kind != LightKind::Perspective {
        return;
    }
    let lamp = light.in_scene(camera);
    let mut position = DVec3::from(lamp.position);
    // No nearer than 1, half of the volume's longest edge.
    while !is_seen(position) && position.length() > 1.0 {
        position *= 0.95;
    }
    light.set_scene_position(position, camera);
}

/// Distance of an added light from the centre of the volume, in scene units (the longest edge is 2): outside every
/// volume.
const ADDED_DISTANCE: f64 = 3.0;

/// Number of candidate positions for a new light around the line of sight.
const PLACES: u32 = 8;

/// Colours of added lights, sRGB, so that they can be told apart: as pale as photographers' gels.
const COLORS: [[f32; 3]; 6] = [
    [1.0, 0.95, 0.86],
    [0.74, 0.85, 1.0],
    [1.0, 0.82, 0.64],
    [0.80, 1.0, 0.88],
    [0.93, 0.82, 1.0],
    [1.0, 0.80, 0.84],
];

/// Intensity of the n-th light. It falls with √n, so that all lights together grow brighter by less than each adds.
fn added_intensity(count: usize) -> f64 {
    0.6 / (count as f64).sqrt()
}

/// Adds a light near the viewer and returns its index; `None` if there are [`MAX_LIGHTS`] already.
pub(in crate::app) fn add_light(settings: &mut Settings) -> Option<usize> {
    let index = settings.lights.len();
    (index < MAX_LIGHTS).then(|| {
        settings.lights.push(Light {
            name: text::lights::numbered(index + 1),
            position: free_place(&settings.camera, &settings.lights),
            color: COLORS[index % COLORS.len()],
            intensity: added_intensity(index + 1),
            ..Light::default()
        });
        index
    })
}

/// Free position for a new light: of [`PLACES`] positions around the line of sight, all on the viewer's side, the one
/// farthest from the existing lights, in scene units.
fn free_place(camera: &Camera, lights: &[Light]) -> [f64; 3] {
    let view = camera.scene_from_view();
    let place = |at: u32| {
        // The first is at the upper right, as a hand would hold a lamp.
        let (sin, cos) = (f64::from(at) * std::f64::consts::TAU / f64::from(PLACES) + 0.8).sin_cos();
        (view.z_axis + 0.85 * (cos * view.x_axis + sin * view.y_axis)).normalize_or(DVec3::Z)
    };
    let taken: Vec<DVec3> = lights.iter().map(|light| light.in_scene(camera).direction()).collect();
    let nearest = |place: DVec3| taken.iter().map(|taken| taken.dot(place)).fold(-1.0, f64::max);
    let free = (0..PLACES).map(place).min_by(|&a, &b| nearest(a).total_cmp(&nearest(b)));
    (free.unwrap_or(DVec3::Z) * ADDED_DISTANCE).into()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn untouched_lights_are_as_they_would_be_put_back() {
        let named = |name: &str, intensity| Light { name: name.to_owned(), intensity, ..Light::default() };
        let first = vec![named("Key", 1.0), named("Fill", 0.1)];
        let mut settings = Settings { lights: first.clone(), ..Settings::default() };
        let is_original = |settings: &Settings, at: usize| {
            let original = original(&first, &settings.lights, at);
            let light = &settings.lights[at];
            let distance = |light: &Light| DVec3::from(light.position).length();
            original.intensity == light.intensity && (distance(&original) - distance(light)).abs() < 1e-9
        };
        assert!(is_original(&settings, 0) && is_original(&settings, 1));
        add_light(&mut settings);
        add_light(&mut settings);
        assert!((0..4).all(|at| is_original(&settings, at)));
        // Independent of the light's name and index.
        settings.lights[1].name = "Rim".to_owned();
        assert!((0..4).all(|at| is_original(&settings, at)));
        settings.lights[1].name = "Fill".to_owned();
        settings.lights.remove(0);
        assert!((0..3).all(|at| is_original(&settings, at)));
        settings.lights[0].intensity = 0.3;
        assert!(!is_original(&settings, 0));
        assert_eq!(original(&first, &settings.lights, 0).intensity, 0.1);
        assert_eq!(original(&first, &settings.lights, 9).intensity, Light::default().intensity);
    }
}
