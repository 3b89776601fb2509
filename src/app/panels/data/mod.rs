//! Section "Data" of the side panel: facts about the volume, its corrections, and the length to which opacities
//! refer.

mod corrections;
mod range;
mod several;

use eframe::egui::{self, Ui};

use super::Panels;
use super::controls::{reset, row, short, spacing};
use crate::app::common::commands::{Command, THINNINGS};
use crate::app::common::elide::elide_middle;
use crate::app::common::volume_facts::VolumeFacts;
use crate::app::text::{self, Named};
use crate::data::{KindName, ValueRange, plain};
use crate::model::{Length, Settings};

/// Longest part of a path that is laid out, in characters; it is then cut to the available width.
const LONGEST_PATH: usize = 4096;

/// Shows the section "Data" of the side panel.
pub(super) fn show(ui: &mut Ui, panels: &mut Panels<'_>) {
    let Some(volume) = panels.volume else {
        ui.label(text::data::NOTHING_OPEN);
        return;
    };
    facts(ui, volume);
    several::show(ui, volume, panels.commands);
    treatment(ui, panels.treated_as, panels.commands);
    range::show(ui, panels.settings, volume);
    thinning(ui, volume, panels.commands);
    opacity_unit(ui, panels.settings, panels.defaults, volume);
    corrections::show(ui, panels.settings, volume);
}

fn facts(ui: &mut Ui, volume: &VolumeFacts) {
    let ValueRange { low, high } = volume.ranges.all;
    let mut rows = vec![
        (text::data::NAME, volume.name.clone()),
        (text::data::SOURCE, plain(&volume.source.to_string_lossy(), LONGEST_PATH)),
        (text::data::DIMENSIONS, text::data::dimensions(volume.dims)),
        (text::data::VOXEL_TYPE, volume.voxel_type.to_owned()),
        (text::data::KIND, text::data::kind(volume.kind)),
        (text::data::SPACING, spacing(volume.spacing_mm, volume.has_unknown_scale)),
        (text::data::VALUES, text::data::values(&short(low), &short(high))),
        (text::data::MEMORY, text::data::memory(volume.bytes as f64 / f64::from(1 << 20))),
    ];
    if volume.file_dims != volume.dims {
        rows.insert(3, (text::data::SHOWN_OF, text::data::shown_of(&volume.held.portion, volume.file_dims)));
    }
    if let (Some(region), Some(grid)) = (volume.held.portion.region, volume.held.grid) {
        rows.insert(3, (text::data::REGION, text::data::region(&region, grid)));
    }
    if volume.non_finite_voxels > 0 {
        rows.push((text::data::NOT_FINITE, text::data::not_finite(volume.non_finite_voxels)));
    }
    for (name, fact) in rows {
        row(ui, Named { name, tip: "" }, |ui| {
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
fn treatment(ui: &mut Ui, treated_as: Option<KindName>, commands: &mut Vec<Command>) {
    let named = text::data::TREAT_AS;
    row(ui, named, |ui| {
        let shown = text::data::treatment(treated_as).name;
        let combo = egui::ComboBox::from_id_salt("treat as").selected_text(shown).width(120.0);
        ui.name_inputs(named.name, |ui| {
            combo.show_ui(ui, |ui| {
                for kind in KindName::choices() {
                    let option = text::data::treatment(kind);
                    let label = ui.selectable_label(kind == treated_as, option.name);
                    if label.on_hover_text(option.tip).clicked() {
                        commands.push(Command::TreatAs(kind));
                    }
                }
            })
        });
    });
}

/// Row that subsamples the volume, for faster pictures and less memory: the file is read again.
fn thinning(ui: &mut Ui, volume: &VolumeFacts, commands: &mut Vec<Command>) {
    let current = volume.held.portion.thinning;
    let mut options: Vec<_> = THINNINGS.map(|thinning| (thinning, text::data::thinning(thinning))).into();
    if !THINNINGS.contains(&current) {
        options.push((current, text::data::thinning(current)));
    }
    let named = text::data::THINNING;
    row(ui, named, |ui| {
        let shown = text::data::thinning(current).name;
        let combo = egui::ComboBox::from_id_salt("fewer voxels").selected_text(shown).width(120.0);
        ui.name_inputs(named.name, |ui| {
            combo.show_ui(ui, |ui| {
                for &(thinning, option) in &options {
                    let label = ui.selectable_label(thinning == current, option.name);
                    if label.on_hover_text(option.tip).clicked() && thinning != current {
                        commands.push(Command::Thin(thinning));
                    }
                }
            })
        });
    });
}

/// Converts a length into the unit in which it is shown: in voxels instead of millimetres if their size is unknown.
fn shown_length(length: Length, volume: &VolumeFacts) -> Length {
    match length {
        Length::Mm(_) if volume.has_unknown_scale => {
            Length::Voxels(length.in_scene(&volume.scene) / volume.scene.mean_edge())
        }
        other => other,
    }
}

/// Name and tooltip of the unit of a length.
fn unit_of(length: Length) -> Named {
    match length {
        Length::Mm(_) => text::data::MILLIMETRES,
        Length::Voxels(_) => text::data::VOXELS,
        Length::Extent(_) => text::data::EXTENT,
    }
}

fn opacity_unit(ui: &mut Ui, settings: &mut Settings, defaults: &Settings, volume: &VolumeFacts) {
    let scene = volume.scene;
    let in_scene = settings.opacity_unit.in_scene(&scene);
    let conversions = [
        Length::Mm(in_scene * scene.mm_per_unit),
        Length::Voxels(in_scene / scene.mean_edge()),
        Length::Extent(in_scene / 2.0),
    ];
    let shown = shown_length(settings.opacity_unit, volume);
    let first = defaults.opacity_unit;
    let mut chosen = settings.opacity_unit;
    let named = text::data::OPACITY_UNIT;
    row(ui, named, |ui| {
        let mut number = shown.number();
        let speed = number * 0.01;
        let field = egui::DragValue::new(&mut number).speed(speed).range(1e-6..=1e6).max_decimals(5);
        if ui.name_inputs(named.name, |ui| ui.add(field)).on_hover_text(named.tip).changed() {
            chosen = match shown {
                Length::Mm(_) => Length::Mm(number),
                Length::Voxels(_) => Length::Voxels(number),
                Length::Extent(_) => Length::Extent(number),
            };
        }
        let unit = unit_of(shown);
        let combo = egui::ComboBox::from_id_salt("opacity unit").selected_text(unit.name).width(60.0);
        ui.name_inputs(text::data::UNITS, |ui| {
            combo.show_ui(ui, |ui| {
                let is_known = |length: &Length| shown_length(*length, volume) == *length;
                for length in conversions.into_iter().filter(is_known) {
                    let option = unit_of(length);
                    let label = ui.selectable_label(option == unit, option.name);
                    if label.on_hover_text(option.tip).clicked() {
                        chosen = length;
                    }
                }
            })
        });
        let back = shown_length(first, volume);
        let back = text::data::length(&short(back.number()), unit_of(back));
        if reset(ui, named.name, (chosen != first).then_some(back.as_str())) {
            chosen = first;
        }
    });
    settings.opacity_unit = chosen;
}
