//! What each step of a job records: the frame's passes, in the order in which they run.

use std::ops::Range;

use super::job::Job;
use super::light_build::{CurrentView, LightBuild};
use super::plan::inputs;
use super::step::{LightStep, Product, Step};
use super::targets::shown_key;
use crate::gpu::GpuError;
use crate::gpu::eye::floor;
use crate::gpu::light::backproject::{Schedule, backproject};
use crate::gpu::light::march::{Sheets, march};
use crate::gpu::light::packed::LookedUp;
use crate::gpu::light::raycast::raycast;
use crate::gpu::output::display::display;
use crate::gpu::scatter::eye::EyeScatter;
use crate::gpu::scatter::light::LightScatter;
use crate::gpu::sky::volume::SkyVolume;
use crate::gpu::volume::listed_bricks::listed;
use crate::gpu::volume::transfer_tables::EVERYWHERE;
use crate::gpu::volume::{Gpu, gradients, prefilter};
use crate::plan::reverse_reach;

impl Job<'_> {
    /// Records one step.
    pub(super) fn encode(&mut self, step: &Step, encoder: &mut wgpu::CommandEncoder) -> Result<(), GpuError> {
        let context = &self.tools.context;
        let volume = &self.loaded.value.volume;
        match step {
            Step::Upload(slices) => {
                self.report.runs.volume += 1;
                volume.upload(context, slices.clone());
                Ok(())
            }
            Step::Presence(slices) => {
                self.report.runs.volume += 1;
                if let Some(presence) = &volume.presence {
                    presence.upload(context, &volume.volume, slices.clone());
                }
                Ok(())
            }
            Step::Pyramid(level, bricks) => {
                self.report.runs.volume += 1;
                prefilter::fill(context, &self.tools.shaders, volume, *level, bricks, encoder)
            }
            Step::Gradients(level, bricks) => {
                self.report.runs.volume += 1;
                gradients::fill(context, &self.tools.shaders, volume, *level, bricks, encoder)
            }
            Step::Materials(side, level, bricks) => {
                self.report.runs.materials += 1;
                let table = side.of(&self.loaded.value.tables.value);
                let Some(materials) = &table.materials else { return Ok(()) };
                materials.fill(Gpu::new(self.tools, volume), &table.buffer, *level, bricks, encoder)
            }
            Step::March(light) => self.encode_light(light, Self::march_view, encoder),
            Step::Backproject(light) => self.encode_light(light, Self::backproject_view, encoder),
            Step::Raycast(build, bricks) => self.encode_raycast(*build, bricks, encoder),
            Step::Combine(bricks) => self.encode_combine(bricks, encoder),
            Step::SkyBlocks => self.encode_sky(None, encoder),
            Step::SkyBatch(batch) => self.encode_sky(Some(*batch), encoder),
            Step::Eye(rows) => self.encode_eye(rows, encoder),
            Step::ScatterEye(slabs) => self.encode_scatter_eye(slabs, encoder),
            Step::Floor(rows) => {
                self.report.runs.floor += 1;
                let target = self.targets.get(self.role);
                let (picture, floor) = (&target.light.value.plane.view, &target.floor.value.view);
                let gpu = Gpu::new(self.tools, volume);
                let inputs = floor::FloorInputs {
                    tables: &self.loaded.value.tables.value,
                    eye: &self.eye,
                    lit: &self.lit,
                    settings: &self.request.settings,
                    options: &self.options,
                    sky: self.sky_volume().and_then(|volume| volume.floor.as_ref()),
                };
                floor::draw(gpu, inputs, picture, floor, rows.clone(), encoder)
            }
            Step::Display => {
                self.report.runs.display += 1;
                let target = self.targets.get(self.role);
                display(self.tools, &self.request.settings.output, &self.options, target, encoder)
            }
            Step::Finish(_) => Ok(()),
        }
    }

    /// Notes what is complete now.
    pub(super) fn finish_products(&mut self) {
        while let Some(Step::Finish(product)) = self.steps.front() {
            let target = self.targets.get_mut(self.role);
            match product {
                Product::Volume => self.loaded.finish(),
                Product::Materials(side) => {
                    if let Some(materials) = &side.of(&self.loaded.value.tables.value).materials {
                        materials.finish();
                    }
                }
                Product::Light(build) => {
                    let light = &mut self.loaded.value.lights[self.builds[*build].slot];
                    light.value.finish();
                    light.finish();
                }
                Product::CombinedLight => {
                    if let Some(combined) = &mut self.loaded.value.combined {
                        combined.finish();
                    }
                    let volumes: Vec<_> = self.builds_keys();
                    self.loaded.value.forget_combined(&volumes);
                    self.slots.clear();
                    self.tools.pool.forget_groups();
                }
                Product::Sky => {
                    if let Some(slot) = self.sky.slot {
                        self.loaded.value.skies[slot].finish();
                    }
                    self.sky.build = None;
                    self.tools.pool.forget_groups();
                }
                Product::Picture => target.light.finish(),
                Product::Floor => target.floor.finish(),
                Product::Shown => {
                    target.shown.restart(Some(shown_key(&self.keys)));
                    target.shown.finish();
                    self.targets.show(self.role);
                }
            }
            self.steps.pop_front();
        }
    }

    /// Keys of the volumes of its lights.
    fn builds_keys(&self) -> Vec<Option<crate::plan::LightKey>> {
        let lights = &self.loaded.value.lights;
        self.slots.iter().map(|slot| slot.map(|slot| lights[slot].key().clone())).collect()
    }

    /// Sets up the march through one view of a light.
    fn begin_view(&mut self, build: &LightBuild, view: usize) -> Result<CurrentView, GpuError> {
        let settings = &self.request.settings;
        let geometry = &build.views[view];
        let loaded = &self.loaded.value;
        let (gpu, tables) = (Gpu::new(self.tools, &loaded.volume), &loaded.tables.value);
        let light = &loaded.lights[build.slot].value;
        let skips = self.options.empty_space_skipping;
        let reach = if skips { i32::from(build.reach) } else { EVERYWHERE };
        let mut sheets = Sheets::new(self.tools, geometry, build.chunks[view], reach)?;
        sheets.min_transmittance = self.options.min_transmittance;
        // A volume as pictures have it serves them, too.
        sheets.preview = self.options.preview && build.is_coarse;
        let mut bytes = self.targets.bytes() + loaded.bytes() + self.tools.pool.bytes() + sheets.ring.bytes();
        let scatter = match &self.scattering {
            Some(scattering) if build.scatters => {
                let read = build.read.as_ref().filter(|_| skips);
                let of_light = (settings, light);
                let fresh =
                    LightScatter::new(gpu, scattering, tables, geometry, of_light, read, &self.options)?;
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
            i32::from(reverse_reach(&build.views, scene, light.divisor))
        };
        let schedule = Schedule::new(scene, geometry, light, sheets.chunk, beyond);
        self.report.peak_gpu_bytes = self.report.peak_gpu_bytes.max(bytes);
        Ok(CurrentView { sheets, schedule, scatter })
    }

    /// Notes that the filling of a light volume begins.
    fn begin_light(&mut self, build: &LightBuild) {
        self.report.runs.light_volumes += 1;
        self.fills[build.index] += 1;
        self.loaded.value.lights[build.slot].value.begin();
    }

    /// Records a step of one half of a light pass.
    fn encode_light(
        &mut self,
        step: &LightStep,
        half: fn(&mut Self, &mut LightBuild, &LightStep, &mut wgpu::CommandEncoder) -> Result<(), GpuError>,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<(), GpuError> {
        // Taken out meanwhile: a half changes its build and the job.
        let mut builds = std::mem::take(&mut self.builds);
        let result = half(self, &mut builds[step.build], step, encoder);
        self.builds = builds;
        result
    }

    /// The view that is being marched, set up when its first step comes.
    fn take_view(&mut self, build: &mut LightBuild, view: usize) -> Result<CurrentView, GpuError> {
        match build.current.take() {
            Some(current) => Ok(current),
            None => self.begin_view(build, view),
        }
    }

    fn march_view(
        &mut self,
        build: &mut LightBuild,
        &LightStep { view, begin, part, .. }: &LightStep,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<(), GpuError> {
        if view == 0 && begin == 0 && part.is_first() {
            let loaded = &self.loaded.value;
            let gpu = Gpu::new(self.tools, &loaded.volume);
            loaded.lights[build.slot].value.clear_margin(gpu, &build.margin, encoder)?;
            self.begin_light(build);
        }
        let chunk = build.chunks[view];
        let current = self.take_view(build, view)?;
        let CurrentView { sheets, schedule, scatter } = build.current.insert(current);
        let geometry = &build.views[view];
        let slabs = begin..(begin + chunk).min(geometry.frame.slab_count);
        let loaded = &self.loaded.value;
        let (gpu, tables) = (Gpu::new(self.tools, &loaded.volume), &loaded.tables.value);
        let lamp = (&build.light, &self.request.settings);
        if let (Some(scatter), Some(scattering)) = (scatter, &self.scattering) {
            let table = &tables.lighting.buffer;
            scatter.march(gpu, scattering, table, lamp, geometry, sheets, slabs, encoder)
        } else {
            let tiles = schedule.tiles((slabs.start / sheets.chunk) as usize, part);
            march(gpu, tables, lamp, geometry, sheets, slabs, tiles, encoder)
        }
    }

    fn backproject_view(
        &mut self,
        build: &mut LightBuild,
        &LightStep { view, begin, part, .. }: &LightStep,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<(), GpuError> {
        let current = self.take_view(build, view)?;
        let shadows = &self.request.settings.shadows;
        let geometry = &build.views[view];
        let slabs = begin..(begin + build.chunks[view]).min(geometry.frame.slab_count);
        let ends_view = slabs.end == geometry.frame.slab_count && part.is_last();
        let loaded = &self.loaded.value;
        let gpu = Gpu::new(self.tools, &loaded.volume);
        let light = &loaded.lights[build.slot].value;
        let CurrentView { sheets, schedule, scatter } = &current;
        match scatter {
            // The first sheet that touches a voxel needs no sums.
            Some(scatter) if !shadows.first_touch => {
                scatter.splat_back(gpu, sheets, slabs, encoder)?;
                if ends_view {
                    scatter.normalise(gpu, light, &build.bricks, encoder)?;
                }
            }
            _ => backproject(gpu, shadows, geometry, (sheets, schedule), light, slabs, part, encoder)?,
        }
        if ends_view {
            self.tools.pool.leave_ring(current.sheets.ring);
        } else {
            build.current = Some(current);
        }
        Ok(())
    }

    fn encode_raycast(
        &mut self,
        at: usize,
        bricks: &Range<usize>,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<(), GpuError> {
        let build = &self.builds[at];
        let loaded = &self.loaded.value;
        let (gpu, tables) = (Gpu::new(self.tools, &loaded.volume), &loaded.tables.value);
        let target = &loaded.lights[build.slot].value;
        if bricks.start == 0 {
            target.clear_margin(gpu, &build.margin, encoder)?;
        }
        let lamp = (&build.light, &self.request.settings);
        raycast(gpu, tables, lamp, &self.options, target, &build.bricks[bricks.clone()], encoder)?;
        if bricks.start == 0 {
            let builds = std::mem::take(&mut self.builds);
            self.begin_light(&builds[at]);
            self.builds = builds;
        }
        Ok(())
    }

    fn encode_combine(
        &mut self,
        bricks: &Range<usize>,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<(), GpuError> {
        self.report.runs.combined_light += 1;
        let loaded = &self.loaded.value;
        let (Some(target), Some(pass)) = (&loaded.combined, &self.combine) else { return Ok(()) };
        let lights = inputs(&self.lit, &self.slots, loaded);
        let list: Vec<_> = target.value.filled.bricks().map(listed).collect();
        let gpu = Gpu::new(self.tools, &loaded.volume);
        let shading = (pass.uniform(), pass.shading_variant());
        target.value.fill(gpu, &loaded.tables.value, shading, &lights, &list[bricks.clone()], encoder)
    }

    /// Views of the light volumes that the picture looks up, in the order of its lights.
    fn looked_up(&self) -> Vec<&wgpu::TextureView> {
        let loaded = &self.loaded.value;
        if self.keys.combined.is_some() {
            return loaded.combined.iter().map(|combined| &combined.value.view).collect();
        }
        inputs(&self.lit, &self.slots, loaded)
            .into_iter()
            .filter_map(|input| input.volume)
            .map(|volume| &volume.view)
            .collect()
    }

    fn encode_eye(&mut self, rows: &Range<u32>, encoder: &mut wgpu::CommandEncoder) -> Result<(), GpuError> {
        self.report.runs.eye += 1;
        let loaded = &self.loaded.value;
        let (gpu, tables) = (Gpu::new(self.tools, &loaded.volume), &loaded.tables.value);
        let picture = &self.targets.get(self.role).light.value.plane.view;
        let sky = self.sky_volume().map(|volume| &volume.view);
        self.eye.draw(
            gpu,
            tables,
            LookedUp { attenuation: &self.looked_up(), sky },
            picture,
            rows.clone(),
            encoder,
        )
    }

    fn encode_scatter_eye(
        &mut self,
        slabs: &Range<u32>,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<(), GpuError> {
        self.report.runs.eye += 1;
        let Some(scattering) = &self.scattering else { return Ok(()) };
        let loaded = &self.loaded.value;
        let (gpu, tables) = (Gpu::new(self.tools, &loaded.volume), &loaded.tables.value);
        let sheets = if let Some(sheets) = self.eye_sheets.take() {
            sheets
        } else {
            let settings = &self.request.settings;
            let fresh = EyeScatter::new(gpu, scattering, tables, self.eye.frame(), settings, &self.options)?;
            let bytes = self.targets.bytes() + loaded.bytes() + self.tools.pool.bytes() + fresh.bytes();
            self.report.peak_gpu_bytes = self.report.peak_gpu_bytes.max(bytes);
            fresh
        };
        let picture = &self.targets.get(self.role).light.value.plane.view;
        let sky = self.sky_volume().map(|volume| &volume.view);
        let looked_up = LookedUp { attenuation: &self.looked_up(), sky };
        sheets.draw(gpu, scattering, &self.eye, tables, looked_up, picture, slabs.clone(), encoder)?;
        self.eye_sheets = Some(sheets);
        Ok(())
    }

    /// The volume that the picture looks up.
    pub(super) fn sky_volume(&self) -> Option<&SkyVolume> {
        Some(&self.loaded.value.skies.get(self.sky.slot?)?.value)
    }

    /// Records a step of the filling: blocks first, or a batch of directions.
    pub(super) fn encode_sky(
        &mut self,
        batch: Option<usize>,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<(), GpuError> {
        let loaded = &self.loaded.value;
        let Some(build) = &self.sky.build else { return Ok(()) };
        let bytes = self.targets.bytes() + loaded.bytes() + self.tools.pool.bytes() + build.bytes();
        self.report.peak_gpu_bytes = self.report.peak_gpu_bytes.max(bytes);
        self.report.runs.sky += u32::from(batch.is_none());
        let Some(volume) = self.sky_volume() else { return Ok(()) };
        let gpu = Gpu::new(self.tools, &loaded.volume);
        let Some(batch) = batch else {
            let (settings, options) = (&self.request.settings, &self.options);
            return build.fill_blocks(gpu, &loaded.tables.value, settings, options, volume, encoder);
        };
        build.fill_batch(gpu, volume, batch, encoder)
    }
}
