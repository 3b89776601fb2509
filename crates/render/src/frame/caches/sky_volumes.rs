//! Cache of sky-visibility volumes: look-up, recycling and eviction for a picture.

use std::sync::Arc;

use super::lookup_reach::{
    MAX_AMBIENT_VOLUMES, ambient_cells, max_stretch_reach, required_reach, view_sample_reach,
};
use crate::GpuError;
use crate::frame::loaded_volume::{LoadedVolume, ProductRequest};
use crate::frame::step::{FrameProduct, RenderStep};
use crate::plan::{FloorPlane, SkyKey};
use crate::resources::gpu_tools::GpuTools;
use crate::resources::product_cache::ProductPlace;
use crate::sky::fill::SkyFill;
use crate::sky::volume::{MAX_DIRECTION_TEXELS, SkyVolume, SkyVolumeExtent, divisor_for_adapter};
use crate::volume::VolumeContext;

/// Sky-visibility volume of a picture, and the work to fill it.
pub(crate) type SkyPlace = ProductPlace<SkyKey, SkyFill>;

impl SkyPlace {
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
    ) -> Result<SkyPlace, GpuError> {
        let ProductRequest { context, request, options, keys, picture_number: now } = wanted;
        if !self.skies.take_incomplete().is_empty() {
            tools.pool.drop_bind_groups();
        }
        let Some(full) = &keys.sky else { return Ok(SkyPlace::default()) };
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
        let has_cells =
            |known: &SkyVolume| cells(known.blocks.divisor, least_reach).is_subset(&known.filled_cells);
        let is_usable = |_: &SkyKey, known: &SkyVolume| has_floor(known) && has_cells(known);
        if let Some(slot) = self.skies.find([Some(full), coarse.as_ref()], is_usable) {
            return Ok(SkyPlace::with_complete(self.skies.claim(slot, now), slot));
        }
        let key = coarse.unwrap_or_else(|| full.clone());
        let divisor =
            divisor_for_adapter(context, self.volume.volume.dims(), key.resolution(), MAX_DIRECTION_TEXELS);
        let mut filled = cells(divisor, reach);
        let mut margin = cells(divisor, reach.max(max_stretch_reach())).difference(&filled);
        // Compared settings may show different cells, so one volume covers both.
        for known in self.skies.products_of(&key) {
            filled = Arc::new(filled.union(&known.filled_cells));
            margin = margin.union(&known.margin).difference(&filled);
        }
        self.skies.make_room(&key, MAX_AMBIENT_VOLUMES);
        tools.pool.drop_bind_groups();
        let extent = SkyVolumeExtent { filled, margin, floor };
        let fresh = SkyVolume::new(context, &self.volume.scene, divisor, extent)?;
        let gpu = VolumeContext::for_light(tools, &self.volume);
        let build = SkyFill::new(gpu, &self.tables.product, options, &key, &fresh)?;
        let slot = self.skies.insert(key.clone(), fresh, now);
        Ok(SkyPlace::with_build(key, slot, build))
    }

    /// Returns the size of all sky-visibility volumes, in bytes.
    pub(crate) fn sky_bytes(&self) -> u64 {
        self.skies.iter().map(|sky| sky.product.bytes()).sum()
    }
}
