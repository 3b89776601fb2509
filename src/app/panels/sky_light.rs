//! Section "Sky and scattering", first half: light from all directions.

use eframe::egui::{Label, Ui};

use super::super::text::common::{DEGREES, FACTOR_SUFFIX};
use super::super::text::{self, ControlText};
use super::PanelContext;
use super::controls::{NumberRow, advanced_group, choice_row, color_button, row};
use super::shadows::soft_light_resolution;
use crate::app::common::commands::AppCommand;
use chiaroscuro_scene::{EnvironmentLight, SKY_DIRECTION_SETS, SkyMode, sky_direction_set};

const MODES: [(SkyMode, ControlText); 4] = [
    (SkyMode::Off, text::sky::OFF),
    (SkyMode::White, text::sky::WHITE),
    (SkyMode::Gradient, text::sky::GRADIENT),
    (SkyMode::Picture, text::sky::PICTURE),
];

/// Shows a choice between the sets of directions; a session may ask for any number, which its nearest set serves.
pub(super) fn directions_row(ui: &mut Ui, named: ControlText, directions: &mut u32) {
    let mut served = sky_direction_set(*directions);
    let options: Vec<_> = SKY_DIRECTION_SETS.into_iter().zip(text::sky::DIRECTION_SETS).collect();
    if choice_row(ui, named, &mut served, &options) {
        *directions = served;
    }
}

/// Shows the rows of the sky in the section "Sky and scattering".
pub(super) fn show(ui: &mut Ui, panels: &mut PanelContext<'_>) {
    let (sky, defaults) = (&mut panels.settings.sky, &panels.first_look.sky);
    let was_picture = sky.mode == SkyMode::Picture;
    choice_row(ui, text::sky::MODE, &mut sky.mode, &MODES);
    if sky.mode == SkyMode::Picture {
        environment_map_row(ui, &sky.picture, panels.commands);
        if !was_picture && sky.picture.name.is_empty() {
            panels.commands.push(AppCommand::UseEnvironmentMap);
        }
    }
    ui.add_enabled_ui(sky.is_on(), |ui| {
        let intensity = NumberRow::new(text::sky::INTENSITY, 0.0..=2.0);
        intensity.show(ui, &mut sky.intensity, defaults.intensity);
        if sky.mode == SkyMode::Gradient {
            for (named, value) in [
                (text::sky::ZENITH, &mut sky.zenith),
                (text::sky::HORIZON, &mut sky.horizon),
                (text::sky::GROUND, &mut sky.ground),
            ] {
                row(ui, named, |ui| color_button(ui, named.name, value));
            }
        }
        if matches!(sky.mode, SkyMode::Gradient | SkyMode::Picture) {
            let tilt = NumberRow::new(text::sky::TILT, 0.0..=180.0).unit(DEGREES).decimals(0);
            tilt.show(ui, &mut sky.tilt_deg, defaults.tilt_deg);
            let turn = NumberRow::new(text::sky::TURN, -180.0..=180.0).unit(DEGREES).decimals(0);
            turn.show(ui, &mut sky.turn_deg, defaults.turn_deg);
        }
        advanced_group(ui, "sky", |ui| {
            let density = NumberRow::new(text::sky::DENSITY, 0.0..=4.0).unit(FACTOR_SUFFIX);
            density.show(ui, &mut sky.density_scale, defaults.density_scale);
            directions_row(ui, text::sky::DIRECTIONS, &mut sky.directions);
            let (shadows, dims) = (&panels.settings.shadows, panels.volume.map(|volume| volume.dims));
            let used = |resolution| Some(shadows.soft_resolution(resolution, dims?));
            soft_light_resolution(ui, &mut sky.resolution, panels.facts.sky_cost(), used);
        });
    });
}

/// Row for the environment map: its name, and a button to choose another.
fn environment_map_row(ui: &mut Ui, picture: &EnvironmentLight, commands: &mut Vec<AppCommand>) {
    row(ui, text::sky::ENVIRONMENT_MAP, |ui| {
        if ui.button(text::sky::CHOOSE).clicked() {
            commands.push(AppCommand::UseEnvironmentMap);
        }
        let name = if picture.name.is_empty() { text::sky::NO_ENVIRONMENT_MAP } else { &picture.name };
        ui.add(Label::new(name).truncate()).on_hover_text(name);
    });
}
