//! Thumbnails of kept views and looks, rendered one after another on a background thread.

use std::sync::mpsc;

use eframe::egui::{self, ColorImage, TextureHandle, TextureOptions};

use crate::app::windows::contact_sheet::{SMALL, small_picture};
use crate::app::windows::export::{Subject, Worker, shown_of};
use crate::app::worker::task::Work;
use crate::model::{Kept, KeptThing, Settings};

/// Finished thumbnail of a kept item.
struct Drawn {
    /// Item that is shown, and content id of the volume.
    of: (KeptThing, u64),
    /// Texture on the GPU; `None` if rendering failed.
    texture: Option<TextureHandle>,
}

/// Batch of thumbnails in progress on a background thread.
struct Drawing {
    work: Work<()>,
    drawn: mpsc::Receiver<(KeptThing, Option<ColorImage>)>,
    wanted: Vec<KeptThing>,
    content_id: u64,
}

/// Finished thumbnails of the current volume, and the batch in progress.
#[derive(Default)]
pub(super) struct Thumbnails {
    drawn: Vec<Drawn>,
    drawing: Option<Drawing>,
    content_id: Option<u64>,
}

impl std::fmt::Debug for Thumbnails {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Thumbnails").field("drawn", &self.drawn.len()).finish_non_exhaustive()
    }
}

impl Thumbnails {
    /// Returns the thumbnail of a kept item, if it has been rendered.
    pub(super) fn get(&self, kept: &Kept) -> Option<&TextureHandle> {
        let is_of = |drawn: &&Drawn| Some(drawn.of.1) == self.content_id && drawn.of.0 == kept.what;
        self.drawn.iter().find(is_of)?.texture.as_ref()
    }

    /// Returns true while thumbnails are being rendered.
    pub(super) fn is_busy(&self) -> bool {
        self.drawing.is_some()
    }

    /// Items that have no thumbnail yet; `None` if there are none, or while a batch is in progress.
    pub(super) fn wanted(&mut self, settings: &Settings, content_id: Option<u64>) -> Option<Vec<KeptThing>> {
        self.content_id = content_id;
        let id = content_id.filter(|_| self.drawing.is_none())?;
        let kept = || settings.kept.iter().map(|kept| &kept.what);
        // Items that were removed or belong to another volume are dropped; should they return, they are rendered
        // again.
        self.drawn.retain(|drawn| drawn.of.1 == id && kept().any(|what| *what == drawn.of.0));
        let is_missing = |what: &&KeptThing| self.drawn.iter().all(|drawn| drawn.of.0 != **what);
        let missing: Vec<_> = kept().filter(is_missing).cloned().collect();
        (!missing.is_empty()).then_some(missing)
    }

    /// Starts to render thumbnails. Views are drawn in the current look.
    pub(super) fn start(
        &mut self,
        wanted: Vec<KeptThing>,
        subject: Subject,
        ctx: &egui::Context,
    ) -> std::io::Result<()> {
        let content_id = subject.dataset.volume().content_id();
        let (sender, drawn) = mpsc::channel();
        let (wake, all) = (ctx.clone(), wanted.clone());
        let task = move || {
            let mut worker = Worker::new(&subject);
            for what in all {
                let settings = shown_of(&what, &subject.settings);
                let picture = match &mut worker {
                    Ok(worker) => small_picture(worker, &subject, &settings),
                    Err(err) => Err(err.clone()),
                };
                if let Err(err) = &picture {
                    log::warn!("a small picture of what is kept was not made: {err}");
                }
                if sender.send((what, picture.ok())).is_err() {
                    return;
                }
                wake.request_repaint();
            }
        };
        let work = Work::start("kept", ctx, task)?;
        self.drawing = Some(Drawing { work, drawn, wanted, content_id });
        Ok(())
    }

    /// Collects the thumbnails that have been rendered since the last call.
    pub(super) fn take(&mut self, ctx: &egui::Context) {
        let Some(drawing) = &self.drawing else { return };
        // Queried before the channel is drained: no thumbnail is sent after the end of the task.
        let is_over = drawing.work.take().is_some();
        for (what, picture) in drawing.drawn.try_iter() {
            let texture = picture.map(|picture| ctx.load_texture("kept", picture, TextureOptions::LINEAR));
            self.drawn.push(Drawn { of: (what, drawing.content_id), texture });
        }
        if let Some(Drawing { wanted, content_id, .. }) = self.drawing.take_if(|_| is_over) {
            // Items that are missing because the thread panicked are marked as failed, so that they are not tried
            // again and again.
            for what in wanted {
                if self.drawn.iter().all(|drawn| drawn.of.0 != what) {
                    self.drawn.push(Drawn { of: (what, content_id), texture: None });
                }
            }
        }
    }
}

/// Size of a thumbnail on screen, for a height in points.
pub(super) fn size_for(height: f32) -> egui::Vec2 {
    egui::vec2(height * SMALL[0] as f32 / SMALL[1] as f32, height)
}
