//! Frame planning: compares the keys of a picture with the cached products and lists the missing steps.

use std::borrow::Cow;
use std::sync::Arc;
use std::time::Instant;

use super::job::Job;
use super::kept::bounces::PlacedBounces;
use super::kept::light::PlacedLights;
use super::kept::sky::PlacedSky;
use super::loaded::{Loaded, Wanted};
use super::report::Report;
use super::step::{Product, Side, Step};
use super::targets::{Role, shown_key};
use crate::data::Dataset;
use crate::gpu::eye::gather::EyePass;
use crate::gpu::eye::looked_up::Around;
use crate::gpu::light::combine;
use crate::gpu::light::packed::LightInput;
use crate::gpu::light::volume::LightVolume;
use crate::gpu::output::target::Shape;
use crate::gpu::resources::cached::Cached;
use crate::gpu::resources::tools::Tools;
use crate::gpu::scatter::eye::SLABS_PER_STEP;
use crate::gpu::scatter::voxels::Scattering;
use crate::gpu::volume::materials::Materials;
use crate::gpu::volume::presence::Presence;
use crate::gpu::volume::transfer_tables::Tables;
use crate::gpu::volume::{GpuVolume, prefilter};
use crate::gpu::{GpuError, RenderOptions, Renderer};
use crate::model::{Depth, SheetOrder};
use crate::plan::{EyeKey, FloorKey, FrameKeys, LightKey, LitLights, Request, SliceOrder};

impl Renderer {
    /// Returns true if a picture needs no more than a display pass.
    pub fn is_drawn(&self, request: &Request, options: &RenderOptions) -> bool {
        let keys = FrameKeys::of(request, options);
        let role = self.targets.holding(&keys, shape(request, options));
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
        role.is_some_and(|role| self.targets.get(role).floor.holds(floor))
    }

    /// Starts a picture: finds stale products and lists the steps.
    ///
    /// # Errors
    /// Returns an error if memory is exhausted; the displayed picture is kept.
    pub fn begin(
        &mut self,
        dataset: &Dataset,
        mut request: Request,
        options: &RenderOptions,
    ) -> Result<Job<'_>, GpuError> {
        // Label settings are converted to transfer functions first, so that passes and keys need not know of labels.
        let drawn = match request.settings.as_drawn(dataset.volume()) {
            Cow::Owned(drawn) => Some(drawn),
            Cow::Borrowed(_) => None,
        };
        if let Some(drawn) = drawn {
            request.settings = drawn;
        }
        let mut keys = FrameKeys::of(&request, options);
        let lit = LitLights::of(&request.settings);
        let shape = shape(&request, options);
        self.pictures += 1;
        self.report = Report { peak_gpu_bytes: self.report.peak_gpu_bytes, ..Report::default() };
        self.fills.resize(self.fills.len().max(request.settings.lights.len()), 0);
        let mut steps = Vec::new();

        let loaded = match self.loaded.take() {
            Some(known) if known.holds(&keys.volume) && known.value.has_type_of(dataset) => known,
            other => {
                if other.as_ref().is_some_and(|known| known.holds(&keys.volume)) {
                    // Equal numbers of another voxel type differ in the last bits.
                    self.targets.forget();
                }
                self.tools.pool.clear();
                let start = Instant::now();
                // Reuses parts of a volume whose picture was interrupted, or that shows another range of values.
                let known = other.filter(|known| {
                    known.key().content_id == keys.volume.content_id && known.value.has_type_of(dataset)
                });
                let (known, presence) = known.map_or((None, None), |known| {
                    let presence = if known.is_complete() { known.value.volume.presence } else { None };
                    (Some(known.value.dataset), presence)
                });
                let known = known.filter(|known| known.volume().shown() == keys.volume.shown);
                let dataset = known.unwrap_or_else(|| dataset.showing(keys.volume.shown));
                let has_presence = presence.is_some();
                let (context, settings) = (&self.tools.context, &request.settings);
                let fresh = Loaded::new(context, &dataset, settings, &keys.tables, presence)?;
                if !has_presence {
                    let slices = fresh.volume.presence.iter().flat_map(Presence::steps);
                    steps.extend(slices.map(Step::Presence));
                }
                steps.extend(upload_steps(&fresh.volume));
                self.report.runs.tables = 2;
                self.report.bricks_ms = start.elapsed().as_secs_f64() * 1000.0;
                Cached::unfilled(keys.volume, fresh)
            }
        };
        let loaded = self.loaded.insert(loaded);

        let mut placed = PlacedLights::default();
        let mut sky = PlacedSky::default();
        let mut bounces = PlacedBounces::default();
        let mut scattering = None;
        let mut role = self.targets.holding(&keys, shape);
        if role.is_none() || keys.floor.is_some() {
            let start = Instant::now();
            let baked = loaded.value.refresh_tables(&self.tools.context, &request.settings, &keys.tables)?;
            if baked > 0 {
                self.tools.pool.forget_groups();
            }
            self.report.runs.tables += baked;
            loaded.value.refresh_materials(&self.tools.context, &request.settings)?;
            steps.extend(material_steps(&loaded.value.tables.value));
            self.report.bricks_ms += start.elapsed().as_secs_f64() * 1000.0;
        }
        if role.is_none() {
            let wanted = Wanted {
                context: &self.tools.context,
                request: &request,
                options,
                keys: &keys,
                now: self.pictures,
            };
            placed = place_lights(&self.tools, &mut loaded.value, wanted)?;
            if placed.builds.is_empty() {
                self.tools.pool.drop_ring();
            }
            sky = loaded.value.place_sky(&self.tools, wanted)?;
            bounces = loaded.value.place_bounces(&self.tools, wanted)?;
            let around = (sky.key.as_ref(), bounces.key.as_ref());
            keys.eye = EyeKey::of(&request, options, &placed.keys, keys.combined.as_ref(), around);
            keys.floor = FloorKey::of(&request, &keys.eye);
            // A preview may find its light volumes at full resolution, and so a picture that is already drawn.
            role = self.targets.holding(&keys, shape);
        }
        let is_floor_drawn = role.is_some_and(|role| self.targets.get(role).floor.holds(&keys.floor));
        if role.is_some() && !is_floor_drawn && keys.floor.is_some() {
            // The floor needs the sky volume, too, even if the rest is drawn.
            let now = self.pictures;
            let wanted =
                Wanted { context: &self.tools.context, request: &request, options, keys: &keys, now };
            sky = loaded.value.place_sky(&self.tools, wanted)?;
            // Area lights also have floor shadow maps; for other lights rays are cast.
            let has_map = lit.shadowed().iter().any(|lit| lit.light.area.is_some());
            if has_map && keys.combined.is_none() {
                placed = place_lights(&self.tools, &mut loaded.value, wanted)?;
            }
        }
        let is_drawn = role.is_some();
        for (at, build) in placed.builds.iter().enumerate() {
            steps.extend(build.steps(at, options.light_parts.max(1)));
        }
        let role = if let Some(role) = role {
            role
        } else {
            steps.extend(combine_steps(placed.bricks_to_combine));
            if request.settings.scatters() {
                let voxels = loaded.value.voxels_for(&self.tools.context, &request.settings)?;
                scattering = Some(Scattering::new(&self.tools.context, voxels));
            }
            self.targets.fit_back(&self.tools, shape)?;
            Role::Back
        };
        steps.extend(sky.steps());
        steps.extend(bounces.steps());

        let value = &loaded.value;
        let volumes = inputs(&lit, &placed.slots, value);
        let window = options.window(&request);
        let around = Around {
            sky: sky.slot.map(|slot| &value.skies[slot].value),
            bounces: bounces.slot.map(|slot| &value.bounces[slot].value),
        };
        let of_lights = |lights: &[LightInput<'_>]| {
            EyePass::new(&value.volume.scene, &request.settings, window, (lights, None, around), options)
        };
        let combine = placed.bricks_to_combine.is_some().then(|| of_lights(&volumes));
        let combined = value.combined.as_ref().filter(|_| keys.combined.is_some());
        let eye = match combined {
            Some(combined) => {
                let unshadowed = inputs_of(lit.unshadowed(), &[], value);
                let scene = &value.volume.scene;
                let lights = (&unshadowed[..], Some(&combined.value), around);
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
            target.light.value.splats = scattering.as_ref().map(|scattering| scattering.counter.clone());
            steps.extend(eye_steps(&value.volume, &eye, &request, scattering.is_some()));
            steps.push(Step::Finish(Product::Picture));
        }
        if target.place_floor(&self.tools.context, keys.floor.as_ref())? {
            self.tools.pool.forget_groups();
        }
        if !target.floor.holds(&keys.floor) {
            target.floor.restart(keys.floor.clone());
            steps.push(Step::Floor(0..shape.drawn()[1]));
            steps.push(Step::Finish(Product::Floor));
        }
        if !target.shown.holds(&Some(shown_key(&keys))) {
            steps.push(Step::Display);
        }
        // Shows the target, even if nothing had to be drawn.
        steps.push(Step::Finish(Product::Shown));

        let bytes = self.targets.bytes() + value.bytes() + self.tools.pool.bytes();
        self.report.peak_gpu_bytes = self.report.peak_gpu_bytes.max(bytes);
        let total = steps.len();
        Ok(Job {
            tools: &self.tools,
            gpu_clock: self.gpu_clock.as_ref(),
            loaded,
            targets: &mut self.targets,
            fills: &mut self.fills,
            report: &mut self.report,
            options: options.clone(),
            keys,
            lit,
            slots: placed.slots,
            builds: placed.builds,
            sky,
            bounces,
            combine,
            eye,
            scattering,
            eye_sheets: None,
            role,
            steps: steps.into(),
            total,
            request,
        })
    }
}

/// Finds or creates the light volumes of a picture, recycling those of an interrupted one.
fn place_lights(tools: &Tools, loaded: &mut Loaded, wanted: Wanted<'_>) -> Result<PlacedLights, GpuError> {
    // Cached bind groups would keep the temporary volumes of the interrupted filling alive.
    let has_scratch = |key: &LightKey| key.samples() > 1 || key.has_colors();
    let is_half_filled = loaded.lights.iter().any(|light| !light.is_complete() && has_scratch(light.key()));
    let mut recyclable = loaded.take_unfinished();
    let placed = loaded.place_lights(wanted, &mut recyclable)?;
    if is_half_filled || !recyclable.is_empty() {
        drop(recyclable);
        tools.pool.forget_groups();
    }
    Ok(placed)
}

/// Returns the steps that classify voxels.
fn material_steps(tables: &Tables) -> Vec<Step> {
    let mut steps = Vec::new();
    let mut begun: Option<&Arc<Materials>> = None;
    for side in [Side::Eye, Side::Lighting] {
        let Some(materials) = &side.of(tables).materials else { continue };
        // Both tables usually share one set of voxels.
        if materials.is_complete() || begun.is_some_and(|begun| Arc::ptr_eq(begun, materials)) {
            continue;
        }
        steps.extend(materials.steps().map(|(level, bricks)| Step::Materials(side, level, bricks)));
        steps.push(Step::Finish(Product::Materials(side)));
        begun = Some(materials);
    }
    steps
}

/// Returns the shape of the target for a request.
fn shape(request: &Request, options: &RenderOptions) -> Shape {
    Shape { size: options.shown(request).size, samples: options.samples, deep: options.depth != Depth::Eight }
}

/// Returns the lights of a picture, each with its volume.
pub(super) fn inputs<'a>(
    lit: &'a LitLights,
    slots: &[Option<usize>],
    loaded: &'a Loaded,
) -> Vec<LightInput<'a>> {
    inputs_of(lit.all(), slots, loaded)
}

fn inputs_of<'a>(
    lights: &'a [crate::plan::LitLight],
    slots: &[Option<usize>],
    loaded: &'a Loaded,
) -> Vec<LightInput<'a>> {
    let volume_of = |index: usize| -> Option<&'a LightVolume> {
        let slot = slots.get(index).copied().flatten()?;
        loaded.lights.get(slot).map(|light| &light.value)
    };
    lights.iter().map(|lit| LightInput { lit, volume: volume_of(lit.index) }).collect()
}

/// Returns the steps that upload a volume and compute its pyramid and gradients.
fn upload_steps(volume: &GpuVolume) -> Vec<Step> {
    let slices = volume.volume.dims()[2];
    let each = volume.slices_per_step();
    let mut steps: Vec<_> =
        (0..slices).step_by(each).map(|first| Step::Upload(first..slices.min(first + each))).collect();
    steps.extend(prefilter::steps(volume).map(|(level, bricks)| Step::Pyramid(level, bricks)));
    if volume.gradients.is_some() {
        steps.extend(prefilter::steps(volume).map(|(level, bricks)| Step::Gradients(level, bricks)));
    }
    steps.push(Step::Finish(Product::Volume));
    steps
}

/// Returns the steps that fill the combined light volume.
fn combine_steps(bricks: Option<usize>) -> Vec<Step> {
    let Some(bricks) = bricks else { return Vec::new() };
    let firsts = (0..bricks).step_by(combine::BRICKS_PER_STEP);
    let end = |first: usize| bricks.min(first + combine::BRICKS_PER_STEP);
    let mut steps: Vec<_> = firsts.map(|first| Step::Combine(first..end(first))).collect();
    steps.push(Step::Finish(Product::CombinedLight));
    steps
}

/// Returns the steps that draw the linear picture.
fn eye_steps(volume: &GpuVolume, eye: &EyePass, request: &Request, scatters: bool) -> Vec<Step> {
    let frame = eye.frame();
    // If everything lies behind the eye there is no sheet; the gathering pass then clears the picture.
    if !scatters || frame.slab_count == 0 {
        return vec![Step::Eye(0..frame.size[1])];
    }
    let count = match request.settings.sampling.order {
        SheetOrder::ImageAligned => frame.slab_count,
        SheetOrder::VolumeAligned | SheetOrder::EveryFootprint => {
            SliceOrder::new(frame, volume.volume.dims()).count
        }
    };
    let firsts = (0..count).step_by(SLABS_PER_STEP as usize);
    firsts.map(|k| Step::ScatterEye(k..count.min(k + SLABS_PER_STEP))).collect()
}
