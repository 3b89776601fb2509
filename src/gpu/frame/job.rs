//! The work for one picture, which holds the renderer until it is done or dropped.

use std::collections::VecDeque;
use std::time::Instant;

use super::kept::bounces::PlacedBounces;
use super::kept::sky::PlacedSky;
use super::light_build::LightBuild;
use super::loaded::Loaded;
use super::report::Report;
use super::step::{Stage, Step, cut_into_bands};
use super::targets::{Role, Targets};
use crate::gpu::context::clock::Clock;
use crate::gpu::eye::gather::EyePass;
use crate::gpu::resources::cached::Cached;
use crate::gpu::resources::tools::Tools;
use crate::gpu::scatter::eye::EyeScatter;
use crate::gpu::scatter::voxels::Scattering;
use crate::gpu::{GpuError, RenderOptions};
use crate::model::ShadowAlgorithm;
use crate::plan::{FrameKeys, LitLights, Request, VolumeKey};

/// How many times longer a picture takes whose samples cast rays themselves, roughly: rows of a band
/// are fewer by so much.
const DIRECT_COST: u32 = 16;

/// The work for one picture, step by step.
///
/// Only one can be under way, and nothing else can be done with the renderer meanwhile. Dropping it leaves what was
/// shown before, and what is complete of its products.
#[derive(Debug)]
pub struct Job<'r> {
    pub(super) tools: &'r Tools,
    pub(super) gpu_clock: Option<&'r Clock>,
    pub(super) loaded: &'r mut Cached<VolumeKey, Loaded>,
    pub(super) targets: &'r mut Targets,
    pub(super) fills: &'r mut Vec<u64>,
    pub(super) report: &'r mut Report,
    pub(super) request: Request,
    pub(super) options: RenderOptions,
    /// Keys of its products, with the light volumes that it really uses.
    pub(super) keys: FrameKeys,
    pub(super) lit: LitLights,
    /// Place of every light's volume among those that are kept.
    pub(super) slots: Vec<Option<usize>>,
    pub(super) builds: Vec<LightBuild>,
    /// The volume of the sky's visibility.
    pub(super) sky: PlacedSky,
    /// The volume of light that has bounced.
    pub(super) bounces: PlacedBounces,
    /// Shades with the volume of each light, for the combined one to be filled.
    pub(super) combine: Option<EyePass>,
    pub(super) eye: EyePass,
    pub(super) scattering: Option<Scattering>,
    /// The eye's sheets, where voxels are scattered.
    pub(super) eye_sheets: Option<EyeScatter>,
    /// The target that it draws into.
    pub(super) role: Role,
    pub(super) steps: VecDeque<Step>,
    pub(super) total: usize,
}

impl Job<'_> {
    /// What the picture is of.
    pub fn request(&self) -> &Request {
        &self.request
    }

    /// What it has taken so far.
    pub fn report(&self) -> &Report {
        self.report
    }

    /// Share of the steps that are done.
    pub fn progress(&self) -> f32 {
        1.0 - self.steps.len() as f32 / self.total.max(1) as f32
    }

    /// What comes next; `None` when the picture is complete.
    pub fn stage(&self) -> Option<Stage> {
        self.steps.iter().find_map(Step::stage)
    }

    /// Whether the picture is complete.
    pub fn is_done(&self) -> bool {
        self.stage().is_none()
    }

    /// Multiplies all light of what is shown, as previews need it; the light itself stays as it is.
    pub fn set_exposure(&mut self, exposure: f32) {
        self.options.exposure = exposure;
        self.keys.display = self.keys.display.clone().exposed(exposure);
    }

    /// Cuts the rows that are still to be drawn into bands of `rows`.
    pub fn set_band(&mut self, rows: u32) {
        let direct = self.request.settings.shadows.algorithm == ShadowAlgorithm::Direct;
        // A ray to each light from every sample: so much longer.
        let rows = if direct { (rows / DIRECT_COST).max(8) } else { rows.max(1) };
        let before = self.steps.len();
        cut_into_bands(&mut self.steps, rows);
        // Progress counts what is left of what there is.
        self.total = self.total - before + self.steps.len();
    }

    /// Submits the next step. Returns whether there are more; after the last one the new picture is
    /// what the renderer reads back.
    ///
    /// # Errors
    /// What the device complains about.
    pub fn step(&mut self) -> Result<bool, GpuError> {
        self.finish_products();
        let next = self.steps.front().and_then(|step| Some((step.clone(), step.stage()?)));
        let Some((step, stage)) = next else { return Ok(false) };
        let start = Instant::now();
        let Tools { context, pool, .. } = self.tools;
        let mut encoder = context.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let clock = self.gpu_clock.filter(|_| self.options.timed);
        if let Some(clock) = clock {
            clock.start(&mut encoder);
        }
        pool.next_submission();
        self.encode(&step, &mut encoder)?;
        if let Some(clock) = clock {
            clock.stop(&mut encoder);
        }
        context.queue.submit([encoder.finish()]);
        self.steps.pop_front();
        self.finish_products();
        if self.options.timed {
            context.wait()?;
        }
        let took = start.elapsed().as_secs_f64() * 1000.0;
        self.report.add(stage, took, clock.map(|clock| clock.read_ms(context)).transpose()?);
        Ok(!self.is_done())
    }
}
