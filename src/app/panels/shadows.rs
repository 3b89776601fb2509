//! Section "Shadows" of the side panel, with the remedies for pictures that are too dark.

use eframe::egui::{self, Ui};

use super::super::text::common::TIMES;
use super::super::text::{self, Named};
use super::controls::{Number, advanced, choice, choice_with, row, switch, unlabelled};
use super::{Panels, sampling};
use crate::app::common::commands::Command;
use crate::app::common::theme;
use crate::app::viewport::LightCost;
use crate::model::{
    Deposit, LightShape, LightStorage, MAX_LEAST_BLOCKS, MAX_LIGHT_SAMPLES, NearField, Precision, Quality,
    Resolution, ReverseKernel, ShadowAlgorithm, Shadows,
};

/// Share of nearly black pixels from which on the meter warns: a third of the picture carries no information then.
const MUCH_DARKNESS: f64 = 0.3;

const ALGORITHMS: [(ShadowAlgorithm, Named); 4] = [
    (ShadowAlgorithm::Off, text::shadows::OFF),
    (ShadowAlgorithm::Splat, text::shadows::SPLAT),
    (ShadowAlgorithm::Raycast, text::shadows::RAYCAST),
    (ShadowAlgorithm::Direct, text::shadows::DIRECT),
];

const RESOLUTIONS: [(Resolution, Named); 3] = [
    (Resolution::Full, text::shadows::FULL),
    (Resolution::Half, text::shadows::HALF),
    (Resolution::Quarter, text::shadows::QUARTER),
];

const PRECISIONS: [(Precision, Named); 2] =
    [(Precision::Half, text::shadows::SIXTEEN_BITS), (Precision::Byte, text::shadows::EIGHT_BITS)];

const STORAGES: [(LightStorage, Named); 3] = [
    (LightStorage::Auto, text::shadows::AUTO),
    (LightStorage::PerLight, text::shadows::PER_LIGHT),
    (LightStorage::Combined, text::shadows::COMBINED),
];

const DEPOSITS: [(Deposit, Named); 2] =
    [(Deposit::SlabMean, text::shadows::SLAB_MEAN), (Deposit::Front, text::shadows::FRONT)];

/// Quality levels; none is selected while the settings match no level.
const LEVELS: [(Option<Quality>, Named); 4] = [
    (Some(Quality::Fast), text::shadows::FAST),
    (Some(Quality::Standard), text::shadows::STANDARD),
    (Some(Quality::Fine), text::shadows::FINE),
    (Some(Quality::Exact), text::shadows::EXACT),
];

const NEAR_FIELDS: [(NearField, Named); 3] = [
    (NearField::Off, text::shadows::NEAR_OFF),
    (NearField::Short, text::shadows::NEAR_SHORT),
    (NearField::Long, text::shadows::NEAR_LONG),
];

const REVERSE_KERNELS: [(ReverseKernel, Named); 2] =
    [(ReverseKernel::Tent, text::shadows::TENT), (ReverseKernel::Forward, text::shadows::FORWARD)];

/// Shows the section "Shadows" of the side panel.
pub(super) fn show(ui: &mut Ui, panels: &mut Panels<'_>) {
    choice(ui, text::shadows::ALGORITHM, &mut panels.settings.shadows.algorithm, &ALGORITHMS);
    let mut level = Quality::of(panels.settings);
    if choice(ui, text::shadows::QUALITY, &mut level, &LEVELS)
        && let Some(level) = level
    {
        level.apply(panels.settings);
    }
    if panels.facts.software && panels.settings.casts_rays_to_all_points() {
        let ink = ui.visuals().warn_fg_color;
        ui.add(egui::Label::new(egui::RichText::new(text::shadows::MANY_RAYS).small().color(ink)).wrap());
    }
    let on = panels.settings.shadows.algorithm.is_on();
    ui.add_enabled_ui(on, |ui| {
        live(ui, panels);
        balance(ui, panels);
        darkness(ui, panels.facts.dark_share);
        opacity(ui, panels);
        let transmission = Number::new(text::shadows::TRANSMISSION, 0.0..=1.0);
        let default = panels.defaults.shadows.transmission;
        transmission.show(ui, &mut panels.settings.shadows.transmission, default);
        choice(ui, text::shadows::NEAR_FIELD, &mut panels.settings.shadows.near_field, &NEAR_FIELDS);
        switch(ui, text::shadows::FIRST_TOUCH, &mut panels.settings.shadows.first_touch);
        resolution(ui, panels);
        advanced(ui, "advanced shadows", |ui| {
            let combines = panels.settings.combines_lights();
            let shadows = &mut panels.settings.shadows;
            let Shadows { kernel, slab, .. } = panels.defaults.shadows;
            let first = sampling::FirstLook { kernel, slab };
            sampling::show(ui, &mut shadows.kernel, &mut shadows.slab, first, &mut shadows.quadrature);
            choice(ui, text::shadows::REVERSE_KERNEL, &mut shadows.reverse_kernel, &REVERSE_KERNELS);
            choice(ui, text::shadows::PRECISION, &mut shadows.precision, &PRECISIONS);
            choice(ui, text::shadows::STORAGE, &mut shadows.storage, &STORAGES);
            ui.weak(text::shadows::light_volumes(panels.facts.light_mebibytes, combines));
            choice(ui, text::shadows::DEPOSIT, &mut shadows.deposit, &DEPOSITS);
            let samples = &mut shadows.area.samples;
            let mut points = f64::from(*samples);
            let number =
                Number::new(text::shadows::AREA_SAMPLES, 1.0..=f64::from(MAX_LIGHT_SAMPLES)).decimals(0);
            number.show(ui, &mut points, f64::from(panels.defaults.shadows.area.samples));
            *samples = points.round().clamp(1.0, f64::from(MAX_LIGHT_SAMPLES)) as u32;
            area_resolution(ui, panels);
            let shadows = &mut panels.settings.shadows;
            let mut blocks = f64::from(shadows.least_blocks);
            let number =
                Number::new(text::shadows::LEAST_BLOCKS, 1.0..=f64::from(MAX_LEAST_BLOCKS)).decimals(0);
            number.show(ui, &mut blocks, f64::from(panels.defaults.shadows.least_blocks));
            shadows.least_blocks = blocks.round().clamp(1.0, f64::from(MAX_LEAST_BLOCKS)) as u32;
        });
    });
}

/// Formats the cost of a light volume at another resolution, scaled from the one that was measured.
fn at_resolution(cost: LightCost, measured: Resolution, wanted: Resolution) -> String {
    let cost = cost.finer(measured.divisor() as f64 / wanted.divisor() as f64);
    text::shadows::cost(cost.ms, cost.mebibytes)
}

/// Row for the resolution of the light volumes of point lights.
fn resolution(ui: &mut Ui, panels: &mut Panels<'_>) {
    let (lights, measured) = (&panels.settings.lights, panels.settings.shadows.resolution);
    let cost =
        panels.facts.cost_of(|at| lights.get(at).is_some_and(|light| light.shape == LightShape::Point));
    let cost_of =
        |&wanted: &Resolution| Some(text::shadows::volume_cost(&at_resolution(cost?, measured, wanted)));
    let resolution = &mut panels.settings.shadows.resolution;
    choice_with(ui, text::shadows::RESOLUTION, resolution, &RESOLUTIONS, cost_of);
}

/// Row for the resolution of the light volumes of area lights.
fn area_resolution(ui: &mut Ui, panels: &mut Panels<'_>) {
    let (lights, shadows) = (&panels.settings.lights, &panels.settings.shadows);
    let dims = panels.volume.map(|volume| volume.dims);
    let cost =
        panels.facts.cost_of(|at| lights.get(at).is_some_and(|light| light.shape != LightShape::Point));
    let (points, least) = (shadows.resolution, shadows.least_blocks);
    let used = |resolution: Resolution| Some(points.max(resolution.with_blocks(dims?, least)));
    let measured = used(shadows.area.resolution);
    let cost_of = |&wanted: &Resolution| {
        Some(text::shadows::area_cost(&at_resolution(cost?, measured?, used(wanted)?)))
    };
    let resolution = &mut panels.settings.shadows.area.resolution;
    choice_with(ui, text::shadows::AREA_RESOLUTION, resolution, &RESOLUTIONS, cost_of);
}

/// Row for the resolution of sky visibility or bounces, which exist once per volume, with their measured cost.
pub(super) fn soft_resolution(
    ui: &mut Ui,
    resolution: &mut Resolution,
    cost: Option<LightCost>,
    used: impl Fn(Resolution) -> Option<Resolution>,
) {
    let measured = used(*resolution);
    let cost_of = |&wanted: &Resolution| {
        Some(text::shadows::soft_cost(&at_resolution(cost?, measured?, used(wanted)?)))
    };
    choice_with(ui, text::shadows::RESOLUTION, resolution, &RESOLUTIONS, cost_of);
}

/// Rows for the settings that take effect without refilling a light volume.
fn live(ui: &mut Ui, panels: &mut Panels<'_>) {
    let rays_nearby = panels.settings.near_field() != NearField::Off;
    let (shadows, defaults) = (&mut panels.settings.shadows, &panels.defaults.shadows);
    let strength = Number::new(text::shadows::STRENGTH, 0.0..=1.0);
    strength.show(ui, &mut shadows.strength, defaults.strength);
    let offset = Number::new(text::shadows::AMBIENT_OFFSET, 0.0..=1.0);
    offset.show(ui, &mut shadows.ambient_offset, defaults.ambient_offset);
    let gain = Number::new(text::shadows::GAIN, 0.1..=10.0).log();
    gain.show(ui, &mut shadows.gain, defaults.gain);
    let bias = Number::new(text::shadows::LIGHT_BIAS, 0.0..=2.0).unit(text::common::VOX);
    // Near-field rays replace the bias.
    ui.add_enabled_ui(!rays_nearby, |ui| bias.show(ui, &mut shadows.bias_voxels, defaults.bias_voxels));
}

fn balance(ui: &mut Ui, panels: &mut Panels<'_>) {
    let balance = Number::new(text::shadows::BALANCE, 0.1..=10.0).unit(TIMES).log();
    let shadows = &mut panels.settings.shadows;
    let before = shadows.balance;
    // A balance that is kept is measured rather than set, so there is no value to restore.
    let first = if shadows.keep_balanced { before } else { panels.defaults.shadows.balance };
    balance.show(ui, &mut shadows.balance, first);
    if shadows.balance.to_bits() != before.to_bits() {
        // A balance set by hand is no longer measured.
        shadows.keep_balanced = false;
    }
    unlabelled(ui, |ui| {
        let idle = !panels.balancing && panels.volume.is_some();
        let measure = text::shadows::MEASURE_BALANCE;
        let button = ui.add_enabled(idle, egui::Button::new(measure.name));
        if button.on_hover_text(measure.tip).clicked() {
            panels.commands.push(Command::Balance);
        }
        if panels.balancing {
            ui.spinner();
        }
    });
    unlabelled(ui, |ui| {
        switch(ui, text::shadows::KEEP_BALANCED, &mut panels.settings.shadows.keep_balanced);
    });
}

/// Meter of the share of nearly black pixels in the picture.
fn darkness(ui: &mut Ui, share: Option<f64>) {
    let named = text::shadows::NEARLY_BLACK;
    row(ui, named, |ui| {
        let Some(share) = share else {
            return ui.weak(text::shadows::UNKNOWN);
        };
        let ink = if share > MUCH_DARKNESS { theme::ACCENT } else { theme::HISTOGRAM };
        let bar = egui::ProgressBar::new(share as f32).fill(ink).desired_width(ui.available_width() - 52.0);
        let bar = ui.add(bar.desired_height(12.0)).on_hover_text(named.tip);
        ui.small(text::shadows::dark_share(share));
        bar
    });
}

fn opacity(ui: &mut Ui, panels: &mut Panels<'_>) {
    let opacity = Number::new(text::shadows::LIGHT_OPACITY, 0.01..=2.0).unit(TIMES).log();
    opacity.show(ui, &mut panels.settings.lighting.scale, panels.defaults.lighting.scale);
    let mut linked = panels.settings.lighting.linked;
    if switch(ui, text::shadows::LINKED, &mut linked).changed() {
        set_linked(panels.settings, linked);
    }
}

/// Links or unlinks the lighting curve; when first unlinked, it starts as a copy of the eye's curve.
pub(in crate::app) fn set_linked(settings: &mut crate::model::Settings, linked: bool) {
    settings.lighting.linked = linked;
    if !linked && settings.lighting.curve.points.is_empty() {
        settings.lighting.curve = settings.transfer.clone();
    }
}
