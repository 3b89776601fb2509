//! Section "Sky and scattering", second half: light that bounces inside the volume.

use eframe::egui::Ui;

use super::super::text;
use super::super::text::common::FACTOR_SUFFIX;
use super::PanelContext;
use super::controls::{NumberRow, advanced_group};
use super::shadows::soft_light_resolution;
use super::sky_light::directions_row;
use chiaroscuro_scene::{MAX_ANISOTROPY, MAX_BOUNCES};

/// Shows the rows of multiple scattering in the section "Sky and scattering".
pub(super) fn show(ui: &mut Ui, panels: &mut PanelContext<'_>) {
    let (scattering, defaults) = (&mut panels.settings.scattering, &panels.first_look.scattering);
    let mut bounces = f64::from(scattering.bounces);
    let number = NumberRow::new(text::scattering::BOUNCES, 0.0..=f64::from(MAX_BOUNCES)).decimals(0);
    number.show(ui, &mut bounces, f64::from(defaults.bounces));
    scattering.bounces = bounces.round().clamp(0.0, f64::from(MAX_BOUNCES)) as u32;
    ui.add_enabled_ui(scattering.bounces > 0, |ui| {
        let albedo = NumberRow::new(text::scattering::ALBEDO, 0.0..=1.0);
        albedo.show(ui, &mut scattering.albedo, defaults.albedo);
        let density = NumberRow::new(text::scattering::DENSITY, 0.01..=4.0).unit(FACTOR_SUFFIX).logarithmic();
        density.show(ui, &mut scattering.density_scale, defaults.density_scale);
        let strength = NumberRow::new(text::scattering::STRENGTH, 0.0..=4.0).unit(FACTOR_SUFFIX);
        strength.show(ui, &mut scattering.strength, defaults.strength);
    });
    let anisotropy = NumberRow::new(text::scattering::ANISOTROPY, -MAX_ANISOTROPY..=MAX_ANISOTROPY);
    anisotropy.show(ui, &mut scattering.anisotropy, defaults.anisotropy);
    ui.add_enabled_ui(scattering.bounces > 0, |ui| {
        advanced_group(ui, "scattering", |ui| {
            directions_row(ui, text::scattering::DIRECTIONS, &mut scattering.directions);
            let (shadows, dims) = (&panels.settings.shadows, panels.volume.map(|volume| volume.dims));
            let used = |resolution| Some(shadows.soft_resolution(resolution, dims?));
            soft_light_resolution(ui, &mut scattering.resolution, panels.facts.bounces_cost(), used);
        });
    });
}
