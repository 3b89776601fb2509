//! Finer resolution levels than the one in memory: while nothing is to be drawn, the pages that the picture shows are read
//! on a thread of their own, and the picture is drawn again as they arrive.

use std::sync::Arc;
use std::sync::mpsc::{Receiver, TryRecvError, channel};
use std::time::{Duration, Instant};

use super::RenderWorker;
use crate::app::worker::mailbox::{FinerLevelStatus, SharedMailbox};
use crate::app::worker::quality::QualityLevel;
use crate::app::worker::render_schedule::RenderPurpose;
use crate::app::worker::request::{FrameRequest, RenderScene};
use chiaroscuro_render::GpuError;
use chiaroscuro_render::plan::{PageDemand, density_visibility, page_demand};
use chiaroscuro_volume::{
    CancelOnDrop, Dataset, LoadError, PAGES_PER_BATCH, Page, PageAddress, PageCache, memory_budget_bytes,
    read_pages,
};
use chiaroscuro_volume_io::FilePages;

/// Memory for pages, in bytes: what most graphics cards can spare.
const PAGE_BYTES: u64 = 1 << 30;

/// Interval at which the picture is drawn again while pages arrive.
const REDRAW_INTERVAL: Duration = Duration::from_millis(1500);

/// Pages that a thread has read.
type ReadPages = Result<Vec<(PageAddress, Arc<Page>)>, LoadError>;

/// Pages of finer levels, and the thread that reads them.
#[derive(Default)]
pub(super) struct FinerLevelReader {
    /// Pages in the density mapping of the picture; `None` before the first, and where the file has no finer levels.
    cache: Option<PageCache>,
    /// True if the file has no finer levels that can be shown.
    is_unavailable: bool,
    /// Pages that a thread reads now.
    reading: Option<Receiver<ReadPages>>,
    /// Cancels reading when the volume is closed.
    cancel: Option<CancelOnDrop>,
    /// Request for which reading failed; another one tries again.
    failed: Option<FrameRequest>,
    last_drawn: Option<Instant>,
}

impl FinerLevelReader {
    /// Returns the pages that were read, if a thread has ended.
    fn take_read(&mut self) -> Option<ReadPages> {
        let read = match self.reading.as_ref()?.try_recv() {
            Ok(read) => Some(read),
            Err(TryRecvError::Empty) => None,
            // The thread has panicked.
            Err(TryRecvError::Disconnected) => Some(Err(LoadError::Cancelled)),
        };
        if read.is_some() {
            self.reading = None;
        }
        read
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
        let Some(file) = &scene.file else {
            self.is_unavailable = true;
            return;
        };
        let bytes = PAGE_BYTES.min(memory_budget_bytes() / 4);
        let whole = scene.dataset.clone().with_pages(None);
        match FilePages::new(&file.path, &file.options, &whole, bytes) {
            Ok(pages) => {
                self.cancel = Some(pages.token().clone().into());
                self.cache = Some(whole.page_cache(Arc::new(pages), bytes));
            }
            Err(why) => {
                log::info!("finer levels of {} are not shown: {why}", file.path.display());
                self.is_unavailable = true;
            }
        }
    }

    /// Starts to read pages on a thread, which wakes the render thread when it ends.
    fn start(
        &mut self,
        missing: Vec<PageAddress>,
        is_visible: impl Fn([f32; 2]) -> bool + Send + Sync + 'static,
        shared: &Arc<SharedMailbox>,
    ) {
        let Some(cache) = &self.cache else { return };
        let (source, shared) = (Arc::clone(cache.source()), Arc::clone(shared));
        let (sender, pages) = channel();
        let spawned = std::thread::Builder::new().name("finer_levels".to_owned()).spawn(move || {
            let read = read_pages(&*source, &missing, is_visible);
            // Nobody waits for the pages of a volume that was closed.
            drop(sender.send(read));
            shared.mailbox().pages_arrived = true;
            shared.changed.notify_one();
        });
        match spawned {
            Ok(_) => self.reading = Some(pages),
            Err(err) => log::warn!("finer levels are not read: {err}"),
        }
    }
}

impl RenderWorker {
    /// Reads the pages that the picture at rest shows, and draws it again with those that have arrived.
    pub(super) fn show_finer_levels(&mut self) {
        while let Some(frame_request) = self.agenda.request_at_rest().cloned() {
            let Some(scene) = self.scene.take() else { return };
            let outcome = self.refine_levels(scene, &frame_request);
            if !outcome {
                return;
            }
        }
    }

    /// Takes a step towards the complete picture; returns false if there is nothing to do before something arrives.
    fn refine_levels(&mut self, mut scene: RenderScene, frame_request: &FrameRequest) -> bool {
        self.finer.refresh_cache(&scene);
        let dataset = scene.dataset.clone();
        let look = &frame_request.looks.left;
        let read = self.finer.take_read();
        let Some(cache) = &mut self.finer.cache else {
            self.scene = Some(scene);
            self.set_finer_status(None);
            return false;
        };
        let demand = |cache: &PageCache| {
            page_demand(&dataset, cache.resident(), look, frame_request.size, cache.capacity())
        };
        let mut error = None;
        match read {
            Some(Ok(pages)) => {
                let wanted = demand(cache).map_or_else(Vec::new, |demand| demand.wanted);
                cache.insert(pages, &wanted, density_visibility(&dataset, look));
            }
            Some(Err(err)) => {
                log::warn!("a finer level could not be read: {err}");
                self.finer.failed = Some(frame_request.clone());
                error = Some(err.to_string());
            }
            None => {}
        }
        let Some(demand) = demand(cache) else {
            self.scene = Some(scene);
            self.set_finer_status(None);
            return false;
        };
        let mut missing = cache.missing(&demand.wanted);
        let status = finer_status(cache, &demand, missing.len(), error);
        let has_failed = self.finer.failed.as_ref() == Some(frame_request);
        let is_complete = missing.is_empty() || has_failed;
        let arrived = cache.resident().id()
            != dataset.pages().map_or_else(Default::default, |pages| pages.id())
            && !cache.resident().pages().is_empty();
        let is_due = self.finer.last_drawn.is_none_or(|drawn| drawn.elapsed() >= REDRAW_INTERVAL);
        let resident = (arrived && (is_complete || is_due)).then(|| Arc::new(cache.resident().clone()));
        if !has_failed || status.error.is_some() {
            self.set_finer_status(Some(status));
        }
        if !is_complete && self.finer.reading.is_none() {
            missing.truncate(PAGES_PER_BATCH);
            let is_visible = density_visibility(&dataset, look);
            self.finer.start(missing, is_visible, &Arc::clone(&self.shared));
        }
        let Some(resident) = resident else {
            self.scene = Some(scene);
            return false;
        };
        scene.dataset = dataset.with_pages(Some(resident));
        let drawn = self.draw_finer(&mut scene, frame_request, is_complete);
        self.finer.last_drawn = Some(Instant::now());
        if let Err(err) = drawn {
            // The picture that is shown is complete; only the memory for more is missing.
            log::warn!("finer levels could not be drawn: {err}");
            scene.dataset = scene.dataset.with_pages(None);
            scene.renderer.drop_all();
            self.last_full_request = None;
            self.finer = FinerLevelReader { is_unavailable: true, ..FinerLevelReader::default() };
            if matches!(err, GpuError::DeviceLost(_)) {
                self.report(err);
            }
        }
        self.scene = Some(scene);
        true
    }

    /// Draws the picture at rest again, with antialiased edges once it is complete.
    fn draw_finer(
        &mut self,
        scene: &mut RenderScene,
        frame_request: &FrameRequest,
        is_complete: bool,
    ) -> Result<(), GpuError> {
        self.render_request(scene, RenderPurpose::Refinement, frame_request.clone())?;
        if is_complete && frame_request.final_quality() == QualityLevel::ANTIALIASED {
            self.render_request(scene, RenderPurpose::Antialiasing, frame_request.clone())?;
        }
        Ok(())
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

/// Returns what the window says about finer levels.
fn finer_status(
    cache: &PageCache,
    demand: &PageDemand,
    missing: usize,
    error: Option<String>,
) -> FinerLevelStatus {
    let level = cache.resident().levels().0.get(demand.finest);
    FinerLevelStatus {
        finest: level.map_or_else(String::new, |level| level.key.clone()),
        missing,
        is_substituted: demand.is_substituted,
        error,
    }
}

/// Returns the dataset that the renderer has made of another one, with the pages of that.
pub(super) fn with_pages_of(made: &Dataset, before: &Dataset) -> Dataset {
    made.clone().with_pages(before.pages().cloned())
}
