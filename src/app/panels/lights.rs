//! Section "Lights" of the side panel: the list of lights and the settings of the selected one.

use eframe::egui::{self, Ui};
use glam::DVec3;

use super::super::text::common::{DEGREES, FACTOR_SUFFIX};
use super::super::text::{self, ControlText};
use super::PanelContext;
use super::controls::{
    NumberRow, SceneUnit, choice_row, color_button, indented_rows, row, switch_row, unlabelled_row,
};
use crate::app::common::commands::AppCommand;
use crate::app::common::elide::elide_middle;
use crate::app::common::theme;
use chiaroscuro_scene::{
    Camera, LightGeometry, LightLock, LightSettings, LightShape, MAX_LIGHTS, MAX_NAME_CHARS, Settings,
    Spotlight,
};

const KINDS: [(LightGeometry, ControlText); 2] = [
    (LightGeometry::Parallel, text::lights::PARALLEL),
    (LightGeometry::Perspective, text::lights::PERSPECTIVE),
];

const LOCKS: [(LightLock, ControlText); 2] =
    [(LightLock::Scene, text::lights::WITH_VOLUME), (LightLock::Camera, text::lights::WITH_CAMERA)];

const SHAPES: [(LightShape, ControlText); 4] = [
    (LightShape::Point, text::lights::POINT),
    (LightShape::Disc, text::lights::DISC),
    (LightShape::Rectangle, text::lights::RECTANGLE),
    (LightShape::Ball, text::lights::SPHERE),
];

/// Light that the reset buttons restore: the one of the first look with the same name or, if the light was renamed,
/// at the same index; for added lights, their initial state.
fn reset_values(first: &[LightSettings], lights: &[LightSettings], index: usize) -> LightSettings {
    let Some(light) = lights.get(index) else { return LightSettings::default() };
    let has_same_name = |first: &&LightSettings| lights.iter().any(|light| light.name == first.name);
    let of_first_look = first.iter().find(|first| first.name == light.name);
    let renamed = || first.get(index).filter(|first| !has_same_name(first));
    let number = || (1..=MAX_LIGHTS).find(|&number| text::lights::default_name(number) == light.name);
    let added = || LightSettings {
        intensity: added_intensity(number().unwrap_or(index + 1)),
        position: [0.0, 0.0, ADDED_LIGHT_DISTANCE],
        ..LightSettings::default()
    };
    of_first_look.or_else(renamed).cloned().unwrap_or_else(added)
}

/// Shows the list of lights, with the settings of the selected one below it.
pub(super) fn show(ui: &mut Ui, panels: &mut PanelContext<'_>) {
    let mut removed = None;
    let unit = panels.scene_unit();
    for index in 0..panels.settings.lights.len() {
        ui.push_id(index, |ui| {
            let selected = *panels.selected_light == index;
            if light_header(ui, &mut panels.settings.lights[index], index, selected) {
                *panels.selected_light = index;
            }
            if !selected {
                return;
            }
            let first = reset_values(&panels.first_look.lights, &panels.settings.lights, index);
            let Settings { camera, lights, .. } = &mut *panels.settings;
            if indented_rows(ui, |ui| {
                light_settings(ui, &mut lights[index], (&first, unit), camera, panels.commands)
            }) {
                removed = Some(index);
            }
        });
    }
    if let Some(index) = removed {
        panels.settings.lights.remove(index);
        *panels.selected_light = index.saturating_sub(1);
    }
    let can_add = panels.settings.lights.len() < MAX_LIGHTS;
    let button = ui.add_enabled(can_add, egui::Button::new(text::lights::ADD.name));
    // The tooltip states the cost before the light is added.
    let cost = panels.facts.light_cost().map(|cost| text::shadows::cost(cost.ms, cost.mebibytes));
    if button.on_hover_text(text::lights::add_tip(cost.as_deref())).clicked() {
        panels.commands.push(AppCommand::AddLight);
    }
}

/// Shows switch, colour and name of a light; returns true if the user selected it.
fn light_header(ui: &mut Ui, light: &mut LightSettings, index: usize, selected: bool) -> bool {
    ui.horizontal(|ui| {
        let on = ui.name_inputs(text::lights::switch_name(&light.name), |ui| ui.checkbox(&mut light.on, ""));
        on.on_hover_text(text::lights::ON_TIP);
        color_button(ui, &text::lights::color(index + 1), &mut light.color);
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
fn light_settings(
    ui: &mut Ui,
    light: &mut LightSettings,
    (first, unit): (&LightSettings, SceneUnit),
    camera: &Camera,
    commands: &mut Vec<AppCommand>,
) -> bool {
    row(ui, text::lights::NAME, |ui| {
        let field = egui::TextEdit::singleline(&mut light.name)
            .char_limit(MAX_NAME_CHARS)
            .hint_text(text::lights::NAME_HINT);
        ui.add(field.desired_width(ui.available_width() - theme::RESET_WIDTH));
    });
    if choice_row(ui, text::lights::KIND, &mut light.kind, &KINDS) {
        move_into_view(light, camera);
    }
    NumberRow::new(text::lights::INTENSITY, 0.0..=4.0).show(ui, &mut light.intensity, first.intensity);
    if light.kind == LightGeometry::Perspective {
        let mut position = DVec3::from(light.position);
        let mut distance = position.length();
        let field = NumberRow::new(text::lights::DISTANCE, 0.1..=20.0).logarithmic();
        let before = distance;
        field.show_length(ui, &mut distance, DVec3::from(first.position).length(), unit);
        if distance != before {
            position = position.normalize_or(DVec3::Z) * distance;
            light.position = position.into();
        }
        spotlight_rows(ui, &mut light.hood, &first.hood);
    }
    emitter_rows(ui, light, first, unit);
    let mut lock = light.lock;
    choice_row(ui, text::lights::LOCK, &mut lock, &LOCKS);
    if lock != light.lock {
        light.set_lock(lock, camera);
    }
    unlabelled_row(ui, |ui| {
        ui.horizontal_wrapped(|ui| {
            let headlight = text::lights::HEADLIGHT;
            if ui.button(headlight.name).on_hover_text(headlight.tooltip).clicked() {
                light.lock = LightLock::Camera;
                light.position = [0.0, 0.0, DVec3::from(light.position).length().max(2.0)];
            }
            let suggest = text::lights::SUGGEST;
            if ui.button(suggest.name).on_hover_text(suggest.tooltip).clicked() {
                commands.push(AppCommand::SuggestLight);
            }
        });
    });
    let density = NumberRow::new(text::lights::DENSITY, 0.01..=4.0).unit(FACTOR_SUFFIX).logarithmic();
    density.show(ui, &mut light.density_scale, first.density_scale);
    switch_row(ui, text::lights::CASTS_SHADOWS, &mut light.casts_shadows);
    unlabelled_row(ui, |ui| {
        ui.button(text::lights::REMOVE.name).on_hover_text(text::lights::REMOVE.tooltip).clicked()
    })
}

/// Rows for the emitter of a light: its shape and size.
fn emitter_rows(ui: &mut Ui, light: &mut LightSettings, first: &LightSettings, unit: SceneUnit) {
    choice_row(ui, text::lights::SHAPE, &mut light.shape, &SHAPES);
    if light.shape == LightShape::Point {
        return;
    }
    match light.kind {
        LightGeometry::Parallel => {
            let angle = NumberRow::new(text::lights::ANGLE, 0.0..=60.0).unit(DEGREES).decimals(1);
            angle.show(ui, &mut light.angle_deg, first.angle_deg);
        }
        LightGeometry::Perspective => {
            NumberRow::new(text::lights::SIZE, 0.0..=4.0).show_length(ui, &mut light.size, first.size, unit);
        }
    }
    if light.shape == LightShape::Rectangle {
        let aspect = NumberRow::new(text::lights::ASPECT, 0.1..=10.0).logarithmic();
        aspect.show(ui, &mut light.aspect, first.aspect);
        let turn = NumberRow::new(text::lights::ROTATION, -180.0..=180.0).unit(DEGREES).decimals(0);
        turn.show(ui, &mut light.turn_deg, first.turn_deg);
    }
}

/// Rows for the spotlight cone (hood) of a positional light.
fn spotlight_rows(ui: &mut Ui, hood: &mut Spotlight, first: &Spotlight) {
    switch_row(ui, text::lights::SPOTLIGHT, &mut hood.on);
    if hood.on {
        let cone = NumberRow::new(text::lights::CONE, 1.0..=89.0).unit(DEGREES).decimals(1);
        cone.show(ui, &mut hood.half_angle_deg, first.half_angle_deg);
        let rim = NumberRow::new(text::lights::FALLOFF, 0.0..=45.0).unit(DEGREES).decimals(1);
        rim.show(ui, &mut hood.rim_deg, first.rim_deg);
    }
}

/// Moves a light that has just become positional into the visible part of the scene, along the line from the centre.
fn move_into_view(light: &mut LightSettings, camera: &Camera) {
    // In shares of a square picture: away from its border and from the overlays there.
    let is_seen = |position: DVec3| {
        let inside = |at: f64| (0.1..=0.9).contains(&at);
        camera.pixel_from_scene(position, 1.0, 1.0).is_some_and(|(x, y, _)| inside(x) && inside(y))
    };
    if light.kind != LightGeometry::Perspective {
        return;
    }
    let scene_light = light.resolve(camera);
    let mut position = DVec3::from(scene_light.position);
    // No nearer than 1, half of the volume's longest edge.
    while !is_seen(position) && position.length() > 1.0 {
        position *= 0.95;
    }
    light.set_scene_position(position, camera);
}

/// Distance of an added light from the centre of the volume, in scene units (the longest edge is 2): outside every
/// volume.
const ADDED_LIGHT_DISTANCE: f64 = 3.0;

/// Number of candidate positions for a new light around the line of sight.
const LIGHT_POSITIONS: u32 = 8;

/// Colours of added lights, sRGB, so that they can be told apart: as pale as photographers' gels.
const ADDED_LIGHT_COLORS: [[f32; 3]; 6] = [
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
pub(crate) fn add_light(settings: &mut Settings) -> Option<usize> {
    let index = settings.lights.len();
    (index < MAX_LIGHTS).then(|| {
        settings.lights.push(LightSettings {
            name: text::lights::default_name(index + 1),
            position: free_light_position(&settings.camera, &settings.lights),
            color: ADDED_LIGHT_COLORS[index % ADDED_LIGHT_COLORS.len()],
            intensity: added_intensity(index + 1),
            ..LightSettings::default()
        });
        index
    })
}

/// Free position for a new light: of [`LIGHT_POSITIONS`] positions around the line of sight, all on the viewer's
/// side, the one farthest from the existing lights, in scene units.
fn free_light_position(camera: &Camera, lights: &[LightSettings]) -> [f64; 3] {
    let view = camera.scene_from_view();
    let place = |at: u32| {
        // The first is at the upper right, as a hand would hold a lamp.
        let (sin, cos) = (f64::from(at) * std::f64::consts::TAU / f64::from(LIGHT_POSITIONS) + 0.8).sin_cos();
        (view.z_axis + 0.85 * (cos * view.x_axis + sin * view.y_axis)).normalize_or(DVec3::Z)
    };
    let taken: Vec<DVec3> = lights.iter().map(|light| light.resolve(camera).direction()).collect();
    let nearest = |place: DVec3| taken.iter().map(|taken| taken.dot(place)).fold(-1.0, f64::max);
    let free = (0..LIGHT_POSITIONS).map(place).min_by(|&a, &b| nearest(a).total_cmp(&nearest(b)));
    (free.unwrap_or(DVec3::Z) * ADDED_LIGHT_DISTANCE).into()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn untouched_lights_equal_their_reset_values() {
        let named = |name: &str, intensity| LightSettings {
            name: name.to_owned(),
            intensity,
            ..LightSettings::default()
        };
        let first = vec![named("Key", 1.0), named("Fill", 0.1)];
        let mut settings = Settings { lights: first.clone(), ..Settings::default() };
        let is_original = |settings: &Settings, at: usize| {
            let original = reset_values(&first, &settings.lights, at);
            let light = &settings.lights[at];
            let distance = |light: &LightSettings| DVec3::from(light.position).length();
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
        assert_eq!(reset_values(&first, &settings.lights, 0).intensity, 0.1);
        assert_eq!(reset_values(&first, &settings.lights, 9).intensity, LightSettings::default().intensity);
    }
}
