//! Recording of a job's steps into command buffers, in the order in which they run.

mod light;

use std::ops::Range;

use super::double_buffer::display_key;
use super::frame_plan::light_inputs;
use super::render_job::RenderJob;
use super::step::{FrameProduct, RenderStep};
use crate::GpuError;
use crate::eye::antialiasing::EdgeRays;
use crate::eye::floor;
use crate::eye::light_lookup::{AmbientVolumes, LightLookup};
use crate::eye::ray_target::RayTarget;
use crate::light::combined_light::CombinedLightShading;
use crate::output::display::record_display;
use crate::scatter::eye::EyeScatter;
use crate::scattered_light::fill::ScatteringInputs;
use crate::scattered_light::steps::ScatteringStep;
use crate::sky::volume::SkyVolume;
use crate::volume::brick_list::brick_entry;
use crate::volume::pyramid::gradients;
use crate::volume::{VolumeContext, pyramid};

impl RenderJob<'_> {
    /// Records one step into the encoder.
    pub(super) fn encode(
        &mut self,
        step: &RenderStep,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<(), GpuError> {
        let context = &self.tools.context;
        let volume = &self.loaded.product.volume;
        match step {
            RenderStep::Upload(slices) => {
                self.report.step_counts.volume += 1;
                volume.upload(context, slices.clone());
                Ok(())
            }
            RenderStep::Presence(observer, texels) => {
                self.report.step_counts.volume += 1;
                if let Some(presence) = &volume.presence {
                    presence.upload(context, &volume.volume, *observer, texels);
                }
                Ok(())
            }
            RenderStep::Pages => {
                self.report.step_counts.pages += 1;
                if let Some(pages) = &mut self.loaded.product.volume.pages {
                    pages.upload(context);
                }
                Ok(())
            }
            RenderStep::Pyramid(level, bricks) => {
                self.report.step_counts.volume += 1;
                pyramid::fill_pyramid(VolumeContext::new(self.tools, volume), *level, bricks, encoder)
            }
            RenderStep::Gradients(level, bricks) => {
                self.report.step_counts.volume += 1;
                gradients::fill_gradients(context, &self.tools.shaders, volume, *level, bricks, encoder)
            }
            RenderStep::Materials { side, level, bricks } => {
                self.report.step_counts.materials += 1;
                let Some(table) = side.table(&self.loaded.product.tables.product) else { return Ok(()) };
                let Some(materials) = &table.materials else { return Ok(()) };
                materials.fill(VolumeContext::new(self.tools, volume), &table.buffer, *level, bricks, encoder)
            }
            RenderStep::March(light) => self.encode_light(light, Self::march_view, encoder),
            RenderStep::Backproject(light) => self.encode_light(light, Self::backproject_view, encoder),
            RenderStep::Raycast(step) => self.encode_raycast(step, encoder),
            RenderStep::Average { build, color, point } => {
                self.encode_average(*build, *color, *point, encoder)
            }
            RenderStep::MergeColors(build) => self.encode_colors(*build, encoder),
            RenderStep::Combine(bricks) => self.encode_combine(bricks, encoder),
            RenderStep::SkyBlocks => self.encode_sky(None, encoder),
            RenderStep::SkyBatch(batch) => self.encode_sky(Some(*batch), encoder),
            RenderStep::ScatteredLight(step) => self.encode_bounce(*step, encoder),
            RenderStep::Eye(rows) => self.encode_eye(rows, encoder),
            RenderStep::Antialiasing(rows) => self.encode_antialiasing(rows, encoder),
            RenderStep::ScatterEye(slabs) => self.encode_scatter_eye(slabs, encoder),
            RenderStep::Floor(rows) => {
                self.report.step_counts.floor += 1;
                let target = self.targets.get(self.role);
                let picture = &target.linear_light(self.keys.antialiased.as_ref()).view;
                let floor = &target.floor.product.view;
                let gpu = VolumeContext::for_light(self.tools, volume);
                let lights = light_inputs(&self.lights, &self.light_indices, &self.loaded.product);
                let shadows: Vec<_> = lights.iter().map(|light| light.volume?.floor.as_ref()).collect();
                let inputs = floor::FloorInputs {
                    shadows: &shadows,
                    tables: &self.loaded.product.tables.product,
                    eye: self.floor_pass.as_ref().unwrap_or(&self.eye_pass),
                    lights: &self.lights,
                    settings: &self.request.settings,
                    options: &self.options,
                    sky: self.sky_volume().and_then(|volume| volume.floor.as_ref()),
                };
                floor::draw_floor(gpu, inputs, picture, floor, rows.clone(), encoder)
            }
            RenderStep::Display => {
                self.report.step_counts.display += 1;
                let target = self.targets.get(self.role);
                let light = &target.linear_light(self.keys.antialiased.as_ref()).view;
                let output = &self.request.settings.output;
                record_display(self.tools, output, &self.options, target, light, encoder)
            }
            RenderStep::Finish(_) => Ok(()),
        }
    }

    /// Processes the `Finish` steps at the front of the queue: marks their products as complete.
    pub(super) fn finish_products(&mut self) {
        while let Some(RenderStep::Finish(product)) = self.steps.front() {
            let target = self.targets.get_mut(self.role);
            match product {
                FrameProduct::Volume => self.loaded.mark_complete(),
                FrameProduct::Pyramid => {
                    if let Some(pyramid) = &mut self.loaded.product.volume.pyramid {
                        pyramid.mark_complete();
                    }
                }
                FrameProduct::Materials(side) => {
                    let table = side.table(&self.loaded.product.tables.product);
                    if let Some(materials) = table.and_then(|table| table.materials.as_ref()) {
                        materials.mark_complete();
                    }
                }
                FrameProduct::Light(build) => {
                    let build = &mut self.light_fills[*build];
                    self.loaded.product.lights.complete(build.cache_index).fill_time.finish();
                    let has_scratch = build.average.take().is_some() | build.colors.take().is_some();
                    if has_scratch {
                        self.tools.pool.drop_bind_groups();
                    }
                }
                FrameProduct::CombinedLight => {
                    if let Some(combined) = &mut self.loaded.product.combined {
                        combined.mark_complete();
                    }
                    let volumes: Vec<_> = self.light_keys();
                    self.loaded.product.drop_combined_lights(&volumes);
                    self.light_indices.clear();
                    self.tools.pool.drop_bind_groups();
                }
                FrameProduct::Sky => {
                    if let Some(slot) = self.sky.slot {
                        self.loaded.product.skies.complete(slot).fill_time.finish();
                    }
                    self.sky.build = None;
                    self.tools.pool.drop_bind_groups();
                }
                FrameProduct::ScatteredLight => {
                    if let Some(slot) = self.scattered_light.slot {
                        self.loaded.product.bounces.complete(slot).fill_time.finish();
                    }
                    self.scattered_light.build = None;
                    self.tools.pool.drop_bind_groups();
                }
                FrameProduct::Picture => target.light.mark_complete(),
                FrameProduct::Antialiasing => target.antialiased.mark_complete(),
                FrameProduct::Floor => target.floor.mark_complete(),
                FrameProduct::Display => {
                    target.display.restart(Some(display_key(&self.keys)));
                    target.display.mark_complete();
                    self.targets.show(self.role);
                }
            }
            self.steps.pop_front();
        }
    }

    /// Returns the keys of the light volumes of the picture.
    fn light_keys(&self) -> Vec<Option<crate::plan::LightKey>> {
        let lights = &self.loaded.product.lights;
        self.light_indices.iter().map(|slot| slot.map(|slot| lights[slot].key().clone())).collect()
    }

    fn encode_combine(
        &mut self,
        bricks: &Range<usize>,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<(), GpuError> {
        self.report.step_counts.combined_light += 1;
        let loaded = &self.loaded.product;
        let (Some(target), Some(pass)) = (&loaded.combined, &self.combine_pass) else { return Ok(()) };
        let lights = light_inputs(&self.lights, &self.light_indices, loaded);
        let list: Vec<_> = target.product.filled.cells.bricks().map(brick_entry).collect();
        let gpu = VolumeContext::new(self.tools, &loaded.volume);
        let shading = CombinedLightShading { eye: pass.uniform(), shading: pass.shading_variant() };
        target.product.fill(gpu, &loaded.tables.product, shading, &lights, &list[bricks.clone()], encoder)
    }

    /// Returns views of the light volumes that the picture looks up, in the order of its lights.
    fn light_views(&self) -> Vec<&wgpu::TextureView> {
        let loaded = &self.loaded.product;
        if self.keys.combined.is_some() {
            return loaded.combined.iter().map(|combined| &combined.product.view).collect();
        }
        light_inputs(&self.lights, &self.light_indices, loaded)
            .into_iter()
            .filter_map(|input| input.volume)
            .map(|volume| &volume.view)
            .collect()
    }

    fn encode_eye(&mut self, rows: &Range<u32>, encoder: &mut wgpu::CommandEncoder) -> Result<(), GpuError> {
        self.report.step_counts.eye += 1;
        let loaded = &self.loaded.product;
        let (gpu, tables) = (VolumeContext::new(self.tools, &loaded.volume), &loaded.tables.product);
        let target = self.targets.get(self.role);
        self.eye_pass.draw(
            gpu,
            tables,
            LightLookup { attenuation: &self.light_views(), ambient: self.ambient_volumes() },
            RayTarget {
                picture: &target.light.product.plane.view,
                earlier: &target.antialiased.product.sums.view,
                edges: &target.antialiased.product.edges,
            },
            rows.clone(),
            encoder,
        )
    }

    fn encode_antialiasing(
        &mut self,
        rows: &Range<u32>,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<(), GpuError> {
        self.report.step_counts.antialiasing += 1;
        let loaded = &self.loaded.product;
        let target = self.targets.get(self.role);
        let rays = EdgeRays {
            eye: &self.eye_pass,
            settings: &self.request.settings,
            count: self.options.rays_per_sample(&self.request),
        };
        rays.draw(
            VolumeContext::new(self.tools, &loaded.volume),
            &loaded.tables.product,
            LightLookup { attenuation: &self.light_views(), ambient: self.ambient_volumes() },
            (&target.light.product.plane.view, &target.antialiased.product),
            rows.clone(),
            encoder,
        )
    }

    fn encode_scatter_eye(
        &mut self,
        slabs: &Range<u32>,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<(), GpuError> {
        self.report.step_counts.eye += 1;
        let Some(scattering) = &self.scattering else { return Ok(()) };
        let loaded = &self.loaded.product;
        let (gpu, tables) = (VolumeContext::new(self.tools, &loaded.volume), &loaded.tables.product);
        let sheets = if let Some(sheets) = self.eye_sheets.take() {
            sheets
        } else {
            let settings = &self.request.settings;
            let fresh =
                EyeScatter::new(gpu, scattering, tables, self.eye_pass.frame(), settings, &self.options)?;
            let bytes = self.targets.bytes() + loaded.bytes() + self.tools.pool.bytes() + fresh.bytes();
            self.report.peak_gpu_bytes = self.report.peak_gpu_bytes.max(bytes);
            fresh
        };
        let picture = &self.targets.get(self.role).light.product.plane.view;
        let looked_up = LightLookup { attenuation: &self.light_views(), ambient: self.ambient_volumes() };
        sheets.draw(gpu, scattering, &self.eye_pass, tables, looked_up, picture, slabs.clone(), encoder)?;
        self.eye_sheets = Some(sheets);
        Ok(())
    }

    /// Returns the volume of sky visibility that the picture looks up.
    pub(super) fn sky_volume(&self) -> Option<&SkyVolume> {
        Some(&self.loaded.product.skies.get(self.sky.slot?)?.product)
    }

    /// Returns the volumes of sky visibility and scattered light that the picture looks up.
    fn ambient_volumes(&self) -> AmbientVolumes<'_> {
        let bounces = self.scattered_light.slot.and_then(|slot| self.loaded.product.bounces.get(slot));
        AmbientVolumes { sky: self.sky_volume(), bounces: bounces.map(|known| &known.product) }
    }

    /// Records a step of filling a volume of scattered light.
    fn encode_bounce(
        &mut self,
        step: ScatteringStep,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<(), GpuError> {
        if let Some(bounces) =
            self.scattered_light.slot.and_then(|slot| self.loaded.product.bounces.get_mut(slot))
        {
            bounces.product.fill_time.begin();
        }
        let loaded = &self.loaded.product;
        let Some(build) = &self.scattered_light.build else { return Ok(()) };
        let bytes = self.targets.bytes() + loaded.bytes() + self.tools.pool.bytes() + build.bytes();
        self.report.peak_gpu_bytes = self.report.peak_gpu_bytes.max(bytes);
        self.report.step_counts.bounces += u32::from(step == ScatteringStep::Blocks);
        let Some(volume) = self.ambient_volumes().bounces else { return Ok(()) };
        let gpu = VolumeContext::for_light(self.tools, &loaded.volume);
        let look = ScatteringInputs {
            tables: &loaded.tables.product,
            settings: &self.request.settings,
            lights: &self.lights,
        };
        build.record(gpu, look, volume, step, encoder)
    }

    /// Records a step of filling a volume of sky visibility: the blocks of extinction (`None`), or a batch of
    /// directions.
    pub(super) fn encode_sky(
        &mut self,
        batch: Option<usize>,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<(), GpuError> {
        if let Some(sky) = self.sky.slot.and_then(|slot| self.loaded.product.skies.get_mut(slot)) {
            sky.product.fill_time.begin();
        }
        let loaded = &self.loaded.product;
        let Some(build) = &self.sky.build else { return Ok(()) };
        let bytes = self.targets.bytes() + loaded.bytes() + self.tools.pool.bytes() + build.bytes();
        self.report.peak_gpu_bytes = self.report.peak_gpu_bytes.max(bytes);
        self.report.step_counts.sky += u32::from(batch.is_none());
        let Some(volume) = self.sky_volume() else { return Ok(()) };
        let gpu = VolumeContext::for_light(self.tools, &loaded.volume);
        let Some(batch) = batch else {
            let settings = &self.request.settings;
            return build.fill_blocks(gpu, &loaded.tables.product, settings, volume, encoder);
        };
        build.fill_batch(gpu, volume, batch, encoder)
    }
}
