//! Finer resolution levels than the one in memory: while nothing is to be drawn, the pages that the picture shows are read
//! on a thread of their own, and the picture is drawn again as they arrive.

use std::sync::Arc;
use std::sync::mpsc::{Receiver, TryRecvError, sync_channel};
use std::time::{Duration, Instant};

use super::RenderWorker;
use crate::app::worker::mailbox::{FinerLevelStatus, SharedMailbox};
use crate::app::worker::quality::QualityLevel;
use crate::app::worker::render_schedule::RenderPurpose;
use crate::app::worker::request::{FrameRequest, RenderScene};
use chiaroscuro_render::GpuError;
use chiaroscuro_render::plan::{density_visibility, page_demand};
use chiaroscuro_scene::{FinerLevelRecord, Settings};
use chiaroscuro_volume::{
    CancelOnDrop, CancelToken, Dataset, LoadError, PAGES_PER_BATCH, Page, PageAddress, PageCache,
    ResidentPages, read_pages,
};

/// Shortest interval at which the picture is drawn again while pages arrive.
const REDRAW_INTERVAL: Duration = Duration::from_millis(1500);

/// Interval of redraws in times of a picture: reading gets most of the processors.
const REDRAW_PICTURES: u32 = 3;

/// Batches that wait for the render thread at most, while it draws: some 180 MB. Reading pauses then.
const MAX_WAITING_BATCHES: usize = 8;

/// Batch of pages that a thread has read; `None` after the last.
type PageBatch = Option<Result<Vec<(PageAddress, Arc<Page>)>, LoadError>>;

/// Thread that reads the pages of a picture.
struct PageReading {
    batches: Receiver<PageBatch>,
    request: FrameRequest,
    /// Ends the thread after its batch when reading is dropped.
    _cancel: CancelOnDrop,
}

/// Pages of finer levels, and the thread that reads them.
#[derive(Default)]
pub(super) struct FinerLevelReader {
    /// Pages in the density mapping of the picture; `None` before the first, and where the file has no finer levels.
    cache: Option<PageCache>,
    /// True if the file has no finer levels that can be shown.
    is_unavailable: bool,
    reading: Option<PageReading>,
    /// Cancels reads from the file when the volume is closed.
    cancel: Option<CancelOnDrop>,
    /// Request for which reading failed; another one tries again.
    failed: Option<FrameRequest>,
    /// Time at which the picture was drawn again last, and how long that took.
    last_drawn: Option<(Instant, Duration)>,
}

impl FinerLevelReader {
    /// Returns the pages that have arrived.
    ///
    /// # Errors
    /// Returns the error at which reading ended.
    fn take_arrived(&mut self) -> Result<Vec<(PageAddress, Arc<Page>)>, LoadError> {
        let mut arrived = Vec::new();
        while let Some(reading) = &self.reading {
            match reading.batches.try_recv() {
                Ok(Some(Ok(pages))) => arrived.extend(pages),
                Err(TryRecvError::Empty) => break,
                Ok(None) => self.reading = None,
                Ok(Some(Err(err))) => {
                    self.reading = None;
                    return Err(err);
                }
                // The thread has panicked.
                Err(TryRecvError::Disconnected) => {
                    self.reading = None;
                    return Err(LoadError::Cancelled);
                }
            }
        }
        Ok(arrived)
    }

    /// Creates the cache of pages for a dataset with the density mapping of its picture, unless it is there.
    fn refresh_cache(&mut self, scene: &RenderScene) {
        let mapping = scene.dataset.volume().density_mapping();
        if self.is_unavailable
            || self.cache.as_ref().is_some_and(|cache| cache.resident().mapping() == mapping)
        {
            return;
        }
        (self.cache, self.reading, self.cancel) = (None, None, None);
        let bytes = PageCache::default_bytes();
        match scene.file.as_ref().and_then(|file| file.pages(&scene.dataset, bytes)) {
            Some(pages) => {
                self.cancel = Some(pages.token().clone().into());
                self.cache = Some(scene.dataset.page_cache(Arc::new(pages), bytes));
            }
            None => self.is_unavailable = true,
        }
    }

    /// Starts to read the pages of a request on a thread, which wakes the render thread after each batch.
    fn start(
        &mut self,
        missing: Vec<PageAddress>,
        is_visible: impl Fn([f32; 2]) -> bool + Send + Sync + 'static,
        request: &FrameRequest,
        shared: &Arc<SharedMailbox>,
    ) {
        let Some(cache) = &self.cache else { return };
        let (source, shared) = (Arc::clone(cache.source()), Arc::clone(shared));
        let (sender, batches) = sync_channel(MAX_WAITING_BATCHES);
        let token = CancelToken::new();
        let cancel = CancelOnDrop::from(token.clone());
        let spawned = std::thread::Builder::new().name("finer_levels".to_owned()).spawn(move || {
            // A failed send means that nobody waits for the pages any longer.
            let send = |batch: PageBatch| {
                let is_sent = sender.send(batch).is_ok();
                shared.mailbox().pages_arrived = true;
                shared.changed.notify_one();
                is_sent
            };
            for batch in missing.chunks(PAGES_PER_BATCH) {
                let read = read_pages(&*source, batch, &is_visible);
                let has_failed = read.is_err();
                if token.is_cancelled() || !send(Some(read)) || has_failed {
                    return;
                }
            }
            send(None);
        });
        match spawned {
            Ok(_) => {
                self.reading = Some(PageReading { batches, request: request.clone(), _cancel: cancel });
            }
            Err(err) => log::warn!("finer levels are not read: {err}"),
        }
    }
}

impl RenderWorker {
    /// Reads the pages that the picture at rest shows, and draws it again with those that have arrived. Nothing is read while
    /// something else is to be drawn.
    pub(super) fn show_finer_levels(&mut self) {
        while let Some(frame_request) = self.agenda.request_at_rest().cloned() {
            let Some(scene) = self.scene.take() else { return };
            if !self.refine_levels(scene, &frame_request) {
                return;
            }
        }
        self.finer.reading = None;
    }

    /// Takes a step towards the complete picture; returns false if there is nothing to do before something arrives.
    fn refine_levels(&mut self, mut scene: RenderScene, frame_request: &FrameRequest) -> bool {
        self.finer.refresh_cache(&scene);
        let look = &frame_request.looks.left;
        let arrived = self.finer.take_arrived();
        let progress =
            self.finer.cache.as_mut().and_then(|cache| {
                LevelProgress::new(cache, &scene.dataset, look, frame_request.size, arrived)
            });
        let Some(LevelProgress { missing, resident, mut status }) = progress else {
            self.scene = Some(scene);
            self.set_finer_status(None);
            return false;
        };
        if status.error.is_some() {
            self.finer.failed = Some(frame_request.clone());
        }
        let has_failed = self.finer.failed.as_ref() == Some(frame_request);
        if has_failed && status.error.is_none() {
            // Said before, for the same picture.
            status.error =
                self.shared.mailbox().figures.finer_levels.as_ref().and_then(|known| known.error.clone());
        }
        self.set_finer_status(Some(status));
        let is_complete = missing.is_empty() || has_failed;
        if is_complete || self.finer.reading.as_ref().is_some_and(|reading| reading.request != *frame_request)
        {
            self.finer.reading = None;
        }
        if !is_complete && self.finer.reading.is_none() {
            let is_visible = density_visibility(&scene.dataset, look);
            self.finer.start(missing, is_visible, frame_request, &Arc::clone(&self.shared));
        }
        let is_due = self
            .finer
            .last_drawn
            .is_none_or(|(drawn, took)| drawn.elapsed() >= REDRAW_INTERVAL.max(took * REDRAW_PICTURES));
        let Some(resident) = resident.filter(|_| is_complete || is_due) else {
            self.scene = Some(scene);
            return false;
        };
        scene.dataset = scene.dataset.with_pages(Some(resident));
        self.draw_finer(&mut scene, frame_request, is_complete);
        self.scene = Some(scene);
        true
    }

    /// Draws the picture at rest again, with antialiased edges once it is complete. Without the memory for it, the picture that
    /// is shown stays, and no pages are read any longer.
    fn draw_finer(&mut self, scene: &mut RenderScene, frame_request: &FrameRequest, is_complete: bool) {
        let begin = Instant::now();
        let mut drawn = self.render_request(scene, RenderPurpose::Refinement, frame_request.clone());
        if is_complete && frame_request.final_quality() == QualityLevel::ANTIALIASED {
            drawn = drawn.and_then(|()| {
                self.render_request(scene, RenderPurpose::Antialiasing, frame_request.clone())
            });
        }
        self.finer.last_drawn = Some((Instant::now(), begin.elapsed()));
        let Err(err) = drawn else { return };
        log::warn!("finer levels could not be drawn: {err}");
        scene.dataset = scene.dataset.clone().with_pages(None);
        scene.renderer.drop_all();
        self.last_full_request = None;
        self.finer = FinerLevelReader { is_unavailable: true, ..FinerLevelReader::default() };
        if matches!(err, GpuError::DeviceLost(_)) {
            self.report(err);
        }
    }

    fn set_finer_status(&self, status: Option<FinerLevelStatus>) {
        let mut mailbox = self.shared.mailbox();
        if mailbox.figures.finer_levels != status {
            mailbox.figures.finer_levels = status;
            drop(mailbox);
            self.ctx.request_repaint();
        }
    }
}

/// Progress of a picture towards the levels that it calls for.
struct LevelProgress {
    /// Pages that have yet to be read.
    missing: Vec<PageAddress>,
    /// Pages for the next picture, if they are others than those of the dataset.
    resident: Option<Arc<ResidentPages>>,
    status: FinerLevelStatus,
}

impl LevelProgress {
    /// Adds the pages that have arrived to a cache; `None` if the picture calls for no finer level.
    fn new(
        cache: &mut PageCache,
        dataset: &Dataset,
        look: &Settings,
        size: [u32; 2],
        arrived: Result<Vec<(PageAddress, Arc<Page>)>, LoadError>,
    ) -> Option<Self> {
        let mut error = None;
        match arrived {
            Ok(pages) if pages.is_empty() => {}
            Ok(pages) => {
                let wanted = page_demand(dataset, cache.resident(), look, size);
                let wanted = wanted.map_or_else(Vec::new, |demand| demand.wanted);
                cache.insert(pages, &wanted, density_visibility(dataset, look));
            }
            Err(err) => {
                log::warn!("a finer level could not be read: {err}");
                error = Some(err.to_string());
            }
        }
        let demand = page_demand(dataset, cache.resident(), look, size)?;
        let missing = cache.missing(&demand.wanted);
        let FinerLevelRecord { finest, is_substituted } = demand.record(cache.resident().levels());
        let status = FinerLevelStatus { finest, missing: missing.len(), is_substituted, error };
        let resident = cache.resident();
        let is_other = dataset.pages().is_none_or(|shown| shown.id() != resident.id());
        let resident = (is_other && !resident.pages().is_empty()).then(|| Arc::new(resident.clone()));
        Some(Self { missing, resident, status })
    }
}

/// Returns the dataset that the renderer has made of another one, with the pages of that.
pub(super) fn with_pages_of(made: &Dataset, before: &Dataset) -> Dataset {
    made.clone().with_pages(before.pages().cloned())
}
