//! Section "Data": what the volume is, and the length to which opacities refer.

use eframe::egui::{self, Ui};

use super::super::volume_facts::VolumeFacts;
use super::Panels;
use super::controls::row;
use crate::model::{Length, Settings};

/// Shows the section.
pub(super) fn show(ui: &mut Ui, panels: &mut Panels<'_>) {
    let Some(volume) = panels.volume else {
        ui.label("No volume is open");
        return;
    };
    facts(ui, volume);
    opacity_unit(ui, panels.settings, panels.defaults, volume);
}

fn facts(ui: &mut Ui, volume: &VolumeFacts) {
    let [nx, ny, nz] = volume.dims;
    let [sx, sy, sz] = volume.spacing_mm.map(short);
    let (low, high) = volume.range;
    let mut rows = vec![
        ("Name", volume.name.clone()),
        ("Source", volume.source.clone()),
        ("Voxels", format!("{nx} × {ny} × {nz}")),
        ("Type", volume.voxel_type.to_owned()),
        ("Spacing", format!("{sx} × {sy} × {sz} mm")),
        ("Values", format!("{} … {}", short(low), short(high))),
        ("Memory", format!("{:.1} MiB", volume.bytes as f64 / f64::from(1 << 20))),
    ];
    if volume.odd_voxels > 0 {
        rows.push(("Not finite", format!("{} voxels, shown as the smallest value", volume.odd_voxels)));
    }
    for (label, text) in rows {
        row(ui, label, "", |ui| ui.add(egui::Label::new(text).truncate()));
    }
}

/// A number with as many digits as it needs.
fn short(value: f64) -> String {
    let text = format!("{value:.4}");
    if value.abs() >= 1e6 || (value != 0.0 && value.abs() < 1e-3) {
        return format!("{value:.3e}");
    }
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

fn opacity_unit(ui: &mut Ui, settings: &mut Settings, defaults: &Settings, volume: &VolumeFacts) {
    let tip = "The thickness of material to which the opacities of the transfer function refer: larger makes \
               everything more transparent";
    let scene = volume.scene;
    let in_scene = settings.opacity_unit.in_scene(&scene);
    let conversions = [
        (Length::Mm(in_scene * scene.mm_per_unit), "mm", "Stays the same for every volume of the same thing"),
        (Length::Voxels(in_scene / scene.mean_edge()), "voxels", "Follows the resolution of the data"),
        (Length::Extent(in_scene / 2.0), "extent", "A share of the longest edge of the volume"),
    ];
    let current =
        |length: &Length| std::mem::discriminant(length) == std::mem::discriminant(&settings.opacity_unit);
    let shown =
        conversions.iter().find(|conversion| current(&conversion.0)).map_or("", |conversion| conversion.1);
    let mut chosen = settings.opacity_unit;
    row(ui, "Opacity unit", tip, |ui| {
        let mut number = chosen.number();
        let speed = number * 0.01;
        let field = egui::DragValue::new(&mut number).speed(speed).range(1e-6..=1e6).max_decimals(5);
        if ui.name_inputs("Opacity unit", |ui| ui.add(field)).on_hover_text(tip).changed() {
            chosen = match chosen {
                Length::Mm(_) => Length::Mm(number),
                Length::Voxels(_) => Length::Voxels(number),
                Length::Extent(_) => Length::Extent(number),
            };
        }
        let combo = egui::ComboBox::from_id_salt("opacity unit").selected_text(shown).width(70.0);
        ui.name_inputs("Unit of the opacity unit", |ui| {
            combo.show_ui(ui, |ui| {
                for (length, name, option_tip) in conversions {
                    let label = ui.selectable_label(name == shown, name).on_hover_text(option_tip);
                    if label.clicked() {
                        chosen = length;
                    }
                }
            })
        });
        if chosen != defaults.opacity_unit && ui.small_button("Reset").clicked() {
            chosen = defaults.opacity_unit;
        }
    });
    settings.opacity_unit = chosen;
}
