//! Cache of scattered-light volumes: look-up, recycling and eviction for a picture.

use std::sync::Arc;

use super::reach::{cells_around, least_reach, sample_reach};
use crate::gpu::GpuError;
use crate::gpu::bounces::build::BouncesBuild;
use crate::gpu::bounces::volume::{BouncesVolume, MOST_TEXELS};
use crate::gpu::frame::loaded::{Loaded, Wanted};
use crate::gpu::frame::step::{Product, Step};
use crate::gpu::resources::cached::Cached;
use crate::gpu::resources::tools::Tools;
use crate::gpu::sky::volume::divisor_on;
use crate::gpu::volume::Gpu;
use crate::plan::BouncesKey;

/// Maximum number of cached volumes: one for the picture, one for its previews, and one for undoing a change.
const MOST_KEPT: usize = 3;

/// Scattered-light volume of a picture, and the work to fill it.
#[derive(Debug, Default)]
pub(in crate::gpu::frame) struct PlacedBounces {
    /// Key of the volume; `None` without one.
    pub key: Option<BouncesKey>,
    /// Index of the volume among the cached ones.
    pub slot: Option<usize>,
    /// Work to fill the volume; `None` if it is already complete.
    pub build: Option<BouncesBuild>,
}

impl PlacedBounces {
    /// Returns the steps that fill the volume.
    pub(in crate::gpu::frame) fn steps(&self) -> Vec<Step> {
        let Some(build) = &self.build else { return Vec::new() };
        let mut steps: Vec<_> = build.steps().into_iter().map(Step::Bounce).collect();
        steps.push(Step::Finish(Product::Bounces));
        steps
    }
}

impl Loaded {
    /// Finds a cached volume that a picture or preview can use, or creates one.
    ///
    /// # Errors
    /// Returns an error if memory is exhausted.
    pub(in crate::gpu::frame) fn place_bounces(
        &mut self,
        tools: &Tools,
        wanted: Wanted<'_>,
    ) -> Result<PlacedBounces, GpuError> {
        let Wanted { context, request, options, keys, now } = wanted;
        let known = self.bounces.len();
        self.bounces.retain(Cached::is_complete);
        if self.bounces.len() < known {
            tools.pool.forget_groups();
        }
        let Some(full) = &keys.bounces else { return Ok(PlacedBounces::default()) };
        let coarse = request.coarse.map(|_| full.coarse());
        let cells = |divisor: usize, reach: u8| {
            cells_around(&self.volume, &self.tables.value, options, (divisor, reach))
        };
        let reach = sample_reach(&self.volume, request, options.samples);
        let least_reach = least_reach(wanted, reach);
        let find = |key: &BouncesKey| {
            let has_cells =
                |known: &BouncesVolume| cells(known.divisor, least_reach).is_within(&known.filled);
            self.bounces.iter().position(|known| known.holds(key) && has_cells(&known.value))
        };
        let found = find(full).or_else(|| coarse.as_ref().and_then(find));
        if let Some(slot) = found {
            self.bounces[slot].value.last_used = now;
            let key = self.bounces[slot].key().clone();
            return Ok(PlacedBounces { key: Some(key), slot: Some(slot), build: None });
        }
        let key = coarse.unwrap_or_else(|| full.clone());
        let divisor = divisor_on(context, self.volume.volume.dims(), key.resolution(), MOST_TEXELS);
        // Unfilled cells hold no light. Previews that look up cells further out find next to nothing visible there.
        let mut filled = cells(divisor, reach);
        // Compared settings may show different cells, so one volume covers both.
        for known in self.bounces.iter().filter(|known| known.holds(&key)) {
            filled = Arc::new(filled.with(&known.value.filled));
        }
        self.bounces.retain(|known| !known.holds(&key));
        if self.bounces.len() >= MOST_KEPT {
            let oldest = (0..self.bounces.len()).min_by_key(|&at| self.bounces[at].value.last_used);
            oldest.map(|at| self.bounces.swap_remove(at));
        }
        tools.pool.forget_groups();
        let mut fresh = BouncesVolume::new(context, self.volume.volume.dims(), divisor, filled)?;
        fresh.last_used = now;
        let slot = self.bounces.len();
        let settings = &request.settings;
        let light = (settings.sky.is_on(), settings.lights.iter().filter(|light| light.on).count());
        let gpu = Gpu::new(tools, &self.volume);
        let build = BouncesBuild::new(gpu, (&self.tables.value, options), &key, light, &fresh)?;
        self.bounces.push(Cached::unfilled(key.clone(), fresh));
        Ok(PlacedBounces { key: Some(key), slot: Some(slot), build: Some(build) })
    }

    /// Returns the size of all volumes of scattered light, in bytes.
    pub(crate) fn bounces_bytes(&self) -> u64 {
        self.bounces.iter().map(|known| known.value.bytes()).sum()
    }
}
