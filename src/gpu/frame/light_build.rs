//! The filling of one light volume, laid out in steps.

use super::loaded::Wanted;
use super::step::{LightStep, Product, RaycastStep, Step};
use crate::gpu::GpuError;
use crate::gpu::light::average::Average;
use crate::gpu::light::backproject::Schedule;
use crate::gpu::light::colors::ColorPlanes;
use crate::gpu::light::march::{SLABS_PER_TEXEL, Sheets};
use crate::gpu::light::raycast::BRICKS_PER_STEP;
use crate::gpu::light::volume::{LightVolume, read_bricks};
use crate::gpu::resources::part::Part;
use crate::gpu::scatter::eye::SLABS_PER_STEP;
use crate::gpu::scatter::light::LightScatter;
use crate::gpu::volume::GpuVolume;
use crate::gpu::volume::listed_bricks::{Listed, listed};
use crate::model::{COLORS, SceneLight, ShadowAlgorithm, Shadows};
use crate::plan::{BrickSet, LightKey, LightView, light_views, reverse_reach};

/// Slabs per chunk of the light march: enough to be worth a dispatch, few enough for one to be short.
const CHUNK_SLABS: std::ops::RangeInclusive<u64> = 8..=64;

/// One light volume to be filled.
#[derive(Debug)]
pub(super) struct LightBuild {
    /// Index of the light in the settings, for counting.
    pub index: usize,
    /// Place of the volume among those that are kept.
    pub slot: usize,
    /// The point lights that stand for it; mostly the light itself.
    pub points: Vec<SceneLight>,
    /// The mean of their volumes in the making, if there are several.
    pub average: Option<Average>,
    /// The volumes of its colours in the making, where each is followed by itself.
    pub colors: Option<ColorPlanes>,
    /// Whether the volume is coarser than the settings ask for, as only previews have it.
    pub is_coarse: bool,
    /// Stacks of sheets, those of each point after those of the point before; none where rays fill the volume.
    pub views: Vec<BuildView>,
    /// Cells around what is filled that the way back from the sheets reads.
    pub reverse_reach: u8,
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

/// A stack of sheets.
#[derive(Debug)]
pub(super) struct BuildView {
    /// Number of the point that looks along it.
    pub point: usize,
    pub geometry: LightView,
    /// Slabs per chunk.
    pub chunk: u32,
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
    /// Lays out the filling of the volume of light `index` of a request, which has that key.
    ///
    /// # Errors
    /// When memory is out.
    pub(super) fn new(
        Wanted { context, request, options, .. }: Wanted<'_>,
        volume: &GpuVolume,
        index: usize,
        (key, fresh): (&LightKey, &LightVolume),
    ) -> Result<Self, GpuError> {
        let settings = &request.settings;
        let resolution = key.resolution();
        let shadows = Shadows { resolution, ..settings.shadows.clone() };
        let light = settings.lights[index].in_scene(&settings.camera);
        let is_coarse = LightKey::of(request, index).is_some_and(|full| full != *key);
        let splats = shadows.algorithm == ShadowAlgorithm::Splat;
        let scatters = splats && settings.scatters();
        let points = light.points(key.samples());
        let geometries: Vec<_> = points
            .iter()
            .map(|point| if splats { light_views(point, &shadows, &volume.scene) } else { Vec::new() })
            .collect();
        let all: Vec<_> = geometries.iter().flatten().cloned().collect();
        let chunk = |geometry: &LightView| {
            let usual = if scatters { SLABS_PER_STEP } else { chunk_slabs(volume, geometry) };
            // Whole texels of the ring.
            options.chunk.unwrap_or(usual).next_multiple_of(SLABS_PER_TEXEL)
        };
        let of_point = |(point, geometries): (usize, Vec<LightView>)| {
            let view = move |geometry| BuildView { point, chunk: chunk(&geometry), geometry };
            geometries.into_iter().map(view)
        };
        let average = (points.len() > 1).then(|| Average::new(context, fresh, points.len()));
        let reverse_reach = reverse_reach(&all, &volume.scene, fresh.divisor);
        Ok(Self {
            index,
            slot: 0,
            is_coarse,
            points,
            average: average.transpose()?,
            colors: fresh.has_colors().then(|| ColorPlanes::new(context, fresh)).transpose()?,
            read: scatters.then(|| read_bricks(volume, &fresh.filled, fresh.divisor, &all)),
            views: geometries.into_iter().enumerate().flat_map(of_point).collect(),
            reverse_reach,
            reach: fresh.reach.saturating_add(reverse_reach),
            margin: fresh.uncleared_margin(),
            bricks: fresh.filled.bricks().map(listed).collect(),
            current: None,
            scatters,
        })
    }

    /// The volume that a colour fills, or all of the light, where the light's own is `whole`.
    pub(super) fn of_color<'a>(&'a self, color: Option<usize>, whole: &'a LightVolume) -> &'a LightVolume {
        match (&self.colors, color) {
            (Some(planes), Some(color)) => planes.plane(color),
            _ => whole,
        }
    }

    /// The volume that the light of a point fills, or a colour of that, where the light's own is `whole`.
    pub(super) fn filled<'a>(
        &'a self,
        point: usize,
        color: Option<usize>,
        whole: &'a LightVolume,
    ) -> &'a LightVolume {
        match &self.average {
            Some(average) => average.point(point),
            None => self.of_color(color, whole),
        }
    }

    /// Bytes of what only the filling needs.
    pub(super) fn bytes(&self) -> u64 {
        self.average.as_ref().map_or(0, Average::bytes) + self.colors.as_ref().map_or(0, ColorPlanes::bytes)
    }

    /// The steps of build number `at`, each chunk of a view cut into `parts`.
    pub(super) fn steps(&self, at: usize, parts: u32) -> Vec<Step> {
        // Scattered slabs are short enough, and not cut into pixels; those of points of a light are many.
        let parts = if self.scatters || self.average.is_some() { 1 } else { parts };
        let mut steps = Vec::new();
        if self.colors.is_some() {
            for color in 0..COLORS {
                steps.extend(self.steps_of_color(at, Some(color), parts));
            }
            steps.push(Step::JoinColors(at));
        } else {
            steps.extend(self.steps_of_color(at, None, parts));
        }
        steps.push(Step::Finish(Product::Light(at)));
        steps
    }

    /// The steps that follow a colour, or all of the light.
    fn steps_of_color(&self, at: usize, color: Option<usize>, parts: u32) -> Vec<Step> {
        let mut steps = Vec::new();
        for point in 0..self.points.len() {
            let views = self.views.iter().enumerate().filter(|(_, view)| view.point == point);
            for (view, BuildView { geometry, chunk, .. }) in views {
                for begin in (0..geometry.frame.slab_count).step_by(*chunk as usize) {
                    let part = |index| Part { index, of: parts };
                    let step = |index| LightStep { build: at, color, view, begin, part: part(index) };
                    steps.extend((0..parts).map(|part| Step::March(step(part))));
                    steps.extend((0..parts).map(|part| Step::Backproject(step(part))));
                }
            }
            if self.views.is_empty() {
                let count = self.bricks.len();
                // One step at least, which begins a light volume without bricks.
                let firsts = (0..count.max(1)).step_by(BRICKS_PER_STEP);
                let bricks = |first: usize| first..count.min(first + BRICKS_PER_STEP);
                let step =
                    |first| Step::Raycast(RaycastStep { build: at, color, point, bricks: bricks(first) });
                steps.extend(firsts.map(step));
            }
            if self.average.as_ref().is_some_and(|average| average.is_due(point)) {
                steps.push(Step::Average { build: at, color, point });
            }
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
