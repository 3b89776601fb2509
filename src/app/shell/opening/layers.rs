//! Adding of further volumes, which are shown with the open one as layers.

use std::path::Path;

use super::VolumeOpener;
use super::file_tasks::ReadPurpose;
use crate::app::text;
use chiaroscuro_scene::{VolumeLayer, first_look};
use chiaroscuro_volume::{Dataset, LoadControl};
use chiaroscuro_volume_io::{LoadOptions, open};

/// Dataset with one more field, and the look of that field.
struct AddedLayer {
    dataset: Dataset,
    layer: VolumeLayer,
}

impl VolumeOpener<'_> {
    /// Reads a volume on a thread, and shows it with the open one as the last layer.
    pub(crate) fn add_layer(&mut self, path: &Path) {
        let Some(shown) = self.editor.viewport.dataset() else {
            return self.editor.messages.note(text::messages::NO_VOLUME_FOR_LAYER);
        };
        // Fields whose layers were removed make room.
        let count = self.editor.document.settings.layers.count();
        let known = shown.with_fields_where(|index| index < count);
        let opened_id = shown.volume().opened_id();
        let read = move |path: &Path| {
            let volume = open(path, &LoadOptions::default(), &LoadControl::default());
            let volume = volume.map_err(|err| err.to_string())?;
            let dataset = known.with_field(&volume, path).map_err(|err| err.to_string())?;
            let layer = first_look::layer_of_field(&dataset, dataset.fields().len() - 1).unwrap_or_default();
            Ok(AddedLayer { dataset, layer })
        };
        self.read_file(ReadPurpose::Layer, path, read, move |opener, read| match read {
            Ok(added) => opener.show_layer(added, opened_id),
            Err(why) => why.report(text::messages::LAYER_NOT_ADDED, &mut opener.editor.messages),
        });
    }

    /// Shows a dataset with one more field, unless another volume was opened meanwhile.
    fn show_layer(&mut self, added: AddedLayer, opened_id: u64) {
        let shown = self.editor.viewport.dataset();
        let AddedLayer { dataset, layer } = added;
        let is_same = shown.is_some_and(|shown| {
            shown.volume().opened_id() == opened_id
                && shown.volume().corrections() == dataset.volume().corrections()
        });
        if !is_same {
            return self.editor.messages.note(text::messages::LAYER_OF_OTHER_VOLUME);
        }
        let document = &mut self.editor.document;
        let index = dataset.fields().len() - 1;
        document.defaults.layers.truncate(index);
        document.defaults.layers.push(layer.clone());
        // A look that was opened may have settings for it.
        if document.settings.layers.count() <= index {
            document.settings.layers.push(layer);
        }
        document.selected_layer = index;
        if let Some(facts) = &mut document.volume {
            facts.update(&dataset);
        }
        self.editor.viewport.set_dataset(dataset);
    }
}
