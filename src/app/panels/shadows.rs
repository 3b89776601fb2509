//! Section "Shadows", with the cures for darkness.

use eframe::egui::{self, Ui};

use super::super::commands::Command;
use super::super::theme;
use super::controls::{Number, advanced, choice, row, switch};
use super::{Panels, sampling};
use crate::model::{Deposit, LightStorage, Precision, Resolution, ShadowAlgorithm};

/// From this share of black the meter warns: a third of the picture tells nothing any more.
const MUCH_DARKNESS: f64 = 0.3;

/// Shows the section.
pub(super) fn show(ui: &mut Ui, panels: &mut Panels<'_>) {
    let algorithms = [
        (ShadowAlgorithm::Off, "Off", "Light reaches everything: only the shading is left"),
        (ShadowAlgorithm::Splat, "Splat", "A light volume filled by sheet-buffer splatting: the quick way"),
        (
            ShadowAlgorithm::Raycast,
            "Ray",
            "A light volume filled by a ray from every voxel: a little sharper, many times slower when a light moves",
        ),
        (
            ShadowAlgorithm::Direct,
            "Direct",
            "A ray to the light from every sample: the sharpest shadows; every picture takes as long as a light volume",
        ),
    ];
    choice(
        ui,
        "Shadows",
        "How light is attenuated on its way",
        &mut panels.settings.shadows.algorithm,
        &algorithms,
    );
    let on = panels.settings.shadows.algorithm.is_on();
    ui.add_enabled_ui(on, |ui| {
        live(ui, panels);
        balance(ui, panels);
        darkness(ui, panels.facts.dark_share);
        opacity(ui, panels);
        let resolutions = [
            (Resolution::Full, "Full", "One light voxel per voxel"),
            (Resolution::Half, "Half", "An eighth of the memory and time; shadow edges get softer"),
            (Resolution::Quarter, "Quarter", "Soft shadows; for very large volumes"),
        ];
        let tip = "Resolution of the light volumes; they are refilled when it changes";
        choice(ui, "Resolution", tip, &mut panels.settings.shadows.resolution, &resolutions);
        advanced(ui, "advanced shadows", |ui| {
            let collapses = panels.settings.collapses_lights();
            let shadows = &mut panels.settings.shadows;
            let tip = "Each voxel takes only the light of the first sheet that touches it: crisper and brighter, \
                       with faint steps";
            switch(ui, "First touch", tip, &mut shadows.first_touch);
            let default_slab = panels.defaults.shadows.slab;
            sampling::show(ui, &mut shadows.kernel, (&mut shadows.slab, default_slab), &mut shadows.quadrature);
            let deposits = [
                (Deposit::SlabMean, "Mean", "The mean over the slab: hardly depends on its thickness"),
                (Deposit::Front, "Front", "What arrives in front of the slab: a little brighter; the paper's equation"),
            ];
            let precisions = [
                (Precision::Half, "16 bits", "Even in the dark, and under gain"),
                (Precision::Byte, "8 bits", "Half the memory; shows steps where gain lifts dark parts"),
            ];
            choice(ui, "Precision", "How light volumes are kept", &mut shadows.precision, &precisions);
            let storages = [
                (LightStorage::Auto, "Auto", "One for all from five lights on, where nothing shines"),
                (LightStorage::PerLight, "Each", "A volume for each light: highlights, and colours that change at once"),
                (
                    LightStorage::Collapsed,
                    "One",
                    "The diffuse light of all in one volume: quick pictures under many lights, without their highlights",
                ),
            ];
            choice(ui, "Volumes", "A light volume for each light, or one for all", &mut shadows.storage, &storages);
            let kind = if collapses { "one for all lights" } else { "one for each light" };
            ui.weak(format!("Light volumes: {:.1} MiB, {kind}", panels.facts.light_mebibytes));
            choice(ui, "Deposit", "Which light a sheet leaves in its voxels", &mut shadows.deposit, &deposits);
        });
    });
}

/// What takes effect without refilling a light volume.
fn live(ui: &mut Ui, panels: &mut Panels<'_>) {
    let (shadows, defaults) = (&mut panels.settings.shadows, &panels.defaults.shadows);
    let tip = "0 shows no shadows, 1 shows them fully; between, they are mixed";
    Number::new("Strength", 0.0..=1.0, tip).show(ui, &mut shadows.strength, defaults.strength);
    let tip = "Light that reaches everything: lifts black interiors without touching bright parts";
    Number::new("Ambient offset", 0.0..=1.0, tip).show(
        ui,
        &mut shadows.ambient_offset,
        defaults.ambient_offset,
    );
    let tip = "Multiplies the light that is left, up to full light: brightens half-shadows";
    Number::new("Gain", 0.1..=10.0, tip).log().show(ui, &mut shadows.gain, defaults.gain);
    let tip = "Looks up the light a little nearer to its source: takes self-shadowing off surfaces";
    Number::new("Light bias", 0.0..=2.0, tip).unit(" vox").show(
        ui,
        &mut shadows.bias_voxels,
        defaults.bias_voxels,
    );
}

fn balance(ui: &mut Ui, panels: &mut Panels<'_>) {
    let shadows = &mut panels.settings.shadows;
    let tip = "Multiplies the lights while shadows are on, so that the picture is as bright as without them";
    Number::new("Balance", 0.1..=10.0, tip).unit(" ×").log().show(
        ui,
        &mut shadows.balance,
        panels.defaults.shadows.balance,
    );
    row(ui, "", tip, |ui| {
        let idle = !panels.balancing && panels.volume.is_some();
        let button = ui.add_enabled(idle, egui::Button::new("Balance brightness"));
        if button
            .on_hover_text("Measures the picture with and without shadows and sets the balance")
            .clicked()
        {
            panels.commands.push(Command::Balance);
        }
        if panels.balancing {
            ui.spinner();
        }
    });
}

/// How much of the picture is lost in the dark.
fn darkness(ui: &mut Ui, share: Option<f64>) {
    let tip = "Share of what is seen that is nearly black. Light opacity below 1 lets light pass thin parts, a \
               narrow Gaussian or a light bias frees surfaces from their own shadow, an ambient offset lifts all";
    row(ui, "Nearly black", tip, |ui| {
        let Some(share) = share else {
            return ui.weak("–");
        };
        let ink = if share > MUCH_DARKNESS { theme::ACCENT } else { theme::HISTOGRAM };
        let bar = egui::ProgressBar::new(share as f32).fill(ink).desired_width(ui.available_width() - 52.0);
        let bar = ui.add(bar.desired_height(12.0)).on_hover_text(tip);
        ui.small(format!("{:.0} %", share * 100.0));
        bar
    });
}

fn opacity(ui: &mut Ui, panels: &mut Panels<'_>) {
    let tip = "Multiplies how strongly material attenuates light, not the eye: below 1 lets light pass thin \
               structures; refills the light volumes";
    Number::new("Light opacity", 0.01..=2.0, tip).unit(" ×").log().show(
        ui,
        &mut panels.settings.lighting.scale,
        panels.defaults.lighting.scale,
    );
    let mut linked = panels.settings.lighting.linked;
    let tip =
        "Light meets the opacity that the eye sees. Unlinked, it gets a curve of its own in the editor below";
    if switch(ui, "Light opacity follows the eye's", tip, &mut linked).changed() {
        set_linked(panels.settings, linked);
    }
}

/// Links or unlinks the lighting curve; the first time it starts as a copy of the eye's.
pub(in crate::app) fn set_linked(settings: &mut crate::model::Settings, linked: bool) {
    settings.lighting.linked = linked;
    if !linked && settings.lighting.curve.points.is_empty() {
        settings.lighting.curve = settings.transfer.clone();
    }
}
