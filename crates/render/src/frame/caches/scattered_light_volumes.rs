//! Cache of scattered-light volumes: look-up, recycling and eviction for a picture.

use std::sync::Arc;

use super::lookup_reach::{MAX_AMBIENT_VOLUMES, ambient_cells, required_reach, view_sample_reach};
use crate::GpuError;
use crate::frame::loaded_volume::{LoadedVolume, ProductRequest};
use crate::frame::step::{FrameProduct, RenderStep};
use crate::plan::BouncesKey;
use crate::resources::gpu_tools::GpuTools;
use crate::resources::product_cache::ProductPlace;
use crate::scattered_light::fill::ScatteredLightFill;
use crate::scattered_light::volume::{MAX_DIRECTION_TEXELS, ScatteredLightVolume};
use crate::sky::volume::divisor_for_adapter;
use crate::volume::VolumeContext;

/// Scattered-light volume of a picture, and the work to fill it.
pub(crate) type ScatteredLightPlace = ProductPlace<BouncesKey, ScatteredLightFill>;

impl ScatteredLightPlace {
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
    ) -> Result<ScatteredLightPlace, GpuError> {
        let ProductRequest { context, request, options, keys, picture_number: now } = wanted;
        if !self.bounces.take_incomplete().is_empty() {
            tools.pool.drop_bind_groups();
        }
        let Some(full) = &keys.bounces else { return Ok(ScatteredLightPlace::default()) };
        let coarse = request.preview_resolution.map(|_| full.for_preview());
        let cells = |divisor: usize, reach: u8| {
            ambient_cells(&self.volume, &self.tables.product, options, divisor, reach)
        };
        let reach = view_sample_reach(&self.volume, request, options.picture.samples);
        let least_reach = required_reach(wanted, reach);
        let has_cells = |_: &BouncesKey, known: &ScatteredLightVolume| {
            cells(known.blocks.divisor, least_reach).is_subset(&known.filled_cells)
        };
        if let Some(slot) = self.bounces.find([Some(full), coarse.as_ref()], has_cells) {
            return Ok(ScatteredLightPlace::with_complete(self.bounces.claim(slot, now), slot));
        }
        let key = coarse.unwrap_or_else(|| full.clone());
        let divisor =
            divisor_for_adapter(context, self.volume.volume.dims(), key.resolution(), MAX_DIRECTION_TEXELS);
        // Unfilled cells hold no light. Previews that look up cells further out find next to nothing visible there.
        let mut filled = cells(divisor, reach);
        // Compared settings may show different cells, so one volume covers both.
        for known in self.bounces.products_of(&key) {
            filled = Arc::new(filled.union(&known.filled_cells));
        }
        self.bounces.make_room(&key, MAX_AMBIENT_VOLUMES);
        tools.pool.drop_bind_groups();
        let fresh = ScatteredLightVolume::new(context, self.volume.volume.dims(), divisor, filled)?;
        let gpu = VolumeContext::for_light(tools, &self.volume);
        let (tables, settings) = (&self.tables.product, &request.settings);
        let build = ScatteredLightFill::new(gpu, tables, options, &key, settings, &fresh)?;
        let slot = self.bounces.insert(key.clone(), fresh, now);
        Ok(ScatteredLightPlace::with_build(key, slot, build))
    }

    /// Returns the size of all volumes of scattered light, in bytes.
    pub(crate) fn bounces_bytes(&self) -> u64 {
        self.bounces.iter().map(|known| known.product.blocks.bytes()).sum()
    }
}
