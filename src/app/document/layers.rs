//! Volumes of the further layers: their removal, and their return by an undo.
//!
//! The list of further volumes is part of a step of the history, as the settings of their layers are. The fields of the
//! dataset follow it, and fields that it no longer names are kept for a while.

use super::Document;
use chiaroscuro_scene::VolumeLayer;
use chiaroscuro_volume::{Dataset, DatasetField, FieldOrigin, MAX_FIELDS};

/// Largest number of fields that are kept though no layer shows them: as many as a picture shows, so that memory is at
/// most twice that of a picture.
const MAX_SPARE_FIELDS: usize = MAX_FIELDS;

/// Field that no layer shows, with the first look of its layer.
#[derive(Debug, Clone)]
pub(super) struct SpareField {
    field: DatasetField,
    first_look: VolumeLayer,
}

impl Document {
    /// Removes a further layer, and selects the one before it; the first one stays.
    pub(crate) fn remove_layer(&mut self, index: usize) {
        if !(1..self.settings.layers.count()).contains(&index) {
            return;
        }
        self.settings.remove_layer(index);
        if index <= self.further_volumes.len() {
            self.further_volumes.remove(index - 1);
        }
        self.selected_layer = index - 1;
    }

    /// Returns the layer that shows a further volume, or the first volume for `None`, to be changed.
    pub(super) fn layer_of_volume_mut(&mut self, further: Option<&FieldOrigin>) -> Option<&mut VolumeLayer> {
        let index = match further {
            None => 0,
            Some(origin) => 1 + self.further_volumes.iter().position(|volume| volume == origin)?,
        };
        self.settings.layers.iter_mut().nth(index)
    }

    /// Returns the dataset with the fields that the list of further volumes names, as far as they are in memory, if it
    /// is another one than is shown. First looks, facts and selection follow.
    pub(crate) fn update_fields(&mut self, shown: &Dataset) -> Option<Dataset> {
        let own = shown.fields().iter().enumerate().skip(1);
        let own = own.map(|(at, field)| (field, self.defaults.layer_at(at)));
        let spare = self.spare_fields.iter().map(|spare| (&spare.field, &spare.first_look));
        let held: Vec<_> = own.chain(spare).collect();
        let find = |origin: &FieldOrigin| held.iter().find(|(field, _)| field.origin() == Some(origin));
        let named: Vec<_> = self.further_volumes.iter().map_while(find).take(MAX_FIELDS - 1).collect();
        if named.iter().filter_map(|(field, _)| field.origin()).eq(shown.further_origins()) {
            return None;
        }
        let dataset = shown.with_further(named.iter().map(|(field, _)| (*field).clone()));
        let looks: Vec<_> = named.iter().map(|(_, look)| (*look).clone()).collect();
        self.keep_fields(shown, &dataset);
        self.defaults.layers.truncate(1);
        for look in looks {
            self.defaults.layers.push(look);
        }
        let selected = shown.fields().get(self.selected_layer).and_then(DatasetField::origin);
        let place = dataset.further_origins().position(|origin| Some(origin) == selected);
        self.selected_layer = place.map_or(self.selected_layer, |at| at + 1);
        if let Some(facts) = &mut self.volume {
            facts.update(&dataset);
        }
        Some(dataset)
    }

    /// Keeps the fields that another dataset in place of the one shown lacks; those that have not been shown for longest
    /// are dropped. To be called before the first look changes.
    pub(crate) fn keep_fields(&mut self, shown: &Dataset, next: &Dataset) {
        let is_shown = |field: &DatasetField| next.further_origins().any(|own| Some(own) == field.origin());
        self.spare_fields.retain(|spare| !is_shown(&spare.field));
        let further = shown.fields().iter().enumerate().skip(1);
        let lacking = further.filter(|(_, field)| !is_shown(field)).map(|(at, field)| SpareField {
            field: field.clone(),
            first_look: self.defaults.layer_at(at).clone(),
        });
        let lacking: Vec<_> = lacking.collect();
        self.spare_fields.splice(0..0, lacking);
        self.spare_fields.truncate(MAX_SPARE_FIELDS);
    }

    /// Lists the volumes of a dataset; those of the list beyond them could not be opened, and stay.
    pub(crate) fn list_volumes_of(&mut self, dataset: &Dataset) {
        let opened: Vec<_> = dataset.further_origins().cloned().collect();
        let count = opened.len().min(self.further_volumes.len());
        self.further_volumes.splice(..count, opened);
    }

    /// Lists the volumes of a record as they were opened, which is no step: earlier steps with the recorded list follow.
    pub(crate) fn list_recorded_volumes(&mut self, dataset: &Dataset, now_s: f64) {
        let recorded = self.history_step();
        self.list_volumes_of(dataset);
        if self.further_volumes == recorded.further_volumes {
            return;
        }
        self.history.merge_into_all(now_s, &recorded, |step| {
            let mut step = step.clone();
            if step.further_volumes == recorded.further_volumes {
                step.further_volumes.clone_from(&self.further_volumes);
            }
            step
        });
    }

    /// Starts with the fields of a dataset that was just opened.
    pub(crate) fn start_layers(&mut self, dataset: &Dataset) {
        self.further_volumes = dataset.further_origins().cloned().collect();
        self.spare_fields.clear();
    }
}
