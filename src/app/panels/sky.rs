//! Section "Sky and scattering", first half: light from all directions.

use eframe::egui::{Label, Ui};

use super::super::text::common::{DEGREES, TIMES};
use super::super::text::{self, Named};
use super::Panels;
use super::controls::{Number, advanced, choice, color, row};
use super::shadows::soft_resolution;
use crate::app::common::commands::Command;
use crate::model::{SKY_DIRECTIONS, SkyMode, SkyPicture};

const MODES: [(SkyMode, Named); 4] = [
    (SkyMode::Off, text::sky::OFF),
    (SkyMode::White, text::sky::WHITE),
    (SkyMode::Gradient, text::sky::GRADIENT),
    (SkyMode::Picture, text::sky::PICTURE),
];

/// Shows the rows of the sky in the section "Sky and scattering".
pub(super) fn show(ui: &mut Ui, panels: &mut Panels<'_>) {
    let (sky, defaults) = (&mut panels.settings.sky, &panels.defaults.sky);
    let was_picture = sky.mode == SkyMode::Picture;
    choice(ui, text::sky::MODE, &mut sky.mode, &MODES);
    if sky.mode == SkyMode::Picture {
        surroundings(ui, &sky.picture, panels.commands);
        if !was_picture && sky.picture.name.is_empty() {
            panels.commands.push(Command::UseSurroundings);
        }
    }
    ui.add_enabled_ui(sky.is_on(), |ui| {
        let intensity = Number::new(text::sky::INTENSITY, 0.0..=2.0);
        intensity.show(ui, &mut sky.intensity, defaults.intensity);
        if sky.mode == SkyMode::Gradient {
            for (named, value) in [
                (text::sky::ZENITH, &mut sky.zenith),
                (text::sky::HORIZON, &mut sky.horizon),
                (text::sky::GROUND, &mut sky.ground),
            ] {
                row(ui, named, |ui| color(ui, named.name, value));
            }
        }
        if matches!(sky.mode, SkyMode::Gradient | SkyMode::Picture) {
            let tilt = Number::new(text::sky::TILT, 0.0..=180.0).unit(DEGREES).decimals(0);
            tilt.show(ui, &mut sky.tilt_deg, defaults.tilt_deg);
            let turn = Number::new(text::sky::TURN, -180.0..=180.0).unit(DEGREES).decimals(0);
            turn.show(ui, &mut sky.turn_deg, defaults.turn_deg);
        }
        advanced(ui, "sky", |ui| {
            let density = Number::new(text::sky::DENSITY, 0.0..=4.0).unit(TIMES);
            density.show(ui, &mut sky.density_scale, defaults.density_scale);
            let (least, most) = (f64::from(*SKY_DIRECTIONS.start()), f64::from(*SKY_DIRECTIONS.end()));
            let mut directions = f64::from(sky.directions);
            let number = Number::new(text::sky::DIRECTIONS, least..=most).decimals(0);
            number.show(ui, &mut directions, f64::from(defaults.directions));
            sky.directions = directions.round().clamp(least, most) as u32;
            let (shadows, dims) = (&panels.settings.shadows, panels.volume.map(|volume| volume.dims));
            let used = |resolution| Some(shadows.soft(resolution, dims?));
            soft_resolution(ui, &mut sky.resolution, panels.facts.sky_cost(), used);
        });
    });
}

/// Row for the environment map: its name, and a button to choose another.
fn surroundings(ui: &mut Ui, picture: &SkyPicture, commands: &mut Vec<Command>) {
    row(ui, text::sky::SURROUNDINGS, |ui| {
        if ui.button(text::sky::CHOOSE).clicked() {
            commands.push(Command::UseSurroundings);
        }
        let name = if picture.name.is_empty() { text::sky::NO_SURROUNDINGS } else { &picture.name };
        ui.add(Label::new(name).truncate()).on_hover_text(name);
    });
}
