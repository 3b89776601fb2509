//! Job: the work for one picture in steps, which borrows the renderer until it is done or dropped.

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

/// Approximate ratio of times per row, with rays to lights from every sample and without; bands have fewer rows by
/// this factor.
const DIRECT_COST: u32 = 16;

/// Work for one picture, executed step by step.
///
/// It borrows the renderer, so only one job exists at a time. Dropping it keeps the picture shown before, and the
/// products that are complete.
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
    /// Keys of the products, with those of the light volumes in actual use (which may be coarser than requested).
    pub(super) keys: FrameKeys,
    pub(super) lit: LitLights,
    /// Index of each light's volume among the cached ones.
    pub(super) slots: Vec<Option<usize>>,
    pub(super) builds: Vec<LightBuild>,
    /// Cached or new volume of sky visibility.
    pub(super) sky: PlacedSky,
    /// Cached or new volume of scattered light.
    pub(super) bounces: PlacedBounces,
    /// Shading parameters with the volume of each light, for filling the combined volume.
    pub(super) combine: Option<EyePass>,
    pub(super) eye: EyePass,
    pub(super) scattering: Option<Scattering>,
    /// Sheets of the eye, for the scattering engine.
    pub(super) eye_sheets: Option<EyeScatter>,
    /// Target that is drawn into.
    pub(super) role: Role,
    pub(super) steps: VecDeque<Step>,
    pub(super) total: usize,
}

impl Job<'_> {
    /// Returns the request that the picture is made for.
    pub fn request(&self) -> &Request {
        &self.request
    }

    /// Returns the times and counts so far.
    pub fn report(&self) -> &Report {
        self.report
    }

    /// Returns the fraction of the steps that are done, 0 to 1.
    pub fn progress(&self) -> f32 {
        1.0 - self.steps.len() as f32 / self.total.max(1) as f32
    }

    /// Returns the stage of the next step; `None` when the picture is complete.
    pub fn stage(&self) -> Option<Stage> {
        self.steps.iter().find_map(Step::stage)
    }

    /// Returns true when the picture is complete.
    pub fn is_done(&self) -> bool {
        self.stage().is_none()
    }

    /// Sets the exposure of previews, which multiplies the displayed light; the linear picture is unchanged.
    pub fn set_exposure(&mut self, exposure: f32) {
        self.options.exposure = exposure;
        self.keys.display = self.keys.display.clone().exposed(exposure);
    }

    /// Splits the rows that are still to be drawn into bands of `rows`.
    pub fn set_band(&mut self, rows: u32) {
        let direct = self.request.settings.shadows.algorithm == ShadowAlgorithm::Direct;
        // Rays to each light from every sample take that much longer.
        let rows = if direct { (rows / DIRECT_COST).max(8) } else { rows.max(1) };
        let before = self.steps.len();
        cut_into_bands(&mut self.steps, rows);
        // Keeps the number of finished steps, so that progress stays correct.
        self.total = self.total - before + self.steps.len();
    }

    /// Submits the next step. Returns true if there are more; after the last one the new picture is the one that the
    /// renderer reads back.
    ///
    /// # Errors
    /// Returns the device's error.
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
