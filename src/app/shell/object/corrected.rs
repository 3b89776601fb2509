//! Correction of file metadata: a thread makes the corrected volume from the opened one.
//!
//! The view is framed again if it was framed before.

use eframe::egui;

use super::upright::is_framed_alike;
use crate::app::memory::FileStamp;
use crate::app::worker::task::Work;
use crate::app::{App, text};
use crate::data::{Corrections, Dataset, VolumeError};
use crate::model::{Settings, auto};

/// Corrected volume, and the first look that frames it.
#[derive(Debug)]
struct Made {
    dataset: Dataset,
    first: Settings,
}

/// Correction in progress on a thread.
#[derive(Debug)]
struct Making {
    by: Corrections,
    /// Identifier of the opened volume.
    opened_id: u64,
    work: Work<Result<Made, VolumeError>>,
}

/// State of the corrections of the open volume.
#[derive(Debug, Default)]
pub(in crate::app) struct Corrected {
    /// Size and modification time of the file when it was opened.
    stamp: FileStamp,
    /// Corrections that need not be remembered: from a session or preset, or remembered already.
    known: Corrections,
    making: Option<Making>,
}

impl Corrected {
    /// Starts with an opened volume and the corrections that it was opened with.
    pub(in crate::app) fn new(stamp: FileStamp, known: Corrections) -> Self {
        Self { stamp, known, making: None }
    }

    /// Accepts corrections from a look, which need not be remembered.
    pub(in crate::app) fn accept(&mut self, by: Corrections) {
        self.known = by;
    }
}

impl App {
    /// Returns true while the volume shown lacks the corrections of the settings.
    pub(in crate::app) fn is_correcting(&self) -> bool {
        let shown = self.viewport.dataset().map(|dataset| *dataset.volume().corrections());
        shown.is_some_and(|shown| shown != self.settings.volume)
    }

    /// Starts correcting the volume as the settings say, and takes over the result.
    pub(in crate::app) fn follow_corrections(&mut self, ctx: &egui::Context) {
        self.take_corrected(ctx);
        let Some(dataset) = self.viewport.dataset() else { return };
        let (volume, wanted) = (dataset.volume(), self.settings.volume);
        if wanted == *volume.corrections() {
            self.corrected.making = None;
            if self.defaults.volume != wanted {
                // Restored by an undo.
                self.defaults.correct(wanted, volume);
            }
            if self.corrected.known != wanted {
                self.corrected.known = wanted;
                if let Some(facts) = &self.volume {
                    let Corrected { stamp, .. } = self.corrected;
                    self.memory.corrected(&facts.source, stamp, volume.opened_id(), wanted);
                }
            }
        } else if self.corrected.making.as_ref().is_none_or(|making| making.by != wanted) {
            self.correct(dataset, ctx);
        }
    }

    /// Starts correcting the volume as the settings say; a correction in progress is dropped.
    fn correct(&mut self, dataset: Dataset, ctx: &egui::Context) {
        let (by, opened_id) = (self.settings.volume, dataset.volume().opened_id());
        let mut first = self.defaults.clone();
        first.correct(by, dataset.volume());
        let task = move || {
            let dataset = dataset.corrected(&by)?;
            auto::frame(&mut first, dataset.volume());
            Ok(Made { dataset, first })
        };
        match Work::start("corrections", ctx, task) {
            Ok(work) => self.corrected.making = Some(Making { by, opened_id, work }),
            Err(err) => self.leave_uncorrected(err.to_string()),
        }
    }

    /// Takes over a corrected volume from its thread.
    fn take_corrected(&mut self, ctx: &egui::Context) {
        let Some(made) = self.corrected.making.as_ref().and_then(|making| making.work.take()) else { return };
        let Some(making) = self.corrected.making.take() else { return };
        let shown = self.viewport.dataset().map(|dataset| dataset.volume().opened_id());
        if making.by != self.settings.volume || shown != Some(making.opened_id) {
            // The settings or the volume have changed meanwhile.
            return;
        }
        match made {
            Ok(Ok(made)) => self.use_corrected(made, ctx),
            Ok(Err(err)) => self.leave_uncorrected(err.to_string()),
            Err(panic) => self.leave_uncorrected(panic),
        }
    }

    /// Goes back to the corrections with which the volume is shown.
    fn leave_uncorrected(&mut self, why: String) {
        if let Some(dataset) = self.viewport.dataset() {
            self.settings.correct(*dataset.volume().corrections(), dataset.volume());
        }
        self.messages.error(text::corrections::NOT_CORRECTED, why);
    }

    /// Shows a corrected volume, framed again and back on the floor if the previous volume was.
    fn use_corrected(&mut self, made: Made, ctx: &egui::Context) {
        let Made { dataset, first } = made;
        let before = self.step();
        let was_framed = is_framed_alike(&self.settings.camera, &self.defaults.camera);
        let was_on_floor = self.settings.floor.height == self.defaults.floor.height;
        self.defaults.correct(*dataset.volume().corrections(), dataset.volume());
        if first.camera.up == self.defaults.camera.up {
            self.defaults.camera.frame_as(&first.camera);
            self.defaults.floor.height = first.floor.height;
        }
        if was_framed {
            self.settings.camera.frame_as(&self.defaults.camera);
        }
        if was_on_floor {
            self.settings.floor.height = self.defaults.floor.height;
        }
        let after = self.step();
        if after != before {
            // Merged into the step of the correction.
            self.history.follow(ctx.input(|input| input.time), &before, &after);
            self.first_lights.follow(&before.settings, &after.settings);
        }
        // Results in progress belong to the volume before.
        (self.light_search, self.balance) = (None, None);
        self.contact_sheet.forget();
        if let Some(facts) = &mut self.volume {
            facts.follow(&dataset);
        }
        self.viewport.set_dataset(dataset);
        ctx.request_repaint();
    }
}
