//! The work for one picture, cut into steps short enough for a watchdog and a waiting user.

use std::collections::VecDeque;
use std::ops::Range;

use crate::gpu::eye::gather::EyePass;
use crate::gpu::light::backproject::Schedule;
use crate::gpu::light::march::{SLABS_PER_TEXEL, Sheets};
use crate::gpu::light::raycast::BRICKS_PER_STEP;
use crate::gpu::light::volume::{LightVolume, read_bricks};
use crate::gpu::resources::listed_bricks::{Listed, listed};
use crate::gpu::scatter::eye::{EyeScatter, SLABS_PER_STEP};
use crate::gpu::scatter::light::LightScatter;
use crate::gpu::volume::GpuVolume;
use crate::model::{Light, ShadowAlgorithm};
use crate::plan::{BrickSet, LightKey, LightView, Request, light_views, reverse_reach};

/// Slabs per chunk of the light march: enough to be worth a dispatch, few enough for one to be short.
const CHUNK_SLABS: std::ops::RangeInclusive<u64> = 8..=64;

/// How many times longer a picture takes whose samples cast rays themselves, roughly: rows of a band
/// are fewer by so much.
const DIRECT_COST: u32 = 16;

/// What a step belongs to, for reports and for the status bar.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stage {
    /// Density, on its way to the GPU.
    Upload,
    /// The pyramid of prefiltered volumes.
    Pyramid,
    /// Sheets of a light.
    LightMarch,
    /// Sheets into the light volume.
    LightBackproject,
    /// Rays from the voxels of the light volume.
    LightRaycast,
    /// The picture.
    Eye,
    /// Its display colours.
    Display,
}

/// A piece of one half of a light pass.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct LightStep {
    /// Index of the light build …
    pub build: usize,
    /// … and of its view.
    pub view: usize,
    /// First slab of the chunk.
    pub begin: u32,
    /// Which part of the tiles or bricks, of how many.
    pub part: (u32, u32),
}

/// A piece of work for one submission.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Step {
    Upload(Range<usize>),
    /// Level, which of its bricks.
    Pyramid(u32, Range<usize>),
    /// Level, which of its bricks.
    Gradients(u32, Range<usize>),
    March(LightStep),
    Backproject(LightStep),
    /// Index of the light build, and which of its bricks.
    Raycast(usize, Range<usize>),
    Eye(Range<u32>),
    /// Rows of the floor.
    Ground(Range<u32>),
    /// Bricks of the volume into which all lights collapse: which of them.
    Collapse(Range<usize>),
    /// Slabs of the eye's scattered sheets.
    ScatterEye(Range<u32>),
    Display,
}

impl Step {
    pub(crate) fn stage(&self) -> Stage {
        match self {
            Self::Upload(_) => Stage::Upload,
            Self::Pyramid(..) | Self::Gradients(..) => Stage::Pyramid,
            Self::March(..) => Stage::LightMarch,
            Self::Backproject(..) | Self::Collapse(_) => Stage::LightBackproject,
            Self::Raycast(..) => Stage::LightRaycast,
            Self::Eye(_) | Self::ScatterEye(_) | Self::Ground(_) => Stage::Eye,
            Self::Display => Stage::Display,
        }
    }
}

/// One light volume to be filled.
#[derive(Debug)]
pub(crate) struct LightBuild {
    /// Index of the light in the settings, for counting.
    pub light: usize,
    /// The light itself, in the scene.
    pub lamp: Light,
    pub key: LightKey,
    /// Stacks of sheets, unless rays fill the volume …
    pub views: Vec<LightView>,
    /// … and slabs per chunk of each.
    pub chunks: Vec<u32>,
    /// Cells beyond those that the transfer functions show whose sheets will be read.
    pub reach: u8,
    /// Data bricks whose scattered sheets will be splatted back.
    pub read: Option<BrickSet>,
    /// Bricks around what is filled that are still to be lit fully.
    pub around: Vec<Listed>,
    /// Bricks of the light volume, for rays to fill or sums to be normalised in.
    pub bricks: Vec<Listed>,
    /// Sheets and schedule of the view that is being marched …
    pub current: Option<(Sheets, Schedule)>,
    /// … and what is scattered into them and back, if it is.
    pub scatter: Option<LightScatter>,
    /// Whether voxels are scattered.
    pub scatters: bool,
}

impl LightBuild {
    /// Lays out the filling of one light volume.
    pub(crate) fn new(
        volume: &GpuVolume,
        request: &Request,
        light: usize,
        fresh: &LightVolume,
        chunk: Option<u32>,
    ) -> Self {
        let settings = &request.settings;
        let shadows =
            crate::model::Shadows { resolution: fresh.key.resolution(), ..settings.shadows.clone() };
        let lamp = settings.lights[light].in_world(&settings.camera);
        let splats = shadows.algorithm == ShadowAlgorithm::Splat;
        let views = if splats { light_views(&lamp, &shadows, &volume.scene) } else { Vec::new() };
        let usual = |view| if settings.scatters() { SLABS_PER_STEP } else { chunk_slabs(volume, view) };
        // Whole texels of the ring.
        let whole = |chunk: u32| chunk.next_multiple_of(SLABS_PER_TEXEL);
        let chunks = views.iter().map(|view| whole(chunk.unwrap_or_else(|| usual(view)))).collect();
        let scatters = splats && settings.scatters();
        let read = scatters.then(|| read_bricks(volume, &fresh.filled, fresh.divisor, &views));
        let reach = fresh.reach.saturating_add(reverse_reach(&views, &volume.scene, fresh.divisor));
        let bricks = fresh.filled.bricks().map(listed).collect();
        Self {
            light,
            lamp,
            key: fresh.key.clone(),
            views,
            chunks,
            reach,
            read,
            around: fresh.dark_around(),
            bricks,
            current: None,
            scatter: None,
            scatters,
        }
    }

    /// The steps of build number `at`, each chunk of a view cut into `parts`.
    pub(crate) fn steps(&self, at: usize, parts: u32) -> Vec<Step> {
        // Scattered slabs are short enough, and not cut into pixels.
        let parts = if self.scatters { 1 } else { parts };
        let mut steps = Vec::new();
        for (view, chunk) in self.chunks.iter().enumerate() {
            for begin in (0..self.views[view].frame.slab_count).step_by(*chunk as usize) {
                let step = |part| LightStep { build: at, view, begin, part: (part, parts) };
                steps.extend((0..parts).map(|part| Step::March(step(part))));
                steps.extend((0..parts).map(|part| Step::Backproject(step(part))));
            }
        }
        if self.views.is_empty() {
            let count = self.bricks.len();
            // One step at least, which completes a light volume without bricks.
            let firsts = (0..count.max(1)).step_by(BRICKS_PER_STEP);
            steps.extend(firsts.map(|first| Step::Raycast(at, first..count.min(first + BRICKS_PER_STEP))));
        }
        steps
    }
}

/// Slabs per chunk so that the ring takes no more than two bytes per voxel of the volume.
fn chunk_slabs(volume: &GpuVolume, view: &LightView) -> u32 {
    let pixels = u64::from(view.frame.size[0]) * u64::from(view.frame.size[1]);
    // Two bytes each, too.
    let fits = volume.volume.voxel_count() as u64 / pixels.max(1);
    fits.clamp(*CHUNK_SLABS.start(), *CHUNK_SLABS.end()) as u32
}

/// The work for one picture.
#[derive(Debug)]
pub struct Job {
    pub(crate) request: Request,
    pub(crate) transparent: bool,
    /// Multiplies all light of what is shown.
    pub(crate) exposure: f32,
    /// Key of every light's volume in this picture; `None` for lights without.
    pub(crate) keys: Vec<Option<LightKey>>,
    pub(crate) builds: Vec<LightBuild>,
    /// Whether the picture takes all of it from one volume of colours.
    pub(crate) collapsed: bool,
    /// Set up when the first rows of the picture are drawn.
    pub(crate) eye: Option<EyePass>,
    /// Its sheets, if voxels are scattered.
    pub(crate) scatter: Option<EyeScatter>,
    pub(crate) steps: VecDeque<Step>,
    pub(crate) total: usize,
}

impl Job {
    /// What the picture is of.
    pub fn request(&self) -> &Request {
        &self.request
    }

    /// Share of the steps that are done.
    pub fn progress(&self) -> f32 {
        1.0 - self.steps.len() as f32 / self.total.max(1) as f32
    }

    /// What comes next; `None` when the picture is complete.
    pub fn stage(&self) -> Option<Stage> {
        self.steps.front().map(Step::stage)
    }

    /// Whether the picture is complete.
    pub fn is_done(&self) -> bool {
        self.steps.is_empty()
    }

    /// Multiplies all light of what is shown, as previews need it; the light itself stays as it is.
    pub fn set_exposure(&mut self, exposure: f32) {
        self.exposure = exposure;
    }

    /// Cuts the rows that are still to be drawn into bands of `rows`.
    pub fn set_band(&mut self, rows: u32) {
        let direct = self.request.settings.shadows.algorithm == ShadowAlgorithm::Direct;
        // A ray to each light from every sample: so much longer.
        let rows = if direct { (rows / DIRECT_COST).max(8) } else { rows.max(1) };
        let before = self.steps.len();
        let mut cut = VecDeque::with_capacity(before);
        for step in self.steps.drain(..) {
            match step {
                Step::Eye(range) => cut_rows(&mut cut, range, rows, Step::Eye),
                Step::Ground(range) => {
                    cut_rows(&mut cut, range, (rows / crate::gpu::eye::floor::COST).max(1), Step::Ground);
                }
                other => cut.push_back(other),
            }
        }
        // Progress counts what is left of what there is.
        self.total = self.total - before + cut.len();
        self.steps = cut;
    }
}

/// Adds bands of rows. Adjoining bands are joined again when the band grows.
fn cut_rows(steps: &mut VecDeque<Step>, range: Range<u32>, rows: u32, step: fn(Range<u32>) -> Step) {
    let Range { mut start, end } = range;
    if let Some(Step::Eye(last) | Step::Ground(last)) = steps.back()
        && steps.back() == Some(&step(last.clone()))
        && last.end == start
        && last.end - last.start < rows
    {
        start = last.start;
        steps.pop_back();
    }
    while start < end {
        steps.push_back(step(start..end.min(start + rows)));
        start += rows;
    }
}
