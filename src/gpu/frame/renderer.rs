//! The renderer: what it keeps, and pictures at once.

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

/// Renders volumes on one device. Every product is kept with the key of what it was made from, and serves all
/// pictures that need the same.
#[derive(Debug)]
pub struct Renderer {
    pub(crate) tools: Tools,
    /// The volume on the GPU by its content and the values that it shows, complete when it is uploaded.
    pub(crate) loaded: Option<Cached<VolumeKey, Loaded>>,
    pub(crate) targets: Targets,
    /// How often the light volume of each light of the settings was filled.
    pub(crate) fills: Vec<u64>,
    /// Counts pictures.
    pub(crate) pictures: u64,
    pub(crate) report: Report,
    /// For pictures that are timed; where the adapter has one.
    pub(crate) gpu_clock: Option<Clock>,
}

impl Renderer {
    /// A renderer on a device.
    ///
    /// # Errors
    /// When not even one texel can be had.
    pub fn new(context: &Context) -> Result<Self, GpuError> {
        Self::with_shaders(context, ShaderLibrary::new(context))
    }

    /// A renderer with shaders of one's own, which tests damage on purpose.
    ///
    /// # Errors
    /// As [`Self::new`].
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

    /// The device.
    pub fn context(&self) -> &Context {
        &self.tools.context
    }

    /// Its pipelines, for other renderers on the device.
    pub fn shaders(&self) -> ShaderLibrary {
        self.tools.shaders.clone()
    }

    /// The volume of the last picture, with the values at densities 0 and 1 that it showed.
    pub fn dataset(&self) -> Option<&Dataset> {
        self.loaded.as_ref().map(|loaded| &loaded.value.dataset)
    }

    /// What the last picture took.
    pub fn report(&self) -> &Report {
        &self.report
    }

    /// Makes a picture and waits for it.
    ///
    /// # Errors
    /// When the GPU cannot do it.
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

    /// Makes a picture, waits for it and reads back what is shown, as [`Self::read_shown`] does, but not its
    /// light, which takes four times the memory.
    ///
    /// # Errors
    /// When the GPU cannot do it.
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
    /// When the GPU cannot do it.
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
        // Bounds what is queued: little where somebody may want to stop.
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

    /// Forgets all that is on the GPU: after an error, some of it may not be what its key says. It is also the most
    /// that can be given back.
    pub fn forget_everything(&mut self) {
        self.loaded = None;
        self.tools.pool.clear();
        self.targets.forget();
        // What was recorded with it may still complain.
        self.tools.context.wait().ok();
    }

    /// Forgets finished pictures, so that the next one is drawn anew whatever it shows: for measurements, and for
    /// tests that the same picture is the same twice.
    pub fn forget_pictures(&mut self) {
        self.targets.forget();
    }
}

fn milliseconds(start: Instant) -> f64 {
    start.elapsed().as_secs_f64() * 1000.0
}
