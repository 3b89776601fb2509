//! Frame planning: compares the keys of a picture with the cached products and lists the missing steps.

mod light_inputs;
mod planner;
mod steps;

use std::borrow::Cow;
use std::sync::Arc;
use std::time::Instant;

pub(super) use self::light_inputs::light_inputs;
use self::planner::FramePlanner;
use self::steps::{pyramid_steps, upload_steps};
use super::loaded_volume::LoadedVolume;
use super::render_job::RenderJob;
use super::report::RenderReport;
use super::step::{FrameProduct, RenderStep};
use crate::output::render_target::TargetShape;
use crate::plan::{ActiveLights, FrameKeys, RenderRequest, VolumeKey};
use crate::resources::cache_entry::CacheEntry;
use crate::volume::pyramid::density_pyramid::needs_density_pyramid;
use crate::volume::reused_textures::{ReusedTextures, changed_box};
use crate::{GpuError, RenderOptions, Renderer};
use chiaroscuro_scene::{PixelFormat, mask_from_shapes};
use chiaroscuro_volume::{Dataset, Observer};

impl Renderer {
    /// Returns true if a picture needs no more than a display pass.
    pub fn is_drawn(&self, request: &RenderRequest, options: &RenderOptions) -> bool {
        let Some(loaded) = &self.loaded else { return false };
        // Pictures are known by the settings that they are drawn with.
        let request = with_resolved_labels(request.clone(), &loaded.product.dataset);
        let keys = FrameKeys::new(&request, options);
        let role = self.targets.find(&keys, target_shape(&request, options));
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
            antialiased,
            floor,
            display: _,
        } = &keys;
        role.is_some_and(|role| {
            let target = self.targets.get(role);
            let is_antialiased = antialiased.is_none() || target.antialiased.is_valid_for(antialiased);
            is_antialiased && target.floor.is_valid_for(floor)
        })
    }

    /// Returns true if the volume of a picture is on the GPU, shown or as a spare one, with the volumes of all its lights
    /// and of its sky, so that it is drawn by the eye pass alone.
    pub fn is_prepared(&self, dataset: &Dataset, request: &RenderRequest, options: &RenderOptions) -> bool {
        let request = with_resolved_labels(request.clone(), dataset);
        let keys = FrameKeys::new(&request, options);
        let shown = self
            .loaded
            .as_ref()
            .filter(|shown| shown.is_valid_for(&keys.volume) && shown.product.has_voxel_type_of(dataset));
        let volume = match shown {
            Some(shown) => Some(&shown.product),
            None => self.spare_volumes.find(&keys.volume, dataset),
        };
        volume.is_some_and(|volume| volume.has_light_of(&keys, request.preview_resolution))
    }

    /// Starts a picture: finds stale products and lists the steps.
    ///
    /// # Errors
    /// Returns an error if memory is exhausted; the displayed picture is kept.
    pub fn begin(
        &mut self,
        dataset: &Dataset,
        request: RenderRequest,
        options: &RenderOptions,
    ) -> Result<RenderJob<'_>, GpuError> {
        let start = Instant::now();
        let request = with_resolved_labels(request, dataset);
        let keys = FrameKeys::new(&request, options);
        let mut planner = self.plan_frame(dataset, request, options, keys)?;
        let placement = planner.place_volumes()?;
        let job = planner.into_job(placement)?;
        job.report.host_ms = start.elapsed().as_secs_f64() * 1000.0;
        Ok(job)
    }

    /// Loads the volume of a picture, and starts its report and its plan.
    fn plan_frame(
        &mut self,
        dataset: &Dataset,
        request: RenderRequest,
        options: &RenderOptions,
        keys: FrameKeys,
    ) -> Result<FramePlanner<'_>, GpuError> {
        self.picture_count += 1;
        self.report = RenderReport { peak_gpu_bytes: self.report.peak_gpu_bytes, ..RenderReport::default() };
        self.fill_counts.resize(self.fill_counts.len().max(request.settings.lights.len()), 0);
        let mut steps = Vec::new();
        let mut loaded = match self.loaded.take() {
            Some(known) if known.is_valid_for(&keys.volume) && known.product.has_voxel_type_of(dataset) => {
                known
            }
            other => match self.spare_volumes.exchange(other, &keys.volume, dataset) {
                Some(known)
                    if known.is_valid_for(&keys.volume) && known.product.has_voxel_type_of(dataset) =>
                {
                    known
                }
                other => self.load_volume(other, dataset, &request, &keys, &mut steps)?,
            },
        };
        self.release_dropped_volumes();
        if needs_density_pyramid(&request.settings)
            && loaded.product.volume.begin_pyramid(&self.tools.context)?
        {
            steps.extend(pyramid_steps(&loaded.product.volume));
        }
        let pages = dataset.pages().filter(|pages| {
            keys.eye.has_pages()
                && pages.mapping() == keys.volume.density_mapping
                && loaded.product.can_show_pages()
        });
        if loaded.product.refresh_pages(&self.tools.context, pages)? {
            self.tools.pool.drop_bind_groups();
        }
        steps.extend(std::iter::repeat_n(RenderStep::Pages, loaded.product.pending_page_steps()));
        let shape = target_shape(&request, options);
        Ok(FramePlanner {
            tools: &self.tools,
            gpu_clock: self.gpu_clock.as_ref(),
            loaded: self.loaded.insert(loaded),
            fill_counts: &mut self.fill_counts,
            report: &mut self.report,
            picture_number: self.picture_count,
            options: options.clone(),
            lights: ActiveLights::from_settings(&request.settings),
            drawn_in: self.targets.find(&keys, shape),
            targets: &mut self.targets,
            request,
            keys,
            shape,
            steps,
        })
    }

    /// Allocates the volume of a picture in place of another one, of which it keeps the parts that are the same, and
    /// appends the steps that fill it.
    fn load_volume(
        &mut self,
        other: Option<CacheEntry<VolumeKey, LoadedVolume>>,
        dataset: &Dataset,
        request: &RenderRequest,
        keys: &FrameKeys,
        steps: &mut Vec<RenderStep>,
    ) -> Result<CacheEntry<VolumeKey, LoadedVolume>, GpuError> {
        if other.as_ref().is_some_and(|known| known.is_valid_for(&keys.volume)) {
            // Equal numbers of another voxel type differ in the last bits.
            self.targets.invalidate();
        }
        self.tools.pool.clear();
        let start = Instant::now();
        // Reuses parts of a volume whose picture was interrupted, or that shows another range of values.
        let known = other.filter(|known| {
            known.key().content_id == keys.volume.content_id && known.product.has_voxel_type_of(dataset)
        });
        let is_same_mask = known.as_ref().is_some_and(|known| known.key().mask == keys.volume.mask);
        let known_mask = known.as_ref().and_then(|known| known.product.volume.volume.mask().cloned());
        let known_dataset = known.as_ref().map(|known| known.product.dataset.clone());
        let reused = known
            .map_or_else(ReusedTextures::default, |known| LoadedVolume::into_reused(known, &keys.volume));
        let mask = if is_same_mask {
            known_mask
        } else {
            mask_from_shapes(dataset.volume(), request.settings.cuts.enabled_shapes()).map(Arc::new)
        };
        let known =
            known_dataset.filter(|known| known.volume().density_mapping() == keys.volume.density_mapping);
        let dataset = known.as_ref().unwrap_or(dataset).with_density_mappings(keys.volume.density_mappings());
        let dataset = dataset.with_mask(mask.as_ref());
        let has_density = reused.density.is_some();
        let volume = dataset.volume();
        let changed = Observer::ALL.map(|observer| match &reused.presence {
            Some((known, before)) if known.own(observer).is_some() => {
                changed_box(volume, observer, before.as_deref(), volume.mask().map(AsRef::as_ref))
            }
            _ => Some(volume.dims().map(|n| 0..n)),
        });
        let (context, settings) = (&self.tools.context, &request.settings);
        let fresh = LoadedVolume::new(context, &dataset, settings, &keys.tables, reused)?;
        for (observer, changed) in Observer::ALL.into_iter().zip(changed) {
            let presence = fresh.volume.presence.as_ref().and_then(|presence| presence.own(observer));
            if let Some((presence, changed)) = presence.zip(changed) {
                steps.extend(presence.steps(&changed).map(|texels| RenderStep::Presence(observer, texels)));
            }
        }
        if !has_density {
            steps.extend(upload_steps(&fresh.volume));
        }
        steps.push(RenderStep::Finish(FrameProduct::Volume));
        self.report.step_counts.tables = 2;
        self.report.tables_ms = start.elapsed().as_secs_f64() * 1000.0;
        Ok(CacheEntry::incomplete(keys.volume, fresh))
    }
}

/// Returns the request with label settings converted to transfer functions, with layers that have a field, and with cuts
/// by voxel if some layers are never cut, so that passes and keys need not know of these.
fn with_resolved_labels(mut request: RenderRequest, dataset: &Dataset) -> RenderRequest {
    let resolved = match request.settings.resolved_for_dataset(dataset) {
        Cow::Owned(drawn) => Some(drawn),
        Cow::Borrowed(_) => None,
    };
    if let Some(drawn) = resolved {
        request.settings = drawn;
    }
    request
}

/// Returns the shape of the target for a request.
fn target_shape(request: &RenderRequest, options: &RenderOptions) -> TargetShape {
    TargetShape {
        size: options.displayed_window(request).size,
        samples: options.picture.samples,
        is_deep: options.picture.depth != PixelFormat::Eight,
    }
}
