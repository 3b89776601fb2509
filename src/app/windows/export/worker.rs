//! Export worker: renders on its own thread with its own renderer, always at full quality, whatever the preview
//! shows.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use eframe::egui;

use super::ExportScene;
use crate::app::text;
use crate::app::worker::jobs::JobControl;
use chiaroscuro_files::fault::{FaultThread, panic_if_injected};
use chiaroscuro_media::{
    Animation, AnimationFormat, AnimationSpec, ContactSheetImage, ExportError, PixelRows, export_png,
    marks_layer, write_picture,
};
use chiaroscuro_render::{
    BandError, BandProgress, MeasuredSettings, PartPages, Renderer, ShaderLibrary, plan::PagedView,
};
use chiaroscuro_scene::{
    Annotations, FinerLevelRecord, ImageRecord, ImageSpec, LookRecord, SavedContent, Settings, VolumeRecord,
};
use chiaroscuro_volume::{CancelToken, Dataset, PageCache, Volume};

/// Size of a picture on the sheet of kept views, in pixels: 4:3, as first looks are framed, and four side by side
/// fill a page at 300 dots per inch.
const KEPT_TILE_SIZE: [u32; 2] = [640, 480];

/// Outcome of an export that did not fail.
#[derive(Debug)]
pub(crate) enum ExportOutcome {
    /// The file that was written.
    File(PathBuf),
    /// The picture for the clipboard.
    Picture(egui::ColorImage),
    /// The user has cancelled the export.
    Cancelled,
}

/// Reason for which an export ended early.
#[derive(Debug)]
enum ExportEnd {
    Cancelled,
    Failed(String),
}

impl From<ExportError> for ExportEnd {
    fn from(err: ExportError) -> Self {
        Self::Failed(err.to_string())
    }
}

impl From<BandError> for ExportEnd {
    fn from(err: BandError) -> Self {
        Self::Failed(err.to_string())
    }
}

impl ExportEnd {
    /// Converts into the result for the window: a cancelled export is no error.
    fn into_result(self) -> Result<ExportOutcome, String> {
        match self {
            Self::Cancelled => Ok(ExportOutcome::Cancelled),
            Self::Failed(why) => Err(why),
        }
    }
}

/// Reports the number of pictures, or parts of one, that are done; an error if the user has cancelled the export.
fn report_progress(job: &JobControl, done: u32, total: u32) -> Result<(), ExportEnd> {
    job.set_progress(done, total);
    if job.token().is_cancelled() { Err(ExportEnd::Cancelled) } else { Ok(()) }
}

/// Renderer on a device beside the window's, so that the window stays responsive.
pub(crate) struct ExportWorker {
    renderer: Renderer,
    adapter: String,
    /// Pages of finer levels that pictures have shown.
    pages: Option<PageCache>,
}

/// Pages of finer levels that the parts of a picture read, and the record of these levels.
struct PicturePages {
    cache: PageCache,
    record: FinerLevelRecord,
}

impl ExportWorker {
    /// Opens a sibling device and creates a renderer on it.
    pub(crate) fn new(subject: &ExportScene) -> Result<Self, String> {
        panic_if_injected(FaultThread::Export);
        let beside = subject.context.second_device().map_err(|err| err.to_string())?;
        let renderer = Renderer::new(&beside).map_err(|err| err.to_string())?;
        Ok(Self { renderer, adapter: beside.description(), pages: None })
    }

    /// Returns the dataset of a picture in its density mapping, with the pages of finer levels that its parts read, if it
    /// shows any.
    fn take_pages(
        &mut self,
        subject: &ExportScene,
        settings: &Settings,
        image_spec: &ImageSpec,
    ) -> (Dataset, Option<PicturePages>) {
        let mapping = settings.shown_content(&subject.dataset.volume().ranges());
        let dataset = subject.dataset.with_density_mapping(mapping);
        let Some(file) = subject.file.as_ref().filter(|file| file.has_volume_of(&dataset)) else {
            return (dataset, None);
        };
        let is_valid = |cache: &PageCache| cache.resident().mapping() == mapping;
        let cache = self.pages.take().filter(is_valid).or_else(|| {
            let bytes = PageCache::default_bytes();
            let pages = file.pages(&dataset, bytes)?;
            Some(dataset.page_cache(Arc::new(pages), bytes))
        });
        let Some(cache) = cache else { return (dataset, None) };
        let size = image_spec.size.map(|n| n * image_spec.samples);
        let levels = cache.resident().levels();
        let Some(view) = PagedView::new(levels, settings, &dataset.volume().scene(), size) else {
            self.pages = Some(cache);
            return (dataset, None);
        };
        let record = view.record(levels);
        (dataset, Some(PicturePages { cache, record }))
    }

    /// Keeps the pages of a picture for the next one, and returns their record.
    fn put_back(&mut self, pages: Option<PicturePages>) -> Option<FinerLevelRecord> {
        let PicturePages { cache, record } = pages?;
        self.pages = Some(cache);
        Some(record)
    }

    /// Renders a picture of the subject with other settings, tone mapped and with marks; RGBA, 8 bits.
    pub(crate) fn render(
        &mut self,
        subject: &ExportScene,
        settings: &Settings,
        image_spec: &ImageSpec,
    ) -> Result<Vec<u8>, String> {
        let drawn = self.render_cancellably(subject, settings, image_spec, &CancelToken::never());
        drawn.map(|(shown, _)| shown).map_err(|end| end.into_result().err().unwrap_or_default())
    }

    /// Renders a picture as [`Self::render`] does, unless it is cancelled while pages of finer levels are read. Returns their
    /// record, too.
    fn render_cancellably(
        &mut self,
        subject: &ExportScene,
        settings: &Settings,
        image_spec: &ImageSpec,
        token: &CancelToken,
    ) -> Result<(Vec<u8>, Option<FinerLevelRecord>), ExportEnd> {
        let (dataset, mut pages) = self.take_pages(subject, settings, image_spec);
        let parts = pages.as_mut().map(|pages| PartPages::new(&mut pages.cache, |_| !token.is_cancelled()));
        let mut shown = match self.renderer.bands(&dataset, settings, image_spec).with_pages(parts).all() {
            Err(_) if token.is_cancelled() => return Err(ExportEnd::Cancelled),
            drawn => drawn?,
        };
        let finer_levels = self.put_back(pages);
        marks_layer(image_spec, settings, subject.dataset.volume()).composite_over(image_spec, 0, &mut shown);
        match shown {
            PixelRows::Bytes(shown) => Ok((shown, finer_levels)),
            PixelRows::Floats(_) => Err(ExportEnd::Failed(text::export::EMPTY_PICTURE.to_owned())),
        }
    }

    /// Pipelines of the worker's device.
    pub(crate) fn shaders(&self) -> ShaderLibrary {
        self.renderer.shaders()
    }

    /// Measures the brightness of a look on a small copy of the volume.
    pub(crate) fn measure_brightness(
        &mut self,
        whole: &Volume,
        small: &Dataset,
        settings: &Settings,
    ) -> Result<MeasuredSettings, String> {
        MeasuredSettings::measure(&mut self.renderer, whole, small, settings).map_err(|err| err.to_string())
    }

    /// Metadata record of a picture (settings, volume, adapter), for a file in a folder.
    fn picture_record(
        &self,
        subject: &ExportScene,
        settings: &Settings,
        image_spec: &ImageSpec,
        folder: Option<&Path>,
        finer_levels: Option<FinerLevelRecord>,
    ) -> String {
        let of = subject.dataset.volume();
        let volume =
            VolumeRecord::new(&subject.source, of.opened_id(), folder).with_choice(of.contents().choice());
        let count = settings.layers.count();
        let shown = subject.dataset.with_fields_where(|index| index < count);
        let volume = volume.with_layers_of(&shown, folder);
        let picture_record =
            ImageRecord { finer_levels, ..ImageRecord::new(*image_spec, self.adapter.clone()) };
        LookRecord::to_json(settings, Some(&volume), Some(&picture_record))
    }
}

/// Renders and writes one picture in bands, with the finest level that it calls for: its parts read their pages one after
/// another.
pub(crate) fn export_still(
    subject: &ExportScene,
    image_spec: &ImageSpec,
    path: PathBuf,
    job: &JobControl,
) -> Result<ExportOutcome, String> {
    let mut worker = ExportWorker::new(subject)?;
    let settings = &subject.settings;
    let (dataset, mut pages) = worker.take_pages(subject, settings, image_spec);
    let finer_levels = pages.as_ref().map(|pages| pages.record.clone());
    let record = worker.picture_record(subject, settings, image_spec, path.parent(), finer_levels);
    let parts = pages.as_mut().map(|pages| PartPages::new(&mut pages.cache, |_| !job.token().is_cancelled()));
    let mut bands = worker.renderer.bands(&dataset, settings, image_spec).with_pages(parts);
    let (layer, mut first) = (marks_layer(image_spec, settings, dataset.volume()), 0);
    let mut rows = || {
        let BandProgress { drawn, total } = bands.progress();
        report_progress(job, drawn as u32, total as u32)?;
        let mut rows = match bands.next_rows() {
            Err(_) if job.token().is_cancelled() => return Err(ExportEnd::Cancelled),
            drawn => drawn?,
        };
        if let Some(rows) = &mut rows {
            layer.composite_over(image_spec, first, rows);
            first += rows.count(image_spec);
        }
        Ok(rows)
    };
    write_picture(&path, image_spec, Some(&record), &mut rows)
        .map_or_else(ExportEnd::into_result, |()| Ok(ExportOutcome::File(path)))
}

/// Change from frame to frame of an animation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum AnimationMotion {
    /// The camera turns once around.
    Camera,
    /// The light with this index turns once around.
    Light(usize),
    /// Time steps follow each other.
    TimeSteps,
}

impl AnimationMotion {
    /// Returns the scene of a frame out of `count`.
    fn scene_at(
        self,
        subject: &ExportScene,
        frame: u32,
        count: u32,
        token: &CancelToken,
    ) -> Result<ExportScene, String> {
        let mut scene = subject.clone();
        let share = f64::from(frame) / f64::from(count);
        match self {
            Self::Camera => scene.settings = subject.settings.at_turntable_angle(None, share),
            Self::Light(index) => scene.settings = subject.settings.at_turntable_angle(Some(index), share),
            Self::TimeSteps => {
                let series = subject.series.as_ref().ok_or(text::time_series::NO_SERIES)?;
                let index = frame as usize;
                scene.dataset = series.read(index, &subject.dataset, (&subject.context, token))?;
                series.steps.path(index).clone_into(&mut scene.source);
            }
        }
        Ok(scene)
    }
}

/// Renders and writes an animation.
pub(crate) fn export_animation(
    subject: &ExportScene,
    motion: AnimationMotion,
    (animation_spec, marks): (&AnimationSpec, Annotations),
    path: PathBuf,
    job: &JobControl,
) -> Result<ExportOutcome, String> {
    let mut worker = ExportWorker::new(subject)?;
    let folder = AnimationFormat::record_folder(&path);
    let image_spec =
        ImageSpec { transparent: animation_spec.transparent, marks, ..ImageSpec::new(animation_spec.size) };
    let mut write = || {
        let mut file = Animation::create(&path, animation_spec)?;
        for frame in 0..animation_spec.frames {
            report_progress(job, frame, animation_spec.frames)?;
            let scene = motion.scene_at(subject, frame, animation_spec.frames, job.token());
            let scene = scene.map_err(ExportEnd::Failed)?;
            let (shown, finer) =
                worker.render_cancellably(&scene, &scene.settings, &image_spec, job.token())?;
            file.add(&shown, &worker.picture_record(&scene, &scene.settings, &image_spec, folder, finer))?;
        }
        file.finish()?;
        Ok(())
    };
    write().map_or_else(ExportEnd::into_result, |()| Ok(ExportOutcome::File(path)))
}

/// Renders all kept views and looks, and writes them side by side into one picture.
pub(crate) fn export_kept_sheet(
    subject: &ExportScene,
    path: PathBuf,
    job: &JobControl,
) -> Result<ExportOutcome, String> {
    let mut worker = ExportWorker::new(subject)?;
    let image_spec = ImageSpec::new(KEPT_TILE_SIZE);
    let kept = &subject.settings.kept;
    let mut sheet = ContactSheetImage::new(kept.len() as u32, KEPT_TILE_SIZE);
    let mut write = || -> Result<(), ExportEnd> {
        for (at, kept) in (0..).zip(kept) {
            report_progress(job, at, subject.settings.kept.len() as u32)?;
            let settings = settings_for_kept(&kept.what, &subject.settings);
            let (shown, _) = worker.render_cancellably(subject, &settings, &image_spec, job.token())?;
            sheet.add(&kept.name, &shown);
        }
        Ok(())
    };
    if let Err(ended) = write() {
        return ended.into_result();
    }
    let (size, shown) = (sheet.size(), sheet.finish());
    // The record contains the current look with all kept items.
    let record =
        worker.picture_record(subject, &subject.settings, &ImageSpec::new(size), path.parent(), None);
    export_png(size, &shown, false, Some(&record), &path).map_err(|err| err.to_string())?;
    Ok(ExportOutcome::File(path))
}

/// Settings that show a kept item: a view in the current look, a look as it was kept.
pub(crate) fn settings_for_kept(what: &SavedContent, settings: &Settings) -> Settings {
    match what {
        SavedContent::View(camera) => Settings { camera: camera.clone(), ..settings.clone() },
        SavedContent::Look(look) => Settings { volume: settings.volume, ..look.settings().clone() },
    }
}

/// Renders a picture for the clipboard.
pub(crate) fn render_for_clipboard(
    subject: &ExportScene,
    image_spec: &ImageSpec,
    job: &JobControl,
) -> Result<ExportOutcome, String> {
    let mut worker = ExportWorker::new(subject)?;
    let size = image_spec.size.map(|n| n as usize);
    let picture = |(shown, _): (Vec<u8>, _)| {
        ExportOutcome::Picture(egui::ColorImage::from_rgba_unmultiplied(size, &shown))
    };
    worker
        .render_cancellably(subject, &subject.settings, image_spec, job.token())
        .map_or_else(ExportEnd::into_result, |drawn| Ok(picture(drawn)))
}
