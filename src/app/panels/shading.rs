//! Section "Shading" of the side panel: render mode, reflection of the material, exposure, tone map,
//! antialiasing and background.

use eframe::egui::Ui;

use super::super::text::common::FACTOR_SUFFIX;
use super::super::text::{self, ControlText};
use super::PanelContext;
use super::controls::{NumberRow, choice_row, color_button, reset_button_cell, row};
use super::render_mode;
use chiaroscuro_scene::{LitSides, MAX_EXPOSURE, MIN_EXPOSURE, RenderMode, ToneMap};

const TONE_MAPS: [(ToneMap, ControlText); 2] =
    [(ToneMap::Neutral, text::shading::NEUTRAL), (ToneMap::Clip, text::shading::CLIP)];

const ANTIALIASING: [(u32, ControlText); 4] = [
    (1, text::shading::NO_ANTIALIASING),
    (4, text::shading::FOUR_RAYS),
    (8, text::shading::EIGHT_RAYS),
    (16, text::shading::SIXTEEN_RAYS),
];

const SIDES: [(LitSides, ControlText); 2] =
    [(LitSides::One, text::shading::ONE_SIDE), (LitSides::Two, text::shading::BOTH_SIDES)];

/// Shows the section "Shading" of the side panel.
pub(super) fn show(ui: &mut Ui, panels: &mut PanelContext<'_>) {
    render_mode::show(ui, panels);
    let is_lit = !panels.settings.is_unlit();
    ui.add_enabled_ui(is_lit, |ui| reflection_rows(ui, panels));
    let output = &mut panels.settings.output;
    ui.add_enabled_ui(is_lit, |ui| {
        let exposure = NumberRow::new(text::shading::EXPOSURE, MIN_EXPOSURE..=MAX_EXPOSURE)
            .unit(FACTOR_SUFFIX)
            .logarithmic();
        exposure.show(ui, &mut output.exposure, panels.first_look.output.exposure);
        choice_row(ui, text::shading::TONE_MAP, &mut output.tone_map, &TONE_MAPS);
    });
    choice_row(ui, text::shading::ANTIALIASING, &mut output.antialiasing, &ANTIALIASING);
    row(ui, text::shading::BACKGROUND, |ui| {
        color_button(ui, text::shading::BACKGROUND_TOP, &mut output.background.top);
        color_button(ui, text::shading::BACKGROUND_BOTTOM, &mut output.background.bottom);
        let first = panels.first_look.output.background;
        let back = (output.background != first).then_some(text::common::FIRST_LOOK);
        if reset_button_cell(ui, text::shading::BACKGROUND.name, back) {
            output.background = first;
        }
    });
}

/// Shows the rows of how material reflects light.
fn reflection_rows(ui: &mut Ui, panels: &mut PanelContext<'_>) {
    // A sky replaces the ambient light.
    let is_flat = !panels.settings.sky.is_on();
    let is_surface = panels.settings.render_mode() == RenderMode::Surface;
    let (shading, defaults) = (&mut panels.settings.shading, &panels.first_look.shading);
    let emission = NumberRow::new(text::shading::EMISSION, 0.0..=2.0);
    emission.show(ui, &mut shading.emission, defaults.emission);
    let ambient = NumberRow::new(text::shading::AMBIENT, 0.0..=1.0);
    ui.add_enabled_ui(is_flat, |ui| ambient.show(ui, &mut shading.ambient, defaults.ambient));
    let diffuse = NumberRow::new(text::shading::DIFFUSE, 0.0..=2.0);
    diffuse.show(ui, &mut shading.diffuse, defaults.diffuse);
    let specular = NumberRow::new(text::shading::SPECULAR, 0.0..=2.0);
    specular.show(ui, &mut shading.specular, defaults.specular);
    let shininess = NumberRow::new(text::shading::SHININESS, 1.0..=200.0).logarithmic().decimals(0);
    shininess.show(ui, &mut shading.shininess, defaults.shininess);
    let gradient = NumberRow::new(text::shading::SURFACE_GRADIENT, 1e-3..=1.0).logarithmic().decimals(4);
    // All of an opaque surface is shaded as one.
    ui.add_enabled_ui(!is_surface, |ui| {
        gradient.show(ui, &mut shading.surface_gradient, defaults.surface_gradient);
    });
    choice_row(ui, text::shading::SIDES, &mut shading.sides, &SIDES);
}
