//! Correction of file metadata: a thread makes the corrected volume from the opened one.
//!
//! The view is framed again if it was framed before.

use eframe::egui;

use super::Document;
use super::orientation::has_same_framing;
use crate::app::persistence::{FileStamp, PersistentState};
use crate::app::worker::jobs::{JobControl, JobKind, JobSlot};
use chiaroscuro_scene::{Settings, first_look};
use chiaroscuro_volume::{Corrections, Dataset, VolumeError};

/// Corrected volume, and the first look that frames it.
#[derive(Debug)]
struct CorrectedVolume {
    dataset: Dataset,
    first: Settings,
}

/// Inputs of a correction in progress on a thread.
#[derive(Debug)]
struct CorrectionInputs {
    corrections: Corrections,
    /// Identifier of the opened volume.
    opened_id: u64,
}

/// State of the corrections of the open volume.
#[derive(Debug, Default)]
pub(crate) struct CorrectionState {
    /// Size and modification time of the file when it was opened.
    stamp: FileStamp,
    /// Corrections that need not be remembered: from a session or preset, or remembered already.
    known: Corrections,
    making: JobSlot<Result<CorrectedVolume, VolumeError>, CorrectionInputs>,
}

impl CorrectionState {
    /// Starts with an opened volume and the corrections that it was opened with.
    pub(crate) fn new(stamp: FileStamp, known: Corrections) -> Self {
        Self { stamp, known, making: JobSlot::default() }
    }

    /// Accepts corrections from a look, which need not be remembered.
    pub(crate) fn accept(&mut self, by: Corrections) {
        self.known = by;
    }
}

impl Document {
    /// Returns true while the volume shown lacks the corrections of the settings.
    pub(crate) fn is_correcting(&self, shown: Option<&Dataset>) -> bool {
        shown.is_some_and(|dataset| *dataset.volume().corrections() != self.settings.volume)
    }

    /// Starts correcting the volume as the settings say, and remembers corrections that are made.
    pub(crate) fn start_correction_if_due(
        &mut self,
        dataset: Dataset,
        memory: &mut PersistentState,
        ctx: &egui::Context,
    ) -> Result<(), String> {
        let (volume, wanted) = (dataset.volume(), self.settings.volume);
        if wanted == *volume.corrections() {
            self.corrections.making.discard();
            if self.defaults.volume != wanted {
                // Restored by an undo.
                self.defaults.apply_corrections(wanted, volume);
            }
            if self.corrections.known != wanted {
                self.corrections.known = wanted;
                if let Some(facts) = &self.volume {
                    let CorrectionState { stamp, .. } = self.corrections;
                    memory.remember_corrections(&facts.source, stamp, volume.opened_id(), wanted);
                }
            }
        } else if self.corrections.making.inputs().is_none_or(|making| making.corrections != wanted) {
            return self.start_correction(dataset, ctx);
        }
        Ok(())
    }

    /// Starts correcting the volume as the settings say; a correction in progress is dropped.
    fn start_correction(&mut self, dataset: Dataset, ctx: &egui::Context) -> Result<(), String> {
        let (by, opened_id) = (self.settings.volume, dataset.volume().opened_id());
        let mut first = self.defaults.clone();
        first.apply_corrections(by, dataset.volume());
        let shown = dataset.clone();
        let task = move |_: &JobControl| {
            let dataset = dataset.corrected(&by)?;
            first_look::frame_object(&mut first, dataset.volume());
            Ok(CorrectedVolume { dataset, first })
        };
        let inputs = CorrectionInputs { corrections: by, opened_id };
        let started = self.corrections.making.start(JobKind::Corrections, ctx, inputs, task);
        started.map_err(|err| {
            self.restore_corrections(&shown);
            err.to_string()
        })
    }

    /// Takes over a corrected volume from its thread. Returns the dataset that is to be shown instead of `shown`.
    pub(crate) fn take_corrected(
        &mut self,
        shown: Option<&Dataset>,
        now_s: f64,
    ) -> Result<Option<Dataset>, String> {
        let Some((inputs, made)) = self.corrections.making.take_ended() else { return Ok(None) };
        let Some(shown) = shown.filter(|shown| shown.volume().opened_id() == inputs.opened_id) else {
            return Ok(None);
        };
        if inputs.corrections != self.settings.volume {
            // The settings have changed meanwhile.
            return Ok(None);
        }
        match made.and_then(|made| made.map_err(|err| err.to_string())) {
            // Layers were added or removed meanwhile, and are corrected by another task.
            Ok(made) if !made.dataset.further_origins().eq(shown.further_origins()) => Ok(None),
            Ok(made) => Ok(Some(self.use_corrected(made, now_s))),
            Err(err) => {
                self.restore_corrections(shown);
                Err(err)
            }
        }
    }

    /// Goes back to the corrections with which the volume is shown.
    fn restore_corrections(&mut self, shown: &Dataset) {
        self.settings.apply_corrections(*shown.volume().corrections(), shown.volume());
    }

    /// Edits a corrected volume from now on, framed again and back on the floor if the previous volume was; returns
    /// its dataset.
    fn use_corrected(&mut self, made: CorrectedVolume, now_s: f64) -> Dataset {
        let CorrectedVolume { dataset, first } = made;
        let before = self.history_step();
        let was_framed = has_same_framing(&self.settings.camera, &self.defaults.camera);
        let was_on_floor = self.settings.floor.height == self.defaults.floor.height;
        self.defaults.apply_corrections(*dataset.volume().corrections(), dataset.volume());
        if first.camera.up == self.defaults.camera.up {
            self.defaults.camera.copy_framing(&first.camera);
            self.defaults.floor.height = first.floor.height;
        }
        if was_framed {
            self.settings.camera.copy_framing(&self.defaults.camera);
        }
        if was_on_floor {
            self.settings.floor.height = self.defaults.floor.height;
        }
        let after = self.history_step();
        if after != before {
            // Merged into the step of the correction.
            self.history.merge_into_last(now_s, &before, &after);
            self.first_lights.accept_change(&before.settings, &after.settings);
        }
        if let Some(facts) = &mut self.volume {
            facts.update(&dataset);
        }
        dataset
    }
}
