//! Adding of further volumes, which are shown with the open one as layers.

use std::path::{Path, PathBuf};

use super::VolumeOpener;
use super::base_volume::is_better_base;
use super::file_tasks::ReadPurpose;
use crate::app::common::alternatives::Alternatives;
use crate::app::text;
use crate::app::worker::loader::{OpenedVolume, ReadChoices};
use chiaroscuro_scene::{LookRecord, Settings, VolumeLayer, VolumeLocation, first_look};
use chiaroscuro_volume::{ChoiceAspect, Dataset, LoadControl, MAX_FIELDS, VolumeChoice};
use chiaroscuro_volume_io::{LoadOptions, open};

/// Volume that is to be shown as a layer.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct LayerFile {
    /// Path of the file, or name of a built-in volume.
    path: PathBuf,
    /// Selected volume, if the file has several.
    choice: VolumeChoice,
    /// Content ID that a record has for the volume, in hexadecimal digits.
    recorded_id: Option<String>,
    /// Look of the volume, without its blend; `None` for the automatic one.
    look: Option<VolumeLayer>,
}

/// Layers that further volumes replace.
#[derive(Debug, Clone, Copy)]
struct LayerReplacement {
    /// Number of volumes that stay, from the first on.
    kept: usize,
    /// True if the settings have looks for those that are added.
    has_looks: bool,
    /// True if the open volume is shown over the one that is added where that is better.
    may_be_base: bool,
}

impl LayerReplacement {
    /// Replaces all layers but the first.
    const BELOW_ALL: Self = Self { kept: 1, has_looks: false, may_be_base: false };
}

/// Dataset with further fields, as far as they could be opened.
struct DatasetWithLayers {
    dataset: Dataset,
    /// First look at the dataset.
    first: Settings,
    /// Reason why a volume could not be added; those after it are left out, too.
    failure: Option<String>,
    /// True if a volume is not the one that a record names.
    is_other: bool,
    /// File over which the dataset is better shown.
    base: Option<PathBuf>,
    /// Number of fields that it had before.
    known: usize,
    /// Volumes that were to be added.
    sources: Vec<LayerFile>,
}

impl LayerFile {
    fn new(path: impl Into<PathBuf>, choice: VolumeChoice) -> Self {
        Self { path: path.into(), choice, recorded_id: None, look: None }
    }
}

/// Opens volumes and adds them to a dataset, as far as possible.
fn with_layers(
    dataset: Dataset,
    first: Settings,
    sources: Vec<LayerFile>,
    options: &LoadOptions,
    may_be_base: bool,
) -> DatasetWithLayers {
    let known = dataset.fields().len();
    let (failure, is_other, base) = (None, false, None);
    let mut added = DatasetWithLayers { dataset, first, failure, is_other, base, known, sources };
    for LayerFile { path, choice, recorded_id, .. } in &added.sources {
        let choice = choice.clone().with_first_as_fallback();
        let options = LoadOptions { choice, ..options.clone() };
        let volume = open(path, &options, &LoadControl::default()).map_err(|err| err.to_string());
        let with_field = volume.and_then(|volume| {
            if may_be_base && is_better_base(&volume, added.dataset.volume()) {
                added.base = Some(path.clone());
            }
            let id = format!("{:016x}", volume.opened_id());
            added.is_other |= recorded_id.as_ref().is_some_and(|recorded| *recorded != id);
            added.dataset.with_field(&volume, path).map_err(|err| text::messages::layer_refused(path, err))
        });
        match with_field {
            Ok(dataset) => added.dataset = dataset,
            Err(why) => {
                added.failure = Some(why);
                break;
            }
        }
    }
    first_look::add_layers(&mut added.first, &added.dataset);
    added
}

impl VolumeOpener<'_> {
    /// Reads a volume on a thread, and shows it with the open one as the last layer.
    pub(crate) fn add_layer(&mut self, path: &Path) {
        let kept = self.editor.document.settings.layers.count();
        let file = LayerFile::new(path, VolumeChoice::default());
        let may_be_base = self.can_become_layers();
        self.add_layers(vec![file], LayerReplacement { kept, has_looks: false, may_be_base });
    }

    /// Shows all channels, arrays or components of the open file, as far as there is room: those that are not shown
    /// become layers. Colours of a file colour its luminance.
    pub(crate) fn add_all_of(&mut self, aspect: ChoiceAspect) {
        let Some(volume) = &self.editor.document.volume else { return };
        let all = Alternatives::new(&volume.held, aspect);
        let Some(all) = all.filter(|all| aspect.is_shown_together(all.count())) else { return };
        let others = (0..all.count()).filter(|&at| at != all.current()).take(MAX_FIELDS - 1);
        let sources = others.map(|at| LayerFile::new(&volume.source, all.choice(at))).collect();
        self.add_layers(sources, LayerReplacement::BELOW_ALL);
    }

    /// Opens the further volumes that a record names, unless they are shown.
    pub(super) fn add_recorded_layers(&mut self, record: &LookRecord) {
        let file = record.file.as_deref().unwrap_or_else(|| Path::new(""));
        let recorded = record.volume.as_ref().map(|volume| volume.layers.as_slice()).unwrap_or_default();
        if recorded.is_empty() {
            return;
        }
        let shown = self.editor.document.volume.as_ref();
        let is_shown = shown.is_some_and(|volume| {
            volume.further.len() >= recorded.len()
                && std::iter::zip(&volume.further, recorded)
                    .all(|(further, recorded)| recorded.matches_content(further.origin.opened_id))
        });
        if is_shown {
            return;
        }
        self.editor.document.further_volumes =
            recorded.iter().map(|volume| volume.origin(file.parent())).collect();
        // The user agreed to open the first volume from its folder.
        let trusted = shown.and_then(|volume| volume.source.parent()).map(Path::to_owned);
        let mut sources = Vec::new();
        for volume in recorded {
            let path = match self.locate_volume(volume, file) {
                VolumeLocation::Builtin(name) => PathBuf::from(name),
                VolumeLocation::InRecordFolder(path) => path,
                VolumeLocation::OtherFolder(path) if trusted.as_deref() == path.parent() => path,
                VolumeLocation::OtherFolder(path) => {
                    let path = path.display().to_string();
                    return self.editor.messages.note(text::messages::layer_not_opened(&path));
                }
                VolumeLocation::Refused(_) => {
                    return self.editor.messages.note(text::messages::layer_not_opened(&volume.source));
                }
            };
            let recorded_id = Some(volume.content_id.clone());
            sources.push(LayerFile { recorded_id, ..LayerFile::new(path, volume.choice.clone()) });
        }
        self.add_layers(sources, LayerReplacement { has_looks: true, ..LayerReplacement::BELOW_ALL });
    }

    /// Returns true if the open volumes can become layers over another one: files that can be read again as they are,
    /// and not more than fit.
    pub(super) fn can_become_layers(&self) -> bool {
        let Some(open) = &self.editor.document.volume else { return false };
        let is_as_read = open.reading.raw.is_none() && open.volume.corrections().is_none();
        is_as_read && self.editor.document.settings.layers.count() < MAX_FIELDS
    }

    /// Shows a volume that has been read, and the open ones as layers over it.
    pub(super) fn show_below(&mut self, opened: OpenedVolume) {
        self.state.requests.layers_over = self.open_volumes_as_layers();
        self.show_opened_with_session(opened);
    }

    /// Opens a volume, and then shows those that are open now as layers over it.
    fn open_below(&mut self, source: &Path) {
        let layers = self.open_volumes_as_layers();
        if self.start_loading(source, ReadChoices::default()) {
            self.state.requests.pending_look = None;
            self.state.requests.layers_over = layers;
        }
    }

    /// Adds the volumes that were open before as layers, if there are any.
    pub(super) fn add_layers_over(&mut self) {
        let layers = std::mem::take(&mut self.state.requests.layers_over);
        if !layers.is_empty() {
            self.editor.messages.note(text::opening::shown_below(self.editor.document.volume_name()));
            self.add_layers(layers, LayerReplacement::BELOW_ALL);
        }
    }

    /// Returns the open volumes as layers, with the looks that the user has changed.
    fn open_volumes_as_layers(&self) -> Vec<LayerFile> {
        let document = &self.editor.document;
        let Some(open) = &document.volume else { return Vec::new() };
        let further = open.further.iter().map(|volume| (&volume.origin.source, volume.origin.choice.clone()));
        let volumes = std::iter::once((&open.source, open.held.choice())).chain(further);
        let shown = volumes.zip(document.settings.layers.iter());
        let mut layers = Vec::new();
        for (index, ((source, choice), look)) in shown.enumerate() {
            let is_changed = look != document.defaults.layer_at(index);
            let mut layer = LayerFile::new(source, choice);
            layer.look = is_changed.then(|| look.clone());
            layers.push(layer);
        }
        layers
    }

    /// Reads volumes on a thread, and shows them with those that stay.
    fn add_layers(&mut self, sources: Vec<LayerFile>, replaced: LayerReplacement) {
        let LayerReplacement { kept, may_be_base, .. } = replaced;
        let Some(shown) = self.editor.viewport.dataset() else {
            return self.editor.messages.note(text::messages::NO_VOLUME_FOR_LAYER);
        };
        let Some(path) = sources.first().map(|source| source.path.clone()) else { return };
        // Fields without a layer make room.
        let known = shown.with_fields_where(|index| index < kept);
        let (opened_id, options) = (shown.volume().opened_id(), self.state.loader.options().clone());
        let mut first = self.editor.document.defaults.clone();
        first.layers.truncate(kept);
        let read = move |_: &Path| Ok(with_layers(known, first, sources, &options, may_be_base));
        self.read_file(ReadPurpose::Layer, &path, read, move |opener, read| match read {
            Ok(DatasetWithLayers { base: Some(base), failure: None, .. }) => opener.open_below(&base),
            Ok(added) => opener.show_layers(added, replaced, opened_id),
            Err(why) => why.report(text::messages::LAYER_NOT_ADDED, &mut opener.editor.messages),
        });
    }

    /// Shows a dataset with further fields, unless another volume was opened meanwhile.
    fn show_layers(&mut self, added: DatasetWithLayers, replaced: LayerReplacement, opened_id: u64) {
        let LayerReplacement { kept, has_looks, .. } = replaced;
        let shown = self.editor.viewport.dataset();
        let DatasetWithLayers { dataset, first, failure, is_other, known, sources, .. } = added;
        let messages = &mut self.editor.messages;
        // Corrections that were made meanwhile are made again, of all fields.
        let Some(shown) = shown.filter(|shown| shown.volume().opened_id() == opened_id) else {
            return messages.note(text::messages::LAYER_OF_OTHER_VOLUME);
        };
        if !shown.further_origins().take(known - 1).eq(dataset.further_origins().take(known - 1)) {
            // Layers were removed or undone meanwhile, and the new one has another place.
            let kept = self.editor.document.settings.layers.count();
            return self.add_layers(sources, LayerReplacement { kept, ..replaced });
        }
        if let Some(why) = failure {
            messages.error(text::messages::LAYER_NOT_ADDED, why);
        }
        if is_other {
            messages.note(text::opening::OTHER_VALUES);
        }
        let document = &mut self.editor.document;
        document.keep_fields(&shown, &dataset);
        if has_looks {
            document.list_recorded_volumes(&dataset, self.ctx.input(|input| input.time));
        } else {
            document.further_volumes.truncate(kept - 1);
            document.list_volumes_of(&dataset);
            document.settings.layers.truncate(kept);
        }
        // Changes by the user are kept.
        document.settings.take_layers(&first, &document.defaults);
        document.defaults = first;
        let looks: Vec<_> = sources.into_iter().map(|source| source.look).collect();
        document.apply_layer_looks(kept, &looks);
        document.selected_layer = kept.min(dataset.fields().len() - 1);
        if let Some(facts) = &mut document.volume {
            facts.update(&dataset);
        }
        self.editor.viewport.set_dataset(dataset);
    }
}
