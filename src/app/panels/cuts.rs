//! Section "Cut": the crop box and the clip plane.

use eframe::egui::{self, DragValue, Ui};
use glam::DVec3;

use super::super::commands::Command;
use super::super::volume_facts::VolumeFacts;
use super::Panels;
use super::controls::{Number, reset, row, switch};
use crate::model::{ClipPlane, CropBox, CutEffect, MIN_CROP};

/// Shows the section.
pub(super) fn show(ui: &mut Ui, panels: &mut Panels<'_>) {
    let Some(volume) = panels.volume else {
        ui.weak("Nothing is open");
        return;
    };
    let cuts = &mut panels.settings.cuts;
    let tip = "Leaves out what lies outside a box; its sides are dragged in the picture";
    switch(ui, "Crop box", tip, &mut cuts.crop.on);
    ui.add_enabled_ui(cuts.crop.on, |ui| {
        for axis in 0..3 {
            extent(ui, &mut cuts.crop, axis, volume);
        }
        effect(ui, "Outside", &mut cuts.crop.effect);
    });
    ui.add_space(4.0);
    let tip = "Leaves out what lies in front of a plane; drag its square to move it and the arrow to turn it";
    switch(ui, "Clip plane", tip, &mut cuts.plane.on);
    ui.add_enabled_ui(cuts.plane.on, |ui| {
        plane(ui, &mut cuts.plane, panels.defaults.cuts.plane.offset, volume);
        row(ui, "Facing", "Where the plane looks; what lies in front of it is cut away", |ui| {
            for (name, normal) in [("x", DVec3::X), ("y", DVec3::Y), ("z", DVec3::Z)] {
                if ui.button(name).on_hover_text(format!("Across the {name} axis")).clicked() {
                    cuts.plane.normal = normal.into();
                }
            }
            if ui.button("Flip").on_hover_text("Cuts the other side away").clicked() {
                cuts.plane.normal = (-cuts.plane.unit_normal()).into();
                cuts.plane.offset = -cuts.plane.offset;
            }
        });
        row(ui, "", "Where the plane looks; what lies in front of it is cut away", |ui| {
            if ui.button("Towards the eye").on_hover_text("Across the line of sight").clicked() {
                panels.commands.push(Command::FacePlane);
            }
        });
        effect(ui, "In front", &mut cuts.plane.effect);
    });
}

/// Where the box begins and ends along an axis, in voxels.
fn extent(ui: &mut Ui, crop: &mut CropBox, axis: usize, volume: &VolumeFacts) {
    let name = ["x", "y", "z"][axis];
    let voxels = volume.dims[axis] as f64;
    row(ui, name, "First and last voxel that remain", |ui| {
        let (mut from, mut to) = (crop.low[axis] * voxels, crop.high[axis] * voxels);
        let least = MIN_CROP * voxels;
        // All of it is 300 points of the mouse.
        let speed = voxels / 300.0;
        let begins = DragValue::new(&mut from).range(0.0..=to - least).speed(speed).max_decimals(0);
        let response = ui.name_inputs(format!("Crop {name} from"), |ui| ui.add(begins));
        if response.changed() {
            crop.low[axis] = from / voxels;
        }
        ui.label("–");
        let ends = DragValue::new(&mut to).range(from + least..=voxels).speed(speed).max_decimals(0);
        if ui.name_inputs(format!("Crop {name} to"), |ui| ui.add(ends)).changed() {
            crop.high[axis] = to / voxels;
        }
        let differs = (crop.low[axis], crop.high[axis]) != (0.0, 1.0);
        if reset(ui, &format!("crop {name}"), differs) {
            (crop.low[axis], crop.high[axis]) = (0.0, 1.0);
        }
        let length_mm = (to - from) * volume.spacing_mm[axis];
        ui.weak(if length_mm < 100.0 { format!("{length_mm:.1} mm") } else { format!("{length_mm:.0} mm") });
    });
}

fn plane(ui: &mut Ui, plane: &mut ClipPlane, default: f64, volume: &VolumeFacts) {
    let (mm, reach) = (volume.scene.mm_per_unit, volume.scene.support_radius());
    let mut offset_mm = plane.offset * mm;
    let before_mm = offset_mm;
    let tip = "From the middle of the volume, in the direction in which the plane looks";
    Number::new("Offset", -reach * mm..=reach * mm, tip).unit(" mm").decimals(1).show(
        ui,
        &mut offset_mm,
        default * mm,
    );
    if offset_mm != before_mm {
        plane.offset = offset_mm / mm;
    }
}

/// What becomes of what is cut away.
fn effect(ui: &mut Ui, label: &'static str, effect: &mut CutEffect) {
    row(ui, label, "What becomes of the part that is cut away", |ui| {
        let combo = egui::ComboBox::from_id_salt(label).selected_text(effect_name(*effect)).width(150.0);
        let shown = combo.show_ui(ui, |ui| {
            for choice in CutEffect::ALL {
                ui.selectable_value(effect, choice, effect_name(choice));
            }
        });
        let name = format!("{label}: effect");
        shown.response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::ComboBox, true, &name));
    });
}

fn effect_name(effect: CutEffect) -> &'static str {
    match effect {
        CutEffect::Removed => "hidden, no shadow",
        CutEffect::Hidden => "hidden, shadow stays",
        CutEffect::Shadowless => "visible, no shadow",
    }
}
