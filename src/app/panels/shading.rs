//! Section "Shading": how material answers to light, and what happens to the picture at the end.

use eframe::egui::Ui;

use super::Panels;
use super::controls::{Number, choice, color, row};
use crate::model::ToneMap;

/// Shows the section.
pub(super) fn show(ui: &mut Ui, panels: &mut Panels<'_>) {
    let (shading, defaults) = (&mut panels.settings.shading, &panels.defaults.shading);
    let tip = "Light that material gives off by itself; for glowing data";
    Number::new("Emission", 0.0..=2.0, tip).show(ui, &mut shading.emission, defaults.emission);
    let tip = "Light from everywhere, never shadowed: too much of it flattens the shape";
    Number::new("Ambient", 0.0..=1.0, tip).show(ui, &mut shading.ambient, defaults.ambient);
    let tip = "Light that a surface scatters evenly: shows how it is turned";
    Number::new("Diffuse", 0.0..=2.0, tip).show(ui, &mut shading.diffuse, defaults.diffuse);
    let tip = "Highlights; for surfaces that should look polished";
    Number::new("Specular", 0.0..=2.0, tip).show(ui, &mut shading.specular, defaults.specular);
    let tip = "How small highlights are";
    Number::new("Shininess", 1.0..=200.0, tip).log().decimals(0).show(
        ui,
        &mut shading.shininess,
        defaults.shininess,
    );
    let tip = "The density step at which material counts as a surface; higher makes noise and haze look soft";
    Number::new("Surface gradient", 1e-3..=1.0, tip).log().decimals(4).show(
        ui,
        &mut shading.surface_gradient,
        defaults.surface_gradient,
    );
    let output = &mut panels.settings.output;
    let tone_maps = [
        (ToneMap::Neutral, "Neutral", "Keeps colours up to 80 %, then rolls off smoothly"),
        (ToneMap::Clip, "Clip", "Cuts at full brightness; exact below"),
    ];
    choice(
        ui,
        "Tone map",
        "What happens to light that is brighter than the screen",
        &mut output.tone_map,
        &tone_maps,
    );
    row(ui, "Background", "Behind the volume, from the top to the bottom", |ui| {
        color(ui, "Background top", &mut output.background.top);
        color(ui, "Background bottom", &mut output.background.bottom);
        if ui.small_button("Reset").on_hover_text("Puts the dark gradient back").clicked() {
            output.background = panels.defaults.output.background;
        }
    });
}
