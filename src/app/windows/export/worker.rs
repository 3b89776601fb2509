//! Export worker: renders on its own thread with its own renderer, always at full quality, whatever the preview
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

/// Size of a picture on the sheet of kept views, in pixels: 4:3, as first looks are framed, and four side by side
/// fill a page at 300 dots per inch.
const TILE: [u32; 2] = [640, 480];

/// Scene to export: volume, settings and device.
#[derive(Debug, Clone)]
pub(in crate::app) struct Subject {
    /// Window's device, of which the worker opens a sibling.
    pub context: Context,
    /// Open volume with its derived data.
    pub dataset: Dataset,
    /// Settings of the whole look.
    pub settings: Settings,
    /// First look at the volume.
    pub first: Settings,
    /// Path or name that was opened.
    pub source: PathBuf,
    /// Index of the selected light, for a turntable of the light.
    pub selected_light: usize,
    /// Outline of the visible object, if it is known.
    pub outline: Option<Arc<Outline>>,
}

/// Outcome of an export that did not fail.
#[derive(Debug)]
pub(in crate::app) enum Exported {
    /// The file that was written.
    File(PathBuf),
    /// The picture for the clipboard.
    Picture(egui::ColorImage),
    /// The user has cancelled the export.
    Cancelled,
}

/// Progress of an export, shared by the window and its worker.
#[derive(Debug, Default)]
pub(crate) struct Progress {
    /// Number of pictures or parts of one that are done.
    pub done: AtomicU32,
    /// Number of pictures or parts in total; 0 while unknown.
    pub total: AtomicU32,
    /// True once the user has cancelled.
    pub cancelled: AtomicBool,
}

/// Reason for which an export ended early.
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
    /// Converts into the result for the window: a cancelled export is no error.
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

/// Renderer on a device beside the window's, so that the window stays responsive.
pub(in crate::app) struct Worker {
    renderer: Renderer,
    adapter: String,
}

impl Worker {
    /// Opens a sibling device and creates a renderer on it.
    pub(in crate::app) fn new(subject: &Subject) -> Result<Self, String> {
        may_panic(Place::Export);
        let beside = subject.context.sibling().map_err(|err| err.to_string())?;
        let renderer = Renderer::new(&beside).map_err(|err| err.to_string())?;
        Ok(Self { renderer, adapter: beside.description() })
    }

    /// Renders a picture of the subject with other settings, tone mapped and with marks; RGBA, 8 bits.
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

    /// Pipelines of the worker's device.
    pub(in crate::app) fn shaders(&self) -> ShaderLibrary {
        self.renderer.shaders()
    }

    /// Measures the brightness of a look on a small copy of the volume.
    pub(in crate::app) fn measure(
        &mut self,
        whole: &Volume,
        small: &Dataset,
        settings: &Settings,
    ) -> Result<SmallLook, String> {
        SmallLook::measure(&mut self.renderer, whole, small, settings).map_err(|err| err.to_string())
    }

    /// Metadata record of a picture (settings, volume, adapter), for a file in a folder.
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

/// Renders and writes one picture in bands.
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

/// Renders and writes an animation, in which a light or else the camera turns once around.
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

/// Renders all kept views and looks, and writes them side by side into one picture.
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
    // The record contains the current look with all kept items.
    let record = worker.record(subject, &subject.settings, &ImageSpec::new(size), path.parent());
    export_png(size, &shown, false, Some(&record), &path).map_err(|err| err.to_string())?;
    Ok(Exported::File(path))
}

/// Settings that show a kept item: a view in the current look, a look as it was kept.
pub(in crate::app) fn shown_of(what: &KeptThing, settings: &Settings) -> Settings {
    match what {
        KeptThing::View(camera) => Settings { camera: camera.clone(), ..settings.clone() },
        KeptThing::Look(look) => Settings { volume: settings.volume, ..look.settings().clone() },
    }
}

/// Renders a picture for the clipboard.
pub(crate) fn copy(subject: &Subject, shot: &ImageSpec) -> Result<Exported, String> {
    let shown = Worker::new(subject)?.render(subject, &subject.settings, shot)?;
    let size = shot.size.map(|n| n as usize);
    Ok(Exported::Picture(egui::ColorImage::from_rgba_unmultiplied(size, &shown)))
}
