//! Cache of sky-visibility volumes: look-up, recycling and eviction for a picture.

use std::sync::Arc;

use super::lookup_reach::{ambient_cells, max_stretch_reach, required_reach, view_sample_reach};
use crate::GpuError;
use crate::frame::loaded_volume::{LoadedVolume, ProductRequest};
use crate::frame::step::{FrameProduct, RenderStep};
use crate::plan::{FloorPlane, SkyKey};
use crate::resources::cache_entry::CacheEntry;
use crate::resources::gpu_tools::GpuTools;
use crate::sky::fill::SkyFill;
use crate::sky::volume::{MAX_DIRECTION_TEXELS, SkyVolume, SkyVolumeExtent, divisor_for_adapter};
use crate::volume::VolumeContext;

/// Maximum number of cached volumes: one for the picture, one for its previews, and one for undoing a change.
const MAX_CACHED: usize = 3;

/// Sky-visibility volume of a picture, and the work to fill it.
#[derive(Debug, Default)]
pub(crate) struct SkyEntry {
    /// Key of the volume; `None` without one.
    pub key: Option<SkyKey>,
    /// Index of the volume among the cached ones.
    pub slot: Option<usize>,
    /// Work to fill the volume; `None` if it is already complete.
    pub build: Option<SkyFill>,
}

impl SkyEntry {
    /// Returns the steps that fill the volume.
    pub(crate) fn steps(&self) -> Vec<RenderStep> {
        let Some(build) = &self.build else { return Vec::new() };
        let mut steps = vec![RenderStep::SkyBlocks];
        steps.extend((0..build.batches()).map(RenderStep::SkyBatch));
        steps.push(RenderStep::Finish(FrameProduct::Sky));
        steps
    }
}

impl LoadedVolume {
    /// Finds a cached volume that a picture or preview can use, or creates one.
    ///
    /// # Errors
    /// Returns an error if memory is exhausted.
    pub(crate) fn find_or_create_sky(
        &mut self,
        tools: &GpuTools,
        wanted: ProductRequest<'_>,
    ) -> Result<SkyEntry, GpuError> {
        let ProductRequest { context, request, options, keys, picture_number: now } = wanted;
        let known = self.skies.len();
        self.skies.retain(CacheEntry::is_complete);
        if self.skies.len() < known {
            tools.pool.drop_bind_groups();
        }
        let Some(full) = &keys.sky else { return Ok(SkyEntry::default()) };
        let coarse = request.preview_resolution.map(|_| full.for_preview());
        // The floor's sky visibility is computed together with that of the volume.
        let floor = FloorPlane::from_settings(&request.settings);
        let has_floor =
            |known: &SkyVolume| floor.is_none() || known.floor.as_ref().map(|map| map.extent) == floor;
        let cells = |divisor: usize, reach: u8| {
            ambient_cells(&self.volume, &self.tables.product, options, divisor, reach)
        };
        let reach = view_sample_reach(&self.volume, request, options.picture.samples);
        // Cells of the margin see the whole sky, which suffices for previews.
        let least_reach = required_reach(wanted, reach);
        let has_cells = |known: &SkyVolume| cells(known.divisor, least_reach).is_subset(&known.filled_cells);
        let find = |key: &SkyKey| {
            let is_usable = |known: &SkyVolume| has_floor(known) && has_cells(known);
            self.skies.iter().position(|known| known.is_valid_for(key) && is_usable(&known.product))
        };
        let found = find(full).or_else(|| coarse.as_ref().and_then(find));
        if let Some(slot) = found {
            self.skies[slot].product.last_used = now;
            let key = self.skies[slot].key().clone();
            return Ok(SkyEntry { key: Some(key), slot: Some(slot), build: None });
        }
        let key = coarse.unwrap_or_else(|| full.clone());
        let divisor =
            divisor_for_adapter(context, self.volume.volume.dims(), key.resolution(), MAX_DIRECTION_TEXELS);
        let mut filled = cells(divisor, reach);
        let mut margin = cells(divisor, reach.max(max_stretch_reach())).difference(&filled);
        // Compared settings may show different cells, so one volume covers both.
        for known in self.skies.iter().filter(|known| known.is_valid_for(&key)) {
            filled = Arc::new(filled.union(&known.product.filled_cells));
            margin = margin.union(&known.product.margin).difference(&filled);
        }
        self.skies.retain(|known| !known.is_valid_for(&key));
        if self.skies.len() >= MAX_CACHED {
            let oldest = (0..self.skies.len()).min_by_key(|&at| self.skies[at].product.last_used);
            oldest.map(|at| self.skies.swap_remove(at));
        }
        tools.pool.drop_bind_groups();
        let mut fresh =
            SkyVolume::new(context, &self.volume.scene, divisor, SkyVolumeExtent { filled, margin, floor })?;
        fresh.last_used = now;
        let slot = self.skies.len();
        let gpu = VolumeContext::new(tools, &self.volume);
        let build = SkyFill::new(gpu, (&self.tables.product, options), &key, &fresh)?;
        self.skies.push(CacheEntry::incomplete(key.clone(), fresh));
        Ok(SkyEntry { key: Some(key), slot: Some(slot), build: Some(build) })
    }

    /// Returns the size of all sky-visibility volumes, in bytes.
    pub(crate) fn sky_bytes(&self) -> u64 {
        self.skies.iter().map(|sky| sky.product.bytes()).sum()
    }
}
