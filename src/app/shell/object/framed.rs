//! Outline of the visible object, by which views are framed.
//!
//! It is found on a thread while the window is idle, since it takes a pass over all voxels.

use std::sync::Arc;

use eframe::egui;

use crate::app::App;
use crate::app::common::commands::Command;
use crate::app::worker::task::Work;
use crate::model::auto::Outline;
use crate::model::{Cuts, DensityRange, LabelTable, Settings, TransferFunction};

/// Inputs on which an outline depends.
#[derive(Debug, Clone, PartialEq)]
struct Shown {
    content_id: u64,
    transfer: TransferFunction,
    labels: LabelTable,
    range: DensityRange,
    cuts: Cuts,
}

impl Shown {
    fn is_by(&self, settings: &Settings, content_id: u64) -> bool {
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
pub(in crate::app) struct Framed {
    known: Option<(Shown, Arc<Outline>)>,
    work: Option<(Shown, Work<Outline>)>,
    /// Volume for which the search failed; it is not retried.
    failed: Option<u64>,
    /// Latest command that waits for the outline.
    waiting: Option<Command>,
}

impl App {
    /// Content identifier of the volume that is shown.
    fn shown_id(&self) -> Option<u64> {
        self.viewport.dataset().map(|dataset| dataset.volume().content_id())
    }

    /// Returns true if the outline of the current look is known, or cannot be found.
    pub(in crate::app) fn knows_outline(&self) -> bool {
        self.shown_id().is_none_or(|id| {
            let is_known = self.framed.known.as_ref().is_some_and(|(of, _)| of.is_by(&self.settings, id));
            is_known || self.framed.failed == Some(id)
        })
    }

    /// Returns the latest outline of the volume shown; it may be of an earlier look while a newer one is not known.
    pub(in crate::app) fn outline(&self) -> Option<Arc<Outline>> {
        let (of, outline) = self.framed.known.as_ref()?;
        (Some(of.content_id) == self.shown_id()).then(|| Arc::clone(outline))
    }

    /// Returns true if a command that needs the outline can run; otherwise it is queued until the outline is known.
    pub(in crate::app::shell) fn can_frame(&mut self, command: Command, ctx: &egui::Context) -> bool {
        if self.knows_outline() {
            return true;
        }
        self.framed.waiting = Some(command);
        self.seek_outline(ctx);
        false
    }

    /// Takes over an outline from its thread, and starts a search when the window is idle and the look has changed.
    /// Returns the command that has waited for the outline.
    pub(in crate::app) fn follow_outline(&mut self, ctx: &egui::Context) -> Option<Command> {
        if let Some((_, work)) = &self.framed.work
            && let Some(found) = work.take()
            && let Some((of, _)) = self.framed.work.take()
        {
            match found {
                Ok(outline) => self.framed.known = Some((of, Arc::new(outline))),
                Err(panic) => {
                    log::warn!("the outline of the object was not found: {panic}");
                    self.framed.failed = Some(of.content_id);
                }
            }
        }
        if self.knows_outline() {
            return self.framed.waiting.take();
        }
        if self.framed.waiting.is_some() || self.is_complete() {
            self.seek_outline(ctx);
        }
        None
    }

    /// Starts the search for the current outline, unless one is running.
    fn seek_outline(&mut self, ctx: &egui::Context) {
        let Some(dataset) = self.viewport.dataset().filter(|_| self.framed.work.is_none()) else { return };
        let settings = self.settings.clone();
        let Settings { transfer, labels, range, cuts, .. } = settings.clone();
        let content_id = dataset.volume().content_id();
        match Work::start("outline", ctx, move || Outline::of(&settings, dataset.volume())) {
            Ok(work) => {
                self.framed.work = Some((Shown { content_id, transfer, labels, range, cuts }, work));
            }
            Err(err) => {
                log::warn!("the outline of the object is not sought: {err}");
                self.framed.failed = Some(content_id);
            }
        }
    }

    /// Frames the visible object from the current direction.
    pub(in crate::app::shell) fn frame_object(&mut self) {
        match self.outline().filter(|outline| !outline.is_empty()) {
            Some(outline) => outline.frame(&mut self.settings.camera),
            // Nothing is visible: framed as the first look was.
            None => self.settings.camera.frame_as(&self.defaults.camera),
        }
    }
}
