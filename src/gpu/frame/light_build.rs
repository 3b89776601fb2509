//! The filling of one light volume, laid out in steps.

use super::step::{LightStep, Product, Step};
use crate::gpu::light::backproject::Schedule;
use crate::gpu::light::march::{SLABS_PER_TEXEL, Sheets};
use crate::gpu::light::raycast::BRICKS_PER_STEP;
use crate::gpu::light::volume::{LightVolume, read_bricks};
use crate::gpu::resources::part::Part;
use crate::gpu::scatter::eye::SLABS_PER_STEP;
use crate::gpu::scatter::light::LightScatter;
use crate::gpu::volume::GpuVolume;
use crate::gpu::volume::listed_bricks::{Listed, listed};
use crate::model::{Resolution, SceneLight, ShadowAlgorithm, Shadows};
use crate::plan::{BrickSet, LightView, Request, light_views, reverse_reach};

/// Slabs per chunk of the light march: enough to be worth a dispatch, few enough for one to be short.
const CHUNK_SLABS: std::ops::RangeInclusive<u64> = 8..=64;

/// One light volume to be filled.
#[derive(Debug)]
pub(super) struct LightBuild {
    /// Index of the light in the settings, for counting.
    pub index: usize,
    /// Place of the volume among those that are kept.
    pub slot: usize,
    /// The light itself.
    pub light: SceneLight,
    /// Whether the volume is coarser than the settings ask for, as only previews have it.
    pub is_coarse: bool,
    /// Stacks of sheets; none where rays fill the volume.
    pub views: Vec<LightView>,
    /// Slabs per chunk of each view.
    pub chunks: Vec<u32>,
    /// Cells beyond those that the transfer functions show whose sheets will be read.
    pub reach: u8,
    /// Data bricks whose scattered sheets will be splatted back.
    pub read: Option<BrickSet>,
    /// Bricks around what is filled that are still to be cleared.
    pub margin: Vec<Listed>,
    /// Bricks of the light volume, for rays to fill or sums to be normalised in.
    pub bricks: Vec<Listed>,
    /// The view that is being marched.
    pub current: Option<CurrentView>,
    /// Whether voxels are scattered.
    pub scatters: bool,
}

/// What the march through one view of a light works with.
#[derive(Debug)]
pub(super) struct CurrentView {
    pub sheets: Sheets,
    pub schedule: Schedule,
    /// What is scattered into the sheets and back, where voxels are scattered.
    pub scatter: Option<LightScatter>,
}

impl LightBuild {
    /// Lays out the filling of the volume of light `index` of a request.
    pub(super) fn new(
        volume: &GpuVolume,
        request: &Request,
        index: usize,
        fresh: &LightVolume,
        resolution: Resolution,
        chunk: Option<u32>,
    ) -> Self {
        let settings = &request.settings;
        let shadows = Shadows { resolution, ..settings.shadows.clone() };
        let light = settings.lights[index].in_scene(&settings.camera);
        let splats = shadows.algorithm == ShadowAlgorithm::Splat;
        let views = if splats { light_views(&light, &shadows, &volume.scene) } else { Vec::new() };
        let usual = |view| if settings.scatters() { SLABS_PER_STEP } else { chunk_slabs(volume, view) };
        // Whole texels of the ring.
        let whole = |chunk: u32| chunk.next_multiple_of(SLABS_PER_TEXEL);
        let chunks = views.iter().map(|view| whole(chunk.unwrap_or_else(|| usual(view)))).collect();
        let scatters = splats && settings.scatters();
        let read = scatters.then(|| read_bricks(volume, &fresh.filled, fresh.divisor, &views));
        let reach = fresh.reach.saturating_add(reverse_reach(&views, &volume.scene, fresh.divisor));
        Self {
            index,
            slot: 0,
            light,
            is_coarse: resolution != settings.shadows.resolution,
            views,
            chunks,
            reach,
            read,
            margin: fresh.uncleared_margin(),
            bricks: fresh.filled.bricks().map(listed).collect(),
            current: None,
            scatters,
        }
    }

    /// The steps of build number `at`, each chunk of a view cut into `parts`.
    pub(super) fn steps(&self, at: usize, parts: u32) -> Vec<Step> {
        // Scattered slabs are short enough, and not cut into pixels.
        let parts = if self.scatters { 1 } else { parts };
        let mut steps = Vec::new();
        for (view, chunk) in self.chunks.iter().enumerate() {
            for begin in (0..self.views[view].frame.slab_count).step_by(*chunk as usize) {
                let step = |index| LightStep { build: at, view, begin, part: Part { index, of: parts } };
                steps.extend((0..parts).map(|part| Step::March(step(part))));
                steps.extend((0..parts).map(|part| Step::Backproject(step(part))));
            }
        }
        if self.views.is_empty() {
            let count = self.bricks.len();
            // One step at least, which begins a light volume without bricks.
            let firsts = (0..count.max(1)).step_by(BRICKS_PER_STEP);
            steps.extend(firsts.map(|first| Step::Raycast(at, first..count.min(first + BRICKS_PER_STEP))));
        }
        steps.push(Step::Finish(Product::Light(at)));
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
