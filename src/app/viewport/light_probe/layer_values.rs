//! Values of the layers that are not seen at the probed point, such as the label that tints it.

use crate::app::common::volume_facts::VolumeFacts;
use crate::app::text;
use chiaroscuro_render::plan::Probe;
use chiaroscuro_scene::{LayerVisibility, Settings};

/// Value of a layer at the probed point.
pub(super) struct LayerValue {
    /// Name of the layer, with its value or label.
    pub(super) text: String,
    /// True for a label.
    pub(super) is_label: bool,
}

/// Returns the values of the layers that are not seen at the probed point; `facts` are those of the first volume.
pub(super) fn values_of_other_layers(
    settings: &Settings,
    facts: &VolumeFacts,
    found: &Probe,
) -> Vec<LayerValue> {
    let count = settings.layers.count().min(facts.further.len() + 1);
    let others = (0..count).filter(|&index| {
        index != found.layer && settings.layer_at(index).visibility != LayerVisibility::Hidden
    });
    let voxel = [0, 1, 2]
        .map(|axis| (found.index[axis].round().max(0.0) as usize).min(facts.dims[axis].saturating_sub(1)));
    let value = |index: usize| {
        let layer = facts.of_layer(index);
        let value = layer.value_at(settings, voxel)?;
        let text = text::probe::layer_value(&layer.part_name(), &value.words);
        Some(LayerValue { text, is_label: value.is_label })
    };
    others.filter_map(value).collect()
}
