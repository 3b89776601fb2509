//! Correction of file metadata: a thread makes the corrected volume from the opened one.
//!
//! The view is framed again if it was framed before.

use eframe::egui;

use super::orientation::has_same_framing;
use crate::app::persistence::FileStamp;
use crate::app::worker::background_task::BackgroundTask;
use crate::app::{App, text};
use chiaroscuro_scene::{Settings, first_look};
use chiaroscuro_volume::{Corrections, Dataset, VolumeError};

/// Corrected volume, and the first look that frames it.
#[derive(Debug)]
struct CorrectedVolume {
    dataset: Dataset,
    first: Settings,
}

/// Correction in progress on a thread.
#[derive(Debug)]
struct CorrectionTask {
    corrections: Corrections,
    /// Identifier of the opened volume.
    opened_id: u64,
    work: BackgroundTask<Result<CorrectedVolume, VolumeError>>,
}

/// State of the corrections of the open volume.
#[derive(Debug, Default)]
pub(crate) struct CorrectionState {
    /// Size and modification time of the file when it was opened.
    stamp: FileStamp,
    /// Corrections that need not be remembered: from a session or preset, or remembered already.
    known: Corrections,
    making: Option<CorrectionTask>,
}

impl CorrectionState {
    /// Starts with an opened volume and the corrections that it was opened with.
    pub(crate) fn new(stamp: FileStamp, known: Corrections) -> Self {
        Self { stamp, known, making: None }
    }

    /// Accepts corrections from a look, which need not be remembered.
    pub(crate) fn accept(&mut self, by: Corrections) {
        self.known = by;
    }
}

impl App {
    /// Returns true while the volume shown lacks the corrections of the settings.
    pub(crate) fn is_correcting(&self) -> bool {
        let shown = self.viewport.dataset().map(|dataset| *dataset.volume().corrections());
        shown.is_some_and(|shown| shown != self.settings.volume)
    }

    /// Starts correcting the volume as the settings say, and takes over the result.
    pub(crate) fn update_corrections(&mut self, ctx: &egui::Context) {
        self.take_corrected(ctx);
        let Some(dataset) = self.viewport.dataset() else { return };
        let (volume, wanted) = (dataset.volume(), self.settings.volume);
        if wanted == *volume.corrections() {
            self.corrections_task.making = None;
            if self.defaults.volume != wanted {
                // Restored by an undo.
                self.defaults.apply_corrections(wanted, volume);
            }
            if self.corrections_task.known != wanted {
                self.corrections_task.known = wanted;
                if let Some(facts) = &self.volume {
                    let CorrectionState { stamp, .. } = self.corrections_task;
                    self.memory.remember_corrections(&facts.source, stamp, volume.opened_id(), wanted);
                }
            }
        } else if self.corrections_task.making.as_ref().is_none_or(|making| making.corrections != wanted) {
            self.correct(dataset, ctx);
        }
    }

    /// Starts correcting the volume as the settings say; a correction in progress is dropped.
    fn correct(&mut self, dataset: Dataset, ctx: &egui::Context) {
        let (by, opened_id) = (self.settings.volume, dataset.volume().opened_id());
        let mut first = self.defaults.clone();
        first.apply_corrections(by, dataset.volume());
        let task = move || {
            let dataset = dataset.corrected(&by)?;
            first_look::frame_object(&mut first, dataset.volume());
            Ok(CorrectedVolume { dataset, first })
        };
        match BackgroundTask::start("corrections", ctx, task) {
            Ok(work) => {
                self.corrections_task.making = Some(CorrectionTask { corrections: by, opened_id, work });
            }
            Err(err) => self.restore_corrections(err.to_string()),
        }
    }

    /// Takes over a corrected volume from its thread.
    fn take_corrected(&mut self, ctx: &egui::Context) {
        let Some(made) = self.corrections_task.making.as_ref().and_then(|making| making.work.take_result())
        else {
            return;
        };
        let Some(making) = self.corrections_task.making.take() else { return };
        let shown = self.viewport.dataset().map(|dataset| dataset.volume().opened_id());
        if making.corrections != self.settings.volume || shown != Some(making.opened_id) {
            // The settings or the volume have changed meanwhile.
            return;
        }
        match made {
            Ok(Ok(made)) => self.use_corrected(made, ctx),
            Ok(Err(err)) => self.restore_corrections(err.to_string()),
            Err(panic) => self.restore_corrections(panic),
        }
    }

    /// Goes back to the corrections with which the volume is shown.
    fn restore_corrections(&mut self, why: String) {
        if let Some(dataset) = self.viewport.dataset() {
            self.settings.apply_corrections(*dataset.volume().corrections(), dataset.volume());
        }
        self.messages.error(text::corrections::CORRECTION_FAILED, why);
    }

    /// Shows a corrected volume, framed again and back on the floor if the previous volume was.
    fn use_corrected(&mut self, made: CorrectedVolume, ctx: &egui::Context) {
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
            self.history.merge_into_last(ctx.input(|input| input.time), &before, &after);
            self.first_lights.accept_change(&before.settings, &after.settings);
        }
        // Results in progress belong to the volume before.
        (self.light_search, self.balance) = (None, None);
        self.contact_sheet.discard();
        if let Some(facts) = &mut self.volume {
            facts.update(&dataset);
        }
        self.viewport.set_dataset(dataset);
        ctx.request_repaint();
    }
}
