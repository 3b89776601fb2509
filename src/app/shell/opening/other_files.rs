//! Reading of files that change a part of the look: environment maps that light the scene, and transfer functions of
//! other programs.

use std::path::Path;

use super::VolumeOpener;
use super::file_tasks::ReadPurpose;
use crate::app::text;
use crate::app::windows::file_dialogs;
use chiaroscuro_media::read_environment_map;
use chiaroscuro_scene::LabelTable;

impl VolumeOpener<'_> {
    /// Reads an environment map on a thread and lights the scene by it; supersedes one that is still being read.
    pub(crate) fn read_environment_map(&mut self, path: &Path) {
        let read = |path: &Path| read_environment_map(path).map_err(|err| err.to_string());
        self.read_file(ReadPurpose::Surroundings, path, read, |opener, read| match read {
            Ok(surroundings) => {
                opener.editor.document.settings.apply_environment_map(&surroundings);
                opener.editor.document.selected_light = 0;
                let has_light = surroundings.light.is_some();
                opener
                    .editor
                    .messages
                    .note(text::messages::environment_map_applied(&surroundings.name, has_light));
            }
            Err(why) => why.report(text::messages::ENVIRONMENT_MAP_NOT_READ, &mut opener.editor.messages),
        });
    }

    /// Reads a transfer function of another program on a thread and applies it to the look.
    pub(crate) fn import_transfer(&mut self, path: &Path) {
        let document = &self.editor.document;
        let range = file_dialogs::transfer_exchange_range(
            &document.with_selected_first(),
            &document.selected_ranges(),
        );
        let read = move |path: &Path| file_dialogs::import_transfer_file(path, range);
        self.read_file(ReadPurpose::Transfer, path, read, |opener, read| match read {
            Ok(function) => {
                let layer = opener.editor.document.selected_layer_mut();
                (layer.transfer, layer.labels) = (function, LabelTable::default());
            }
            Err(why) => why.report(text::messages::TRANSFER_NOT_IMPORTED, &mut opener.editor.messages),
        });
    }
}
