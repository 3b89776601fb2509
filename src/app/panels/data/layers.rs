//! Layers of the section "Data": the volumes that are shown together.

use eframe::egui::{self, Button, Ui};

use super::super::controls::{NumberRow, choice_row, color_button, row, switch_row};
use super::PanelContext;
use crate::app::common::commands::AppCommand;
use crate::app::common::elide::elide_middle;
use crate::app::common::volume_facts::VolumeFacts;
use crate::app::text::{self, ControlText};
use chiaroscuro_scene::{LayerBlend, LayerVisibility, VolumeLayer, VolumeLayers};

/// Range of the factor by which opacities of a layer are shown, a thousandth to a thousand.
const STRENGTH: std::ops::RangeInclusive<f64> = 1e-3..=1e3;

/// Largest change of density per voxel that the row of edges offers: half of the range from one voxel to the next,
/// which only sharp borders of a scan have.
const MAX_EDGES: f64 = 0.5;

/// Shows a row for each layer, the settings of the selected one, and buttons that add a layer and remove it.
pub(super) fn show(ui: &mut Ui, panels: &mut PanelContext<'_>, volume: &VolumeFacts) {
    let PanelContext { settings, first_look, selected_layer, commands, .. } = panels;
    let count = settings.layers.count().min(volume.further.len() + 1);
    let selected = volume.of_layer(**selected_layer);
    if count > 1 {
        for (index, layer) in settings.layers.iter_mut().take(count).enumerate() {
            let name = &volume.of_layer(index).part_name();
            ui.push_id(("layer", index), |ui| name_row(ui, layer, name, index, selected_layer));
        }
        visibility_rows(ui, &mut settings.layers, selected.layer);
    }
    let is_layered = settings.is_layered();
    let layer = settings.layer_at_mut(selected.layer);
    if count > 1 {
        if selected.layer > 0 {
            let blends = LayerBlend::ALL.map(|blend| (blend, text::data::layer_blend(blend)));
            choice_row(ui, text::data::LAYER_BLEND, &mut layer.blend, &blends);
        }
        strength_row(ui, layer);
        // Tints have no matter that could stay.
        if is_layered {
            switch_row(ui, text::data::LAYER_IGNORES_CUTS, &mut layer.ignores_cuts);
        }
    }
    if layer.labels.is_empty() {
        let edges = NumberRow::new(text::data::LAYER_EDGES, 0.0..=MAX_EDGES);
        edges.show(ui, &mut layer.edges, first_look.layer_at(selected.layer).edges);
    } else if selected.layer > 0 {
        let mut has_outlines = layer.edges > 0.0;
        if switch_row(ui, text::data::LAYER_OUTLINES, &mut has_outlines).changed() {
            layer.edges = if has_outlines { 1.0 } else { 0.0 };
        }
    }
    row(ui, text::data::ALL_LAYERS, |ui| {
        if ui.button(text::data::ADD_LAYER).on_hover_text(text::commands::ADD_LAYER).clicked() {
            commands.push(AppCommand::AddLayer);
        }
        if count > 1 {
            let remove = ui.add_enabled(selected.layer > 0, Button::new(text::data::REMOVE_LAYER));
            let remove = remove.on_hover_text(text::data::REMOVE_LAYER_TIP);
            if remove.on_disabled_hover_text(text::data::FIRST_LAYER_STAYS).clicked() {
                commands.push(AppCommand::RemoveLayer);
            }
        }
    });
}

/// Shows colour and name of a layer; a click on the name selects it.
fn name_row(ui: &mut Ui, layer: &mut VolumeLayer, name: &str, index: usize, selected: &mut usize) {
    let named = ControlText { name: text::data::LAYERS[index], tooltip: text::data::LAYER_TIP };
    row(ui, named, |ui| {
        let is_scale = layer.labels.is_empty() && index > 0;
        if is_scale
            && let Some(mut color) = layer.transfer.points.last().map(|point| point.color)
            && color_button(ui, text::data::LAYER_COLOR, &mut color).changed()
        {
            layer.transfer.points.iter_mut().for_each(|point| point.color = color);
        }
        let words = elide_middle(ui, name, &egui::TextStyle::Button, ui.available_width());
        if ui.selectable_label(*selected == index, words).on_hover_text(name).clicked() {
            *selected = index;
        }
    });
}

/// Shows where a layer has an effect, and whether it is the only one that has.
fn visibility_rows(ui: &mut Ui, layers: &mut VolumeLayers, selected: usize) {
    let visibility = [LayerVisibility::Shown, LayerVisibility::CastsShadows, LayerVisibility::Hidden]
        .map(|visibility| (visibility, text::data::layer_visibility(visibility)));
    if let Some(layer) = layers.iter_mut().nth(selected) {
        choice_row(ui, text::data::LAYER_VISIBILITY, &mut layer.visibility, &visibility);
    }
    let mut is_alone = layers.is_alone(selected);
    if switch_row(ui, text::data::LAYER_ALONE, &mut is_alone).changed() {
        layers.show_alone(selected, is_alone);
    }
}

/// Shows how dense a layer is: the inverse of the length to which its opacities refer.
fn strength_row(ui: &mut Ui, layer: &mut VolumeLayer) {
    let named = text::data::LAYER_STRENGTH;
    row(ui, named, |ui| {
        let mut strength = 1.0 / layer.opacity_unit.number();
        let speed = 0.01 * strength;
        let field = egui::DragValue::new(&mut strength).speed(speed).range(STRENGTH).max_decimals(3);
        if ui.name_inputs(named.name, |ui| ui.add(field)).on_hover_text(named.tooltip).changed() {
            layer.opacity_unit = layer.opacity_unit.scaled(1.0 / (strength * layer.opacity_unit.number()));
        }
    });
}
