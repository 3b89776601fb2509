//! Recording of a job's steps into command buffers, in the order in which they run.

mod light;

use std::ops::Range;

use super::job::Job;
use super::plan::inputs;
use super::step::{Product, Step};
use super::targets::shown_key;
use crate::gpu::GpuError;
use crate::gpu::bounces::build::Look;
use crate::gpu::bounces::steps::BounceStep;
use crate::gpu::eye::floor;
use crate::gpu::eye::looked_up::{Around, LookedUp};
use crate::gpu::output::display::display;
use crate::gpu::scatter::eye::EyeScatter;
use crate::gpu::sky::volume::SkyVolume;
use crate::gpu::volume::listed_bricks::listed;
use crate::gpu::volume::{Gpu, gradients, prefilter};

impl Job<'_> {
    /// Records one step into the encoder.
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
            Step::Raycast(step) => self.encode_raycast(step, encoder),
            Step::Average { build, color, point } => self.encode_average(*build, *color, *point, encoder),
            Step::JoinColors(build) => self.encode_colors(*build, encoder),
            Step::Combine(bricks) => self.encode_combine(bricks, encoder),
            Step::SkyBlocks => self.encode_sky(None, encoder),
            Step::SkyBatch(batch) => self.encode_sky(Some(*batch), encoder),
            Step::Bounce(step) => self.encode_bounce(*step, encoder),
            Step::Eye(rows) => self.encode_eye(rows, encoder),
            Step::ScatterEye(slabs) => self.encode_scatter_eye(slabs, encoder),
            Step::Floor(rows) => {
                self.report.runs.floor += 1;
                let target = self.targets.get(self.role);
                let (picture, floor) = (&target.light.value.plane.view, &target.floor.value.view);
                let gpu = Gpu::new(self.tools, volume);
                let lights = inputs(&self.lit, &self.slots, &self.loaded.value);
                let shadows: Vec<_> = lights.iter().map(|light| light.volume?.floor.as_ref()).collect();
                let inputs = floor::FloorInputs {
                    shadows: &shadows,
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

    /// Processes the `Finish` steps at the front of the queue: marks their products as complete.
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
                    let build = &mut self.builds[*build];
                    let light = &mut self.loaded.value.lights[build.slot];
                    light.value.fill.finish();
                    light.finish();
                    let has_scratch = build.average.take().is_some() | build.colors.take().is_some();
                    if has_scratch {
                        self.tools.pool.forget_groups();
                    }
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
                        let sky = &mut self.loaded.value.skies[slot];
                        sky.value.fill.finish();
                        sky.finish();
                    }
                    self.sky.build = None;
                    self.tools.pool.forget_groups();
                }
                Product::Bounces => {
                    if let Some(slot) = self.bounces.slot {
                        let bounces = &mut self.loaded.value.bounces[slot];
                        bounces.value.fill.finish();
                        bounces.finish();
                    }
                    self.bounces.build = None;
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

    /// Returns the keys of the light volumes of the picture.
    fn builds_keys(&self) -> Vec<Option<crate::plan::LightKey>> {
        let lights = &self.loaded.value.lights;
        self.slots.iter().map(|slot| slot.map(|slot| lights[slot].key().clone())).collect()
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

    /// Returns views of the light volumes that the picture looks up, in the order of its lights.
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
        self.eye.draw(
            gpu,
            tables,
            LookedUp { attenuation: &self.looked_up(), around: self.around() },
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
        let looked_up = LookedUp { attenuation: &self.looked_up(), around: self.around() };
        sheets.draw(gpu, scattering, &self.eye, tables, looked_up, picture, slabs.clone(), encoder)?;
        self.eye_sheets = Some(sheets);
        Ok(())
    }

    /// Returns the volume of sky visibility that the picture looks up.
    pub(super) fn sky_volume(&self) -> Option<&SkyVolume> {
        Some(&self.loaded.value.skies.get(self.sky.slot?)?.value)
    }

    /// Returns the volumes of sky visibility and scattered light that the picture looks up.
    fn around(&self) -> Around<'_> {
        let bounces = self.bounces.slot.and_then(|slot| self.loaded.value.bounces.get(slot));
        Around { sky: self.sky_volume(), bounces: bounces.map(|known| &known.value) }
    }

    /// Records a step of filling a volume of scattered light.
    fn encode_bounce(
        &mut self,
        step: BounceStep,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<(), GpuError> {
        if let Some(bounces) = self.bounces.slot.and_then(|slot| self.loaded.value.bounces.get_mut(slot)) {
            bounces.value.fill.begin();
        }
        let loaded = &self.loaded.value;
        let Some(build) = &self.bounces.build else { return Ok(()) };
        let bytes = self.targets.bytes() + loaded.bytes() + self.tools.pool.bytes() + build.bytes();
        self.report.peak_gpu_bytes = self.report.peak_gpu_bytes.max(bytes);
        self.report.runs.bounces += u32::from(step == BounceStep::Blocks);
        let Some(volume) = self.around().bounces else { return Ok(()) };
        let gpu = Gpu::new(self.tools, &loaded.volume);
        let look = Look { tables: &loaded.tables.value, settings: &self.request.settings, lit: &self.lit };
        build.record(gpu, look, volume, step, encoder)
    }

    /// Records a step of filling a volume of sky visibility: the blocks of extinction (`None`), or a batch of
    /// directions.
    pub(super) fn encode_sky(
        &mut self,
        batch: Option<usize>,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<(), GpuError> {
        if let Some(sky) = self.sky.slot.and_then(|slot| self.loaded.value.skies.get_mut(slot)) {
            sky.value.fill.begin();
        }
        let loaded = &self.loaded.value;
        let Some(build) = &self.sky.build else { return Ok(()) };
        let bytes = self.targets.bytes() + loaded.bytes() + self.tools.pool.bytes() + build.bytes();
        self.report.peak_gpu_bytes = self.report.peak_gpu_bytes.max(bytes);
        self.report.runs.sky += u32::from(batch.is_none());
        let Some(volume) = self.sky_volume() else { return Ok(()) };
        let gpu = Gpu::new(self.tools, &loaded.volume);
        let Some(batch) = batch else {
            let settings = &self.request.settings;
            return build.fill_blocks(gpu, &loaded.tables.value, settings, volume, encoder);
        };
        build.fill_batch(gpu, volume, batch, encoder)
    }
}
