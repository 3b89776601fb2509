//! Section "Shading" of the side panel: reflection of the material, exposure, tone map and background.

use eframe::egui::Ui;

use super::super::text::common::TIMES;
use super::super::text::{self, Named};
use super::Panels;
use super::controls::{Number, choice, color, reset, row};
use crate::model::{MAX_EXPOSURE, MIN_EXPOSURE, Sides, ToneMap};

const TONE_MAPS: [(ToneMap, Named); 2] =
    [(ToneMap::Neutral, text::shading::NEUTRAL), (ToneMap::Clip, text::shading::CLIP)];

const SIDES: [(Sides, Named); 2] =
    [(Sides::One, text::shading::ONE_SIDE), (Sides::Two, text::shading::BOTH_SIDES)];

/// Shows the section "Shading" of the side panel.
pub(super) fn show(ui: &mut Ui, panels: &mut Panels<'_>) {
    // A sky replaces the ambient light.
    let is_flat = !panels.settings.sky.is_on();
    let (shading, defaults) = (&mut panels.settings.shading, &panels.defaults.shading);
    let emission = Number::new(text::shading::EMISSION, 0.0..=2.0);
    emission.show(ui, &mut shading.emission, defaults.emission);
    let ambient = Number::new(text::shading::AMBIENT, 0.0..=1.0);
    ui.add_enabled_ui(is_flat, |ui| ambient.show(ui, &mut shading.ambient, defaults.ambient));
    let diffuse = Number::new(text::shading::DIFFUSE, 0.0..=2.0);
    diffuse.show(ui, &mut shading.diffuse, defaults.diffuse);
    let specular = Number::new(text::shading::SPECULAR, 0.0..=2.0);
    specular.show(ui, &mut shading.specular, defaults.specular);
    let shininess = Number::new(text::shading::SHININESS, 1.0..=200.0).log().decimals(0);
    shininess.show(ui, &mut shading.shininess, defaults.shininess);
    let gradient = Number::new(text::shading::SURFACE_GRADIENT, 1e-3..=1.0).log().decimals(4);
    gradient.show(ui, &mut shading.surface_gradient, defaults.surface_gradient);
    choice(ui, text::shading::SIDES, &mut shading.sides, &SIDES);
    let output = &mut panels.settings.output;
    let exposure = Number::new(text::shading::EXPOSURE, MIN_EXPOSURE..=MAX_EXPOSURE).unit(TIMES).log();
    exposure.show(ui, &mut output.exposure, panels.defaults.output.exposure);
    choice(ui, text::shading::TONE_MAP, &mut output.tone_map, &TONE_MAPS);
    row(ui, text::shading::BACKGROUND, |ui| {
        color(ui, text::shading::BACKGROUND_TOP, &mut output.background.top);
        color(ui, text::shading::BACKGROUND_BOTTOM, &mut output.background.bottom);
        let first = panels.defaults.output.background;
        let back = (output.background != first).then_some(text::common::FIRST_LOOK);
        if reset(ui, text::shading::BACKGROUND.name, back) {
            output.background = first;
        }
    });
}
