//! Renderer: cached products of one device, and blocking functions to draw a picture.

use std::time::Instant;

use super::loaded::Loaded;
use super::report::{Picture, Report};
use super::targets::Targets;
use crate::data::{Dataset, Interrupt};
use crate::gpu::context::clock::Clock;
use crate::gpu::resources::cached::Cached;
use crate::gpu::resources::tools::Tools;
use crate::gpu::{Context, GpuError, RenderOptions, ShaderLibrary};
use crate::model::Settings;
use crate::plan::{Request, VolumeKey};

/// Renderer of volumes on one device. Each product is cached with the key of its inputs, and reused by all pictures
/// with the same key.
#[derive(Debug)]
pub struct Renderer {
    pub(crate) tools: Tools,
    /// Volume on the GPU, by content and shown values; complete when it is uploaded.
    pub(crate) loaded: Option<Cached<VolumeKey, Loaded>>,
    pub(crate) targets: Targets,
    /// Number of times that the light volume of each light in the settings was filled.
    pub(crate) fills: Vec<u64>,
    /// Number of pictures started.
    pub(crate) pictures: u64,
    pub(crate) report: Report,
    /// Clock for timed pictures; `None` if the adapter has no timestamps.
    pub(crate) gpu_clock: Option<Clock>,
}

impl Renderer {
    /// Creates a renderer on a device.
    ///
    /// # Errors
    /// Returns an error if memory is exhausted.
    pub fn new(context: &Context) -> Result<Self, GpuError> {
        Self::with_shaders(context, ShaderLibrary::new(context))
    }

    /// Creates a renderer with the given shaders, which tests damage on purpose.
    ///
    /// # Errors
    /// Same as [`Self::new`].
    pub fn with_shaders(context: &Context, shaders: ShaderLibrary) -> Result<Self, GpuError> {
        Ok(Self {
            tools: Tools::new(context, shaders)?,
            loaded: None,
            targets: Targets::new(context)?,
            fills: Vec::new(),
            pictures: 0,
            report: Report::default(),
            gpu_clock: Clock::new(context),
        })
    }

    /// Returns the device context.
    pub fn context(&self) -> &Context {
        &self.tools.context
    }

    /// Returns the shader library, to share its pipelines with other renderers on the device.
    pub fn shaders(&self) -> ShaderLibrary {
        self.tools.shaders.clone()
    }

    /// Returns the volume of the last picture, with the values at densities 0 and 1 that it showed.
    pub fn dataset(&self) -> Option<&Dataset> {
        self.loaded.as_ref().map(|loaded| &loaded.value.dataset)
    }

    /// Returns times and counts of the last picture.
    pub fn report(&self) -> &Report {
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
    ) -> Result<Picture, GpuError> {
        let shown = self.render_shown(dataset, settings, size, options)?;
        let start = Instant::now();
        let light = self.read_light()?;
        self.report.readback_ms += milliseconds(start);
        Ok(Picture { size, light, shown })
    }

    /// Renders a picture and reads back the displayed result like [`Self::read_shown`], without the linear light,
    /// which takes four times the memory.
    ///
    /// # Errors
    /// Returns an error if the device fails or memory is exhausted.
    pub fn render_shown(
        &mut self,
        dataset: &Dataset,
        settings: &Settings,
        size: [u32; 2],
        options: &RenderOptions,
    ) -> Result<Vec<u8>, GpuError> {
        self.draw(dataset, settings, size, options)?;
        let start = Instant::now();
        let shown = self.read_shown()?;
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
        let drawn = self.draw_all(dataset, settings, size, options);
        if drawn.is_err() {
            self.forget_everything();
        }
        drawn
    }

    fn draw_all(
        &mut self,
        dataset: &Dataset,
        settings: &Settings,
        size: [u32; 2],
        options: &RenderOptions,
    ) -> Result<(), GpuError> {
        let context = self.tools.context.clone();
        let volume = dataset.volume().id();
        let request = Request { volume, settings: settings.clone(), size, coarse: None };
        let mut job = self.begin(dataset, request, options)?;
        // A quarter of a megapixel per submission stays below driver watchdogs on slow GPUs.
        job.set_band((1 << 18) / options.window(job.request()).size[0].max(1));
        let interrupt = Interrupt::here();
        // Limits the queued submissions: few if the work may be interrupted.
        let most = if interrupt.is_possible() { 4 } else { 64 };
        let mut unfinished = 0;
        while job.step()? {
            if interrupt.is_due() {
                return Err(GpuError::Refused("nobody waits for the picture any more".to_owned()));
            }
            unfinished += 1;
            if unfinished % most == 0 {
                context.wait()?;
            }
        }
        context.wait()
    }

    /// Drops everything on the GPU. After an error, products may not match their keys. Also frees the most memory.
    pub fn forget_everything(&mut self) {
        self.loaded = None;
        self.tools.pool.clear();
        self.targets.forget();
        // Pending work may still report errors about dropped resources.
        self.tools.context.wait().ok();
    }

    /// Invalidates finished pictures, so that the next one is drawn again: for measurements, and for tests of
    /// determinism.
    pub fn forget_pictures(&mut self) {
        self.targets.forget();
    }
}

fn milliseconds(start: Instant) -> f64 {
    start.elapsed().as_secs_f64() * 1000.0
}
