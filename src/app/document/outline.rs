//! Outline of the visible object, by which views are framed.
//!
//! It is found on a thread while the window is idle, since it takes a pass over all voxels.

use std::sync::Arc;

use eframe::egui;

use super::Document;
use crate::app::common::commands::AppCommand;
use crate::app::worker::jobs::{JobKind, JobSlot};
use chiaroscuro_scene::{Clipping, Settings, VolumeLayer, VolumeLayers, first_look::ObjectOutline};
use chiaroscuro_volume::Dataset;

/// Inputs on which an outline depends.
#[derive(Debug, Clone, PartialEq)]
struct OutlineInputs {
    content_id: u64,
    layers: VolumeLayers,
    cuts: Clipping,
}

impl OutlineInputs {
    fn matches(&self, settings: &Settings, content_id: u64) -> bool {
        let Self { content_id: of, layers, cuts } = self;
        *of == content_id
            && *cuts == settings.cuts
            && layers.count() == settings.layers.count()
            && layers.iter().zip(settings.layers.iter()).all(|(known, layer)| has_same_outline(known, layer))
    }
}

/// Returns true if two layers have the same outline, on which light, densities and edges have no influence.
fn has_same_outline(a: &VolumeLayer, b: &VolumeLayer) -> bool {
    let VolumeLayer {
        range,
        labels,
        transfer,
        lighting: _,
        opacity_unit: _,
        visibility,
        blend,
        edges: _,
        materials,
        ignores_cuts,
    } = a;
    *range == b.range
        && *labels == b.labels
        && *transfer == b.transfer
        && *visibility == b.visibility
        && *blend == b.blend
        && *materials == b.materials
        && *ignores_cuts == b.ignores_cuts
}

/// Outline of the object with the search for it.
#[derive(Debug, Default)]
pub(crate) struct OutlineCache {
    known: Option<(OutlineInputs, Arc<ObjectOutline>)>,
    search: JobSlot<ObjectOutline, OutlineInputs>,
    /// Volume for which the search failed; it is not retried.
    failed: Option<u64>,
    /// Latest command that waits for the outline.
    waiting: Option<AppCommand>,
}

/// Content identifier of the volume that is shown.
fn content_id(dataset: Option<&Dataset>) -> Option<u64> {
    dataset.map(|dataset| dataset.id().content_id)
}

impl Document {
    /// Returns true if the outline of the current look is known, or cannot be found.
    pub(crate) fn knows_outline(&self, dataset: Option<&Dataset>) -> bool {
        content_id(dataset).is_none_or(|id| {
            let is_known =
                self.outline_cache.known.as_ref().is_some_and(|(of, _)| of.matches(&self.settings, id));
            is_known || self.outline_cache.failed == Some(id)
        })
    }

    /// Returns the latest outline of the volume shown; it may be of an earlier look while a newer one is not known.
    pub(crate) fn outline(&self, dataset: Option<&Dataset>) -> Option<Arc<ObjectOutline>> {
        let (of, outline) = self.outline_cache.known.as_ref()?;
        (Some(of.content_id) == content_id(dataset)).then(|| Arc::clone(outline))
    }

    /// Returns true if a command that needs the outline can run; otherwise it is queued until the outline is known.
    pub(crate) fn can_frame(
        &mut self,
        command: AppCommand,
        dataset: Option<Dataset>,
        ctx: &egui::Context,
    ) -> bool {
        if self.knows_outline(dataset.as_ref()) {
            return true;
        }
        self.outline_cache.waiting = Some(command);
        self.start_outline_search(dataset, ctx);
        false
    }

    /// Takes over an outline from its thread.
    pub(crate) fn take_outline(&mut self) {
        match self.outline_cache.search.take_ended() {
            None => {}
            Some((of, Ok(outline))) => self.outline_cache.known = Some((of, Arc::new(outline))),
            Some((of, Err(panic))) => {
                log::warn!("the search for the outline of the object failed: {panic}");
                self.outline_cache.failed = Some(of.content_id);
            }
        }
    }

    /// Takes the command that has waited for the outline.
    pub(crate) fn take_waiting_command(&mut self) -> Option<AppCommand> {
        self.outline_cache.waiting.take()
    }

    /// Returns true while a command waits for the outline.
    pub(crate) fn is_outline_awaited(&self) -> bool {
        self.outline_cache.waiting.is_some()
    }

    /// Starts the search for the current outline, unless one is running.
    pub(crate) fn start_outline_search(&mut self, dataset: Option<Dataset>, ctx: &egui::Context) {
        let Some(dataset) = dataset.filter(|_| !self.outline_cache.search.is_running()) else {
            return;
        };
        let settings = self.settings.clone();
        let (layers, cuts) = (settings.layers.clone(), settings.cuts.clone());
        let content_id = dataset.id().content_id;
        let inputs = OutlineInputs { content_id, layers, cuts };
        let started = self
            .outline_cache
            .search
            .start(JobKind::Outline, ctx, inputs, move |_| ObjectOutline::from_dataset(&settings, &dataset));
        if let Err(err) = started {
            log::warn!("the search for the outline of the object could not start: {err}");
            self.outline_cache.failed = Some(content_id);
        }
    }

    /// Frames the visible object from the current direction.
    pub(crate) fn frame_object(&mut self, dataset: Option<&Dataset>) {
        match self.outline(dataset).filter(|outline| !outline.is_empty()) {
            Some(outline) => outline.frame(&mut self.settings.camera),
            // Nothing is visible: framed as the first look was.
            None => self.settings.camera.copy_framing(&self.defaults.camera),
        }
    }
}
