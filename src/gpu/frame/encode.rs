//! What each step of a job records: the frame's passes, in the order in which they run.

use std::ops::Range;

use super::job::{Job, LightStep, Stage, Step};
use crate::gpu::eye::floor as ground;
use crate::gpu::eye::gather::EyePass;
use crate::gpu::light::backproject::{Schedule, backproject};
use crate::gpu::light::march::{Sheets, march};
use crate::gpu::light::raycast::raycast;
use crate::gpu::light::volume::LightVolume;
use crate::gpu::output::display::display;
use crate::gpu::resources::listed_bricks::listed;
use crate::gpu::scatter::eye::EyeScatter;
use crate::gpu::scatter::light::LightScatter;
use crate::gpu::scatter::voxels::ScatterVoxels;
use crate::gpu::volume::Gpu;
use crate::gpu::volume::transfer_tables::{EVERYWHERE, Tables};
use crate::gpu::volume::{gradients, prefilter};
use crate::gpu::{GpuError, Renderer};
use crate::plan::reverse_reach;

/// What went away between `begin` and `step`.
fn out_of_date() -> GpuError {
    GpuError::Refused("the job is out of date".to_owned())
}

impl Renderer {
    /// Records one step.
    pub(crate) fn encode(
        &mut self,
        job: &mut Job,
        step: &Step,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<(), GpuError> {
        match step {
            Step::Upload(slices) => {
                self.volume.as_ref().ok_or_else(out_of_date)?.upload(&self.context, slices.clone());
                Ok(())
            }
            Step::Pyramid(level, bricks) => {
                let volume = self.volume.as_ref().ok_or_else(out_of_date)?;
                prefilter::fill(&self.context, &self.shaders, volume, *level, bricks, encoder)?;
                self.uploaded = job.steps.front().is_none_or(|next| next.stage() != Stage::Pyramid);
                Ok(())
            }
            Step::Gradients(level, bricks) => {
                let volume = self.volume.as_ref().ok_or_else(out_of_date)?;
                gradients::fill(&self.context, &self.shaders, volume, *level, bricks, encoder)?;
                self.uploaded = job.steps.front().is_none_or(|next| next.stage() != Stage::Pyramid);
                Ok(())
            }
            Step::March(light) => self.encode_march(job, light, encoder),
            Step::Backproject(light) => self.encode_backproject(job, light, encoder),
            Step::Raycast(build, bricks) => self.encode_raycast(job, *build, bricks, encoder),
            Step::Collapse(bricks) => self.encode_collapse(job, bricks, encoder),
            Step::Eye(_) | Step::ScatterEye(_) => self.encode_eye(job, step, encoder),
            Step::Ground(rows) => {
                let target = self.back.as_ref().ok_or_else(out_of_date)?;
                let (gpu, tables) = self.gpu()?;
                let eye = job.eye.as_ref().ok_or_else(out_of_date)?;
                let of = (eye, &job.request.settings);
                let views = (&target.picture_view, &target.floor_view);
                ground::draw(gpu, tables, of, &self.options, views, rows.clone(), encoder)
            }
            Step::Display => {
                let target = self.back.as_ref().ok_or_else(out_of_date)?;
                let output = &job.request.settings.output;
                let how = (&self.options, job.transparent, job.exposure);
                display((&self.context, &self.recycled), &self.shaders, output, how, target, encoder)
            }
        }
    }

    /// What all passes over the volume work with.
    pub(crate) fn gpu(&self) -> Result<(Gpu<'_>, &Tables), GpuError> {
        let (Some(volume), Some(tables)) = (&self.volume, &self.tables) else { return Err(out_of_date()) };
        let gpu = Gpu {
            context: &self.context,
            shaders: &self.shaders,
            volume,
            nothing: &self.nothing,
            recycled: &self.recycled,
        };
        Ok((gpu, tables))
    }

    /// What scattering passes work with besides.
    pub(crate) fn scattering(&self) -> Result<(&ScatterVoxels, &wgpu::Buffer), GpuError> {
        self.voxels.as_ref().zip(self.splats.as_ref()).ok_or_else(out_of_date)
    }

    fn encode_march(
        &mut self,
        job: &mut Job,
        LightStep { build, view, begin, part }: &LightStep,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<(), GpuError> {
        let settings = &job.request.settings;
        let build = &mut job.builds[*build];
        let (geometry, chunk) = (&build.views[*view], build.chunks[*view]);
        let (gpu, tables) = self.gpu()?;
        let mut peak = 0;
        if *begin == 0 && part.0 == 0 {
            let light = self.lights.iter().find(|light| light.key == build.key).ok_or_else(out_of_date)?;
            if *view == 0 {
                light.light_up(gpu, &build.around, encoder)?;
            }
            let reach = if self.options.leaping { i32::from(build.reach) } else { EVERYWHERE };
            let mut sheets = Sheets::new(&self.context, &self.recycled, geometry, chunk, reach)?;
            sheets.dark = self.options.dark;
            // A volume as pictures have it serves them, too.
            sheets.preview = self.options.preview && light.key.resolution() != settings.shadows.resolution;
            peak = self.gpu_bytes() + sheets.bytes();
            if build.scatters {
                let of_light = (settings, light);
                let (voxels, _) = self.scattering()?;
                let read = build.read.as_ref().filter(|_| self.options.leaping);
                let scatter =
                    LightScatter::new(gpu, voxels, tables, geometry, of_light, read, &self.options)?;
                peak += scatter.bytes();
                build.scatter = Some(scatter);
            }
            let scene = &gpu.volume.scene;
            // Scattered sheets are not marched in tiles.
            let beyond = match sheets.reach {
                _ if build.scatters => EVERYWHERE,
                EVERYWHERE => EVERYWHERE,
                _ => i32::from(reverse_reach(&build.views, scene, light.divisor)),
            };
            let schedule = Schedule::new(scene, geometry, light, (sheets.chunk, beyond));
            build.current = Some((sheets, schedule));
        }
        let Some((sheets, schedule)) = &build.current else { return Ok(()) };
        let slabs = *begin..(*begin + chunk).min(geometry.frame.slab_count);
        let lamp = (&build.lamp, settings);
        if let Some(scatter) = &build.scatter {
            let (voxels, counter) = self.scattering()?;
            scatter.march(
                gpu,
                voxels,
                counter,
                &tables.lighting.buffer,
                lamp,
                geometry,
                sheets,
                slabs,
                encoder,
            )?;
        } else {
            let tiles = schedule.tiles((slabs.start / sheets.chunk) as usize, *part);
            march(gpu, tables, lamp, geometry, sheets, ((slabs.start, slabs.end), tiles), encoder)?;
        }
        self.report.peak_gpu_bytes = self.report.peak_gpu_bytes.max(peak);
        if *begin == 0 && part.0 == 0 && *view == 0 {
            self.rebuilds[build.light] += 1;
            self.lights.iter_mut().filter(|light| light.key == build.key).for_each(LightVolume::begin);
        }
        Ok(())
    }

    fn encode_backproject(
        &mut self,
        job: &mut Job,
        LightStep { build, view, begin, part }: &LightStep,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<(), GpuError> {
        let shadows = &job.request.settings.shadows;
        let build = &mut job.builds[*build];
        let (geometry, chunk) = (&build.views[*view], build.chunks[*view]);
        let at = self.lights.iter().position(|light| light.key == build.key).ok_or_else(out_of_date)?;
        let light = &self.lights[at];
        let Some(current) = &build.current else { return Ok(()) };
        let slabs = *begin..(*begin + chunk).min(geometry.frame.slab_count);
        let ends_view = slabs.end == geometry.frame.slab_count && part.0 + 1 == part.1;
        let (gpu, _) = self.gpu()?;
        match &build.scatter {
            // The first sheet that touches a voxel needs no sums.
            Some(scatter) if !shadows.first_touch => {
                scatter.splat_back(gpu, &current.0, slabs, encoder)?;
                if ends_view {
                    scatter.normalise(gpu, light, &build.bricks, encoder)?;
                }
            }
            _ => {
                let slabs = ((slabs.start, slabs.end), *part);
                backproject(gpu, shadows, geometry, current, light, slabs, encoder)?;
            }
        }
        if ends_view {
            if let Some((sheets, _)) = build.current.take() {
                self.recycled.leave_sheets(sheets);
            }
            build.scatter = None;
        }
        if ends_view && view + 1 == build.views.len() {
            self.lights[at].finish();
        }
        Ok(())
    }

    fn encode_raycast(
        &mut self,
        job: &Job,
        build: usize,
        bricks: &Range<usize>,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<(), GpuError> {
        let build = &job.builds[build];
        let at = self.lights.iter().position(|light| light.key == build.key).ok_or_else(out_of_date)?;
        let (gpu, tables) = self.gpu()?;
        let list = &build.bricks[bricks.clone()];
        let lamp = (&build.lamp, &job.request.settings);
        if bricks.start == 0 {
            self.lights[at].light_up(gpu, &build.around, encoder)?;
        }
        raycast(gpu, tables, lamp, &self.options, &self.lights[at], list, encoder)?;
        if bricks.start == 0 {
            self.rebuilds[build.light] += 1;
            self.lights[at].begin();
        }
        if bricks.end == build.bricks.len() {
            self.lights[at].finish();
        }
        Ok(())
    }

    /// The volume of every light of a job.
    fn light_volumes(&self, job: &Job) -> Vec<Option<&LightVolume>> {
        let find =
            |key: &Option<_>| key.as_ref().and_then(|key| self.lights.iter().find(|light| light.key == *key));
        job.keys.iter().map(find).collect()
    }

    fn encode_collapse(
        &mut self,
        job: &Job,
        bricks: &Range<usize>,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<(), GpuError> {
        let found = self.light_volumes(job);
        let attenuation: Vec<_> = found.iter().flatten().map(|light| &light.view).collect();
        let (gpu, _) = self.gpu()?;
        let target = self.collapsed.as_ref().ok_or_else(out_of_date)?;
        let settings = &job.request.settings;
        let window = self.options.window(&job.request);
        let pass = EyePass::new(&gpu.volume.scene, settings, window, &found, None, &self.options);
        let list: Vec<_> = target.filled.bricks().map(listed).collect();
        target.fill(gpu, &pass, &attenuation, &list[bricks.clone()], encoder)?;
        let is_last = bricks.end == list.len();
        if is_last {
            if let Some(collapsed) = &mut self.collapsed {
                collapsed.complete = true;
            }
            self.forget_collapsed(&job.keys);
        }
        Ok(())
    }

    fn encode_eye(
        &mut self,
        job: &mut Job,
        step: &Step,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<(), GpuError> {
        let settings = &job.request.settings;
        let collapsed = self.collapsed.as_ref().filter(|_| job.collapsed);
        let found = if collapsed.is_some() { Vec::new() } else { self.light_volumes(job) };
        let mut attenuation: Vec<_> = found.iter().flatten().map(|light| &light.view).collect();
        attenuation.extend(collapsed.map(|light| &light.view));
        let target = self.back.as_ref().ok_or_else(out_of_date)?;
        let (gpu, tables) = self.gpu()?;
        let window = self.options.window(&job.request);
        let eye = job.eye.get_or_insert_with(|| {
            EyePass::new(&gpu.volume.scene, settings, window, &found, collapsed, &self.options)
        });
        let slabs = eye.slab_count();
        let size = window.size;
        let divisor = found.iter().flatten().map(|light| light.divisor).max().unwrap_or(0);
        let mut peak = 0;
        match step {
            Step::ScatterEye(range) => {
                let (voxels, counter) = self.scattering()?;
                if range.start == 0 {
                    let fresh = EyeScatter::new(gpu, voxels, tables, eye.frame(), settings, &self.options)?;
                    peak = self.gpu_bytes() + fresh.bytes();
                    job.scatter = Some(fresh);
                }
                let scatter = job.scatter.as_ref().ok_or_else(out_of_date)?;
                let picture = &target.picture_view;
                let range = range.clone();
                scatter.draw(gpu, voxels, counter, eye, tables, &attenuation, picture, range, encoder)?;
            }
            Step::Eye(rows) => {
                eye.draw(gpu, tables, &attenuation, &target.picture_view, rows.clone(), encoder)?;
            }
            _ => {}
        }
        self.report.slabs = slabs;
        (self.report.size, self.report.light_divisor) = (size, divisor);
        self.report.peak_gpu_bytes = self.report.peak_gpu_bytes.max(peak);
        Ok(())
    }
}
