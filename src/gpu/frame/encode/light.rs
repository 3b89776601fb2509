//! Recording of the light pass: march, back-projection, ray casting, averaging and merging of colours.

use crate::gpu::GpuError;
use crate::gpu::frame::job::Job;
use crate::gpu::frame::light_build::{BuildView, CurrentView, LightBuild};
use crate::gpu::frame::step::{LightStep, RaycastStep};
use crate::gpu::light::backproject::{Schedule, backproject};
use crate::gpu::light::floor_shadow::ViewOfPoint;
use crate::gpu::light::march::{Sheets, march, march_uniform};
use crate::gpu::light::raycast::raycast;
use crate::gpu::scatter::light::LightScatter;
use crate::gpu::volume::Gpu;
use crate::gpu::volume::transfer_tables::EVERYWHERE;

impl Job<'_> {
    /// Prepares the march through one view of a light.
    fn begin_view(
        &mut self,
        build: &LightBuild,
        (view, color): (usize, Option<usize>),
    ) -> Result<CurrentView, GpuError> {
        let settings = &self.request.settings;
        let BuildView { point, geometry, chunk } = &build.views[view];
        let loaded = &self.loaded.value;
        let (gpu, tables) = (Gpu::new(self.tools, &loaded.volume), &loaded.tables.value);
        let light = build.filled(*point, color, &loaded.lights[build.slot].value);
        let skips = self.options.empty_space_skipping;
        let reach = if skips { i32::from(build.reach) } else { EVERYWHERE };
        let mut sheets = Sheets::new(self.tools, geometry, *chunk, reach)?;
        sheets.min_transmittance = self.options.min_transmittance;
        // A volume at full resolution also serves pictures, so it is filled with the full reach.
        sheets.preview = self.options.preview && build.is_coarse;
        let mut bytes = self.targets.bytes() + loaded.bytes() + self.tools.pool.bytes();
        bytes += sheets.ring.bytes() + build.bytes();
        let scatter = match &self.scattering {
            Some(scattering) if build.scatters => {
                let read = build.read.as_ref().filter(|_| skips);
                let of_light = (settings, light);
                let fresh = LightScatter::new(
                    gpu,
                    scattering,
                    (tables, color),
                    geometry,
                    of_light,
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
        let beyond = if build.scatters || sheets.reach == EVERYWHERE {
            EVERYWHERE
        } else {
            i32::from(build.reverse_reach)
        };
        let has_floor = loaded.lights[build.slot].value.floor.is_some();
        let schedule = Schedule::new(scene, geometry, light, sheets.chunk, (beyond, has_floor));
        self.report.peak_gpu_bytes = self.report.peak_gpu_bytes.max(bytes);
        Ok(CurrentView { sheets, schedule, scatter })
    }

    /// Records the start of filling a light volume in the report and the counters.
    fn begin_light(&mut self, build: &LightBuild) {
        self.report.runs.light_volumes += 1;
        self.fills[build.index] += 1;
        self.loaded.value.lights[build.slot].value.begin();
    }

    /// Records a step of the march or of the back-projection (`half`).
    pub(super) fn encode_light(
        &mut self,
        step: &LightStep,
        half: fn(&mut Self, &mut LightBuild, &LightStep, &mut wgpu::CommandEncoder) -> Result<(), GpuError>,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<(), GpuError> {
        // Moved out of the job while `half` borrows both the build and the job.
        let mut builds = std::mem::take(&mut self.builds);
        let result = half(self, &mut builds[step.build], step, encoder);
        self.builds = builds;
        result
    }

    /// Takes the view that is being marched, prepared at its first step.
    fn take_view(
        &mut self,
        build: &mut LightBuild,
        view: (usize, Option<usize>),
    ) -> Result<CurrentView, GpuError> {
        match build.current.take() {
            Some(current) => Ok(current),
            None => self.begin_view(build, view),
        }
    }

    /// Marches the light of a view through a chunk of slabs.
    pub(super) fn march_view(
        &mut self,
        build: &mut LightBuild,
        &LightStep { color, view, begin, part, .. }: &LightStep,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<(), GpuError> {
        let is_first = color.unwrap_or(0) == 0 && view == 0 && begin == 0 && part.is_first();
        if is_first {
            let loaded = &self.loaded.value;
            let gpu = Gpu::new(self.tools, &loaded.volume);
            loaded.lights[build.slot].value.clear_margin(gpu, &build.margin, encoder)?;
            self.begin_light(build);
        }
        let current = self.take_view(build, (view, color))?;
        let CurrentView { sheets, schedule, scatter } = build.current.insert(current);
        let BuildView { point, geometry, chunk } = &build.views[view];
        let slabs = begin..(begin + chunk).min(geometry.frame.slab_count);
        let loaded = &self.loaded.value;
        let (gpu, tables) = (Gpu::new(self.tools, &loaded.volume), &loaded.tables.value);
        let lamp = (&build.points[*point], &self.request.settings);
        if let (Some(scatter), Some(scattering)) = (scatter, &self.scattering) {
            let table = &tables.met(color).buffer;
            scatter.march(gpu, scattering, table, lamp, geometry, sheets, slabs, encoder)
        } else {
            let tiles = schedule.tiles((slabs.start / sheets.chunk) as usize, part);
            march(gpu, (tables, color), lamp, geometry, sheets, slabs, tiles, encoder)
        }
    }

    /// Back-projects a chunk of a view's sheets into the grid.
    pub(super) fn backproject_view(
        &mut self,
        build: &mut LightBuild,
        &LightStep { color, view, begin, part, .. }: &LightStep,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<(), GpuError> {
        let current = self.take_view(build, (view, color))?;
        let shadows = &self.request.settings.shadows;
        let BuildView { point, geometry, chunk } = &build.views[view];
        let slabs = begin..(begin + chunk).min(geometry.frame.slab_count);
        let ends_view = slabs.end == geometry.frame.slab_count && part.is_last();
        let loaded = &self.loaded.value;
        let gpu = Gpu::new(self.tools, &loaded.volume);
        let whole = &loaded.lights[build.slot].value;
        let light = build.filled(*point, color, whole);
        let CurrentView { sheets, schedule, scatter } = &current;
        match scatter {
            // With first touch a voxel takes one deposit, so neither sums nor weights are needed.
            Some(scatter) if !shadows.first_touch => {
                scatter.splat_back(gpu, sheets, slabs, encoder)?;
                if ends_view {
                    scatter.normalise(gpu, light, &build.bricks, encoder)?;
                }
            }
            _ => backproject(gpu, shadows, geometry, (sheets, schedule), light, slabs, part, encoder)?,
        }
        if let Some(floor) = whole.floor.as_ref().filter(|_| ends_view) {
            let of = ViewOfPoint {
                point: &build.points[*point],
                geometry,
                index: view,
                count: build.views.len(),
                points: build.points.len(),
            };
            let cut = self.request.settings.cuts.shading().region(&gpu.volume.scene);
            let marched = march_uniform(of.point, &cut, geometry, sheets, 0..geometry.frame.slab_count);
            floor.add(gpu, of, (marched, sheets), encoder)?;
        }
        if ends_view {
            self.tools.pool.leave_ring(current.sheets.ring);
        } else {
            build.current = Some(current);
        }
        Ok(())
    }

    /// Records the rays to a light from some bricks.
    pub(super) fn encode_raycast(
        &mut self,
        RaycastStep { build: at, color, point, bricks }: &RaycastStep,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<(), GpuError> {
        let build = &self.builds[*at];
        let loaded = &self.loaded.value;
        let (gpu, tables) = (Gpu::new(self.tools, &loaded.volume), &loaded.tables.value);
        let whole = &loaded.lights[build.slot].value;
        let is_first = color.unwrap_or(0) == 0 && *point == 0 && bricks.start == 0;
        if is_first {
            whole.clear_margin(gpu, &build.margin, encoder)?;
        }
        let lamp = (&build.points[*point], &self.request.settings);
        let target = build.filled(*point, *color, whole);
        raycast(gpu, (tables, *color), lamp, &self.options, target, &build.bricks[bricks.clone()], encoder)?;
        if is_first {
            let builds = std::mem::take(&mut self.builds);
            self.begin_light(&builds[*at]);
            self.builds = builds;
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
        let build = &self.builds[at];
        let Some(average) = &build.average else { return Ok(()) };
        let loaded = &self.loaded.value;
        let whole = &loaded.lights[build.slot].value;
        let gpu = Gpu::new(self.tools, &loaded.volume);
        average.add(gpu, build.of_color(color, whole), point, &build.bricks, encoder)
    }

    /// Records the merging of the volumes of red, green and blue light.
    pub(super) fn encode_colors(
        &self,
        at: usize,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<(), GpuError> {
        let build = &self.builds[at];
        let Some(colors) = &build.colors else { return Ok(()) };
        let loaded = &self.loaded.value;
        let gpu = Gpu::new(self.tools, &loaded.volume);
        colors.join(gpu, &loaded.lights[build.slot].value, &build.bricks, encoder)
    }
}
