//! Tabs above the curve: one for each layer, of which the curve or table of labels is edited.

use eframe::egui::{self, Color32, RichText, Sense, Ui, Vec2};

use crate::app::common::elide::elide_middle;
use crate::app::common::volume_facts::VolumeFacts;
use crate::app::text;
use chiaroscuro_scene::{Settings, VolumeLayer};

/// Largest width of a name, in points: four names and their swatches fit in the smallest window.
const MAX_NAME_WIDTH: f32 = 150.0;

/// Edge of the swatch with the colour of a layer, in points.
const SWATCH_EDGE: f32 = 9.0;

/// Shows the tabs if several layers are shown, and selects the one that is clicked. `volume`: facts about the first
/// volume.
pub(super) fn show(ui: &mut Ui, settings: &Settings, volume: &VolumeFacts, selected: &mut usize) {
    let count = settings.layers.count().min(volume.further.len() + 1);
    if count == 1 {
        return;
    }
    ui.horizontal(|ui| {
        for (index, layer) in settings.layers.iter().take(count).enumerate() {
            let name = &volume.of_layer(index).part_name();
            if let Some(color) = layer_color(layer) {
                let (area, _) = ui.allocate_exact_size(Vec2::splat(SWATCH_EDGE), Sense::hover());
                ui.painter().rect_filled(area, 2.0, color);
            }
            let words = elide_middle(ui, name, &egui::TextStyle::Button, MAX_NAME_WIDTH);
            let words = RichText::new(words);
            let words = if layer.is_seen() { words } else { words.weak() };
            let tip = text::transfer::layer_tab_tooltip(index + 1, name);
            if ui.selectable_label(*selected == index, words).on_hover_text(tip).clicked() {
                *selected = index;
            }
        }
    });
}

/// Colour of the densest material of a layer; `None` for labels, which have one each.
fn layer_color(layer: &VolumeLayer) -> Option<Color32> {
    let points = layer.transfer.points.iter().filter(|_| layer.labels.is_empty());
    let densest = points.max_by(|a, b| a.opacity.total_cmp(&b.opacity))?;
    let [red, green, blue] = densest.color.map(|c| (c.clamp(0.0, 1.0) * 255.0).round() as u8);
    Some(Color32::from_rgb(red, green, blue))
}
