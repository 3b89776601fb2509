//! Cache of scattered-light volumes: look-up, recycling and eviction for a picture.

use std::sync::Arc;

use super::lookup_reach::{ambient_cells, required_reach, view_sample_reach};
use crate::GpuError;
use crate::frame::loaded_volume::{LoadedVolume, ProductRequest};
use crate::frame::step::{FrameProduct, RenderStep};
use crate::plan::BouncesKey;
use crate::resources::cache_entry::CacheEntry;
use crate::resources::gpu_tools::GpuTools;
use crate::scattered_light::fill::ScatteredLightFill;
use crate::scattered_light::volume::{MAX_DIRECTION_TEXELS, ScatteredLightVolume};
use crate::sky::volume::divisor_for_adapter;
use crate::volume::VolumeContext;

/// Maximum number of cached volumes: one for the picture, one for its previews, and one for undoing a change.
const MAX_CACHED: usize = 3;

/// Scattered-light volume of a picture, and the work to fill it.
#[derive(Debug, Default)]
pub(crate) struct ScatteredLightEntry {
    /// Key of the volume; `None` without one.
    pub key: Option<BouncesKey>,
    /// Index of the volume among the cached ones.
    pub slot: Option<usize>,
    /// Work to fill the volume; `None` if it is already complete.
    pub build: Option<ScatteredLightFill>,
}

impl ScatteredLightEntry {
    /// Returns the steps that fill the volume.
    pub(crate) fn steps(&self) -> Vec<RenderStep> {
        let Some(build) = &self.build else { return Vec::new() };
        let mut steps: Vec<_> = build.steps().into_iter().map(RenderStep::ScatteredLight).collect();
        steps.push(RenderStep::Finish(FrameProduct::ScatteredLight));
        steps
    }
}

impl LoadedVolume {
    /// Finds a cached volume that a picture or preview can use, or creates one.
    ///
    /// # Errors
    /// Returns an error if memory is exhausted.
    pub(crate) fn find_or_create_scattered_light(
        &mut self,
        tools: &GpuTools,
        wanted: ProductRequest<'_>,
    ) -> Result<ScatteredLightEntry, GpuError> {
        let ProductRequest { context, request, options, keys, picture_number: now } = wanted;
        let entry = self.bounces.len();
        self.bounces.retain(CacheEntry::is_complete);
        if self.bounces.len() < entry {
            tools.pool.drop_bind_groups();
        }
        let Some(full) = &keys.bounces else { return Ok(ScatteredLightEntry::default()) };
        let coarse = request.preview_resolution.map(|_| full.for_preview());
        let cells = |divisor: usize, reach: u8| {
            ambient_cells(&self.volume, &self.tables.product, options, divisor, reach)
        };
        let reach = view_sample_reach(&self.volume, request, options.picture.samples);
        let least_reach = required_reach(wanted, reach);
        let find = |key: &BouncesKey| {
            let has_cells = |known: &ScatteredLightVolume| {
                cells(known.divisor, least_reach).is_subset(&known.filled_cells)
            };
            self.bounces.iter().position(|known| known.is_valid_for(key) && has_cells(&known.product))
        };
        let found = find(full).or_else(|| coarse.as_ref().and_then(find));
        if let Some(slot) = found {
            self.bounces[slot].product.last_used = now;
            let key = self.bounces[slot].key().clone();
            return Ok(ScatteredLightEntry { key: Some(key), slot: Some(slot), build: None });
        }
        let key = coarse.unwrap_or_else(|| full.clone());
        let divisor =
            divisor_for_adapter(context, self.volume.volume.dims(), key.resolution(), MAX_DIRECTION_TEXELS);
        // Unfilled cells hold no light. Previews that look up cells further out find next to nothing visible there.
        let mut filled = cells(divisor, reach);
        // Compared settings may show different cells, so one volume covers both.
        for known in self.bounces.iter().filter(|known| known.is_valid_for(&key)) {
            filled = Arc::new(filled.union(&known.product.filled_cells));
        }
        self.bounces.retain(|known| !known.is_valid_for(&key));
        if self.bounces.len() >= MAX_CACHED {
            let oldest = (0..self.bounces.len()).min_by_key(|&at| self.bounces[at].product.last_used);
            oldest.map(|at| self.bounces.swap_remove(at));
        }
        tools.pool.drop_bind_groups();
        let mut created = ScatteredLightVolume::new(context, self.volume.volume.dims(), divisor, filled)?;
        created.last_used = now;
        let slot = self.bounces.len();
        let settings = &request.settings;
        let light = (settings.sky.is_on(), settings.lights.iter().filter(|light| light.on).count());
        let gpu = VolumeContext::new(tools, &self.volume);
        let build = ScatteredLightFill::new(gpu, (&self.tables.product, options), &key, light, &created)?;
        self.bounces.push(CacheEntry::incomplete(key.clone(), created));
        Ok(ScatteredLightEntry { key: Some(key), slot: Some(slot), build: Some(build) })
    }

    /// Returns the size of all volumes of scattered light, in bytes.
    pub(crate) fn bounces_bytes(&self) -> u64 {
        self.bounces.iter().map(|known| known.product.bytes()).sum()
    }
}
