//! Renderer: cached products of one device, and blocking functions to draw a picture.

use std::time::Instant;

use super::caches::spare_volumes::SpareVolumes;
use super::double_buffer::DoubleBuffer;
use super::loaded_volume::LoadedVolume;
use super::report::{RenderReport, RenderedPicture};
use crate::context::gpu_clock::GpuClock;
use crate::plan::{RenderRequest, VolumeKey};
use crate::resources::cache_entry::CacheEntry;
use crate::resources::gpu_tools::GpuTools;
use crate::{GpuContext, GpuError, RenderOptions, ShaderLibrary};
use chiaroscuro_scene::Settings;
use chiaroscuro_volume::{CancelToken, Dataset};

/// Renderer of volumes on one device. Each product is cached with the key of its inputs, and reused by all pictures
/// with the same key.
#[derive(Debug)]
pub struct Renderer {
    pub(crate) tools: GpuTools,
    /// Volume on the GPU, by content and shown values; complete when it is uploaded.
    pub(crate) loaded: Option<CacheEntry<VolumeKey, LoadedVolume>>,
    /// Volumes of other time steps.
    pub(crate) spare_volumes: SpareVolumes,
    pub(crate) targets: DoubleBuffer,
    /// Number of times that the light volume of each light in the settings was filled.
    pub(crate) fill_counts: Vec<u64>,
    /// Number of pictures started.
    pub(crate) picture_count: u64,
    pub(crate) report: RenderReport,
    /// Clock for timed pictures; `None` if the adapter has no timestamps.
    pub(crate) gpu_clock: Option<GpuClock>,
}

impl Renderer {
    /// Creates a renderer on a device.
    ///
    /// # Errors
    /// Returns an error if memory is exhausted.
    pub fn new(context: &GpuContext) -> Result<Self, GpuError> {
        Self::with_shaders(context, ShaderLibrary::new(context))
    }

    /// Creates a renderer with the given shaders, which tests damage on purpose.
    ///
    /// # Errors
    /// Same as [`Self::new`].
    pub fn with_shaders(context: &GpuContext, shaders: ShaderLibrary) -> Result<Self, GpuError> {
        Ok(Self {
            tools: GpuTools::new(context, shaders)?,
            loaded: None,
            spare_volumes: SpareVolumes::default(),
            targets: DoubleBuffer::new(context)?,
            fill_counts: Vec::new(),
            picture_count: 0,
            report: RenderReport::default(),
            gpu_clock: GpuClock::new(context),
        })
    }

    /// Returns the device context.
    pub fn context(&self) -> &GpuContext {
        &self.tools.context
    }

    /// Returns the shader library, to share its pipelines with other renderers on the device.
    pub fn shaders(&self) -> ShaderLibrary {
        self.tools.shaders.clone()
    }

    /// Returns the volume of the last picture, with the values at densities 0 and 1 that it showed.
    pub fn dataset(&self) -> Option<&Dataset> {
        self.loaded.as_ref().map(|loaded| &loaded.product.dataset)
    }

    /// Returns times and counts of the last picture.
    pub fn report(&self) -> &RenderReport {
        &self.report
    }

    /// Renders a picture and reads it back, with its linear light.
    ///
    /// # Errors
    /// Returns an error if the device fails or memory is exhausted.
    pub fn render(
        &mut self,
        dataset: &Dataset,
        settings: &Settings,
        size: [u32; 2],
        options: &RenderOptions,
    ) -> Result<RenderedPicture, GpuError> {
        let shown = self.render_display(dataset, settings, size, options)?;
        let start = Instant::now();
        let light = self.read_light()?;
        self.report.readback_ms += milliseconds(start);
        Ok(RenderedPicture { size, linear: light, display: shown })
    }

    /// Renders a picture and reads back the displayed result like [`Self::read_display`], without the linear light,
    /// which takes four times the memory.
    ///
    /// # Errors
    /// Returns an error if the device fails or memory is exhausted.
    pub fn render_display(
        &mut self,
        dataset: &Dataset,
        settings: &Settings,
        size: [u32; 2],
        options: &RenderOptions,
    ) -> Result<Vec<u8>, GpuError> {
        self.draw(dataset, settings, size, options)?;
        let start = Instant::now();
        let shown = self.read_display()?;
        self.report.readback_ms += milliseconds(start);
        Ok(shown)
    }

    /// Draws a picture and waits until it is complete, without reading it back.
    ///
    /// # Errors
    /// Returns an error if the device fails or memory is exhausted.
    pub fn draw(
        &mut self,
        dataset: &Dataset,
        settings: &Settings,
        size: [u32; 2],
        options: &RenderOptions,
    ) -> Result<(), GpuError> {
        let drawn = self.try_draw(dataset, settings, size, options);
        if drawn.is_err() {
            self.drop_all();
        }
        drawn
    }

    fn try_draw(
        &mut self,
        dataset: &Dataset,
        settings: &Settings,
        size: [u32; 2],
        options: &RenderOptions,
    ) -> Result<(), GpuError> {
        let context = self.tools.context.clone();
        let volume = dataset.id();
        let request = RenderRequest { volume, settings: settings.clone(), size, preview_resolution: None };
        let mut job = self.begin(dataset, request, options)?;
        // A quarter of a megapixel per submission stays below driver watchdogs on slow GPUs.
        job.set_band((1 << 18) / options.sample_window(job.request()).size[0].max(1));
        let interrupt = CancelToken::current();
        // Limits the queued submissions: few if the work may be interrupted.
        let most = if interrupt.is_cancellable() { 4 } else { 64 };
        let mut unfinished = 0;
        let mut submitted = Instant::now();
        loop {
            let has_more = job.step()?;
            if has_more && interrupt.should_stop() {
                return Err(GpuError::Cancelled);
            }
            unfinished += 1;
            if !has_more || unfinished == most || job.awaits_pace() {
                context.wait()?;
                job.learn_pace_of(unfinished, milliseconds(submitted));
                (unfinished, submitted) = (0, Instant::now());
            }
            if !has_more {
                return Ok(());
            }
        }
    }

    /// Sets the memory that volumes of other time steps may take beside the one that is shown, in bytes. They stay on the
    /// GPU with their light; at first it is 0, and none stays.
    pub fn set_spare_volume_bytes(&mut self, bytes: u64) {
        self.spare_volumes.set_budget(bytes);
        self.release_dropped_volumes();
    }

    /// Drops the bind groups that would keep the textures of dropped volumes alive.
    pub(crate) fn release_dropped_volumes(&mut self) {
        if self.spare_volumes.take_dropped() {
            self.tools.pool.drop_bind_groups();
        }
    }

    /// Drops everything on the GPU. After an error, products may not match their keys. Also frees the most memory.
    pub fn drop_all(&mut self) {
        self.loaded = None;
        self.spare_volumes.clear();
        self.tools.pool.clear();
        self.targets.invalidate();
        // Pending work may still report errors about dropped resources.
        self.tools.context.wait().ok();
        self.targets.drop_back(&self.tools.context);
    }
}

fn milliseconds(start: Instant) -> f64 {
    start.elapsed().as_secs_f64() * 1000.0
}
