//! Cache of sky-visibility volumes: look-up, recycling and eviction for a picture.

use std::sync::Arc;

use super::reach::{cells_around, least_reach, sample_reach, widest};
use crate::gpu::GpuError;
use crate::gpu::frame::loaded::{Loaded, Wanted};
use crate::gpu::frame::step::{Product, Step};
use crate::gpu::resources::cached::Cached;
use crate::gpu::resources::tools::Tools;
use crate::gpu::sky::build::SkyBuild;
use crate::gpu::sky::volume::{MOST_TEXELS, SkyVolume, divisor_on};
use crate::gpu::volume::Gpu;
use crate::plan::{FloorPlace, SkyKey};

/// Maximum number of cached volumes: one for the picture, one for its previews, and one for undoing a change.
const MOST_KEPT: usize = 3;

/// Sky-visibility volume of a picture, and the work to fill it.
#[derive(Debug, Default)]
pub(in crate::gpu::frame) struct PlacedSky {
    /// Key of the volume; `None` without one.
    pub key: Option<SkyKey>,
    /// Index of the volume among the cached ones.
    pub slot: Option<usize>,
    /// Work to fill the volume; `None` if it is already complete.
    pub build: Option<SkyBuild>,
}

impl PlacedSky {
    /// Returns the steps that fill the volume.
    pub(in crate::gpu::frame) fn steps(&self) -> Vec<Step> {
        let Some(build) = &self.build else { return Vec::new() };
        let mut steps = vec![Step::SkyBlocks];
        steps.extend((0..build.batches()).map(Step::SkyBatch));
        steps.push(Step::Finish(Product::Sky));
        steps
    }
}

impl Loaded {
    /// Finds a cached volume that a picture or preview can use, or creates one.
    ///
    /// # Errors
    /// Returns an error if memory is exhausted.
    pub(in crate::gpu::frame) fn place_sky(
        &mut self,
        tools: &Tools,
        wanted: Wanted<'_>,
    ) -> Result<PlacedSky, GpuError> {
        let Wanted { context, request, options, keys, now } = wanted;
        let known = self.skies.len();
        self.skies.retain(Cached::is_complete);
        if self.skies.len() < known {
            tools.pool.forget_groups();
        }
        let Some(full) = &keys.sky else { return Ok(PlacedSky::default()) };
        let coarse = request.coarse.map(|_| full.coarse());
        // The floor's sky visibility is computed together with that of the volume.
        let floor = FloorPlace::of(&request.settings);
        let has_floor =
            |known: &SkyVolume| floor.is_none() || known.floor.as_ref().map(|map| map.place) == floor;
        let cells = |divisor: usize, reach: u8| {
            cells_around(&self.volume, &self.tables.value, options, (divisor, reach))
        };
        let reach = sample_reach(&self.volume, request, options.samples);
        // Cells of the margin see the whole sky, which suffices for previews.
        let least_reach = least_reach(wanted, reach);
        let has_cells = |known: &SkyVolume| cells(known.divisor, least_reach).is_within(&known.filled);
        let find = |key: &SkyKey| {
            let is_usable = |known: &SkyVolume| has_floor(known) && has_cells(known);
            self.skies.iter().position(|known| known.holds(key) && is_usable(&known.value))
        };
        let found = find(full).or_else(|| coarse.as_ref().and_then(find));
        if let Some(slot) = found {
            self.skies[slot].value.last_used = now;
            let key = self.skies[slot].key().clone();
            return Ok(PlacedSky { key: Some(key), slot: Some(slot), build: None });
        }
        let key = coarse.unwrap_or_else(|| full.clone());
        let divisor = divisor_on(context, self.volume.volume.dims(), key.resolution(), MOST_TEXELS);
        let mut filled = cells(divisor, reach);
        let mut margin = cells(divisor, reach.max(widest())).without(&filled);
        // Compared settings may show different cells, so one volume covers both.
        for known in self.skies.iter().filter(|known| known.holds(&key)) {
            filled = Arc::new(filled.with(&known.value.filled));
            margin = margin.with(&known.value.margin).without(&filled);
        }
        self.skies.retain(|known| !known.holds(&key));
        if self.skies.len() >= MOST_KEPT {
            let oldest = (0..self.skies.len()).min_by_key(|&at| self.skies[at].value.last_used);
            oldest.map(|at| self.skies.swap_remove(at));
        }
        tools.pool.forget_groups();
        let mut fresh = SkyVolume::new(context, &self.volume.scene, divisor, (filled, margin), floor)?;
        fresh.last_used = now;
        let slot = self.skies.len();
        let gpu = Gpu::new(tools, &self.volume);
        let build = SkyBuild::new(gpu, (&self.tables.value, options), &key, &fresh)?;
        self.skies.push(Cached::unfilled(key.clone(), fresh));
        Ok(PlacedSky { key: Some(key), slot: Some(slot), build: Some(build) })
    }

    /// Returns the size of all sky-visibility volumes, in bytes.
    pub(crate) fn sky_bytes(&self) -> u64 {
        self.skies.iter().map(|sky| sky.value.bytes()).sum()
    }
}
