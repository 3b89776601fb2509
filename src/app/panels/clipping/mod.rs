//! Section "Clipping" of the side panel: the crop box, the clip plane, and cuts by shapes.

mod shape_cuts;

use eframe::egui::{self, DragValue, Ui};
use glam::DVec3;

use super::PanelContext;
use super::controls::{NumberRow, reset_button_cell, row, switch_row, unlabelled_row};
use crate::app::common::commands::AppCommand;
use crate::app::common::volume_facts::VolumeFacts;
use crate::app::text::{self, ControlText};
use chiaroscuro_scene::{ClipEffect, CropBox, MIN_CROP_EXTENT};

/// Shows the section "Clipping" of the side panel.
pub(super) fn show(ui: &mut Ui, panels: &mut PanelContext<'_>) {
    let Some(volume) = panels.volume else {
        ui.weak(text::cuts::NOTHING_OPEN);
        return;
    };
    let unit = panels.scene_unit();
    let cuts = &mut panels.settings.cuts;
    switch_row(ui, text::cuts::CROP, &mut cuts.crop.on);
    ui.add_enabled_ui(cuts.crop.on, |ui| {
        for axis in 0..3 {
            crop_extent_row(ui, &mut cuts.crop, &panels.first_look.cuts.crop, axis, volume);
        }
        cut_effect_row(ui, text::cuts::OUTSIDE, &mut cuts.crop.effect);
    });
    ui.add_space(4.0);
    switch_row(ui, text::cuts::PLANE, &mut cuts.plane.on);
    ui.add_enabled_ui(cuts.plane.on, |ui| {
        let reach = volume.scene.support_radius();
        let offset = NumberRow::new(text::cuts::OFFSET, -reach..=reach);
        offset.show_length(ui, &mut cuts.plane.offset, panels.first_look.cuts.plane.offset, unit);
        row(ui, text::cuts::FACING, |ui| {
            for (axis, normal) in text::cuts::AXES.into_iter().zip(DVec3::AXES) {
                if ui.button(axis).on_hover_text(text::cuts::across_tooltip(axis)).clicked() {
                    cuts.plane.normal = normal.into();
                }
            }
            if ui.button(text::cuts::FLIP.name).on_hover_text(text::cuts::FLIP.tooltip).clicked() {
                cuts.plane.normal = (-cuts.plane.unit_normal()).into();
                cuts.plane.offset = -cuts.plane.offset;
            }
        });
        unlabelled_row(ui, |ui| {
            let towards = text::cuts::TOWARDS_EYE;
            if ui.button(towards.name).on_hover_text(towards.tooltip).clicked() {
                panels.commands.push(AppCommand::FacePlane);
            }
        });
        cut_effect_row(ui, text::cuts::IN_FRONT, &mut cuts.plane.effect);
    });
    ui.add_space(4.0);
    shape_cuts::show(ui, &mut cuts.shapes, (volume, unit), panels.commands);
}

/// Row for the extent of the crop box along an axis, in voxels.
fn crop_extent_row(ui: &mut Ui, crop: &mut CropBox, first: &CropBox, axis: usize, volume: &VolumeFacts) {
    let name = text::cuts::AXES[axis];
    let voxels = volume.dims[axis] as f64;
    row(ui, ControlText { name, tooltip: text::cuts::EXTENT_TIP }, |ui| {
        let (mut from, mut to) = (crop.low[axis] * voxels, crop.high[axis] * voxels);
        let min_extent = MIN_CROP_EXTENT * voxels;
        // Dragging over 300 points covers the whole axis.
        let speed = voxels / 300.0;
        let begins = DragValue::new(&mut from).range(0.0..=to - min_extent).speed(speed).max_decimals(0);
        let response = ui.name_inputs(text::cuts::crop_from(name), |ui| ui.add(begins));
        if response.changed() {
            crop.low[axis] = from / voxels;
        }
        ui.label(text::cuts::RANGE_SEPARATOR);
        let ends = DragValue::new(&mut to).range(from + min_extent..=voxels).speed(speed).max_decimals(0);
        if ui.name_inputs(text::cuts::crop_to(name), |ui| ui.add(ends)).changed() {
            crop.high[axis] = to / voxels;
        }
        let default_extent = (first.low[axis], first.high[axis]);
        let words =
            text::cuts::voxels((default_extent.0 * voxels).round(), (default_extent.1 * voxels).round());
        let differs = (crop.low[axis], crop.high[axis]) != default_extent;
        if reset_button_cell(ui, &text::cuts::crop(name), differs.then_some(words.as_str())) {
            (crop.low[axis], crop.high[axis]) = default_extent;
        }
        ui.weak(text::cuts::length((to - from) * volume.spacing_mm[axis], volume.length_unit()));
    });
}

/// Row for the treatment of clipped material: removed, hidden or without shadow.
fn cut_effect_row(ui: &mut Ui, named: ControlText, effect: &mut ClipEffect) {
    row(ui, named, |ui| {
        let combo = egui::ComboBox::from_id_salt(named.name).selected_text(effect_name(*effect)).width(150.0);
        let shown = combo.show_ui(ui, |ui| {
            for choice in ClipEffect::ALL {
                ui.selectable_value(effect, choice, effect_name(choice));
            }
        });
        let name = text::cuts::effect_name(named.name);
        shown.response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::ComboBox, true, &name));
    });
}

fn effect_name(effect: ClipEffect) -> &'static str {
    match effect {
        ClipEffect::Removed => text::cuts::REMOVED,
        ClipEffect::Hidden => text::cuts::HIDDEN,
        ClipEffect::Shadowless => text::cuts::SHADOWLESS,
    }
}
