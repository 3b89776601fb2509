//! Filling of a light volume: its temporary resources and its steps.

use super::loaded_volume::ProductRequest;
use super::step::{FrameProduct, LightStep, RaycastStep, RenderStep};
use crate::GpuError;
use crate::light::area_light::AreaLightAverage;
use crate::light::backproject::ChunkSchedule;
use crate::light::block_normals::BlockNormals;
use crate::light::colored_shadows::ColorVolumes;
use crate::light::light_volume::{LightVolume, back_projected_bricks};
use crate::light::march::{LightSheets, SLABS_PER_TEXEL};
use crate::light::raycast::BRICKS_PER_STEP;
use crate::plan::{BrickSet, LightKey, LightView, light_views, reverse_reach};
use crate::resources::work_part::WorkPart;
use crate::scatter::eye::SLABS_PER_STEP;
use crate::scatter::light::LightScatterer;
use crate::volume::GpuVolume;
use crate::volume::brick_list::{BrickEntry, brick_entry};
use crate::volume::transfer_tables::TransferTables;
use chiaroscuro_scene::{LIGHT_COLORS, SceneLight, ShadowAlgorithm, ShadowSettings};

/// Range of slabs per chunk of the light march: enough to be worth a dispatch, few enough for a short one.
const CHUNK_SLABS: std::ops::RangeInclusive<u64> = 8..=64;

/// Work to fill one light volume.
#[derive(Debug)]
pub(crate) struct LightFill {
    /// Index of the light in the settings, for counting.
    pub light_index: usize,
    /// Index of the volume among the cached ones.
    pub cache_index: usize,
    /// Light in the scene.
    pub light: SceneLight,
    /// Point lights on an area light; the light itself if it has no size.
    pub points: Vec<SceneLight>,
    /// Temporary volumes for averaging, if there are several points.
    pub average: Option<AreaLightAverage>,
    /// Temporary volumes of red, green and blue light, for coloured shadows.
    pub colors: Option<ColorVolumes>,
    /// `true` if the volume is coarser than the settings ask for, as in previews.
    pub is_coarse: bool,
    /// Stacks of sheets in the order of the points; empty where rays fill the volume.
    pub views: Vec<LightFillView>,
    /// Reach of the back-projection, in cells around the filled ones.
    pub reverse_reach: u8,
    /// Distance from visible cells, in cells, up to which sheets are read.
    pub reach: u8,
    /// Data bricks whose scattered sheets are back-projected; `None` for the gathering engine.
    pub back_projected_bricks: Option<BrickSet>,
    /// Bricks of the margin that have yet to be cleared.
    pub margin: Vec<BrickEntry>,
    /// Bricks of the light volume, for ray casting, normalisation and averages; empty where none of these follows.
    pub bricks: Vec<BrickEntry>,
    /// View that is being marched.
    pub march_state: Option<MarchState>,
    /// `true` for the scattering engine.
    pub scatters: bool,
}

/// Stack of sheets seen from one point.
#[derive(Debug)]
pub(crate) struct LightFillView {
    /// Index of the point light.
    pub point: usize,
    pub geometry: LightView,
    /// Number of slabs per chunk.
    pub chunk: u32,
}

/// State of the march through one view of a light.
#[derive(Debug)]
pub(crate) struct MarchState {
    pub sheets: LightSheets,
    pub schedule: ChunkSchedule,
    /// Scattering state, for the scattering engine.
    pub scatter: Option<LightScatterer>,
}

impl LightFill {
    /// Plans the filling of the volume of light `index` of a request, with that key.
    ///
    /// # Errors
    /// Returns an error if memory is exhausted.
    pub(super) fn new(
        ProductRequest { context, request, options, .. }: ProductRequest<'_>,
        (volume, tables): (&GpuVolume, &TransferTables),
        index: usize,
        key: &LightKey,
        fresh: &LightVolume,
    ) -> Result<Self, GpuError> {
        let settings = &request.settings;
        let resolution = key.resolution();
        let shadows = ShadowSettings { resolution, ..settings.shadows.clone() };
        let light = settings.lights[index].resolve(&settings.camera);
        let is_coarse = LightKey::new(request, index).is_some_and(|full| full != *key);
        let splats = shadows.algorithm == ShadowAlgorithm::Splat;
        let scatters = splats && settings.uses_scattering_engine();
        let points = light.sample_lights(key.samples());
        let geometries: Vec<_> = points
            .iter()
            .map(|point| if splats { light_views(point, &shadows, &volume.scene) } else { Vec::new() })
            .collect();
        let all: Vec<_> = geometries.iter().flatten().cloned().collect();
        let chunk = |geometry: &LightView| {
            let usual = if scatters { SLABS_PER_STEP } else { chunk_slabs(volume, geometry) };
            // Rounded up to whole texels of the ring.
            options.switches.chunk.unwrap_or(usual).next_multiple_of(SLABS_PER_TEXEL)
        };
        let point_views = |(point, geometries): (usize, Vec<LightView>)| {
            let view = move |geometry| LightFillView { point, chunk: chunk(&geometry), geometry };
            geometries.into_iter().map(view)
        };
        let normals = || BlockNormals::new(context, volume, tables, options, fresh);
        let average = (points.len() > 1).then(|| {
            let normals = key.has_weighted_points().then(normals).transpose()?;
            AreaLightAverage::new(context, &light, key.samples(), fresh, normals)
        });
        let is_averaged = average.is_some() || fresh.has_colors();
        let bricks = if !splats || scatters || is_averaged {
            fresh.filled_cells.cells.bricks().map(brick_entry).collect()
        } else {
            Vec::new()
        };
        let reverse_reach = reverse_reach(&all, &volume.scene, fresh.divisor);
        Ok(Self {
            light_index: index,
            cache_index: 0,
            is_coarse,
            light,
            points,
            average: average.transpose()?,
            colors: fresh.has_colors().then(|| ColorVolumes::new(context, fresh)).transpose()?,
            back_projected_bricks: scatters
                .then(|| back_projected_bricks(volume, &fresh.filled_cells.cells, fresh.divisor, &all)),
            views: geometries.into_iter().enumerate().flat_map(point_views).collect(),
            reverse_reach,
            reach: fresh.reach.saturating_add(reverse_reach),
            margin: fresh.uncleared_margin(),
            bricks,
            march_state: None,
            scatters,
        })
    }

    /// Returns the volume to be filled for a colour; `whole` is the light's own volume, used for white light.
    pub(super) fn color_volume<'a>(
        &'a self,
        color: Option<usize>,
        whole: &'a LightVolume,
    ) -> &'a LightVolume {
        match (&self.colors, color) {
            (Some(planes), Some(color)) => planes.volume(color),
            _ => whole,
        }
    }

    /// Returns the volume to be filled for a point and a colour; `whole` is the light's own volume.
    pub(super) fn target_volume<'a>(
        &'a self,
        point: usize,
        color: Option<usize>,
        whole: &'a LightVolume,
    ) -> &'a LightVolume {
        match &self.average {
            Some(average) => average.point_volume(point),
            None => self.color_volume(color, whole),
        }
    }

    /// Returns the size of the temporary volumes, in bytes.
    pub(super) fn bytes(&self) -> u64 {
        self.average.as_ref().map_or(0, AreaLightAverage::bytes)
            + self.colors.as_ref().map_or(0, ColorVolumes::bytes)
    }

    /// Returns the steps of build number `at`, with each chunk of a view split into `parts`.
    pub(super) fn steps(&self, at: usize, parts: u32) -> Vec<RenderStep> {
        // Scattered slabs are short enough and cannot be split by pixels; the points of an area light are many short
        // views.
        let parts = if self.scatters || self.average.is_some() { 1 } else { parts };
        let mut steps = Vec::new();
        if self.colors.is_some() {
            for color in 0..LIGHT_COLORS {
                steps.extend(self.color_steps(at, Some(color), parts));
            }
            steps.push(RenderStep::MergeColors(at));
        } else {
            steps.extend(self.color_steps(at, None, parts));
        }
        steps.push(RenderStep::Finish(FrameProduct::Light(at)));
        steps
    }

    /// Returns the steps for one colour, or for white light.
    fn color_steps(&self, at: usize, color: Option<usize>, parts: u32) -> Vec<RenderStep> {
        let mut steps = Vec::new();
        for point in 0..self.points.len() {
            let views = self.views.iter().enumerate().filter(|(_, view)| view.point == point);
            for (view, LightFillView { geometry, chunk, .. }) in views {
                for begin in (0..geometry.frame.slab_count).step_by(*chunk as usize) {
                    let part = |index| WorkPart { index, count: parts };
                    let step = |index| LightStep { build: at, color, view, begin, part: part(index) };
                    steps.extend((0..parts).map(|part| RenderStep::March(step(part))));
                    steps.extend((0..parts).map(|part| RenderStep::Backproject(step(part))));
                }
            }
            if self.views.is_empty() {
                let count = self.bricks.len();
                // At least one step, which starts a light volume without bricks.
                let firsts = (0..count.max(1)).step_by(BRICKS_PER_STEP);
                let bricks = |first: usize| first..count.min(first + BRICKS_PER_STEP);
                let step = |first| {
                    RenderStep::Raycast(RaycastStep { build: at, color, point, bricks: bricks(first) })
                };
                steps.extend(firsts.map(step));
            }
            if self.average.as_ref().is_some_and(|average| average.ends_batch(point)) {
                steps.push(RenderStep::Average { build: at, color, point });
            }
        }
        steps
    }
}

/// Returns the number of slabs per chunk with which the ring takes at most two bytes per voxel of the volume.
fn chunk_slabs(volume: &GpuVolume, view: &LightView) -> u32 {
    let pixels = u64::from(view.frame.size[0]) * u64::from(view.frame.size[1]);
    // A slab's pixel takes two bytes, too.
    let fits = volume.volume.voxel_count() as u64 / pixels.max(1);
    fits.clamp(*CHUNK_SLABS.start(), *CHUNK_SLABS.end()) as u32
}
