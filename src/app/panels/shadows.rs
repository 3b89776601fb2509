//! Section "Shadows" of the side panel, with the remedies for pictures that are too dark.

use eframe::egui::{self, Ui};

use super::super::text::common::FACTOR_SUFFIX;
use super::super::text::{self, ControlText};
use super::controls::{
    NumberRow, advanced_group, choice_row, choice_row_with_tips, row, switch_row, unlabelled_row,
};
use super::{PanelContext, sampling};
use crate::app::common::commands::AppCommand;
use crate::app::common::theme;
use crate::app::viewport::LightCost;
use chiaroscuro_scene::{
    DepositMode, LightShape, LightStorage, LightVolumePrecision, LightVolumeResolution, MAX_LIGHT_SAMPLES,
    MAX_MIN_BLOCKS, NearFieldRay, QualityPreset, ReverseKernel, ShadowAlgorithm, ShadowSettings,
};

/// Share of nearly black pixels from which on the meter warns: a third of the picture carries no information then.
const DARKNESS_WARNING: f64 = 0.3;

const ALGORITHMS: [(ShadowAlgorithm, ControlText); 4] = [
    (ShadowAlgorithm::Off, text::shadows::OFF),
    (ShadowAlgorithm::Splat, text::shadows::SPLAT),
    (ShadowAlgorithm::Raycast, text::shadows::RAYCAST),
    (ShadowAlgorithm::Direct, text::shadows::DIRECT),
];

const RESOLUTIONS: [(LightVolumeResolution, ControlText); 3] = [
    (LightVolumeResolution::Full, text::shadows::FULL),
    (LightVolumeResolution::Half, text::shadows::HALF),
    (LightVolumeResolution::Quarter, text::shadows::QUARTER),
];

const PRECISIONS: [(LightVolumePrecision, ControlText); 2] = [
    (LightVolumePrecision::Half, text::shadows::SIXTEEN_BITS),
    (LightVolumePrecision::Byte, text::shadows::EIGHT_BITS),
];

const STORAGES: [(LightStorage, ControlText); 3] = [
    (LightStorage::Auto, text::shadows::AUTO),
    (LightStorage::PerLight, text::shadows::PER_LIGHT),
    (LightStorage::Combined, text::shadows::COMBINED),
];

const DEPOSITS: [(DepositMode, ControlText); 2] =
    [(DepositMode::SlabMean, text::shadows::SLAB_MEAN), (DepositMode::Front, text::shadows::SLAB_FRONT)];

/// Quality levels; none is selected while the settings match no level.
const LEVELS: [(Option<QualityPreset>, ControlText); 4] = [
    (Some(QualityPreset::Fast), text::shadows::FAST),
    (Some(QualityPreset::Standard), text::shadows::STANDARD),
    (Some(QualityPreset::Fine), text::shadows::FINE),
    (Some(QualityPreset::Exact), text::shadows::EXACT),
];

const NEAR_FIELDS: [(NearFieldRay, ControlText); 3] = [
    (NearFieldRay::Off, text::shadows::CONTACT_OFF),
    (NearFieldRay::Short, text::shadows::CONTACT_SHORT),
    (NearFieldRay::Long, text::shadows::CONTACT_LONG),
];

const REVERSE_KERNELS: [(ReverseKernel, ControlText); 2] =
    [(ReverseKernel::Tent, text::shadows::TENT), (ReverseKernel::Forward, text::shadows::FORWARD_KERNEL)];

/// Shows the section "Shadows" of the side panel.
pub(super) fn show(ui: &mut Ui, panels: &mut PanelContext<'_>) {
    choice_row(ui, text::shadows::ALGORITHM, &mut panels.settings.shadows.algorithm, &ALGORITHMS);
    let mut level = QualityPreset::from_settings(panels.settings);
    if choice_row(ui, text::shadows::QUALITY, &mut level, &LEVELS)
        && let Some(level) = level
    {
        level.apply(panels.settings);
    }
    if panels.facts.is_software && panels.settings.casts_rays_to_all_samples() {
        let ink = ui.visuals().warn_fg_color;
        ui.add(
            egui::Label::new(egui::RichText::new(text::shadows::SOFTWARE_RAYS_WARNING).small().color(ink))
                .wrap(),
        );
    }
    let on = panels.settings.shadows.algorithm.is_on();
    ui.add_enabled_ui(on, |ui| {
        live_rows(ui, panels);
        balance_rows(ui, panels);
        darkness_meter(ui, panels.facts.dark_share);
        light_opacity_rows(ui, panels);
        let transmission = NumberRow::new(text::shadows::TRANSMISSION, 0.0..=1.0);
        let default = panels.first_look.shadows.transmission;
        transmission.show(ui, &mut panels.settings.shadows.transmission, default);
        choice_row(ui, text::shadows::NEAR_FIELD, &mut panels.settings.shadows.near_field, &NEAR_FIELDS);
        switch_row(ui, text::shadows::FIRST_TOUCH, &mut panels.settings.shadows.first_touch);
        point_light_resolution(ui, panels);
        advanced_group(ui, "advanced shadows", |ui| {
            let combines = panels.settings.combines_lights();
            let shadows = &mut panels.settings.shadows;
            let ShadowSettings { kernel, slab, .. } = panels.first_look.shadows;
            let first = sampling::SamplingDefaults { kernel, slab };
            sampling::show_kernel_and_slab(
                ui,
                &mut shadows.kernel,
                &mut shadows.slab,
                first,
                &mut shadows.quadrature,
            );
            choice_row(ui, text::shadows::REVERSE_KERNEL, &mut shadows.reverse_kernel, &REVERSE_KERNELS);
            choice_row(ui, text::shadows::PRECISION, &mut shadows.precision, &PRECISIONS);
            choice_row(ui, text::shadows::STORAGE, &mut shadows.storage, &STORAGES);
            ui.weak(text::shadows::light_volumes(panels.facts.light_mebibytes, combines));
            choice_row(ui, text::shadows::DEPOSIT, &mut shadows.deposit, &DEPOSITS);
            let samples = &mut shadows.area.samples;
            let mut point_resolution = f64::from(*samples);
            let number =
                NumberRow::new(text::shadows::AREA_SAMPLES, 1.0..=f64::from(MAX_LIGHT_SAMPLES)).decimals(0);
            number.show(ui, &mut point_resolution, f64::from(panels.first_look.shadows.area.samples));
            *samples = point_resolution.round().clamp(1.0, f64::from(MAX_LIGHT_SAMPLES)) as u32;
            area_light_resolution(ui, panels);
            let shadows = &mut panels.settings.shadows;
            let mut blocks = f64::from(shadows.least_blocks);
            let number =
                NumberRow::new(text::shadows::MIN_BLOCKS, 1.0..=f64::from(MAX_MIN_BLOCKS)).decimals(0);
            number.show(ui, &mut blocks, f64::from(panels.first_look.shadows.least_blocks));
            shadows.least_blocks = blocks.round().clamp(1.0, f64::from(MAX_MIN_BLOCKS)) as u32;
        });
    });
}

/// Formats the cost of a light volume at another resolution, scaled from the one that was measured.
fn cost_at_resolution(
    cost: LightCost,
    measured: LightVolumeResolution,
    wanted: LightVolumeResolution,
) -> String {
    let cost = cost.at_resolution(measured.divisor() as f64 / wanted.divisor() as f64);
    text::shadows::cost(cost.ms, cost.mebibytes)
}

/// Row for the resolution of the light volumes of point lights.
fn point_light_resolution(ui: &mut Ui, panels: &mut PanelContext<'_>) {
    let (lights, measured) = (&panels.settings.lights, panels.settings.shadows.resolution);
    let cost = panels
        .facts
        .max_cost_where(|at| lights.get(at).is_some_and(|light| light.shape == LightShape::Point));
    let cost_of = |&wanted: &LightVolumeResolution| {
        Some(text::shadows::volume_cost(&cost_at_resolution(cost?, measured, wanted)))
    };
    let resolution = &mut panels.settings.shadows.resolution;
    choice_row_with_tips(ui, text::shadows::RESOLUTION, resolution, &RESOLUTIONS, cost_of);
}

/// Row for the resolution of the light volumes of area lights.
fn area_light_resolution(ui: &mut Ui, panels: &mut PanelContext<'_>) {
    let (lights, shadows) = (&panels.settings.lights, &panels.settings.shadows);
    let dims = panels.volume.map(|volume| volume.dims);
    let cost = panels
        .facts
        .max_cost_where(|at| lights.get(at).is_some_and(|light| light.shape != LightShape::Point));
    let (points, least) = (shadows.resolution, shadows.least_blocks);
    let used = |resolution: LightVolumeResolution| Some(points.max(resolution.with_min_blocks(dims?, least)));
    let measured = used(shadows.area.resolution);
    let cost_of = |&wanted: &LightVolumeResolution| {
        Some(text::shadows::area_cost(&cost_at_resolution(cost?, measured?, used(wanted)?)))
    };
    let resolution = &mut panels.settings.shadows.area.resolution;
    choice_row_with_tips(ui, text::shadows::AREA_RESOLUTION, resolution, &RESOLUTIONS, cost_of);
}

/// Row for the resolution of sky visibility or bounces, which exist once per volume, with their measured cost.
pub(super) fn soft_light_resolution(
    ui: &mut Ui,
    resolution: &mut LightVolumeResolution,
    cost: Option<LightCost>,
    used: impl Fn(LightVolumeResolution) -> Option<LightVolumeResolution>,
) {
    let measured = used(*resolution);
    let cost_of = |&wanted: &LightVolumeResolution| {
        Some(text::shadows::soft_cost(&cost_at_resolution(cost?, measured?, used(wanted)?)))
    };
    choice_row_with_tips(ui, text::shadows::RESOLUTION, resolution, &RESOLUTIONS, cost_of);
}

/// Rows for the settings that take effect without refilling a light volume.
fn live_rows(ui: &mut Ui, panels: &mut PanelContext<'_>) {
    let has_near_field = panels.settings.effective_near_field() != NearFieldRay::Off;
    let (shadows, defaults) = (&mut panels.settings.shadows, &panels.first_look.shadows);
    let strength = NumberRow::new(text::shadows::STRENGTH, 0.0..=1.0);
    strength.show(ui, &mut shadows.strength, defaults.strength);
    let offset = NumberRow::new(text::shadows::AMBIENT_OFFSET, 0.0..=1.0);
    offset.show(ui, &mut shadows.ambient_offset, defaults.ambient_offset);
    let gain = NumberRow::new(text::shadows::GAIN, 0.1..=10.0).logarithmic();
    gain.show(ui, &mut shadows.gain, defaults.gain);
    let bias = NumberRow::new(text::shadows::LIGHT_BIAS, 0.0..=2.0).unit(text::common::VOXELS_SUFFIX);
    // Near-field rays replace the bias.
    ui.add_enabled_ui(!has_near_field, |ui| bias.show(ui, &mut shadows.bias_voxels, defaults.bias_voxels));
}

fn balance_rows(ui: &mut Ui, panels: &mut PanelContext<'_>) {
    let balance = NumberRow::new(text::shadows::BALANCE, 0.1..=10.0).unit(FACTOR_SUFFIX).logarithmic();
    let shadows = &mut panels.settings.shadows;
    let before = shadows.balance;
    // A balance that is kept is measured rather than set, so there is no value to restore.
    let first = if shadows.keep_balanced { before } else { panels.first_look.shadows.balance };
    balance.show(ui, &mut shadows.balance, first);
    if shadows.balance.to_bits() != before.to_bits() {
        // A balance set by hand is no longer measured.
        shadows.keep_balanced = false;
    }
    unlabelled_row(ui, |ui| {
        let idle = !panels.is_balancing && panels.volume.is_some();
        let measure = text::shadows::MEASURE_BALANCE;
        let button = ui.add_enabled(idle, egui::Button::new(measure.name));
        if button.on_hover_text(measure.tooltip).clicked() {
            panels.commands.push(AppCommand::Balance);
        }
        if panels.is_balancing {
            ui.spinner();
        }
    });
    unlabelled_row(ui, |ui| {
        switch_row(ui, text::shadows::KEEP_BALANCED, &mut panels.settings.shadows.keep_balanced);
    });
}

/// Meter of the share of nearly black pixels in the picture.
fn darkness_meter(ui: &mut Ui, share: Option<f64>) {
    let named = text::shadows::NEARLY_BLACK;
    row(ui, named, |ui| {
        let Some(share) = share else {
            return ui.weak(text::shadows::UNKNOWN);
        };
        let ink = if share > DARKNESS_WARNING { theme::ACCENT } else { theme::LOW_BAR };
        let bar = egui::ProgressBar::new(share as f32).fill(ink).desired_width(ui.available_width() - 52.0);
        let bar = ui.add(bar.desired_height(12.0)).on_hover_text(named.tooltip);
        ui.small(text::shadows::dark_share(share));
        bar
    });
}

fn light_opacity_rows(ui: &mut Ui, panels: &mut PanelContext<'_>) {
    let opacity = NumberRow::new(text::shadows::LIGHT_OPACITY, 0.01..=2.0).unit(FACTOR_SUFFIX).logarithmic();
    let selected = *panels.selected_layer;
    let layer = panels.settings.layer_at_mut(selected);
    opacity.show(ui, &mut layer.lighting.scale, panels.first_look.layer_at(selected).lighting.scale);
    let mut linked = layer.lighting.linked;
    if switch_row(ui, text::shadows::LINKED, &mut linked).changed() {
        set_linked(layer, linked);
    }
}

/// Links or unlinks the lighting curve; when first unlinked, it starts as a copy of the eye's curve.
pub(crate) fn set_linked(layer: &mut chiaroscuro_scene::VolumeLayer, linked: bool) {
    layer.lighting.linked = linked;
    if !linked && layer.lighting.curve.points.is_empty() {
        layer.lighting.curve = layer.transfer.clone();
    }
}
