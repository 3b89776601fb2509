//! Treatment of the volume as another kind of data than was detected, with the first look for that kind.
//!
//! A thread makes the look in a pass over all voxels.

use std::io;
use std::sync::Arc;

use eframe::egui;

use super::Document;
use super::light_placement::LightPlacement;
use crate::app::worker::jobs::{JobKind, JobSlot};
use chiaroscuro_scene::{LabelTable, Settings, TransferFunction, VolumeLayer, first_look};
use chiaroscuro_volume::{Dataset, FieldOrigin, KindName};

/// Result of a pass over all voxels.
#[derive(Debug)]
enum KindTaskResult {
    /// First look for a kind of data.
    Look(Option<KindName>, Box<Settings>),
    /// Transfer function and table of labels of a further volume, or of the first one.
    Transfer(Option<Box<FieldOrigin>>, TransferFunction, LabelTable),
}

/// Kind of data as which the volume is treated, and the first looks for the other kinds.
#[derive(Debug, Default)]
pub(crate) struct KindOverride {
    kind: Option<KindName>,
    /// Values of the reset buttons for other kinds of data, one look for each.
    other_looks: Vec<(Option<KindName>, Settings)>,
    task: JobSlot<KindTaskResult>,
}

impl KindOverride {
    /// Returns the kind chosen for the current look; `None` is the volume's own.
    pub(crate) fn kind(&self) -> Option<KindName> {
        self.kind
    }

    /// Returns true while a look is being made.
    pub(crate) fn is_busy(&self) -> bool {
        self.task.is_running()
    }

    /// Changes the kind, and with it the values of the reset buttons, if they have been made for it.
    pub(crate) fn change(&mut self, kind: Option<KindName>, defaults: &mut Settings) {
        let before = std::mem::replace(&mut self.kind, kind);
        if before == kind {
            return;
        }
        let known = self.other_looks.iter().position(|(other, _)| *other == kind);
        let known = known.map(|at| self.other_looks.swap_remove(at).1);
        self.other_looks.push((before, defaults.clone()));
        if let Some(mut look) = known {
            // Further layers show other volumes.
            look.layers.replace_further(&defaults.layers);
            *defaults = look;
        }
    }
}

impl Document {
    /// Makes a first look for a kind of data, or for the volume's own kind if `None`.
    pub(crate) fn treat_as(
        &mut self,
        kind: Option<KindName>,
        dataset: Option<Dataset>,
        ctx: &egui::Context,
    ) -> io::Result<()> {
        let (Some(dataset), Some(facts)) = (dataset, &self.volume) else { return Ok(()) };
        let (histogram, up) = (Arc::clone(&facts.histogram), self.settings.camera.up);
        let task = move || {
            KindTaskResult::Look(
                kind,
                Box::new(first_look::first_look_as_kind(dataset.volume(), &histogram, kind, up)),
            )
        };
        self.start_kind_task(task, ctx)
    }

    /// Makes the automatic transfer function or table of labels for the current kind of data.
    pub(crate) fn use_automatic_transfer(
        &mut self,
        dataset: Option<Dataset>,
        ctx: &egui::Context,
    ) -> io::Result<()> {
        let (Some(dataset), Some(facts)) = (dataset, self.selected_volume()) else { return Ok(()) };
        let (histogram, kind, index) = (Arc::clone(&facts.histogram), self.kind_override.kind, facts.layer);
        let further = index.checked_sub(1).and_then(|at| self.further_volumes.get(at)).cloned().map(Box::new);
        let task = move || {
            if further.is_some()
                && let Some(VolumeLayer { transfer, labels, .. }) =
                    first_look::layer_of_field(&dataset, index)
            {
                return KindTaskResult::Transfer(further, transfer, labels);
            }
            let volume = dataset.volume();
            KindTaskResult::Transfer(
                None,
                first_look::transfer_for_kind(volume, &histogram, kind),
                first_look::labels_for_kind(volume, kind),
            )
        };
        self.start_kind_task(task, ctx)
    }

    /// Starts a task; the result of one in progress is dropped.
    fn start_kind_task(
        &mut self,
        task: impl FnOnce() -> KindTaskResult + Send + 'static,
        ctx: &egui::Context,
    ) -> io::Result<()> {
        self.kind_override.task.start(JobKind::KindLook, ctx, (), |_| task())
    }

    /// Takes over the result of a task from its thread. Returns true if it is a first look, which now replaces the
    /// settings.
    pub(crate) fn finish_kind_task(
        &mut self,
        dataset: Option<Dataset>,
        ctx: &egui::Context,
    ) -> Result<bool, String> {
        let Some(made) = self.kind_override.task.take_result() else { return Ok(false) };
        match made? {
            KindTaskResult::Look(kind, look) if look.camera.up == self.settings.camera.up => {
                self.use_first_look(kind, *look);
                return Ok(true);
            }
            KindTaskResult::Look(kind, _) => {
                // The object was turned meanwhile.
                self.treat_as(kind, dataset, ctx).map_err(|err| err.to_string())?;
            }
            KindTaskResult::Transfer(of, transfer, labels) => {
                // The layer may have been removed meanwhile, or have another place.
                if let Some(layer) = self.layer_of_volume_mut(of.as_deref()) {
                    (layer.transfer, layer.labels) = (transfer, labels);
                }
            }
        }
        Ok(false)
    }

    /// Applies a first look for a kind of data.
    fn use_first_look(&mut self, kind: Option<KindName>, look: Settings) {
        let look = first_look::replace_look(look, &self.settings);
        self.kind_override.change(kind, &mut self.defaults);
        self.selected_light = self.selected_light.min(look.lights.len().saturating_sub(1));
        // A light search follows, as for any first look.
        self.first_lights = LightPlacement::new(&look);
        self.defaults = look.clone();
        self.settings = look;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_kind_has_one_first_look_to_which_steps_lead_back() {
        let look = |ambient: f64| {
            let mut settings = Settings::default();
            settings.shading.ambient = ambient;
            settings
        };
        let (mut treated, mut defaults) = (KindOverride::default(), look(0.1));
        for round in 0..50 {
            for (at, kind) in KindName::choices().enumerate() {
                treated.change(kind, &mut defaults);
                if round == 0 && kind.is_some() {
                    defaults = look(f64::from(at as u32 + 2) / 10.0);
                }
            }
        }
        assert!(treated.other_looks.len() < KindName::choices().count());
        for (at, kind) in KindName::choices().enumerate() {
            treated.change(kind, &mut defaults);
            let ambient = if kind.is_some() { f64::from(at as u32 + 2) / 10.0 } else { 0.1 };
            assert_eq!((treated.kind(), &defaults), (kind, &look(ambient)));
            treated.change(kind, &mut defaults);
            assert_eq!(defaults, look(ambient));
        }
    }
}
