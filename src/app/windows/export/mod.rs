//! Export of pictures and animations: the user's choices, the export window, and the worker that renders and writes.

mod destination;
mod dialog;
mod export_scene;
mod worker;

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use eframe::egui;

pub(crate) use self::export_scene::{ExportScene, ReadableSeries};
use self::worker::AnimationMotion;
pub(crate) use self::worker::{ExportOutcome, ExportWorker, settings_for_kept};
use crate::app::text;
use crate::app::worker::jobs::{JobControl, JobKind, JobProgress, JobSlot};
use chiaroscuro_media::{AnimationFormat, AnimationSpec};
use chiaroscuro_scene::ImageSpec;

/// Longest wait of a closing window for an export to end: a part of a picture takes seconds on slow adapters.
const CANCEL_TIMEOUT: Duration = Duration::from_secs(10);

/// Kind of export: still or turntable.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum ExportKind {
    /// A single still picture.
    Still,
    /// A turntable of the camera.
    Turntable,
    /// A turntable of the selected light.
    LightTurntable,
    /// An animation of all time steps.
    TimeSeries,
}

/// Progress of an export whose window is closed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct ExportProgress {
    /// Number of pictures, or parts of one, that are done.
    pub done: u32,
    /// Number of pictures, or parts of one, in total.
    pub total: u32,
    /// Estimated remaining time, once one part is done.
    pub remaining: Option<Duration>,
}

/// State of the export window: specification and progress of the export.
#[derive(Debug)]
pub(crate) struct ExportWindow {
    open: bool,
    image_spec: ImageSpec,
    path: String,
    kind: ExportKind,
    frames: u32,
    rate: u16,
    /// Number of time steps of the open volume; 0 if it is alone.
    step_count: u32,
    /// File that the user has agreed to replace.
    replaceable: Option<PathBuf>,
    /// True while the user is asked whether the file may be replaced.
    asks_to_replace: bool,
    started: Instant,
    work: JobSlot<Result<ExportOutcome, String>>,
    /// True if the user has chosen or typed the file name.
    has_user_name: bool,
    /// File that was written last.
    last_file: Option<PathBuf>,
}

impl Default for ExportWindow {
    fn default() -> Self {
        Self {
            open: false,
            image_spec: ImageSpec::new([0, 0]),
            path: "chiaroscuro.png".to_owned(),
            kind: ExportKind::Still,
            frames: 72,
            rate: 24,
            step_count: 0,
            replaceable: None,
            asks_to_replace: false,
            started: Instant::now(),
            work: JobSlot::default(),
            has_user_name: false,
            last_file: None,
        }
    }
}

impl ExportWindow {
    /// Opens the window, at first with the size of the viewport and the name of the volume.
    pub(crate) fn open(&mut self, viewport: [u32; 2], folder: Option<&Path>, volume: &str) {
        self.open = true;
        if !self.has_user_name {
            // A folder of pictures has no extension.
            let ending = Path::new(&self.path).extension().map(std::ffi::OsStr::to_owned).unwrap_or_default();
            let name = Path::new(&destination::default_file_name(volume)).with_extension(ending);
            self.path = destination::default_folder(folder).join(name).display().to_string();
        }
        if self.image_spec.size == [0, 0] {
            self.image_spec.size = viewport;
        }
    }

    /// Sets the file to write, and opens the window.
    pub(crate) fn set_path(&mut self, path: &Path) {
        self.path = path.display().to_string();
        self.has_user_name = true;
        self.adapt_depth_to_name();
        self.open = true;
    }

    /// Sets the file to write and permits replacing it: the user has been asked already, or the call comes from a
    /// program.
    pub(crate) fn allow_replacing(&mut self, path: &Path) {
        self.set_path(path);
        self.replaceable = Some(path.to_owned());
    }

    /// Sets the size of the picture in pixels, within the limits.
    pub(crate) fn set_size(&mut self, size: [u32; 2]) {
        self.image_spec = ImageSpec { size, ..self.image_spec }.clamped();
    }

    /// Returns true while an export is in progress.
    pub(crate) fn is_busy(&self) -> bool {
        self.work.is_running()
    }

    /// Progress of an export in progress, if its window is closed.
    pub(crate) fn background_progress(&self) -> Option<ExportProgress> {
        let JobProgress { done, total } = self.work.progress().filter(|_| !self.open)?;
        Some(ExportProgress { done, total, remaining: self.remaining_time() })
    }

    /// Estimated remaining time of the export, once one part is done.
    pub(crate) fn remaining_time(&self) -> Option<Duration> {
        let JobProgress { done, total } = self.work.progress()?;
        // The first part gives no estimate yet.
        (total > 1 && done > 0).then(|| self.started.elapsed() * total.saturating_sub(done) / done)
    }

    /// Specification of the picture that would be exported, while the window is open.
    pub(crate) fn requested_image(&self) -> Option<ImageSpec> {
        (self.open && !self.image_spec.size.contains(&0)).then_some(self.image_spec)
    }

    /// Cancels the export in progress.
    pub(crate) fn cancel(&self) {
        self.work.cancel();
    }

    /// Cancels the export because the window closes, and waits for its end, so that no temporary file remains.
    pub(crate) fn cancel_and_wait(&mut self) {
        self.cancel();
        self.work.wait(CANCEL_TIMEOUT);
    }

    /// Returns the result of the last export, once.
    pub(crate) fn take_result(&mut self) -> Option<Result<ExportOutcome, String>> {
        let result = self.work.take_result()?;
        let result = result.and_then(|result| result);
        if let Ok(ExportOutcome::File(path)) = &result {
            self.last_file = Some(path.clone());
        }
        Some(result)
    }

    /// Returns the number of frames of the animation.
    fn frame_count(&self) -> u32 {
        if self.kind == ExportKind::TimeSeries { self.step_count } else { self.frames }
    }

    /// Starts to render and write the export.
    pub(crate) fn start(&mut self, subject: ExportScene, ctx: &egui::Context) -> Result<(), String> {
        self.replaceable = None;
        let (image_spec, path) = (self.image_spec.clamped(), PathBuf::from(self.path.trim()));
        let motion = match self.kind {
            ExportKind::Still => {
                return self.run(ctx, move |job| worker::export_still(&subject, &image_spec, path, job));
            }
            ExportKind::Turntable => AnimationMotion::Camera,
            ExportKind::LightTurntable => AnimationMotion::Light(subject.selected_light),
            ExportKind::TimeSeries => AnimationMotion::TimeSteps,
        };
        let transparent = image_spec.transparent && self.animation_format() != AnimationFormat::Mp4;
        let animation_spec =
            AnimationSpec { size: image_spec.size, frames: self.frame_count(), rate: self.rate, transparent };
        let marks = image_spec.marks;
        self.run(ctx, move |job| {
            worker::export_animation(&subject, motion, (&animation_spec, marks), path, job)
        })
    }

    /// Starts to render a picture for the clipboard, as large as the viewport.
    pub(crate) fn copy_to_clipboard(
        &mut self,
        subject: ExportScene,
        size: [u32; 2],
        ctx: &egui::Context,
    ) -> Result<(), String> {
        let Self { image_spec: ImageSpec { transparent, marks, .. }, .. } = *self;
        let image_spec = ImageSpec { transparent, marks, ..ImageSpec::new(size) };
        self.run(ctx, move |job| worker::render_for_clipboard(&subject, &image_spec, job))
    }

    /// Starts to render all kept views and looks into one picture.
    pub(crate) fn export_kept_sheet(
        &mut self,
        subject: ExportScene,
        path: &Path,
        ctx: &egui::Context,
    ) -> Result<(), String> {
        if self.is_busy() {
            return Err(text::messages::EXPORT_RUNS.to_owned());
        }
        let path = path.to_owned();
        self.run(ctx, move |job| worker::export_kept_sheet(&subject, path, job))
    }

    fn run(
        &mut self,
        ctx: &egui::Context,
        task: impl FnOnce(&JobControl) -> Result<ExportOutcome, String> + Send + 'static,
    ) -> Result<(), String> {
        self.started = Instant::now();
        self.work.start(JobKind::Export, ctx, (), task).map_err(text::export::no_thread)
    }
}
