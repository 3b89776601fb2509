//! Outline of the visible object, by which views are framed.
//!
//! It is found on a thread while the window is idle, since it takes a pass over all voxels.

use std::sync::Arc;

use eframe::egui;

use crate::app::App;
use crate::app::common::commands::AppCommand;
use crate::app::worker::background_task::BackgroundTask;
use chiaroscuro_scene::{
    Clipping, DensityRange, LabelTable, Settings, TransferFunction, first_look::ObjectOutline,
};

/// Inputs on which an outline depends.
#[derive(Debug, Clone, PartialEq)]
struct OutlineInputs {
    content_id: u64,
    transfer: TransferFunction,
    labels: LabelTable,
    range: DensityRange,
    cuts: Clipping,
}

impl OutlineInputs {
    fn matches(&self, settings: &Settings, content_id: u64) -> bool {
        let Self { content_id: of, transfer, labels, range, cuts } = self;
        *of == content_id
            && *transfer == settings.transfer
            && *labels == settings.labels
            && *range == settings.range
            && *cuts == settings.cuts
    }
}

/// Outline of the object with the search for it.
#[derive(Debug, Default)]
pub(crate) struct OutlineCache {
    known: Option<(OutlineInputs, Arc<ObjectOutline>)>,
    work: Option<(OutlineInputs, BackgroundTask<ObjectOutline>)>,
    /// Volume for which the search failed; it is not retried.
    failed: Option<u64>,
    /// Latest command that waits for the outline.
    waiting: Option<AppCommand>,
}

impl App {
    /// Content identifier of the volume that is shown.
    fn shown_id(&self) -> Option<u64> {
        self.viewport.dataset().map(|dataset| dataset.volume().content_id())
    }

    /// Returns true if the outline of the current look is known, or cannot be found.
    pub(crate) fn knows_outline(&self) -> bool {
        self.shown_id().is_none_or(|id| {
            let is_known =
                self.outline_task.known.as_ref().is_some_and(|(of, _)| of.matches(&self.settings, id));
            is_known || self.outline_task.failed == Some(id)
        })
    }

    /// Returns the latest outline of the volume shown; it may be of an earlier look while a newer one is not known.
    pub(crate) fn outline(&self) -> Option<Arc<ObjectOutline>> {
        let (of, outline) = self.outline_task.known.as_ref()?;
        (Some(of.content_id) == self.shown_id()).then(|| Arc::clone(outline))
    }

    /// Returns true if a command that needs the outline can run; otherwise it is queued until the outline is known.
    pub(crate) fn can_frame(&mut self, command: AppCommand, ctx: &egui::Context) -> bool {
        if self.knows_outline() {
            return true;
        }
        self.outline_task.waiting = Some(command);
        self.start_outline_search(ctx);
        false
    }

    /// Takes over an outline from its thread, and starts a search when the window is idle and the look has changed.
    /// Returns the command that has waited for the outline.
    pub(crate) fn update_outline(&mut self, ctx: &egui::Context) -> Option<AppCommand> {
        if let Some((_, work)) = &self.outline_task.work
            && let Some(found) = work.take_result()
            && let Some((of, _)) = self.outline_task.work.take()
        {
            match found {
                Ok(outline) => self.outline_task.known = Some((of, Arc::new(outline))),
                Err(panic) => {
                    log::warn!("the search for the outline of the object failed: {panic}");
                    self.outline_task.failed = Some(of.content_id);
                }
            }
        }
        if self.knows_outline() {
            return self.outline_task.waiting.take();
        }
        if self.outline_task.waiting.is_some() || self.is_complete() {
            self.start_outline_search(ctx);
        }
        None
    }

    /// Starts the search for the current outline, unless one is running.
    fn start_outline_search(&mut self, ctx: &egui::Context) {
        let Some(dataset) = self.viewport.dataset().filter(|_| self.outline_task.work.is_none()) else {
            return;
        };
        let settings = self.settings.clone();
        let Settings { transfer, labels, range, cuts, .. } = settings.clone();
        let content_id = dataset.volume().content_id();
        match BackgroundTask::start("outline", ctx, move || {
            ObjectOutline::from_settings(&settings, dataset.volume())
        }) {
            Ok(work) => {
                self.outline_task.work =
                    Some((OutlineInputs { content_id, transfer, labels, range, cuts }, work));
            }
            Err(err) => {
                log::warn!("the search for the outline of the object could not start: {err}");
                self.outline_task.failed = Some(content_id);
            }
        }
    }

    /// Frames the visible object from the current direction.
    pub(crate) fn frame_object(&mut self) {
        match self.outline().filter(|outline| !outline.is_empty()) {
            Some(outline) => outline.frame(&mut self.settings.camera),
            // Nothing is visible: framed as the first look was.
            None => self.settings.camera.copy_framing(&self.defaults.camera),
        }
    }
}
