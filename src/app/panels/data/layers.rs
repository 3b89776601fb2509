//! Layers of the section "Data": the volumes that are shown together.

use eframe::egui::{self, Ui};

use super::super::controls::{choice_row, color_button, row};
use crate::app::common::commands::AppCommand;
use crate::app::common::volume_facts::VolumeFacts;
use crate::app::text::{self, ControlText};
use chiaroscuro_scene::{LayerBlend, LayerVisibility, OpacityLength, Settings, VolumeLayer};

/// Range of the factor by which opacities of a layer are shown, a thousandth to a thousand.
const STRENGTH: std::ops::RangeInclusive<f64> = 1e-3..=1e3;

/// Shows the rows of the layers, and buttons that add one and remove the last.
pub(super) fn show(
    ui: &mut Ui,
    settings: &mut Settings,
    volume: &VolumeFacts,
    commands: &mut Vec<AppCommand>,
) {
    let count = settings.layers.count().min(volume.further.len() + 1);
    if count > 1 {
        let names = std::iter::once(&volume.name).chain(volume.further.iter().map(|further| &further.name));
        for (index, (layer, name)) in settings.layers.iter_mut().zip(names).enumerate() {
            ui.push_id(("layer", index), |ui| layer_rows(ui, layer, name, index));
        }
    }
    row(ui, text::data::ALL_LAYERS, |ui| {
        if ui.button(text::data::ADD_LAYER).on_hover_text(text::commands::ADD_LAYER).clicked() {
            commands.push(AppCommand::AddLayer);
        }
        if count > 1
            && ui.button(text::data::REMOVE_LAYER).on_hover_text(text::commands::REMOVE_LAYER).clicked()
        {
            commands.push(AppCommand::RemoveLayer);
        }
    });
}

fn layer_rows(ui: &mut Ui, layer: &mut VolumeLayer, name: &str, index: usize) {
    let named = ControlText { name: text::data::LAYERS[index], tooltip: "" };
    row(ui, named, |ui| {
        let is_scale = layer.labels.is_empty() && index > 0;
        if is_scale
            && let Some(mut color) = layer.transfer.points.last().map(|point| point.color)
            && color_button(ui, text::data::LAYER_COLOR, &mut color).changed()
        {
            layer.transfer.points.iter_mut().for_each(|point| point.color = color);
        }
        ui.add(egui::Label::new(name).truncate()).on_hover_text(name);
    });
    let visibility = [LayerVisibility::Shown, LayerVisibility::CastsShadows, LayerVisibility::Hidden]
        .map(|visibility| (visibility, text::data::layer_visibility(visibility)));
    choice_row(ui, text::data::LAYER_VISIBILITY, &mut layer.visibility, &visibility);
    if index > 0 {
        let blends = LayerBlend::ALL.map(|blend| (blend, text::data::layer_blend(blend)));
        choice_row(ui, text::data::LAYER_BLEND, &mut layer.blend, &blends);
    }
    strength_row(ui, layer);
}

/// Shows how dense a layer is: the inverse of the length to which its opacities refer.
fn strength_row(ui: &mut Ui, layer: &mut VolumeLayer) {
    let named = text::data::LAYER_STRENGTH;
    row(ui, named, |ui| {
        let mut strength = 1.0 / layer.opacity_unit.number();
        let speed = 0.01 * strength;
        let field = egui::DragValue::new(&mut strength).speed(speed).range(STRENGTH).max_decimals(3);
        if ui.name_inputs(named.name, |ui| ui.add(field)).on_hover_text(named.tooltip).changed() {
            let length = 1.0 / strength;
            layer.opacity_unit = match layer.opacity_unit {
                OpacityLength::Mm(_) => OpacityLength::Mm(length),
                OpacityLength::Voxels(_) => OpacityLength::Voxels(length),
                OpacityLength::Extent(_) => OpacityLength::Extent(length),
            };
        }
    });
}
