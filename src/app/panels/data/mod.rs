//! Section "Data" of the side panel: facts about the volume, its corrections, and the length to which opacities
//! refer.

mod alternatives;
mod corrections;
mod layers;
mod range;

use eframe::egui::{self, Ui};

use super::PanelContext;
use super::controls::{format_number, format_spacing, reset_button_cell, row};
use crate::app::common::commands::{AppCommand, SUBSAMPLINGS};
use crate::app::common::elide::elide_middle;
use crate::app::common::volume_facts::VolumeFacts;
use crate::app::text::{self, ControlText};
use chiaroscuro_files::sanitised;
use chiaroscuro_scene::{OpacityLength, Settings};
use chiaroscuro_volume::{KindName, ValueRange};

/// Longest part of a path that is laid out, in characters; it is then cut to the available width.
const MAX_PATH_CHARS: usize = 4096;

/// Shows the section "Data" of the side panel.
pub(super) fn show(ui: &mut Ui, panels: &mut PanelContext<'_>) {
    let Some(volume) = panels.volume else {
        ui.label(text::data::NOTHING_OPEN);
        return;
    };
    facts(ui, volume);
    alternatives::show(ui, volume, &mut panels.settings.sampling, panels.commands);
    layers::show(ui, panels, volume);
    let selected = volume.of_layer(*panels.selected_layer);
    range::show(ui, panels.settings, selected);
    opacity_unit(ui, panels.settings, panels.first_look, selected);
    data_kind_row(ui, panels.treated_as, panels.commands);
    subsampling_row(ui, volume, panels.commands);
    corrections::show(ui, panels.settings, volume);
}

fn facts(ui: &mut Ui, volume: &VolumeFacts) {
    let ValueRange { low, high } = volume.ranges.all;
    let mut rows = vec![
        (text::data::NAME, volume.name.clone()),
        (text::data::SOURCE, sanitised(&volume.source.to_string_lossy(), MAX_PATH_CHARS)),
        (text::data::DIMENSIONS, text::data::dimensions(volume.dims)),
        (text::data::VOXEL_TYPE, volume.voxel_type.to_owned()),
        (text::data::KIND, text::data::kind(volume.kind)),
        (text::data::SPACING, format_spacing(volume.spacing_mm, volume.has_unknown_scale)),
        (text::data::VALUES, text::data::values(&format_number(low), &format_number(high))),
        (text::data::MEMORY, text::data::memory_size(volume.bytes as f64 / f64::from(1 << 20))),
    ];
    if volume.file_dims != volume.dims {
        rows.insert(
            3,
            (text::data::READ_OF, text::data::file_dimensions(&volume.held.portion, volume.file_dims)),
        );
    }
    if let (Some(region), Some(grid)) = (volume.held.portion.region, volume.held.grid) {
        rows.insert(3, (text::data::REGION, text::data::region(&region, grid)));
    }
    if volume.non_finite_voxels > 0 {
        rows.push((text::data::NOT_FINITE, text::data::non_finite_voxels(volume.non_finite_voxels)));
    }
    for (name, fact) in rows {
        row(ui, ControlText { name, tooltip: "" }, |ui| {
            let shown = elide_middle(ui, &fact, &egui::TextStyle::Body, ui.available_width());
            let is_cut = shown != fact;
            let label = ui.add(egui::Label::new(shown).truncate());
            if is_cut {
                label.on_hover_text(fact);
            }
        });
    }
}

/// Row that chooses the kind of data for which the first look is made.
fn data_kind_row(ui: &mut Ui, treated_as: Option<KindName>, commands: &mut Vec<AppCommand>) {
    let named = text::data::TREAT_AS;
    row(ui, named, |ui| {
        let shown = text::data::kind_choice(treated_as).name;
        let combo = egui::ComboBox::from_id_salt("treat as").selected_text(shown).width(120.0);
        ui.name_inputs(named.name, |ui| {
            combo.show_ui(ui, |ui| {
                for kind in KindName::choices() {
                    let option = text::data::kind_choice(kind);
                    let label = ui.selectable_label(kind == treated_as, option.name);
                    if label.on_hover_text(option.tooltip).clicked() {
                        commands.push(AppCommand::TreatAs(kind));
                    }
                }
            })
        });
    });
}

/// Row that subsamples the volume, for faster pictures and less memory: the file is read again.
fn subsampling_row(ui: &mut Ui, volume: &VolumeFacts, commands: &mut Vec<AppCommand>) {
    let current = volume.held.portion.thinning;
    let mut options: Vec<_> =
        SUBSAMPLINGS.map(|thinning| (thinning, text::data::subsampling(thinning))).into();
    if !SUBSAMPLINGS.contains(&current) {
        options.push((current, text::data::subsampling(current)));
    }
    let named = text::data::SUBSAMPLE;
    row(ui, named, |ui| {
        let shown = text::data::subsampling(current).name;
        let combo = egui::ComboBox::from_id_salt("fewer voxels").selected_text(shown).width(120.0);
        ui.name_inputs(named.name, |ui| {
            combo.show_ui(ui, |ui| {
                for &(thinning, option) in &options {
                    let label = ui.selectable_label(thinning == current, option.name);
                    if label.on_hover_text(option.tooltip).clicked() && thinning != current {
                        commands.push(AppCommand::Subsample(thinning));
                    }
                }
            })
        });
    });
}

/// Converts a length into the unit in which it is shown: in voxels instead of millimetres if their size is unknown.
fn displayed_length(length: OpacityLength, volume: &VolumeFacts) -> OpacityLength {
    match length {
        OpacityLength::Mm(_) if volume.has_unknown_scale => {
            OpacityLength::Voxels(length.scene_units(&volume.scene) / volume.scene.mean_edge())
        }
        other => other,
    }
}

/// Name and tooltip of the unit of a length.
fn length_unit_text(length: OpacityLength) -> ControlText {
    match length {
        OpacityLength::Mm(_) => text::data::MILLIMETRES,
        OpacityLength::Voxels(_) => text::data::VOXELS,
        OpacityLength::Extent(_) => text::data::EXTENT,
    }
}

fn opacity_unit(ui: &mut Ui, settings: &mut Settings, defaults: &Settings, volume: &VolumeFacts) {
    let scene = volume.scene;
    let in_scene = settings.layer_at(volume.layer).opacity_unit.scene_units(&scene);
    let conversions = [
        OpacityLength::Mm(in_scene * scene.mm_per_unit),
        OpacityLength::Voxels(in_scene / scene.mean_edge()),
        OpacityLength::Extent(in_scene / 2.0),
    ];
    let shown = displayed_length(settings.layer_at(volume.layer).opacity_unit, volume);
    let first = defaults.layer_at(volume.layer).opacity_unit;
    let mut chosen = settings.layer_at(volume.layer).opacity_unit;
    let named = text::data::OPACITY_UNIT;
    row(ui, named, |ui| {
        let mut number = shown.number();
        let speed = number * 0.01;
        let field = egui::DragValue::new(&mut number).speed(speed).range(1e-6..=1e6).max_decimals(5);
        if ui.name_inputs(named.name, |ui| ui.add(field)).on_hover_text(named.tooltip).changed() {
            chosen = match shown {
                OpacityLength::Mm(_) => OpacityLength::Mm(number),
                OpacityLength::Voxels(_) => OpacityLength::Voxels(number),
                OpacityLength::Extent(_) => OpacityLength::Extent(number),
            };
        }
        let unit = length_unit_text(shown);
        let combo = egui::ComboBox::from_id_salt("opacity unit").selected_text(unit.name).width(60.0);
        ui.name_inputs(text::data::UNITS, |ui| {
            combo.show_ui(ui, |ui| {
                let is_known = |length: &OpacityLength| displayed_length(*length, volume) == *length;
                for length in conversions.into_iter().filter(is_known) {
                    let option = length_unit_text(length);
                    let label = ui.selectable_label(option == unit, option.name);
                    if label.on_hover_text(option.tooltip).clicked() {
                        chosen = length;
                    }
                }
            })
        });
        let back = displayed_length(first, volume);
        let back = text::data::length(&format_number(back.number()), length_unit_text(back));
        if reset_button_cell(ui, named.name, (chosen != first).then_some(back.as_str())) {
            chosen = first;
        }
    });
    settings.layer_at_mut(volume.layer).opacity_unit = chosen;
}
