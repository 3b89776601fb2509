//! Recording of the light pass: march, back-projection, ray casting, averaging and merging of colours.

use crate::GpuError;
use crate::frame::light_fill::{LightFill, LightFillView, MarchState};
use crate::frame::render_job::RenderJob;
use crate::frame::step::{LightStep, RaycastStep};
use crate::light::area_light::AreaLightAverage;
use crate::light::backproject::{ChunkSchedule, backproject};
use crate::light::fill_inputs::{LightTables, LightWithSettings};
use crate::light::floor_shadow::PointView;
use crate::light::march::{LightSheets, march, march_uniform};
use crate::light::raycast::raycast;
use crate::scatter::light::{LightScatterer, ScatterTarget};
use crate::volume::VolumeContext;
use crate::volume::transfer_tables::UNLIMITED_REACH;

impl RenderJob<'_> {
    /// Prepares the march through one view of a light.
    fn begin_view(
        &mut self,
        build: &LightFill,
        &LightStep { view, color, .. }: &LightStep,
    ) -> Result<MarchState, GpuError> {
        let settings = &self.request.settings;
        let LightFillView { point, geometry, chunk } = &build.views[view];
        let loaded = &self.loaded.product;
        let (gpu, tables) = (VolumeContext::for_light(self.tools, &loaded.volume), &loaded.tables.product);
        let light = build.target_volume(*point, color, &loaded.lights[build.cache_index].product);
        let skips = self.options.switches.empty_space_skipping;
        let reach = if skips { i32::from(build.reach) } else { UNLIMITED_REACH };
        let mut sheets = LightSheets::new(self.tools, geometry, *chunk, reach)?;
        sheets.min_transmittance = self.options.switches.min_transmittance;
        // A volume at full resolution also serves pictures, so it is filled with the full reach.
        sheets.is_preview = self.options.work.preview && build.is_coarse;
        let mut bytes = self.targets.bytes() + loaded.bytes() + self.tools.pool.bytes();
        bytes += sheets.ring.bytes() + build.bytes();
        let scatter = match &self.scattering {
            Some(scattering) if build.scatters => {
                let read = build.back_projected_bricks.as_ref().filter(|_| skips);
                let target = ScatterTarget { settings, light_volume: light };
                let fresh = LightScatterer::new(
                    gpu,
                    scattering,
                    LightTables { tables, color },
                    geometry,
                    target,
                    read,
                    &self.options,
                )?;
                bytes += fresh.bytes();
                Some(fresh)
            }
            _ => None,
        };
        let scene = &gpu.volume.scene;
        // Scattered sheets are not marched in tiles.
        let read_reach = if build.scatters || sheets.reach == UNLIMITED_REACH {
            UNLIMITED_REACH
        } else {
            i32::from(build.reverse_reach)
        };
        let has_floor = loaded.lights[build.cache_index].product.floor.is_some();
        let schedule = ChunkSchedule::new(scene, geometry, light, sheets.chunk, read_reach, has_floor);
        self.report.peak_gpu_bytes = self.report.peak_gpu_bytes.max(bytes);
        Ok(MarchState { sheets, schedule, scatter })
    }

    /// Records the start of filling a light volume in the report and the counters.
    fn begin_light(&mut self, build: &LightFill) {
        self.report.step_counts.light_volumes += 1;
        self.fill_counts[build.light_index] += 1;
        self.loaded.product.lights[build.cache_index].product.begin_filling();
    }

    /// Records a step of the march or of the back-projection (`half`).
    pub(super) fn encode_light(
        &mut self,
        step: &LightStep,
        half: fn(&mut Self, &mut LightFill, &LightStep, &mut wgpu::CommandEncoder) -> Result<(), GpuError>,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<(), GpuError> {
        // Moved out of the job while `half` borrows both the build and the job.
        let mut builds = std::mem::take(&mut self.light_fills);
        let result = half(self, &mut builds[step.build], step, encoder);
        self.light_fills = builds;
        result
    }

    /// Takes the view that is being marched, prepared at its first step.
    fn take_view(&mut self, build: &mut LightFill, step: &LightStep) -> Result<MarchState, GpuError> {
        match build.march_state.take() {
            Some(current) => Ok(current),
            None => self.begin_view(build, step),
        }
    }

    /// Marches the light of a view through a chunk of slabs.
    pub(super) fn march_view(
        &mut self,
        build: &mut LightFill,
        step: &LightStep,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<(), GpuError> {
        let &LightStep { color, view, begin, part, .. } = step;
        let is_first = color.unwrap_or(0) == 0 && view == 0 && begin == 0 && part.is_first();
        if is_first {
            let loaded = &self.loaded.product;
            let gpu = VolumeContext::for_light(self.tools, &loaded.volume);
            loaded.lights[build.cache_index].product.clear_margin(gpu, &build.margin, encoder)?;
            self.begin_light(build);
        }
        let current = self.take_view(build, step)?;
        let MarchState { sheets, schedule, scatter } = build.march_state.insert(current);
        let LightFillView { point, geometry, chunk } = &build.views[view];
        let slabs = begin..(begin + chunk).min(geometry.frame.slab_count);
        let loaded = &self.loaded.product;
        let (gpu, tables) = (VolumeContext::for_light(self.tools, &loaded.volume), &loaded.tables.product);
        let source = LightWithSettings { light: &build.points[*point], settings: &self.request.settings };
        if let (Some(scatter), Some(scattering)) = (scatter, &self.scattering) {
            let table = &tables.lighting_of_color(color).buffer;
            scatter.march(gpu, scattering, table, source, geometry, sheets, slabs, encoder)
        } else {
            let tiles = schedule.tiles((slabs.start / sheets.chunk) as usize, part);
            march(gpu, LightTables { tables, color }, source, geometry, sheets, slabs, tiles, encoder)
        }
    }

    /// Back-projects a chunk of a view's sheets into the grid.
    pub(super) fn backproject_view(
        &mut self,
        build: &mut LightFill,
        step: &LightStep,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<(), GpuError> {
        let &LightStep { color, view, begin, part, .. } = step;
        let current = self.take_view(build, step)?;
        let shadows = &self.request.settings.shadows;
        let LightFillView { point, geometry, chunk } = &build.views[view];
        let slabs = begin..(begin + chunk).min(geometry.frame.slab_count);
        let ends_view = slabs.end == geometry.frame.slab_count && part.is_last();
        let loaded = &self.loaded.product;
        let gpu = VolumeContext::for_light(self.tools, &loaded.volume);
        let light_volume = &loaded.lights[build.cache_index].product;
        let light = build.target_volume(*point, color, light_volume);
        let MarchState { sheets, schedule, scatter } = &current;
        match scatter {
            // With first touch a voxel takes one deposit, so neither sums nor weights are needed.
            Some(scatter) if !shadows.first_touch => {
                scatter.splat_back(gpu, sheets, slabs, encoder)?;
                if ends_view {
                    scatter.normalise(gpu, light, &build.bricks, encoder)?;
                }
            }
            _ => backproject(gpu, shadows, geometry, sheets, schedule, light, slabs, part, encoder)?,
        }
        if let Some(floor) = light_volume.floor.as_ref().filter(|_| ends_view) {
            let point_view = PointView {
                point: &build.points[*point],
                whole: &build.light,
                geometry,
                index: view,
                count: build.views.len(),
                points: build.points.len(),
            };
            let cut = self.request.settings.cuts.shadowing_part().region(&gpu.volume.scene);
            let marched =
                march_uniform(point_view.point, &cut, geometry, sheets, 0..geometry.frame.slab_count);
            floor.add_view(gpu, point_view, marched, sheets, encoder)?;
        }
        if ends_view {
            self.tools.pool.put_ring(current.sheets.ring);
        } else {
            build.march_state = Some(current);
        }
        Ok(())
    }

    /// Records the rays to a light from some bricks.
    pub(super) fn encode_raycast(
        &mut self,
        RaycastStep { build: at, color, point, bricks }: &RaycastStep,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<(), GpuError> {
        let build = &self.light_fills[*at];
        let loaded = &self.loaded.product;
        let (gpu, tables) = (VolumeContext::for_light(self.tools, &loaded.volume), &loaded.tables.product);
        let whole = &loaded.lights[build.cache_index].product;
        let is_first = color.unwrap_or(0) == 0 && *point == 0 && bricks.start == 0;
        if is_first {
            whole.clear_margin(gpu, &build.margin, encoder)?;
        }
        let source = LightWithSettings { light: &build.points[*point], settings: &self.request.settings };
        let target = build.target_volume(*point, *color, whole);
        raycast(
            gpu,
            LightTables { tables, color: *color },
            source,
            &self.options,
            target,
            &build.bricks[bricks.clone()],
            encoder,
        )?;
        if is_first {
            let builds = std::mem::take(&mut self.light_fills);
            self.begin_light(&builds[*at]);
            self.light_fills = builds;
        }
        Ok(())
    }

    /// Records the averaging of the latest batch of an area light's points.
    pub(super) fn encode_average(
        &self,
        at: usize,
        color: Option<usize>,
        point: usize,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<(), GpuError> {
        let build = &self.light_fills[at];
        let Some(average) = &build.average else { return Ok(()) };
        let loaded = &self.loaded.product;
        let whole = &loaded.lights[build.cache_index].product;
        let gpu = VolumeContext::for_light(self.tools, &loaded.volume);
        let is_first = color.unwrap_or(0) == 0 && AreaLightAverage::is_in_first_batch(point);
        if let Some(normals) = average.normals.as_ref().filter(|_| is_first) {
            let (tables, settings) = (&loaded.tables.product, &self.request.settings);
            normals.fill(gpu, tables, settings, build.light.density_scale, encoder)?;
        }
        average.add_batch(gpu, build.color_volume(color, whole), point, &build.bricks, encoder)
    }

    /// Records the merging of the volumes of red, green and blue light.
    pub(super) fn encode_colors(
        &self,
        at: usize,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<(), GpuError> {
        let build = &self.light_fills[at];
        let Some(colors) = &build.colors else { return Ok(()) };
        let loaded = &self.loaded.product;
        let gpu = VolumeContext::for_light(self.tools, &loaded.volume);
        colors.merge(gpu, &loaded.lights[build.cache_index].product, &build.bricks, encoder)
    }
}
