//! Statistics of a renderer: cached volumes, memory and work done.

use crate::light::light_volume::LightVolume;
use crate::plan::{BouncesKey, LightKey, RenderRequest, SkyKey};
use crate::resources::cache_entry::CacheEntry;
use crate::resources::fill_time::FillStopwatch;
use crate::resources::textures::read_word;
use crate::{GpuError, Renderer};

/// Statistics of a light volume, for display.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LightVolumeStatistics {
    /// `true` if the volume is filled.
    pub is_complete: bool,
    /// Time to fill the volume, in milliseconds, on adapters that execute commands synchronously; else `None`.
    pub fill_ms: Option<f64>,
    /// Size of the texture, in bytes.
    pub bytes: u64,
}

impl Renderer {
    /// Returns the statistics of a request's light volumes at full resolution, in the order of the settings.
    pub fn light_statistics(&self, request: &RenderRequest) -> Vec<Option<LightVolumeStatistics>> {
        let Some(loaded) = &self.loaded else { return Vec::new() };
        let figures = |key: &Option<LightKey>| {
            let wanted = key.as_ref()?;
            let is_same = |light: &&CacheEntry<LightKey, LightVolume>| *light.key() == *wanted;
            let light = loaded.product.lights.iter().find(is_same)?;
            Some(self.volume_statistics(light.is_complete(), &light.product.fill_time, light.product.bytes()))
        };
        (0..request.settings.lights.len()).map(|light| figures(&LightKey::new(request, light))).collect()
    }

    /// Returns the statistics of a request's sky volume at full resolution, if there is one.
    pub fn sky_statistics(&self, request: &RenderRequest) -> Option<LightVolumeStatistics> {
        let wanted = SkyKey::new(request)?;
        let sky = self.loaded.as_ref()?.product.skies.iter().find(|sky| *sky.key() == wanted)?;
        Some(self.volume_statistics(sky.is_complete(), &sky.product.fill_time, sky.product.bytes()))
    }

    /// Returns the number of voxels along the edge of a block in the last used sky volume; larger than requested if
    /// the rays would take too much memory.
    pub fn sky_divisor(&self) -> Option<usize> {
        let skies = &self.loaded.as_ref()?.product.skies;
        skies.last_used().map(|sky| sky.blocks.divisor)
    }

    /// Returns the statistics of a request's scattered-light volume at full resolution, if there is one.
    pub fn scattered_light_statistics(&self, request: &RenderRequest) -> Option<LightVolumeStatistics> {
        let wanted = BouncesKey::new(request)?;
        let known = &self.loaded.as_ref()?.product.bounces;
        let bounces = known.iter().find(|bounces| *bounces.key() == wanted)?;
        Some(self.volume_statistics(
            bounces.is_complete(),
            &bounces.product.fill_time,
            bounces.product.blocks.bytes(),
        ))
    }

    fn volume_statistics(&self, complete: bool, fill: &FillStopwatch, bytes: u64) -> LightVolumeStatistics {
        // On graphics cards submission is asynchronous, and the time measured is meaningless.
        let fill_ms = fill.elapsed_ms().filter(|_| self.context().is_software());
        LightVolumeStatistics { is_complete: complete, fill_ms, bytes }
    }

    /// Returns true if the volume of the last picture is completely transparent.
    pub fn is_volume_transparent(&self) -> bool {
        self.loaded.as_ref().is_some_and(|loaded| loaded.product.tables.product.eye.is_empty)
    }

    /// Returns the number of times each light's volume was filled, counted at its first march.
    pub fn light_rebuilds(&self) -> &[u64] {
        &self.fill_counts
    }

    /// Returns the number of complete light volumes in the cache.
    pub fn cached_light_volumes(&self) -> usize {
        let lights = self.loaded.iter().flat_map(|loaded| loaded.product.lights.iter());
        lights.filter(|light| light.is_complete()).count()
    }

    /// Returns the current size of the renderer's textures and buffers on the GPU, in bytes.
    pub fn gpu_bytes(&self) -> u64 {
        let loaded = self.loaded.as_ref().map_or(0, |loaded| loaded.product.bytes());
        self.targets.bytes() + self.tools.pool.bytes() + loaded + self.spare_volumes.bytes()
    }

    /// Returns the size of all attenuation volumes and the combined one, in bytes.
    pub fn light_bytes(&self) -> u64 {
        self.loaded.as_ref().map_or(0, |loaded| loaded.product.light_bytes())
    }

    /// Returns the number of footprints that the last picture splatted; 0 for the gathering engine. Waits for the
    /// picture.
    ///
    /// # Errors
    /// Returns an error if the device fails.
    pub fn splat_count(&self) -> Result<u64, GpuError> {
        let counter = self.targets.front.light.product.splat_counter.as_ref();
        counter.map_or(Ok(0), |counter| read_word(self.context(), counter).map(u64::from))
    }

    /// Returns the number of buffers, bind groups and rings made so far, which stays constant while the same things
    /// are drawn again.
    #[cfg(feature = "testing")]
    pub fn created_resources(&self) -> u64 {
        self.tools.pool.created_count()
    }
}
