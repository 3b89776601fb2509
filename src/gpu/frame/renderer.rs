//! The frame, read from top to bottom, and every cache.

use std::sync::Arc;
use std::time::Instant;

use super::job::{Job, Stage, Step};
use super::light_cache::PlacedLights;
use super::options::{Picture, RenderOptions, Report};
use crate::data::{Bricks, Volume};
use crate::gpu::context::clock::Clock;
use crate::gpu::light::combine::{self as light_collapse, CollapsedLight};
use crate::gpu::light::volume::LightVolume;
use crate::gpu::output::display::{Shape, Target, display};
use crate::gpu::resources::pool::Recycled;
use crate::gpu::scatter::eye::SLABS_PER_STEP;
use crate::gpu::scatter::voxels::ScatterVoxels;
use crate::gpu::volume::prefilter;
use crate::gpu::volume::transfer_tables::Tables;
use crate::gpu::volume::{GpuVolume, texture_3d};
use crate::gpu::{Context, GpuError, ShaderLibrary};
use crate::model::{Classification, Depth, Settings, SheetOrder};
use crate::plan::eye_frame;
use crate::plan::{Request, SliceOrder};

/// Renders volumes on one device.
#[derive(Debug)]
pub struct Renderer {
    pub(crate) context: Context,
    pub(crate) shaders: ShaderLibrary,
    pub(crate) volume: Option<GpuVolume>,
    pub(crate) uploaded: bool,
    pub(crate) tables: Option<Tables>,
    pub(crate) lights: Vec<LightVolume>,
    /// Light volumes whose textures serve those that a picture needs; empty in between.
    pub(crate) unwanted: Vec<LightVolume>,
    /// The diffuse light of all of them in one.
    pub(crate) collapsed: Option<CollapsedLight>,
    /// What is shown, and a spare one to draw into.
    pub(crate) front: Option<Target>,
    pub(crate) back: Option<Target>,
    /// The volume's voxels for scattering, once a picture has asked for them.
    pub(crate) voxels: Option<ScatterVoxels>,
    /// Counts what the picture scatters.
    pub(crate) splats: Option<wgpu::Buffer>,
    /// Bound where a light has no volume.
    pub(crate) nothing: wgpu::TextureView,
    pub(crate) recycled: Recycled,
    pub(crate) options: RenderOptions,
    pub(crate) rebuilds: Vec<u64>,
    /// Counts pictures.
    pub(crate) clock: u64,
    pub(crate) report: Report,
    /// For pictures that are timed; where the adapter has one.
    gpu_clock: Option<Clock>,
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
        let usage = wgpu::TextureUsages::TEXTURE_BINDING;
        let nothing =
            context.texture(&texture_3d("Renderer::nothing", [1; 3], context.storage_format, usage))?;
        Ok(Self {
            context: context.clone(),
            shaders,
            volume: None,
            uploaded: false,
            tables: None,
            lights: Vec::new(),
            unwanted: Vec::new(),
            collapsed: None,
            front: None,
            back: None,
            voxels: None,
            splats: None,
            nothing: nothing.create_view(&wgpu::TextureViewDescriptor::default()),
            recycled: Recycled::default(),
            options: RenderOptions::default(),
            rebuilds: Vec::new(),
            clock: 0,
            report: Report::default(),
            gpu_clock: Clock::new(context),
        })
    }

    /// The device.
    pub fn context(&self) -> &Context {
        &self.context
    }

    /// What the last picture took.
    pub fn report(&self) -> &Report {
        &self.report
    }

    /// Shows the picture of a finished job again with another exposure.
    ///
    /// # Errors
    /// When there is no picture or the GPU cannot do it.
    pub fn expose(&mut self, job: &Job, exposure: f32) -> Result<(), GpuError> {
        let target =
            self.front.as_ref().ok_or_else(|| GpuError::Refused("no picture was drawn".to_owned()))?;
        let output = &job.request().settings.output;
        let mut encoder =
            self.context.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        self.recycled.next_submission();
        let with = (&self.context, &self.recycled);
        display(
            with,
            &self.shaders,
            output,
            (&self.options, job.transparent, exposure),
            target,
            &mut encoder,
        )?;
        self.context.queue.submit([encoder.finish()]);
        self.context.wait()
    }

    /// Makes a picture and waits for it.
    ///
    /// # Errors
    /// When the GPU cannot do it.
    pub fn render(
        &mut self,
        volume: &Arc<Volume>,
        bricks: &Arc<Bricks>,
        settings: &Settings,
        size: [u32; 2],
        options: &RenderOptions,
    ) -> Result<Picture, GpuError> {
        let shown = self.render_shown(volume, bricks, settings, size, options)?;
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
        volume: &Arc<Volume>,
        bricks: &Arc<Bricks>,
        settings: &Settings,
        size: [u32; 2],
        options: &RenderOptions,
    ) -> Result<Vec<u8>, GpuError> {
        self.draw(volume, bricks, settings, size, options)?;
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
        volume: &Arc<Volume>,
        bricks: &Arc<Bricks>,
        settings: &Settings,
        size: [u32; 2],
        options: &RenderOptions,
    ) -> Result<(), GpuError> {
        let request = Request { volume: volume.content_id(), settings: settings.clone(), size, coarse: None };
        let mut job = self.begin(volume, bricks, request, options)?;
        // A quarter of a megapixel per submission stays below driver watchdogs on slow GPUs.
        job.set_band((1 << 18) / options.window(job.request()).size[0].max(1));
        let mut unfinished = 0;
        while self.step(&mut job)? {
            unfinished += 1;
            // Bounds what is queued.
            if unfinished % 64 == 0 {
                self.context.wait()?;
            }
        }
        self.context.wait()
    }

    /// Starts a picture: finds what is stale and lists the steps. An earlier job must not be
    /// continued afterwards.
    ///
    /// # Errors
    /// When memory for it cannot be had. What was shown stays.
    pub fn begin(
        &mut self,
        volume: &Arc<Volume>,
        bricks: &Arc<Bricks>,
        request: Request,
        options: &RenderOptions,
    ) -> Result<Job, GpuError> {
        self.options = options.clone();
        self.clock += 1;
        self.report = Report { peak_gpu_bytes: self.report.peak_gpu_bytes, ..Report::default() };
        self.unwanted = self.lights.extract_if(.., |light| !light.complete).collect();
        let mut steps = Vec::new();
        self.place_volume(volume, bricks, &mut steps)?;
        let start = Instant::now();
        let Some(gpu_volume) = &self.volume else { return Err(GpuError::Refused("no volume".to_owned())) };
        match &mut self.tables {
            Some(tables) => {
                if tables.refresh(&self.context, gpu_volume, &request.settings)? {
                    self.recycled.forget_groups();
                }
            }
            tables => *tables = Some(Tables::new(&self.context, gpu_volume, &request.settings)?),
        }
        self.report.bricks_ms = milliseconds(start);
        let PlacedLights { keys, builds, collapsed, to_collapse } = self.place_all_light(&request)?;
        if !self.unwanted.is_empty() {
            self.unwanted.clear();
            self.recycled.forget_groups();
        }
        if builds.is_empty() {
            self.recycled.drop_sheets();
        }
        for (at, build) in builds.iter().enumerate() {
            steps.extend(build.steps(at, options.light_parts.max(1)));
        }
        if let Some(bricks) = to_collapse {
            // One step at least, which completes a volume without bricks.
            let firsts = (0..bricks.max(1)).step_by(light_collapse::BRICKS_PER_STEP);
            let end = |first: usize| bricks.min(first + light_collapse::BRICKS_PER_STEP);
            steps.extend(firsts.map(|first| Step::Collapse(first..end(first))));
        }
        let shape = Shape {
            size: options.shown(&request).size,
            samples: options.samples,
            has_floor: request.settings.ground.on,
            deep: options.depth != Depth::Eight,
        };
        if self.back.as_ref().is_none_or(|target| target.shape != shape) {
            self.back = None;
            self.recycled.forget_groups();
            self.back = Some(Target::new(&self.context, shape)?);
        }
        steps.extend(self.eye_steps(&request)?);
        if request.settings.ground.on {
            steps.push(Step::Ground(0..shape.drawn()[1]));
        }
        steps.push(Step::Display);
        self.report.peak_gpu_bytes = self.report.peak_gpu_bytes.max(self.gpu_bytes());
        let total = steps.len();
        Ok(Job {
            request,
            transparent: options.transparent,
            exposure: 1.0,
            keys,
            builds,
            collapsed,
            eye: None,
            scatter: None,
            steps: steps.into(),
            total,
        })
    }

    /// The steps that draw the picture.
    fn eye_steps(&mut self, request: &Request) -> Result<Vec<Step>, GpuError> {
        self.splats = None;
        let (settings, window) = (&request.settings, self.options.window(request));
        let Some(gpu_volume) = &self.volume else { return Err(GpuError::Refused("no volume".to_owned())) };
        let frame = eye_frame(&settings.camera, &gpu_volume.scene, window, settings.sampling.slab);
        if settings.scatters() {
            let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC;
            self.splats = Some(self.context.buffer("Renderer::splats", &[0u32], usage));
            // Sums of nothing are zeros, but voxels of nothing are not splatted by themselves.
            let by_voxel = settings.sampling.classification == Classification::Pre
                || settings.sampling.order == SheetOrder::EveryFootprint;
            let all = by_voxel && self.tables.as_ref().is_some_and(Tables::show_nothing);
            if !self.voxels.as_ref().is_some_and(|voxels| voxels.holds_all || !all) {
                self.voxels = Some(ScatterVoxels::new(&self.context, gpu_volume, all)?);
            }
        }
        // With everything behind the eye there is no sheet: the gathering pass clears the picture.
        if settings.scatters() && frame.slab_count > 0 {
            let count = match settings.sampling.order {
                SheetOrder::ImageAligned => frame.slab_count,
                SheetOrder::VolumeAligned | SheetOrder::EveryFootprint => {
                    SliceOrder::new(&frame, gpu_volume.volume.dims()).count
                }
            };
            let firsts = (0..count).step_by(SLABS_PER_STEP as usize);
            let end = |k: u32| count.min(k + SLABS_PER_STEP);
            Ok(firsts.map(|k| Step::ScatterEye(k..end(k))).collect())
        } else {
            Ok(vec![Step::Eye(0..window.size[1])])
        }
    }

    /// Submits the next step. Returns whether there are more; after the last one the new picture is
    /// what [`Self::read_shown`] gives.
    ///
    /// # Errors
    /// What the device complains about.
    pub fn step(&mut self, job: &mut Job) -> Result<bool, GpuError> {
        let Some(step) = job.steps.pop_front() else { return Ok(false) };
        let start = Instant::now();
        let mut encoder =
            self.context.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let timed = self.options.timed;
        if let Some(clock) = self.gpu_clock.as_ref().filter(|_| timed) {
            clock.start(&mut encoder);
        }
        self.recycled.next_submission();
        self.encode(job, &step, &mut encoder)?;
        if let Some(clock) = self.gpu_clock.as_ref().filter(|_| timed) {
            clock.stop(&mut encoder);
        }
        self.context.queue.submit([encoder.finish()]);
        if self.options.timed {
            self.context.wait()?;
        }
        let took = milliseconds(start);
        if let Some(clock) = self.gpu_clock.as_ref().filter(|_| timed) {
            let sum = match step.stage() {
                Stage::LightMarch | Stage::LightBackproject | Stage::LightRaycast => {
                    &mut self.report.light_gpu_ms
                }
                _ => &mut self.report.eye_gpu_ms,
            };
            if !matches!(step.stage(), Stage::Upload | Stage::Pyramid | Stage::Display) {
                *sum = Some(sum.unwrap_or(0.0) + clock.read_ms(&self.context)?);
            }
        }
        match step.stage() {
            Stage::Upload | Stage::Pyramid => self.report.upload_ms += took,
            Stage::LightMarch => self.report.light_march_ms += took,
            Stage::LightBackproject => self.report.light_backproject_ms += took,
            Stage::LightRaycast => self.report.light_raycast_ms += took,
            Stage::Eye => self.report.eye_ms += took,
            Stage::Display => self.report.readback_ms += took,
        }
        if step == Step::Display {
            std::mem::swap(&mut self.front, &mut self.back);
        }
        Ok(!job.is_done())
    }

    /// Makes room for a volume and lists its upload, unless it is there already.
    fn place_volume(
        &mut self,
        volume: &Arc<Volume>,
        bricks: &Arc<Bricks>,
        steps: &mut Vec<Step>,
    ) -> Result<(), GpuError> {
        let same = |known: &GpuVolume| known.volume.content_id() == volume.content_id();
        if !(self.uploaded && self.volume.as_ref().is_some_and(same)) {
            let fresh = GpuVolume::new(&self.context, volume, bricks)?;
            let slices = volume.dims()[2];
            for first in (0..slices).step_by(fresh.slices_per_step()) {
                steps.push(Step::Upload(first..slices.min(first + fresh.slices_per_step())));
            }
            steps.extend(prefilter::steps(&fresh).map(|(level, bricks)| Step::Pyramid(level, bricks)));
            if fresh.gradients.is_some() {
                steps.extend(prefilter::steps(&fresh).map(|(level, bricks)| Step::Gradients(level, bricks)));
            }
            self.volume = Some(fresh);
            self.uploaded = false;
            self.tables = None;
            self.voxels = None;
            self.collapsed = None;
            self.lights.clear();
            self.recycled.clear();
        }
        Ok(())
    }
}

fn milliseconds(start: Instant) -> f64 {
    start.elapsed().as_secs_f64() * 1000.0
}
