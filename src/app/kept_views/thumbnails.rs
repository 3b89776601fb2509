//! Thumbnails of kept views and looks, rendered one after another on a background thread.

use std::sync::mpsc;

use eframe::egui::{self, ColorImage, TextureHandle, TextureOptions};

use crate::app::windows::contact_sheet::{SMALL, render_small};
use crate::app::windows::export::{ExportScene, ExportWorker, settings_for_kept};
use crate::app::worker::jobs::{JobControl, JobKind, JobSlot};
use chiaroscuro_scene::{SavedContent, SavedEntry, Settings};

/// Finished thumbnail of a kept item.
struct KeptThumbnail {
    /// Item that is shown, and content id of the volumes.
    key: (SavedContent, u64),
    /// Texture on the GPU; `None` if rendering failed.
    texture: Option<TextureHandle>,
}

/// Batch of thumbnails in progress on a background thread.
struct ThumbnailBatch {
    results: mpsc::Receiver<(SavedContent, Option<ColorImage>)>,
    requested: Vec<SavedContent>,
    content_id: u64,
}

/// Finished thumbnails of the current volume, and the batch in progress.
#[derive(Default)]
pub(super) struct KeptThumbnails {
    finished: Vec<KeptThumbnail>,
    batch: JobSlot<(), ThumbnailBatch>,
    content_id: Option<u64>,
}

impl std::fmt::Debug for KeptThumbnails {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Thumbnails").field("drawn", &self.finished.len()).finish_non_exhaustive()
    }
}

impl KeptThumbnails {
    /// Returns the thumbnail of a kept item, if it has been rendered.
    pub(super) fn get(&self, kept: &SavedEntry) -> Option<&TextureHandle> {
        let is_of = |drawn: &&KeptThumbnail| Some(drawn.key.1) == self.content_id && drawn.key.0 == kept.what;
        self.finished.iter().find(is_of)?.texture.as_ref()
    }

    /// Returns true while thumbnails are being rendered.
    pub(super) fn is_busy(&self) -> bool {
        self.batch.is_running()
    }

    /// Items that have no thumbnail yet; `None` if there are none, or while a batch is in progress.
    pub(super) fn missing(
        &mut self,
        settings: &Settings,
        content_id: Option<u64>,
    ) -> Option<Vec<SavedContent>> {
        self.content_id = content_id;
        let id = content_id.filter(|_| !self.batch.is_running())?;
        let kept = || settings.kept.iter().map(|kept| &kept.what);
        // Items that were removed or belong to another volume are dropped; should they return, they are rendered
        // again.
        self.finished.retain(|drawn| drawn.key.1 == id && kept().any(|what| *what == drawn.key.0));
        let is_missing = |what: &&SavedContent| self.finished.iter().all(|drawn| drawn.key.0 != **what);
        let missing: Vec<_> = kept().filter(is_missing).cloned().collect();
        (!missing.is_empty()).then_some(missing)
    }

    /// Starts to render thumbnails. Views are drawn in the current look.
    pub(super) fn start(
        &mut self,
        wanted: Vec<SavedContent>,
        subject: ExportScene,
        ctx: &egui::Context,
    ) -> std::io::Result<()> {
        let content_id = subject.dataset.id().content_id;
        let (sender, drawn) = mpsc::channel();
        let (wake, all) = (ctx.clone(), wanted.clone());
        let task = move |job: &JobControl| {
            let mut worker = ExportWorker::new(&subject);
            for what in all {
                let settings = settings_for_kept(&what, &subject.settings);
                let picture = match &mut worker {
                    Ok(worker) => render_small(worker, &subject, &settings),
                    Err(err) => Err(err.clone()),
                };
                if let Err(err) = &picture {
                    log::warn!("a thumbnail of a saved view or look was not rendered: {err}");
                }
                if sender.send((what, picture.ok())).is_err() || job.token().is_cancelled() {
                    return;
                }
                wake.request_repaint();
            }
        };
        let batch = ThumbnailBatch { results: drawn, requested: wanted, content_id };
        self.batch.start(JobKind::SavedThumbnails, ctx, batch, task)
    }

    /// Collects the thumbnails that have been rendered since the last call.
    pub(super) fn collect(&mut self, ctx: &egui::Context) {
        // Taken before the channel is drained: no thumbnail is sent after the end of the task.
        let ended = self.batch.take_ended().map(|(batch, _)| batch);
        let Some(drawing) = ended.as_ref().or(self.batch.inputs()) else { return };
        for (what, picture) in drawing.results.try_iter() {
            let texture = picture.map(|picture| ctx.load_texture("kept", picture, TextureOptions::LINEAR));
            self.finished.push(KeptThumbnail { key: (what, drawing.content_id), texture });
        }
        if let Some(ThumbnailBatch { requested: wanted, content_id, .. }) = ended {
            // Items that are missing because the thread panicked are marked as failed, so that they are not tried
            // again and again.
            for what in wanted {
                if self.finished.iter().all(|drawn| drawn.key.0 != what) {
                    self.finished.push(KeptThumbnail { key: (what, content_id), texture: None });
                }
            }
        }
    }
}

/// Size of a thumbnail on screen, for a height in points.
pub(super) fn thumbnail_size(height: f32) -> egui::Vec2 {
    egui::vec2(height * SMALL[0] as f32 / SMALL[1] as f32, height)
}
