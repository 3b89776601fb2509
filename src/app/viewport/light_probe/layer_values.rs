//! Values of the layers that are not seen at the probed point, such as the label that tints it.

use crate::app::common::volume_facts::{VolumeFacts, range_decimals};
use crate::app::text;
use chiaroscuro_render::plan::Probe;
use chiaroscuro_scene::{LayerVisibility, Settings};
use chiaroscuro_volume::Dataset;

/// Value of a layer at the probed point.
pub(super) struct LayerValue {
    /// Name of the layer, with its value or label.
    pub(super) text: String,
    /// True for a label.
    pub(super) is_label: bool,
}

/// Returns the values of the layers that are not seen at the probed point, where they have a voxel.
///
/// Labels without a look are left out: they are the background.
pub(super) fn values_of_other_layers(
    settings: &Settings,
    dataset: &Dataset,
    facts: &VolumeFacts,
    found: &Probe,
) -> Vec<LayerValue> {
    let count = settings.layers.count().min(dataset.fields().len());
    let others = (0..count).filter(|&index| {
        index != found.layer && settings.layer_at(index).visibility != LayerVisibility::Hidden
    });
    let line = |index: usize| {
        let (layer, volume, facts) =
            (settings.layer_at(index), dataset.fields()[index].volume(), facts.of_layer(index));
        let dims = volume.dims();
        let [x, y, z] =
            [0, 1, 2].map(|axis| (found.index[axis].round().max(0.0) as usize).min(dims[axis] - 1));
        if volume.presence(x + dims[0] * (y + dims[1] * z)) <= 0.0 {
            return None;
        }
        let value = volume.value(x, y, z);
        let is_label = facts.is_shown_by_label(settings);
        let words = if is_label {
            let label = facts.label_of(value)?;
            layer.labels.get(label.look_number)?;
            text::probe::label(label.number, &label.name(&layer.labels))
        } else {
            text::probe::number(value, range_decimals(volume.table_range()))
        };
        Some(LayerValue { text: text::probe::layer_value(&facts.part_name(), &words), is_label })
    };
    others.filter_map(line).collect()
}
