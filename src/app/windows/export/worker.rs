//! What an export does on its own thread, on a renderer of its own: always full quality, whatever the preview
//! shows.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};

use eframe::egui;

use crate::app::text;
use crate::data::{Dataset, Volume};
use crate::export::{
    Animation, AnimationFormat, AnimationSpec, ExportError, Rows, Sheet, export_png, marks, write_picture,
};
use crate::fault::{Place, may_panic};
use crate::gpu::{Context, GpuError, RenderOptions, Renderer, ShaderLibrary, SmallLook};
use crate::model::auto::Outline;
use crate::model::{ImageSpec, KeptThing, Marks, PictureRecord, Record, Settings, VolumeRecord};

/// Pixels of a picture on a sheet of what is kept: 4:3, as first looks are framed, and four beside each other fill a page
/// at 300 dots per inch.
const TILE: [u32; 2] = [640, 480];

/// What is to be exported.
#[derive(Debug, Clone)]
pub(in crate::app) struct Subject {
    /// The window's device.
    pub context: Context,
    /// The open volume.
    pub dataset: Dataset,
    /// The whole look.
    pub settings: Settings,
    /// The first look at the volume.
    pub first: Settings,
    /// What was opened.
    pub source: PathBuf,
    /// The light that turns, if one is to.
    pub selected_light: usize,
    /// Where the object ends, if that is known.
    pub outline: Option<Arc<Outline>>,
}

/// What an export ended with.
#[derive(Debug)]
pub(in crate::app) enum Exported {
    /// A file was written.
    File(PathBuf),
    /// A picture for the clipboard.
    Picture(egui::ColorImage),
    /// The user did not want it any more.
    Cancelled,
}

/// How far an export is, shared by the window and its worker.
#[derive(Debug, Default)]
pub(crate) struct Progress {
    /// Pictures or parts of one that are done.
    pub done: AtomicU32,
    /// Pictures or parts of one that are to be made; 0 while nobody knows.
    pub total: AtomicU32,
    /// Nobody wants the rest.
    pub cancelled: AtomicBool,
}

/// Why an export ended early.
#[derive(Debug)]
enum Ended {
    Cancelled,
    Failed(String),
}

impl From<ExportError> for Ended {
    fn from(err: ExportError) -> Self {
        Self::Failed(err.to_string())
    }
}

impl From<GpuError> for Ended {
    fn from(err: GpuError) -> Self {
        Self::Failed(err.to_string())
    }
}

impl Ended {
    /// The result for the window: a cancelled export is no error.
    fn result(self) -> Result<Exported, String> {
        match self {
            Self::Cancelled => Ok(Exported::Cancelled),
            Self::Failed(why) => Err(why),
        }
    }
}

impl Progress {
    fn set(&self, done: u32, total: u32) -> Result<(), Ended> {
        self.done.store(done, Ordering::Relaxed);
        self.total.store(total, Ordering::Relaxed);
        if self.cancelled.load(Ordering::Relaxed) { Err(Ended::Cancelled) } else { Ok(()) }
    }
}

/// A renderer beside the window's device, so that the window stays alive.
pub(in crate::app) struct Worker {
    renderer: Renderer,
    adapter: String,
}

impl Worker {
    /// A renderer for a subject.
    pub(in crate::app) fn new(subject: &Subject) -> Result<Self, String> {
        may_panic(Place::Export);
        let beside = subject.context.sibling().map_err(|err| err.to_string())?;
        let renderer = Renderer::new(&beside).map_err(|err| err.to_string())?;
        Ok(Self { renderer, adapter: beside.description() })
    }

    /// A picture of the subject with settings of one's own, as it is shown.
    pub(in crate::app) fn render(
        &mut self,
        subject: &Subject,
        settings: &Settings,
        shot: &ImageSpec,
    ) -> Result<Vec<u8>, String> {
        let options = RenderOptions::of_shot(shot);
        let shown = self.renderer.render_shown(&subject.dataset, settings, shot.size, &options);
        let mut shown = Rows::Bytes(shown.map_err(|err| err.to_string())?);
        marks(shot, settings, subject.dataset.volume()).lay_over(shot, 0, &mut shown);
        match shown {
            Rows::Bytes(shown) => Ok(shown),
            Rows::Floats(_) => Err(text::export::NO_BYTES.to_owned()),
        }
    }

    /// The pipelines of the worker's device.
    pub(in crate::app) fn shaders(&self) -> ShaderLibrary {
        self.renderer.shaders()
    }

    /// How bright a look of a volume is, on a small copy of it.
    pub(in crate::app) fn measure(
        &mut self,
        whole: &Volume,
        small: &Dataset,
        settings: &Settings,
    ) -> Result<SmallLook, String> {
        SmallLook::measure(&mut self.renderer, whole, small, settings).map_err(|err| err.to_string())
    }

    /// How a picture was made, for a file in a folder.
    fn record(
        &self,
        subject: &Subject,
        settings: &Settings,
        shot: &ImageSpec,
        folder: Option<&Path>,
    ) -> String {
        let of = subject.dataset.volume();
        let volume = VolumeRecord::new(&subject.source, of.opened_id(), folder).choosing(of.held().choice());
        let how = PictureRecord::new(*shot, self.adapter.clone());
        Record::text(settings, Some(&volume), Some(&how))
    }
}

/// Renders and writes one picture.
pub(crate) fn still(
    subject: &Subject,
    shot: &ImageSpec,
    path: PathBuf,
    progress: &Progress,
) -> Result<Exported, String> {
    let mut worker = Worker::new(subject)?;
    let record = worker.record(subject, &subject.settings, shot, path.parent());
    let Subject { dataset, settings, .. } = subject;
    let mut bands = worker.renderer.bands(dataset, settings, shot);
    let (layer, mut first) = (marks(shot, settings, dataset.volume()), 0);
    let mut rows = || {
        let (done, total) = bands.progress();
        progress.set(done as u32, total as u32)?;
        let mut rows = bands.next_rows()?;
        if let Some(rows) = &mut rows {
            layer.lay_over(shot, first, rows);
            first += rows.count(shot);
        }
        Ok(rows)
    };
    write_picture(&path, shot, Some(&record), &mut rows)
        .map_or_else(Ended::result, |()| Ok(Exported::File(path)))
}

/// Renders and writes one turn, of a light or else of the camera.
pub(crate) fn turn(
    subject: &Subject,
    light: Option<usize>,
    (reel, marks): (&AnimationSpec, Marks),
    path: PathBuf,
    progress: &Progress,
) -> Result<Exported, String> {
    let mut worker = Worker::new(subject)?;
    let folder = AnimationFormat::record_folder(&path);
    let shot = ImageSpec { transparent: reel.transparent, marks, ..ImageSpec::new(reel.size) };
    let mut write = || {
        let mut file = Animation::create(&path, reel)?;
        for frame in 0..reel.frames {
            progress.set(frame, reel.frames)?;
            let settings = subject.settings.turned(light, f64::from(frame) / f64::from(reel.frames));
            let shown = worker.render(subject, &settings, &shot).map_err(Ended::Failed)?;
            file.add(&shown, &worker.record(subject, &settings, &shot, folder))?;
        }
        file.finish()?;
        Ok(())
    };
    write().map_or_else(Ended::result, |()| Ok(Exported::File(path)))
}

/// Renders all views and looks that are kept, and writes them side by side into one picture.
pub(crate) fn sheet(subject: &Subject, path: PathBuf, progress: &Progress) -> Result<Exported, String> {
    let mut worker = Worker::new(subject)?;
    let shot = ImageSpec::new(TILE);
    let kept = &subject.settings.kept;
    let mut sheet = Sheet::new(kept.len() as u32, TILE);
    let mut write = || -> Result<(), Ended> {
        for (at, kept) in (0..).zip(kept) {
            progress.set(at, subject.settings.kept.len() as u32)?;
            let settings = shown_of(&kept.what, &subject.settings);
            let shown = worker.render(subject, &settings, &shot).map_err(Ended::Failed)?;
            sheet.add(&kept.name, &shown);
        }
        Ok(())
    };
    if let Err(ended) = write() {
        return ended.result();
    }
    let (size, shown) = sheet.finish();
    // Whoever opens it has the look with all that is kept.
    let record = worker.record(subject, &subject.settings, &ImageSpec::new(size), path.parent());
    export_png(size, &shown, false, Some(&record), &path).map_err(|err| err.to_string())?;
    Ok(Exported::File(path))
}

/// Settings that show something that is kept: views in the look that there is, looks as they were seen.
pub(in crate::app) fn shown_of(what: &KeptThing, settings: &Settings) -> Settings {
    match what {
        KeptThing::View(camera) => Settings { camera: camera.clone(), ..settings.clone() },
        KeptThing::Look(look) => Settings { volume: settings.volume, ..look.settings().clone() },
    }
}

/// Renders for the clipboard.
pub(crate) fn copy(subject: &Subject, shot: &ImageSpec) -> Result<Exported, String> {
    let shown = Worker::new(subject)?.render(subject, &subject.settings, shot)?;
    let size = shot.size.map(|n| n as usize);
    Ok(Exported::Picture(egui::ColorImage::from_rgba_unmultiplied(size, &shown)))
}
