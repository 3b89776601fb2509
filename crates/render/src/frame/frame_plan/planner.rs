//! Planner: the placement of the light volumes of one picture, and its steps.

use std::time::Instant;

use super::light_inputs::{light_inputs, light_inputs_of};
use super::steps::{combine_steps, eye_steps, material_steps};
use crate::context::gpu_clock::GpuClock;
use crate::eye::eye_pass::{EyeLights, EyePass};
use crate::eye::light_lookup::AmbientVolumes;
use crate::frame::caches::placement::VolumePlacement;
use crate::frame::double_buffer::{DoubleBuffer, TargetRole, display_key};
use crate::frame::loaded_volume::{LoadedVolume, ProductRequest};
use crate::frame::render_job::RenderJob;
use crate::frame::report::RenderReport;
use crate::frame::step::{FrameProduct, RenderStep};
use crate::light::light_uniform::LightInput;
use crate::output::render_target::TargetShape;
use crate::pipelines::shader_library::PipelinePreparation;
use crate::plan::{
    ActiveLights, AntialiasedKey, EyeKey, FloorKey, FrameKeys, PagedView, RenderRequest, VolumeKey,
};
use crate::resources::cache_entry::CacheEntry;
use crate::resources::gpu_tools::GpuTools;
use crate::scatter::voxels::ScatterState;
use crate::{GpuError, RenderOptions};

/// Plan of one picture while it is made: parts of the renderer, inputs, and the steps so far.
#[derive(Debug)]
pub(super) struct FramePlanner<'r> {
    pub tools: &'r GpuTools,
    pub gpu_clock: Option<&'r GpuClock>,
    pub loaded: &'r mut CacheEntry<VolumeKey, LoadedVolume>,
    pub targets: &'r mut DoubleBuffer,
    pub fill_counts: &'r mut Vec<u64>,
    pub report: &'r mut RenderReport,
    pub picture_number: u64,
    pub request: RenderRequest,
    pub options: RenderOptions,
    pub keys: FrameKeys,
    pub lights: ActiveLights,
    pub shape: TargetShape,
    /// Target that already holds the linear light of the picture, if any.
    pub drawn_in: Option<TargetRole>,
    pub steps: Vec<RenderStep>,
}

/// Shading parameters of a picture.
#[derive(Debug)]
struct ShadingPasses {
    eye: EyePass,
    /// Pass with the volume of each light, if the combined volume has to be filled.
    combine: Option<EyePass>,
    /// Pass without pages of finer levels, if the eye's has some.
    floor: Option<EyePass>,
}

impl<'r> FramePlanner<'r> {
    /// Finds or creates the volumes of light that the picture looks up. Its keys become those of the volumes in use,
    /// with which it may turn out to be drawn already.
    pub(super) fn place_volumes(&mut self) -> Result<VolumePlacement, GpuError> {
        if self.casts_eye_rays() || self.keys.floor.is_some() {
            self.refresh_tables()?;
        }
        let mut placement = VolumePlacement::default();
        if self.casts_eye_rays() {
            let wanted = ProductRequest {
                context: &self.tools.context,
                request: &self.request,
                options: &self.options,
                keys: &self.keys,
                picture_number: self.picture_number,
            };
            placement = VolumePlacement::new(self.tools, &mut self.loaded.product, wanted)?;
            let (sky, bounces) = (placement.sky.key.as_ref(), placement.bounces.key.as_ref());
            let combined = self.keys.combined.as_ref();
            let eye =
                EyeKey::new(&self.request, &self.options, &placement.lights.keys, combined, sky, bounces);
            self.keys.antialiased = AntialiasedKey::new(&self.request, &self.options, &eye);
            self.keys.floor = FloorKey::new(&self.request, &self.options, &eye);
            self.keys.eye = eye;
            // A preview may find its light volumes at full resolution, and so a picture that is already drawn.
            self.drawn_in = self.targets.find(&self.keys, self.shape);
        }
        let has_stale_floor = |role: TargetRole| !self.targets.get(role).floor.is_valid_for(&self.keys.floor);
        if self.keys.floor.is_some() && self.drawn_in.is_some_and(has_stale_floor) {
            let wanted = ProductRequest {
                context: &self.tools.context,
                request: &self.request,
                options: &self.options,
                keys: &self.keys,
                picture_number: self.picture_number,
            };
            placement.place_for_floor(self.tools, &mut self.loaded.product, wanted, &self.lights)?;
        }
        Ok(placement)
    }

    /// Returns true if rays of the eye are missing: the picture's, or those of its antialiasing.
    fn casts_eye_rays(&self) -> bool {
        let antialiased = &self.keys.antialiased;
        self.drawn_in.is_none_or(|role| {
            antialiased.is_some() && !self.targets.get(role).antialiased.is_valid_for(antialiased)
        })
    }

    /// Updates the transfer tables and the classified voxels.
    fn refresh_tables(&mut self) -> Result<(), GpuError> {
        let start = Instant::now();
        let (context, settings) = (&self.tools.context, &self.request.settings);
        let baked = self.loaded.product.refresh_tables(context, settings, &self.keys.tables)?;
        if self.loaded.product.refresh_page_table(context) || baked > 0 {
            self.tools.pool.drop_bind_groups();
        }
        self.report.step_counts.tables += baked;
        self.loaded.product.refresh_materials(context, settings)?;
        self.steps.extend(material_steps(&self.loaded.product.tables.product));
        self.report.tables_ms += start.elapsed().as_secs_f64() * 1000.0;
        Ok(())
    }

    /// Lists the steps that are left, with volumes of light in these places.
    pub(super) fn into_job(mut self, placement: VolumePlacement) -> Result<RenderJob<'r>, GpuError> {
        let light_parts = self.options.work.light_parts.max(1);
        for (at, build) in placement.lights.builds.iter().enumerate() {
            self.steps.extend(build.steps(at, light_parts));
        }
        self.steps.extend(combine_steps(placement.lights.bricks_to_combine));
        let mut scattering = None;
        if self.drawn_in.is_none() {
            let settings = &self.request.settings;
            if settings.uses_scattering_engine() {
                let voxels = self.loaded.product.scatter_voxels_for(&self.tools.context, settings)?;
                scattering = Some(ScatterState::new(&self.tools.context, voxels));
            }
            self.targets.resize_back(self.tools, self.shape)?;
        }
        self.steps.extend(placement.sky.steps());
        self.steps.extend(placement.bounces.steps());
        let passes = self.shading_passes(&placement);
        let role = self.append_picture_steps(&passes.eye, scattering.as_ref())?;
        // The largest shader is compiled while light is computed.
        let is_gathered = self.drawn_in.is_none() && scattering.is_none();
        let eye_preparation = is_gathered.then(|| self.prepare_eye(&passes.eye)).flatten();
        let bytes = self.targets.bytes() + self.loaded.product.bytes() + self.tools.pool.bytes();
        self.report.peak_gpu_bytes = self.report.peak_gpu_bytes.max(bytes);
        Ok(RenderJob {
            tools: self.tools,
            gpu_clock: self.gpu_clock,
            loaded: self.loaded,
            targets: self.targets,
            fill_counts: self.fill_counts,
            report: self.report,
            options: self.options,
            keys: self.keys,
            lights: self.lights,
            light_indices: placement.lights.slots,
            light_fills: placement.lights.builds,
            sky: placement.sky,
            scattered_light: placement.bounces,
            combine_pass: passes.combine,
            eye_pass: passes.eye,
            floor_pass: passes.floor,
            _eye_preparation: eye_preparation,
            scattering,
            eye_sheets: None,
            role,
            step_count: self.steps.len(),
            submitted: None,
            steps: self.steps.into(),
            request: self.request,
        })
    }

    /// Starts to compile the pipeline of the eye pass, if it is missing.
    fn prepare_eye(&self, eye: &EyePass) -> Option<PipelinePreparation> {
        let LoadedVolume { volume, tables, .. } = &self.loaded.product;
        self.tools.shaders.prepare(&eye.pipeline_variant(volume, &tables.product))
    }

    /// Prepares the shading of the picture's lights, and reports its size.
    fn shading_passes(&mut self, placement: &VolumePlacement) -> ShadingPasses {
        let (value, settings) = (&self.loaded.product, &self.request.settings);
        let volumes = light_inputs(&self.lights, &placement.lights.slots, value);
        let window = self.options.sample_window(&self.request);
        let ambient = AmbientVolumes {
            sky: placement.sky.slot.map(|slot| &value.skies[slot].product),
            bounces: placement.bounces.slot.map(|slot| &value.bounces[slot].product),
        };
        let scene = &value.volume.scene;
        let pass = |lights: EyeLights<'_>, paged: Option<PagedView>| {
            EyePass::new(scene, settings, window, lights, &self.options, paged)
        };
        let paged = value.volume.pages.as_ref().and_then(|pool| pool.view_of(settings, scene, window));
        let each = EyeLights { lights: &volumes, combined: None, ambient };
        let combine = placement.lights.bricks_to_combine.is_some().then(|| pass(each, None));
        let floor = paged.is_some().then(|| pass(each, None));
        let combined = value.combined.as_ref().filter(|_| self.keys.combined.is_some());
        let eye = match combined {
            Some(combined) => {
                let unshadowed = light_inputs_of(self.lights.unshadowed(), &[], value);
                pass(EyeLights { lights: &unshadowed, combined: Some(&combined.product), ambient }, paged)
            }
            None => pass(each, paged),
        };
        self.report.slabs = eye.slab_count();
        self.report.size = window.size;
        let looked_up = |inputs: &[LightInput<'_>]| {
            inputs.iter().filter_map(|input| input.volume).map(|volume| volume.divisor).max().unwrap_or(0)
        };
        self.report.light_divisor = if combined.is_some() { 0 } else { looked_up(&volumes) };
        ShadingPasses { eye, combine, floor }
    }

    /// Appends the steps of the linear picture, the floor and the display. Returns the target that they draw into.
    fn append_picture_steps(
        &mut self,
        eye: &EyePass,
        scattering: Option<&ScatterState>,
    ) -> Result<TargetRole, GpuError> {
        let role = self.drawn_in.unwrap_or(TargetRole::Back);
        let target = self.targets.get_mut(role);
        if self.drawn_in.is_none() {
            target.light.restart(Some(self.keys.eye.clone()));
            target.light.product.splat_counter = scattering.map(|scattering| scattering.counter.clone());
            let volume = &self.loaded.product.volume;
            self.steps.extend(eye_steps(volume, eye, &self.request, scattering.is_some()));
            self.steps.push(RenderStep::Finish(FrameProduct::Picture));
        }
        let antialiased = &self.keys.antialiased;
        if target.resize_antialiased(&self.tools.context, antialiased.as_ref())? {
            self.tools.pool.drop_bind_groups();
        }
        if antialiased.is_some() && !target.antialiased.is_valid_for(antialiased) {
            target.antialiased.restart(antialiased.clone());
            self.steps.push(RenderStep::Antialiasing(0..self.shape.sample_size()[1]));
            self.steps.push(RenderStep::Finish(FrameProduct::Antialiasing));
        }
        if target.resize_floor(&self.tools.context, self.keys.floor.as_ref())? {
            self.tools.pool.drop_bind_groups();
        }
        if !target.floor.is_valid_for(&self.keys.floor) {
            target.floor.restart(self.keys.floor.clone());
            self.steps.push(RenderStep::Floor(0..self.shape.sample_size()[1]));
            self.steps.push(RenderStep::Finish(FrameProduct::Floor));
        }
        if !target.display.is_valid_for(&Some(display_key(&self.keys))) {
            self.steps.push(RenderStep::Display);
        }
        // Shows the target, even if nothing had to be drawn.
        self.steps.push(RenderStep::Finish(FrameProduct::Display));
        Ok(role)
    }
}
