//! Small pictures of what is kept, made on a thread of their own, one after the other.

use std::sync::mpsc;

use eframe::egui::{self, ColorImage, TextureHandle, TextureOptions};

use crate::app::windows::contact_sheet::{SMALL, small_picture};
use crate::app::windows::export::{Subject, Worker, shown_of};
use crate::app::worker::task::Work;
use crate::model::{Kept, KeptThing, Settings};

/// A picture of something that is kept.
struct Drawn {
    /// What it shows, and of which volume.
    of: (KeptThing, u64),
    /// None where it could not be made.
    texture: Option<TextureHandle>,
}

/// Pictures that are on their way.
struct Drawing {
    work: Work<()>,
    drawn: mpsc::Receiver<(KeptThing, Option<ColorImage>)>,
    wanted: Vec<KeptThing>,
    content_id: u64,
}

/// The pictures that there are.
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
    /// The picture of something that is kept, if it is there.
    pub(super) fn get(&self, kept: &Kept) -> Option<&TextureHandle> {
        let is_of = |drawn: &&Drawn| Some(drawn.of.1) == self.content_id && drawn.of.0 == kept.what;
        self.drawn.iter().find(is_of)?.texture.as_ref()
    }

    /// Whether pictures are being made.
    pub(super) fn is_busy(&self) -> bool {
        self.drawing.is_some()
    }

    /// What there are no pictures of yet; none while some are made.
    pub(super) fn wanted(&mut self, settings: &Settings, content_id: Option<u64>) -> Option<Vec<KeptThing>> {
        self.content_id = content_id;
        let id = content_id.filter(|_| self.drawing.is_none())?;
        let kept = || settings.kept.iter().map(|kept| &kept.what);
        // What is gone, and what is of another volume, is drawn again if it comes back.
        self.drawn.retain(|drawn| drawn.of.1 == id && kept().any(|what| *what == drawn.of.0));
        let is_missing = |what: &&KeptThing| self.drawn.iter().all(|drawn| drawn.of.0 != **what);
        let missing: Vec<_> = kept().filter(is_missing).cloned().collect();
        (!missing.is_empty()).then_some(missing)
    }

    /// Starts to make pictures. Views are drawn in the look that is shown now.
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

    /// Takes in pictures that were made.
    pub(super) fn take(&mut self, ctx: &egui::Context) {
        let Some(drawing) = &self.drawing else { return };
        // Asked before what was handed on is taken: nothing comes after the end.
        let is_over = drawing.work.take().is_some();
        for (what, picture) in drawing.drawn.try_iter() {
            let texture = picture.map(|picture| ctx.load_texture("kept", picture, TextureOptions::LINEAR));
            self.drawn.push(Drawn { of: (what, drawing.content_id), texture });
        }
        if let Some(Drawing { wanted, content_id, .. }) = self.drawing.take_if(|_| is_over) {
            // What was not made, because the thread has come to a bad end, is not tried again and again.
            for what in wanted {
                if self.drawn.iter().all(|drawn| drawn.of.0 != what) {
                    self.drawn.push(Drawn { of: (what, content_id), texture: None });
                }
            }
        }
    }
}

/// Width and height of a picture on screen, for a height in points.
pub(super) fn size_for(height: f32) -> egui::Vec2 {
    egui::vec2(height * SMALL[0] as f32 / SMALL[1] as f32, height)
}
