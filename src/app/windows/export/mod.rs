//! Export of pictures and animations: the user's choices, the export window, and the worker that renders and writes.

mod destination;
mod dialog;
mod worker;

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::time::{Duration, Instant};

use eframe::egui;

use self::worker::Progress;
pub(in crate::app) use self::worker::{Exported, Subject, Worker, shown_of};
use crate::app::text;
use crate::app::worker::task::Work;
use crate::export::{AnimationFormat, AnimationSpec};
use crate::model::ImageSpec;

/// Longest wait of a closing window for an export to end: a part of a picture takes seconds on slow adapters.
const LONGEST_WAIT: Duration = Duration::from_secs(10);

/// Kind of export: still or turntable.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    /// A single still picture.
    Still,
    /// A turntable of the camera.
    Turntable,
    /// A turntable of the selected light.
    LightTurn,
}

/// Request of the user to the export window.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Request {
    /// Choose a file with the file dialog.
    Choose,
    /// Render the picture and write it.
    Export,
    /// Reports that no file manager could be started, and why.
    NoFolder(String),
}

/// Progress of an export whose window is closed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Unseen {
    /// Number of pictures, or parts of one, that are done.
    pub done: u32,
    /// Number of pictures, or parts of one, in total.
    pub total: u32,
    /// Estimated remaining time, once one part is done.
    pub left: Option<Duration>,
}

/// State of the export window: specification and progress of the export.
#[derive(Debug)]
pub(crate) struct Export {
    open: bool,
    shot: ImageSpec,
    path: String,
    kind: Kind,
    frames: u32,
    rate: u16,
    /// File that the user has agreed to replace.
    agreed: Option<PathBuf>,
    /// True while the user is asked whether the file may be replaced.
    asks: bool,
    progress: Arc<Progress>,
    began: Instant,
    work: Option<Work<Result<Exported, String>>>,
    /// True if the user has chosen or typed the file name.
    is_named: bool,
    /// File that was written last.
    last: Option<PathBuf>,
}

impl Default for Export {
    fn default() -> Self {
        Self {
            open: false,
            shot: ImageSpec::new([0, 0]),
            path: "chiaroscuro.png".to_owned(),
            kind: Kind::Still,
            frames: 72,
            rate: 24,
            agreed: None,
            asks: false,
            progress: Arc::default(),
            began: Instant::now(),
            work: None,
            is_named: false,
            last: None,
        }
    }
}

impl Export {
    /// Opens the window, at first with the size of the viewport and the name of the volume.
    pub(crate) fn open(&mut self, viewport: [u32; 2], folder: Option<&Path>, volume: &str) {
        self.open = true;
        if !self.is_named {
            // A folder of pictures has no extension.
            let ending = Path::new(&self.path).extension().map(std::ffi::OsStr::to_owned).unwrap_or_default();
            let name = Path::new(&destination::file_name(volume)).with_extension(ending);
            self.path = destination::folder(folder).join(name).display().to_string();
        }
        if self.shot.size == [0, 0] {
            self.shot.size = viewport;
        }
    }

    /// Sets the file to write, and opens the window.
    pub(crate) fn set_path(&mut self, path: &Path) {
        self.path = path.display().to_string();
        self.is_named = true;
        self.follow_name();
        self.open = true;
    }

    /// Sets the file to write and permits replacing it: the user has been asked already, or the call comes from a
    /// program.
    pub(crate) fn agree_to(&mut self, path: &Path) {
        self.set_path(path);
        self.agreed = Some(path.to_owned());
    }

    /// Sets the size of the picture in pixels, within the limits.
    pub(crate) fn set_size(&mut self, size: [u32; 2]) {
        self.shot = ImageSpec { size, ..self.shot }.within_limits();
    }

    /// Returns true while an export is in progress.
    pub(crate) fn is_busy(&self) -> bool {
        self.work.is_some()
    }

    /// Progress of an export in progress, if its window is closed.
    pub(crate) fn progress_unseen(&self) -> Option<Unseen> {
        let Progress { done, total, cancelled: _ } = &*self.progress;
        (self.is_busy() && !self.open).then(|| Unseen {
            done: done.load(Ordering::Relaxed),
            total: total.load(Ordering::Relaxed),
            left: self.left(),
        })
    }

    /// Estimated remaining time of the export, once one part is done.
    pub(crate) fn left(&self) -> Option<Duration> {
        let [done, total] = [&self.progress.done, &self.progress.total].map(|n| n.load(Ordering::Relaxed));
        // The first part gives no estimate yet.
        (total > 1 && done > 0).then(|| self.began.elapsed() * total.saturating_sub(done) / done)
    }

    /// Specification of the picture that would be exported, while the window is open.
    pub(crate) fn asked(&self) -> Option<ImageSpec> {
        (self.open && !self.shot.size.contains(&0)).then_some(self.shot)
    }

    /// Cancels the export in progress.
    pub(crate) fn cancel(&self) {
        self.progress.cancelled.store(true, Ordering::Relaxed);
    }

    /// Cancels the export because the window closes, and waits for its end, so that no temporary file remains.
    pub(crate) fn abandon(&mut self) {
        self.cancel();
        let begin = Instant::now();
        while self.is_busy() && self.take().is_none() && begin.elapsed() < LONGEST_WAIT {
            std::thread::sleep(Duration::from_millis(20));
        }
    }

    /// Returns the result of the last export, once.
    pub(crate) fn take(&mut self) -> Option<Result<Exported, String>> {
        let result = self.work.as_ref()?.take()?;
        self.work = None;
        let result = result.and_then(|result| result);
        if let Ok(Exported::File(path)) = &result {
            self.last = Some(path.clone());
        }
        Some(result)
    }

    /// Starts to render and write the export.
    pub(crate) fn start(&mut self, subject: Subject, ctx: &egui::Context) -> Result<(), String> {
        self.agreed = None;
        let (shot, path) = (self.shot.within_limits(), PathBuf::from(self.path.trim()));
        self.progress = Arc::default();
        let progress = Arc::clone(&self.progress);
        let light = match self.kind {
            Kind::Still => return self.run(ctx, move || worker::still(&subject, &shot, path, &progress)),
            Kind::Turntable => None,
            Kind::LightTurn => Some(subject.selected_light),
        };
        let transparent = shot.transparent && self.animation() != AnimationFormat::Mp4;
        let reel = AnimationSpec { size: shot.size, frames: self.frames, rate: self.rate, transparent };
        let marks = shot.marks;
        self.run(ctx, move || worker::turn(&subject, light, (&reel, marks), path, &progress))
    }

    /// Starts to render a picture for the clipboard, as large as the viewport.
    pub(crate) fn copy(
        &mut self,
        subject: Subject,
        size: [u32; 2],
        ctx: &egui::Context,
    ) -> Result<(), String> {
        let Self { shot: ImageSpec { transparent, marks, .. }, .. } = *self;
        let shot = ImageSpec { transparent, marks, ..ImageSpec::new(size) };
        self.progress = Arc::default();
        self.run(ctx, move || worker::copy(&subject, &shot))
    }

    /// Starts to render all kept views and looks into one picture.
    pub(crate) fn sheet(&mut self, subject: Subject, path: &Path, ctx: &egui::Context) -> Result<(), String> {
        if self.is_busy() {
            return Err(text::messages::EXPORT_RUNS.to_owned());
        }
        let path = path.to_owned();
        self.progress = Arc::default();
        let progress = Arc::clone(&self.progress);
        self.run(ctx, move || worker::sheet(&subject, path, &progress))
    }

    fn run(
        &mut self,
        ctx: &egui::Context,
        task: impl FnOnce() -> Result<Exported, String> + Send + 'static,
    ) -> Result<(), String> {
        self.began = Instant::now();
        let work = Work::start("export", ctx, task);
        self.work = Some(work.map_err(text::export::no_thread)?);
        Ok(())
    }
}
