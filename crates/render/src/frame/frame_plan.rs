//! Frame planning: compares the keys of a picture with the cached products and lists the missing steps.

use std::borrow::Cow;
use std::sync::Arc;
use std::time::Instant;

use super::caches::light_volumes::LightEntries;
use super::caches::scattered_light_volumes::ScatteredLightEntry;
use super::caches::sky_volumes::SkyEntry;
use super::double_buffer::{TargetRole, display_key};
use super::loaded_volume::{LoadedVolume, ProductRequest};
use super::render_job::RenderJob;
use super::report::RenderReport;
use super::step::{FrameProduct, RenderStep, TransferSelector};
use crate::eye::eye_pass::EyePass;
use crate::eye::light_lookup::AmbientVolumes;
use crate::light::combined_light;
use crate::light::light_uniform::LightInput;
use crate::light::light_volume::LightVolume;
use crate::output::render_target::TargetShape;
use crate::plan::{ActiveLights, EyeKey, FloorKey, FrameKeys, LightKey, RenderRequest, SliceOrder};
use crate::resources::cache_entry::CacheEntry;
use crate::resources::gpu_tools::GpuTools;
use crate::scatter::eye::SLABS_PER_STEP;
use crate::scatter::voxels::ScatterState;
use crate::volume::preclassified::PreclassifiedVoxels;
use crate::volume::presence::PresenceTexture;
use crate::volume::transfer_tables::TransferTables;
use crate::volume::{GpuVolume, pyramid};
use crate::{GpuError, RenderOptions, Renderer};
use chiaroscuro_scene::{PixelFormat, SheetOrder};
use chiaroscuro_volume::Dataset;

impl Renderer {
    /// Returns true if a picture needs no more than a display pass.
    pub fn is_drawn(&self, request: &RenderRequest, options: &RenderOptions) -> bool {
        let keys = FrameKeys::new(request, options);
        let role = self.targets.find(&keys, target_shape(request, options));
        // Destructured without `..`, so that the compiler asks about each new product. The key of the eye covers
        // everything that its picture depends on.
        let FrameKeys {
            volume: _,
            tables: _,
            lights: _,
            combined: _,
            sky: _,
            bounces: _,
            eye: _,
            floor,
            display: _,
        } = &keys;
        role.is_some_and(|role| self.targets.get(role).floor.is_valid_for(floor))
    }

    /// Starts a picture: finds stale products and lists the steps.
    ///
    /// # Errors
    /// Returns an error if memory is exhausted; the displayed picture is kept.
    pub fn begin(
        &mut self,
        dataset: &Dataset,
        mut request: RenderRequest,
        options: &RenderOptions,
    ) -> Result<RenderJob<'_>, GpuError> {
        // Label settings are converted to transfer functions first, so that passes and keys need not know of labels.
        let converted = match request.settings.resolved_for(dataset.volume()) {
            Cow::Owned(drawn) => Some(drawn),
            Cow::Borrowed(_) => None,
        };
        if let Some(drawn) = converted {
            request.settings = drawn;
        }
        let mut keys = FrameKeys::new(&request, options);
        let lit = ActiveLights::from_settings(&request.settings);
        let shape = target_shape(&request, options);
        self.picture_count += 1;
        self.report = RenderReport { peak_gpu_bytes: self.report.peak_gpu_bytes, ..RenderReport::default() };
        self.fill_counts.resize(self.fill_counts.len().max(request.settings.lights.len()), 0);
        let mut steps = Vec::new();

        let loaded = match self.loaded.take() {
            Some(known) if known.is_valid_for(&keys.volume) && known.product.has_voxel_type_of(dataset) => {
                known
            }
            other => {
                if other.as_ref().is_some_and(|known| known.is_valid_for(&keys.volume)) {
                    // Equal numbers of another voxel type differ in the last bits.
                    self.targets.invalidate();
                }
                self.tools.pool.clear();
                let start = Instant::now();
                // Reuses parts of a volume whose picture was interrupted, or that shows another range of values.
                let known = other.filter(|known| {
                    known.key().content_id == keys.volume.content_id
                        && known.product.has_voxel_type_of(dataset)
                });
                let (known, presence) = known.map_or((None, None), |known| {
                    let presence = if known.is_complete() { known.product.volume.presence } else { None };
                    (Some(known.product.dataset), presence)
                });
                let known =
                    known.filter(|known| known.volume().density_mapping() == keys.volume.density_mapping);
                let dataset =
                    known.unwrap_or_else(|| dataset.with_density_mapping(keys.volume.density_mapping));
                let has_presence = presence.is_some();
                let (context, settings) = (&self.tools.context, &request.settings);
                let fresh = LoadedVolume::new(context, &dataset, settings, &keys.tables, presence)?;
                if !has_presence {
                    let slices = fresh.volume.presence.iter().flat_map(PresenceTexture::steps);
                    steps.extend(slices.map(RenderStep::Presence));
                }
                steps.extend(upload_steps(&fresh.volume));
                self.report.step_counts.tables = 2;
                self.report.tables_ms = start.elapsed().as_secs_f64() * 1000.0;
                CacheEntry::incomplete(keys.volume, fresh)
            }
        };
        let loaded = self.loaded.insert(loaded);

        let mut light_entries = LightEntries::default();
        let mut sky = SkyEntry::default();
        let mut bounces = ScatteredLightEntry::default();
        let mut scattering = None;
        let mut role = self.targets.find(&keys, shape);
        if role.is_none() || keys.floor.is_some() {
            let start = Instant::now();
            let baked =
                loaded.product.refresh_tables(&self.tools.context, &request.settings, &keys.tables)?;
            if baked > 0 {
                self.tools.pool.drop_bind_groups();
            }
            self.report.step_counts.tables += baked;
            loaded.product.refresh_materials(&self.tools.context, &request.settings)?;
            steps.extend(material_steps(&loaded.product.tables.product));
            self.report.tables_ms += start.elapsed().as_secs_f64() * 1000.0;
        }
        if role.is_none() {
            let wanted = ProductRequest {
                context: &self.tools.context,
                request: &request,
                options,
                keys: &keys,
                picture_number: self.picture_count,
            };
            light_entries = place_lights(&self.tools, &mut loaded.product, wanted)?;
            if light_entries.builds.is_empty() {
                self.tools.pool.drop_ring();
            }
            sky = loaded.product.find_or_create_sky(&self.tools, wanted)?;
            bounces = loaded.product.find_or_create_scattered_light(&self.tools, wanted)?;
            let ambient = (sky.key.as_ref(), bounces.key.as_ref());
            keys.eye = EyeKey::new(&request, options, &light_entries.keys, keys.combined.as_ref(), ambient);
            keys.floor = FloorKey::new(&request, &keys.eye);
            // A preview may find its light volumes at full resolution, and so a picture that is already drawn.
            role = self.targets.find(&keys, shape);
        }
        let is_floor_drawn = role.is_some_and(|role| self.targets.get(role).floor.is_valid_for(&keys.floor));
        if role.is_some() && !is_floor_drawn && keys.floor.is_some() {
            // The floor needs the sky volume, too, even if the rest is drawn.
            let now = self.picture_count;
            let wanted = ProductRequest {
                context: &self.tools.context,
                request: &request,
                options,
                keys: &keys,
                picture_number: now,
            };
            sky = loaded.product.find_or_create_sky(&self.tools, wanted)?;
            // Area lights also have floor shadow maps; for other lights rays are cast.
            let has_map = lit.shadowed().iter().any(|lit| lit.light.area.is_some());
            if has_map && keys.combined.is_none() {
                light_entries = place_lights(&self.tools, &mut loaded.product, wanted)?;
            }
        }
        let is_drawn = role.is_some();
        for (at, build) in light_entries.builds.iter().enumerate() {
            steps.extend(build.steps(at, options.work.light_parts.max(1)));
        }
        let role = if let Some(role) = role {
            role
        } else {
            steps.extend(combine_steps(light_entries.bricks_to_combine));
            if request.settings.uses_scattering_engine() {
                let voxels = loaded.product.scatter_voxels_for(&self.tools.context, &request.settings)?;
                scattering = Some(ScatterState::new(&self.tools.context, voxels));
            }
            self.targets.resize_back(&self.tools, shape)?;
            TargetRole::Back
        };
        steps.extend(sky.steps());
        steps.extend(bounces.steps());

        let value = &loaded.product;
        let volumes = light_inputs(&lit, &light_entries.slots, value);
        let window = options.sample_window(&request);
        let around = AmbientVolumes {
            sky: sky.slot.map(|slot| &value.skies[slot].product),
            bounces: bounces.slot.map(|slot| &value.bounces[slot].product),
        };
        let of_lights = |lights: &[LightInput<'_>]| {
            EyePass::new(&value.volume.scene, &request.settings, window, (lights, None, around), options)
        };
        let combine = light_entries.bricks_to_combine.is_some().then(|| of_lights(&volumes));
        let combined = value.combined.as_ref().filter(|_| keys.combined.is_some());
        let eye = match combined {
            Some(combined) => {
                let unshadowed = light_inputs_of(lit.unshadowed(), &[], value);
                let scene = &value.volume.scene;
                let lights = (&unshadowed[..], Some(&combined.product), around);
                EyePass::new(scene, &request.settings, window, lights, options)
            }
            None => of_lights(&volumes),
        };
        self.report.slabs = eye.slab_count();
        self.report.size = window.size;
        let looked_up = |inputs: &[LightInput<'_>]| {
            inputs.iter().filter_map(|input| input.volume).map(|volume| volume.divisor).max().unwrap_or(0)
        };
        self.report.light_divisor = if combined.is_some() { 0 } else { looked_up(&volumes) };

        let target = self.targets.get_mut(role);
        if !is_drawn {
            target.light.restart(Some(keys.eye.clone()));
            target.light.product.splat_counter =
                scattering.as_ref().map(|scattering| scattering.counter.clone());
            steps.extend(eye_steps(&value.volume, &eye, &request, scattering.is_some()));
            steps.push(RenderStep::Finish(FrameProduct::Picture));
        }
        if target.resize_floor(&self.tools.context, keys.floor.as_ref())? {
            self.tools.pool.drop_bind_groups();
        }
        if !target.floor.is_valid_for(&keys.floor) {
            target.floor.restart(keys.floor.clone());
            steps.push(RenderStep::Floor(0..shape.sample_size()[1]));
            steps.push(RenderStep::Finish(FrameProduct::Floor));
        }
        if !target.display.is_valid_for(&Some(display_key(&keys))) {
            steps.push(RenderStep::Display);
        }
        // Shows the target, even if nothing had to be drawn.
        steps.push(RenderStep::Finish(FrameProduct::Display));

        let bytes = self.targets.bytes() + value.bytes() + self.tools.pool.bytes();
        self.report.peak_gpu_bytes = self.report.peak_gpu_bytes.max(bytes);
        let total = steps.len();
        Ok(RenderJob {
            tools: &self.tools,
            gpu_clock: self.gpu_clock.as_ref(),
            loaded,
            targets: &mut self.targets,
            fill_counts: &mut self.fill_counts,
            report: &mut self.report,
            options: options.clone(),
            keys,
            lights: lit,
            light_indices: light_entries.slots,
            light_fills: light_entries.builds,
            sky,
            scattered_light: bounces,
            combine_pass: combine,
            eye_pass: eye,
            scattering,
            eye_sheets: None,
            role,
            steps: steps.into(),
            step_count: total,
            request,
        })
    }
}

/// Finds or creates the light volumes of a picture, recycling those of an interrupted one.
fn place_lights(
    tools: &GpuTools,
    loaded: &mut LoadedVolume,
    wanted: ProductRequest<'_>,
) -> Result<LightEntries, GpuError> {
    // Cached bind groups would keep the temporary volumes of the interrupted filling alive.
    let has_scratch = |key: &LightKey| key.samples() > 1 || key.has_colors();
    let is_half_filled = loaded.lights.iter().any(|light| !light.is_complete() && has_scratch(light.key()));
    let mut recyclable = loaded.take_incomplete();
    let placed = loaded.find_or_create_lights(wanted, &mut recyclable)?;
    if is_half_filled || !recyclable.is_empty() {
        drop(recyclable);
        tools.pool.drop_bind_groups();
    }
    Ok(placed)
}

/// Returns the steps that classify voxels.
fn material_steps(tables: &TransferTables) -> Vec<RenderStep> {
    let mut steps = Vec::new();
    let mut begun: Option<&Arc<PreclassifiedVoxels>> = None;
    for side in [TransferSelector::Eye, TransferSelector::Lighting] {
        let Some(materials) = &side.table(tables).materials else { continue };
        // Both tables usually share one set of voxels.
        if materials.is_complete() || begun.is_some_and(|begun| Arc::ptr_eq(begun, materials)) {
            continue;
        }
        steps.extend(materials.steps().map(|(level, bricks)| RenderStep::Materials(side, level, bricks)));
        steps.push(RenderStep::Finish(FrameProduct::Materials(side)));
        begun = Some(materials);
    }
    steps
}

/// Returns the shape of the target for a request.
fn target_shape(request: &RenderRequest, options: &RenderOptions) -> TargetShape {
    TargetShape {
        size: options.displayed_window(request).size,
        samples: options.picture.samples,
        is_deep: options.picture.depth != PixelFormat::Eight,
    }
}

/// Returns the lights of a picture, each with its volume.
pub(super) fn light_inputs<'a>(
    lit: &'a ActiveLights,
    slots: &[Option<usize>],
    loaded: &'a LoadedVolume,
) -> Vec<LightInput<'a>> {
    light_inputs_of(lit.all(), slots, loaded)
}

fn light_inputs_of<'a>(
    lights: &'a [crate::plan::ActiveLight],
    slots: &[Option<usize>],
    loaded: &'a LoadedVolume,
) -> Vec<LightInput<'a>> {
    let volume_of = |index: usize| -> Option<&'a LightVolume> {
        let slot = slots.get(index).copied().flatten()?;
        loaded.lights.get(slot).map(|light| &light.product)
    };
    lights.iter().map(|lit| LightInput { light: lit, volume: volume_of(lit.index) }).collect()
}

/// Returns the steps that upload a volume and compute its pyramid and gradients.
fn upload_steps(volume: &GpuVolume) -> Vec<RenderStep> {
    let slices = volume.volume.dims()[2];
    let each = volume.slices_per_step();
    let mut steps: Vec<_> =
        (0..slices).step_by(each).map(|first| RenderStep::Upload(first..slices.min(first + each))).collect();
    steps.extend(pyramid::steps(volume).map(|(level, bricks)| RenderStep::Pyramid(level, bricks)));
    if volume.gradients.is_some() {
        steps.extend(pyramid::steps(volume).map(|(level, bricks)| RenderStep::Gradients(level, bricks)));
    }
    steps.push(RenderStep::Finish(FrameProduct::Volume));
    steps
}

/// Returns the steps that fill the combined light volume.
fn combine_steps(bricks: Option<usize>) -> Vec<RenderStep> {
    let Some(bricks) = bricks else { return Vec::new() };
    let firsts = (0..bricks).step_by(combined_light::BRICKS_PER_STEP);
    let end = |first: usize| bricks.min(first + combined_light::BRICKS_PER_STEP);
    let mut steps: Vec<_> = firsts.map(|first| RenderStep::Combine(first..end(first))).collect();
    steps.push(RenderStep::Finish(FrameProduct::CombinedLight));
    steps
}

/// Returns the steps that draw the linear picture.
fn eye_steps(volume: &GpuVolume, eye: &EyePass, request: &RenderRequest, scatters: bool) -> Vec<RenderStep> {
    let frame = eye.frame();
    // If everything lies behind the eye there is no sheet; the gathering pass then clears the picture.
    if !scatters || frame.slab_count == 0 {
        return vec![RenderStep::Eye(0..frame.size[1])];
    }
    let count = match request.settings.sampling.order {
        SheetOrder::ImageAligned => frame.slab_count,
        SheetOrder::VolumeAligned | SheetOrder::EveryFootprint => {
            SliceOrder::new(frame, volume.volume.dims()).count
        }
    };
    let firsts = (0..count).step_by(SLABS_PER_STEP as usize);
    firsts.map(|k| RenderStep::ScatterEye(k..count.min(k + SLABS_PER_STEP))).collect()
}
