//! What views are framed by: where the object ends that is shown, found on a thread of its own while nothing else is
//! done, since that goes through all voxels.

use std::sync::Arc;

use eframe::egui;

use crate::app::App;
use crate::app::common::commands::Command;
use crate::app::worker::task::Work;
use crate::model::auto::Outline;
use crate::model::{Cuts, DensityRange, LabelTable, Settings, TransferFunction};

/// What an outline depends on.
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

/// The outline of the object, as far as it is known.
#[derive(Debug, Default)]
pub(in crate::app) struct Framed {
    known: Option<(Shown, Arc<Outline>)>,
    work: Option<(Shown, Work<Outline>)>,
    /// It could not be found: it is not sought again for this volume.
    failed: Option<u64>,
    /// What waits for it, the latest.
    waiting: Option<Command>,
}

impl App {
    /// Identifies the volume that is shown.
    fn shown_id(&self) -> Option<u64> {
        self.viewport.dataset().map(|dataset| dataset.volume().content_id())
    }

    /// Whether the outline is that of what is shown.
    pub(in crate::app) fn knows_outline(&self) -> bool {
        self.shown_id().is_none_or(|id| {
            let is_known = self.framed.known.as_ref().is_some_and(|(of, _)| of.is_by(&self.settings, id));
            is_known || self.framed.failed == Some(id)
        })
    }

    /// The outline of what is shown, or of what was before while nobody knows a newer one.
    pub(in crate::app) fn outline(&self) -> Option<Arc<Outline>> {
        let (of, outline) = self.framed.known.as_ref()?;
        (Some(of.content_id) == self.shown_id()).then(|| Arc::clone(outline))
    }

    /// Whether a command that needs the outline can be carried out; if not, that is done when it is known.
    pub(in crate::app::shell) fn can_frame(&mut self, command: Command, ctx: &egui::Context) -> bool {
        if self.knows_outline() {
            return true;
        }
        self.framed.waiting = Some(command);
        self.seek_outline(ctx);
        false
    }

    /// Takes in the outline that was found, and seeks it anew when all is at rest and something else is shown. Returns
    /// what has waited for it.
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

    /// Starts to seek the outline of what is shown, unless one is being sought.
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

    /// Frames what is shown, from where the eye looks.
    pub(in crate::app::shell) fn frame_object(&mut self) {
        match self.outline().filter(|outline| !outline.is_empty()) {
            Some(outline) => outline.frame(&mut self.settings.camera),
            // Nothing is shown: what was at first.
            None => self.settings.camera.frame_as(&self.defaults.camera),
        }
    }
}
